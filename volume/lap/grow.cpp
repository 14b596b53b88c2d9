#include "volume/lap/grow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pith {

void GrowWorkspace::begin(std::size_t simplices, std::size_t vertices) {
  if (simplex_.size() != simplices || vertex_.size() != vertices || stamp_ == 0xffffffffu) {
    simplex_.assign(simplices, 0);
    simplex_stamp_.assign(simplices, 0);
    vertex_.assign(vertices, 0);
    vertex_stamp_.assign(vertices, 0);
    stamp_ = 0;
  }
  ++stamp_;
}

namespace {

constexpr float little_confidence =
    0.02f; ///< of simplices whose frame is not the seed's, where they are taken at all

class Grower {
public:
  Grower(const Simplices& mesh, const GrowField& field, const Mask& mask, std::uint32_t seed,
         const std::array<double, 3>& pin, const std::array<float, 4>& at, const GrowRule& rule,
         GrowWorkspace& workspace)
      : mesh_(mesh), field_(field), mask_(mask), rule_(rule), workspace_(workspace),
        frames_(field.frames, rule.seed_frame), seed_scale_(field.scale[seed]), pin_(pin), pin_at_(at),
        smallest_cosine_(std::cos(rule.frame_tolerance)), farthest_cosine_(rule.reach > std::numbers::pi ? -2
                                                                           : rule.reach > 0 ? std::cos(rule.reach)
                                                                                            : 2) {
    workspace_.begin(mesh.count, mesh.vertex_count);
    Clump& clump = growth_.clump;
    clump.axes = mask.axes;
    add_simplex(seed);
    Vec3d center = Vec3d::Zero();
    for (int i = 0; i < mesh_.corners; ++i) center += at[i] * position(corner(seed, i));
    for (int i = 0; i < mesh_.corners; ++i) {
      const std::uint32_t v = corner(seed, i);
      for (int a = 0; a < clump.axes; ++a) set_coordinate(v, a, pin[a] + target_[0].col(a).dot(position(v) - center));
    }
  }

  Growth run() {
    expand(0);
    for (int pass = 0; pass < 3; ++pass) {
      warp_clump();
      const std::size_t before = growth_.clump.simplex.size();
      expand(0);
      if (growth_.clump.simplex.size() == before) break;
      if (growth_.clump.simplex.size() < before + before / 50) {
        warp_clump();
        break;
      }
    }
    give_back_mirrored();
    set_weights();
    return std::move(growth_);
  }

private:
  std::uint32_t corner(std::uint32_t simplex, int i) const {
    return mesh_.corner[std::size_t(simplex) * mesh_.corners + i];
  }
  const Vec3d& position(std::uint32_t vertex) const { return mesh_.position[vertex]; }
  bool imposed(int axis) const { return !field_.coordinate[axis].empty(); }

  void set_coordinate(std::uint32_t vertex, int axis, double value) {
    growth_.clump.coordinate[workspace_.local_vertex(vertex) * growth_.clump.axes + axis] =
        imposed(axis) ? field_.coordinate[axis][vertex] : value;
  }

  /// The gradients (columns) that the coordinates should have on a simplex: its frame's axes over its scale, or the
  /// seed's where the simplex' own frame does not count.
  Mat3d target(std::uint32_t s, bool follows) const {
    Mat3d gradient = follows ? frames_.at(s) : frames_.seed();
    const double scale = follows ? field_.scale[s] : seed_scale_;
    for (int a = 0; a < 3; ++a) gradient.col(a) /= scale * field_.extent[a];
    return gradient;
  }

  void add_simplex(std::uint32_t s) {
    Clump& clump = growth_.clump;
    workspace_.set_simplex(s, static_cast<std::uint32_t>(clump.simplex.size()));
    clump.simplex.push_back(s);
    const bool follows = follows_seed(s);
    clump.confidence.push_back(follows ? 1.0f : little_confidence);
    if (!field_.length_weight.empty()) clump.length_weight.push_back(follows ? field_.length_weight[s] : 1.0f);
    target_.push_back(target(s, follows));
    for (int i = 0; i < mesh_.corners; ++i) {
      const std::uint32_t v = corner(s, i);
      std::uint32_t local = workspace_.local_vertex(v);
      if (local == Simplices::none) {
        local = static_cast<std::uint32_t>(clump.vertex.size());
        workspace_.set_vertex(v, local);
        clump.vertex.push_back(v);
        clump.coordinate.resize(clump.coordinate.size() + clump.axes, 0.0);
      }
      clump.corner.push_back(local);
    }
  }

  bool singular(std::uint32_t s) const { return !field_.singular.empty() && field_.singular[s]; }

  bool follows_seed(std::uint32_t s) const {
    if (singular(s)) return false;
    const double ratio = field_.scale[s] / seed_scale_;
    return frames_.cosine(s) >= smallest_cosine_ && ratio <= rule_.scale_tolerance &&
           ratio * rule_.scale_tolerance >= 1;
  }

  /// Coordinates of all corners of a simplex beside the clump: known ones, and for a new corner the mean of what its
  /// frame predicts from the known ones (cf. Praun 2000, "predicted positions").
  void predict(std::uint32_t s, std::array<std::array<double, 3>, 4>& w) const {
    const int axes = growth_.clump.axes;
    const Mat3d gradient = target(s, follows_seed(s));
    std::array<std::uint32_t, 4> local{};
    for (int i = 0; i < mesh_.corners; ++i) local[i] = workspace_.local_vertex(corner(s, i));
    for (int i = 0; i < mesh_.corners; ++i) {
      if (local[i] != Simplices::none) {
        for (int a = 0; a < axes; ++a) w[i][a] = growth_.clump.coordinate[local[i] * axes + a];
        continue;
      }
      w[i] = {};
      int known = 0;
      for (int j = 0; j < mesh_.corners; ++j) {
        if (local[j] == Simplices::none) continue;
        ++known;
        const Vec3d step = position(corner(s, i)) - position(corner(s, j));
        for (int a = 0; a < axes; ++a)
          w[i][a] += growth_.clump.coordinate[local[j] * axes + a] + gradient.col(a).dot(step);
      }
      for (int a = 0; a < axes; ++a) w[i][a] = imposed(a) ? field_.coordinate[a][corner(s, i)] : w[i][a] / known;
    }
  }

  /// Partly under the mask: at a corner, the middle of an edge, or the barycentre.
  bool under_mask(const std::array<std::array<double, 3>, 4>& w, int corners) const {
    const auto opaque_at = [&](auto&&... i) {
      std::array<double, 3> p{};
      for (int a = 0; a < mask_.axes; ++a) p[a] = (w[i][a] + ...) / sizeof...(i);
      return mask_.touches(p.data());
    };
    for (int i = 0; i < corners; ++i) {
      if (opaque_at(i)) return true;
      for (int j = 0; j < i; ++j)
        if (opaque_at(i, j)) return true;
    }
    return corners == 4 ? opaque_at(0, 1, 2, 3) : corners == 3 && opaque_at(0, 1, 2);
  }

  /// Breadth first from clump simplex `from` on: adds neighbours that follow the seed's frame and lie under the mask.
  void expand(std::size_t from) {
    Clump& clump = growth_.clump;
    std::array<std::array<double, 3>, 4> w;
    for (std::size_t at = from; at < clump.simplex.size(); ++at)
      for (int k = 0; k < mesh_.corners; ++k) {
        const std::uint32_t next = mesh_.neighbor[std::size_t(clump.simplex[at]) * mesh_.corners + k];
        if (next == Simplices::none || workspace_.local_simplex(next) != Simplices::none) continue;
        if (!follows_seed(next) && !singular(next) && !(frames_.cosine(next) >= farthest_cosine_)) continue;
        predict(next, w);
        if (!under_mask(w, mesh_.corners)) continue;
        add_simplex(next);
        for (int i = 0; i < mesh_.corners; ++i)
          for (int a = 0; a < clump.axes; ++a) set_coordinate(corner(next, i), a, w[i][a]);
      }
  }

  void warp_clump() {
    Clump& clump = growth_.clump;
    const int axes = clump.axes;
    std::vector<Vec3d> targets(clump.simplex.size() * axes);
    std::vector<double> weight(clump.simplex.size());
    for (std::uint32_t s = 0; s < clump.simplex.size(); ++s) {
      for (int a = 0; a < axes; ++a) targets[s * axes + a] = target_[s].col(a);
      const double scale = field_.scale[clump.simplex[s]];
      weight[s] = mesh_.measure[clump.simplex[s]] * clump.confidence[s] * scale * scale;
    }
    std::array<bool, 3> solve{};
    for (int a = 0; a < axes; ++a) solve[a] = !imposed(a);
    growth_.warp_iterations += warp(mesh_, clump, targets, weight, solve, pin_, pin_at_);
  }

  /// Takes tets in mirror image out of the clump: beyond the axis coordinates that are imposed fall again.
  void give_back_mirrored() {
    Clump& clump = growth_.clump;
    if (mesh_.corners != 4 || clump.axes != 3) return;
    std::uint32_t kept = 0;
    for (std::uint32_t s = 0; s < clump.simplex.size(); ++s) {
      const auto at = [&](int i) { return Vec3d::Map(&clump.coordinate[std::size_t(clump.corner[4 * s + i]) * 3]); };
      const Vec3d origin = at(0);
      if (!(rule_.mirrored && s == 0) && (at(1) - origin).cross(at(2) - origin).dot(at(3) - origin) < 0) {
        workspace_.set_simplex(clump.simplex[s], Simplices::none);
        continue;
      }
      clump.simplex[kept] = clump.simplex[s];
      clump.confidence[kept] = clump.confidence[s];
      if (!clump.length_weight.empty()) clump.length_weight[kept] = clump.length_weight[s];
      for (int i = 0; i < 4; ++i) clump.corner[4 * kept + i] = clump.corner[4 * s + i];
      ++kept;
    }
    clump.simplex.resize(kept);
    clump.confidence.resize(kept);
    if (!clump.length_weight.empty()) clump.length_weight.resize(kept);
    clump.corner.resize(4 * std::size_t(kept));
  }

  /// A vertex on a side behind which growth stopped although the mask is not 0 there fades to 0. A pivot does not:
  /// all pieces around it end there, and it would be left bare.
  void set_weights() {
    const Clump& clump = growth_.clump;
    growth_.weight.assign(clump.vertex.size(), 1.0f);
    if (farthest_cosine_ < -1) return;
    for (std::size_t s = 0; s < clump.simplex.size(); ++s)
      for (int k = 0; k < mesh_.corners; ++k) {
        const std::uint32_t next = mesh_.neighbor[std::size_t(clump.simplex[s]) * mesh_.corners + k];
        if (next == Simplices::none || workspace_.local_simplex(next) != Simplices::none) continue;
        std::array<std::array<double, 3>, 4> side{};
        std::array<std::uint32_t, 4> local{};
        int count = 0;
        for (int i = 0; i < mesh_.corners; ++i) {
          if (i == k) continue;
          local[count] = clump.corner[s * mesh_.corners + i];
          for (int a = 0; a < clump.axes; ++a) side[count][a] = clump.coordinate[local[count] * clump.axes + a];
          ++count;
        }
        if (under_mask(side, count))
          for (int i = 0; i < count; ++i)
            if (field_.pivot.empty() || !field_.pivot[clump.vertex[local[i]]]) growth_.weight[local[i]] = 0;
      }
  }

  const Simplices& mesh_;
  const GrowField& field_;
  const Mask& mask_;
  const GrowRule& rule_;
  GrowWorkspace& workspace_;
  PasteFrames frames_;
  double seed_scale_;
  std::array<double, 3> pin_;
  std::array<float, 4> pin_at_;
  double smallest_cosine_, farthest_cosine_;
  std::vector<Mat3d> target_; ///< per clump simplex
  Growth growth_;
};

} // namespace

Growth grow(const Simplices& mesh, const GrowField& field, const Mask& mask, std::uint32_t seed,
            const std::array<double, 3>& pin, const std::array<float, 4>& pin_barycentric, const GrowRule& rule,
            GrowWorkspace& workspace) {
  return Grower(mesh, field, mask, seed, pin, pin_barycentric, rule, workspace).run();
}

} // namespace pith
