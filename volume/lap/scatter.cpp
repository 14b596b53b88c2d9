// Poisson-disk sampling by dart throwing in a fixed random order (Cook 1986; the order by hashed priority as in Wei,
// Parallel Poisson Disk Sampling, SIGGRAPH 2008), with boxes instead of balls.
#include "volume/lap/scatter.h"

#include "volume/base/error.h"
#include "volume/base/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <unordered_map>

namespace pith {

namespace {

constexpr std::uint64_t stage = 0x5ca77e2; // of random numbers
constexpr int tries_per_cell = 2;

struct Candidate {
  std::uint64_t priority = 0;
  std::array<std::int32_t, 4> cell{}; ///< of the lattice, and which of its points
  TetId tet;
  Vec3d place = Vec3d::Zero();
  std::array<double, 4> barycentric{};
};

void check(const ScatterGround& ground, const ScatterOptions& o, const std::string& where) {
  const auto refuse = [&](const char* key, const std::string& what, const std::string& mend) {
    throw InvalidInput(where + "/" + key, what, mend);
  };
  if (!(o.size > 0) || !std::isfinite(o.size))
    refuse("size", "is " + std::to_string(o.size) + ", must be positive", "give millimetres");
  if (!(o.size_variation >= 0) || o.size_variation > 0.9)
    refuse("size_variation", "is outside 0 to 0.9", "give a part");
  if (o.count < 0) refuse("count", "is negative", "give a number of things");
  if (!(o.spacing >= 0) || !(o.gap >= 0)) refuse("spacing", "or gap is negative", "give millimetres");
  if (o.count == 0 && !(o.spacing > 0)) refuse("count", "is missing", "give a count, or a spacing in millimetres");
  if (!(o.depth[0] <= o.depth[1])) refuse("depth", "is an empty band", "give [low, high]");
  if ((o.depth[0] > 0 || o.depth[1] < 1) && ground.depth.size() != ground.paste.mesh.vertex_count())
    refuse("depth", "is given for a solid that has no depth", "remove it, or give the solid depth constraints");
  if (!(o.along[0] <= o.along[1])) refuse("along", "is an empty band", "give [low, high]");
  if (!((o.axis[1] - o.axis[0]).norm() > 0)) refuse("axis", "has no length", "give two different points");
  if (o.groups < 0) refuse("groups", "is negative", "give a number of sectors");
  if (!(o.group_width > 0) || o.group_width > 1)
    refuse("group_width", "is outside 0 to 1", "give a part of a sector");
  if (o.follow == Follow::warped && (ground.paste.axes.empty() || ground.paste.scale.empty()))
    refuse("follow", "is \"warped\", but the solid has no frames to follow", "use \"rigid\"");
}

/// Where middles may lie, but for depth.
class Rule {
public:
  explicit Rule(const ScatterOptions& o) : o_(o), direction_(o.axis[1] - o.axis[0]) {
    const double squared = direction_.squaredNorm();
    per_length_ = direction_ / squared;
    Vec3d helper = Vec3d::Zero();
    int smallest = 0;
    for (int a = 1; a < 3; ++a)
      if (std::abs(direction_[a]) < std::abs(direction_[smallest])) smallest = a;
    helper[smallest] = 1;
    first_ = (helper - helper.dot(direction_) * per_length_).normalized();
    second_ = direction_.cross(first_).normalized();
    everywhere_ = o.groups == 0 && std::isinf(o.along[0]) && std::isinf(o.along[1]);
  }
  bool allows(const Vec3d& x) const {
    if (everywhere_) return true;
    const Vec3d from = x - o_.axis[0];
    const double t = from.dot(per_length_);
    if (t < o_.along[0] || t > o_.along[1]) return false;
    if (o_.groups == 0) return true;
    const double turn = std::atan2(from.dot(second_), from.dot(first_)) / (2 * std::numbers::pi) * o_.groups;
    return std::abs(turn - std::round(turn)) <= 0.5 * o_.group_width;
  }

private:
  const ScatterOptions& o_;
  Vec3d direction_, per_length_, first_, second_;
  bool everywhere_;
};

/// The lattice's edge, mm: fine enough that things find what room there is, coarse enough that not many more
/// candidates are tried than things are wanted. In steps of √2, so that small changes of the solid leave it alone.
double lattice_edge(const ScatterGround& ground, const Thing& thing, const ScatterOptions& o,
                    const std::string& where) {
  const Vec3d extent = thing.solid.extent();
  const double smallest = 0.9 * o.size * extent.minCoeff() / extent.maxCoeff();
  double volume = 0;
  for (const TetId t : all_ids<TetId>(ground.paste.mesh.tet_count()))
    if (ground.paste.mesh.region[t] == ground.paste.region) volume += signed_volume(ground.paste.mesh, t);
  double edge = std::max(smallest, o.spacing / 2);
  if (o.count > 0) edge = std::max(edge, std::cbrt(volume / (200.0 * o.count)));
  edge = std::exp2(std::round(2 * std::log2(edge)) / 2);
  const double candidates = tries_per_cell * volume / (edge * edge * edge);
  if (candidates > 1e8)
    throw InvalidInput(where, "asks for about " + std::to_string(candidates / 50) + " things",
                       "give a larger spacing or size");
  return edge;
}

std::vector<Candidate> candidates_of(const ScatterGround& ground, const ScatterOptions& o, double edge) {
  const TetMesh& mesh = ground.paste.mesh;
  const Rule rule(o);
  const bool banded = o.depth[0] > 0 || o.depth[1] < 1;
  constexpr std::size_t block = 256;
  std::vector<std::vector<Candidate>> found((mesh.tet_count() + block - 1) / block);
  parallel_blocks(mesh.tet_count(), block, [&](std::size_t begin, std::size_t end) {
    std::vector<Candidate>& list = found[begin / block];
    for (std::size_t i = begin; i < end; ++i) {
      const TetId t(i);
      if (mesh.region[t] != ground.paste.region) continue;
      const auto& c = mesh.corner[t];
      std::array<double, 4> depth{};
      if (banded) {
        for (int k = 0; k < 4; ++k) depth[k] = ground.depth[c[k]];
        const auto [low, high] = std::minmax_element(depth.begin(), depth.end());
        if (*high < o.depth[0] || *low > o.depth[1]) continue;
      }
      Box box;
      for (const VertexId v : c) box.add(mesh.position[v]);
      std::array<std::int32_t, 3> first, last;
      for (int a = 0; a < 3; ++a) {
        first[a] = static_cast<std::int32_t>(std::floor(box.low[a] / edge));
        last[a] = static_cast<std::int32_t>(std::floor(box.high[a] / edge));
      }
      const Vec3d& p0 = mesh.position[c[0]];
      Mat3d edges;
      for (int k = 0; k < 3; ++k) edges.col(k) = mesh.position[c[k + 1]] - p0;
      const Mat3d inverse = edges.inverse();
      // How far barycentrics reach within half a cell: cells wholly outside the tet are left out before any hashing.
      const Vec3d reach = 0.5 * edge * inverse.cwiseAbs().rowwise().sum();
      const double reach0 = 0.5 * edge * inverse.colwise().sum().cwiseAbs().sum();
      const Vec3d rise = Vec3d(depth[1], depth[2], depth[3]) - Vec3d::Constant(depth[0]); // of depth, per barycentric
      const double depth_reach = 0.5 * edge * (rise.transpose() * inverse).cwiseAbs().sum();
      for (std::int32_t z = first[2]; z <= last[2]; ++z)
        for (std::int32_t y = first[1]; y <= last[1]; ++y)
          for (std::int32_t x = first[0]; x <= last[0]; ++x) {
            const Vec3d middle = inverse * (edge * Vec3d(x + 0.5, y + 0.5, z + 0.5) - p0);
            if ((middle + reach).minCoeff() < 0 || 1 - middle.sum() + reach0 < 0) continue;
            if (banded) {
              const double d = depth[0] + rise.dot(middle);
              if (d + depth_reach < o.depth[0] || d - depth_reach > o.depth[1]) continue;
            }
            for (int n = 0; n < tries_per_cell; ++n) {
              Random random(o.seed, stage, x, y, z, n);
              const double ux = random.uniform(), uy = random.uniform(), uz = random.uniform();
              const Vec3d place = edge * Vec3d(x + ux, y + uy, z + uz);
              const Vec3d b = inverse * (place - p0);
              const double b0 = 1 - b.sum();
              if (b0 < 0 || (b.array() < 0).any()) continue;
              if (banded) {
                const double d = b0 * depth[0] + b[0] * depth[1] + b[1] * depth[2] + b[2] * depth[3];
                if (d < o.depth[0] || d > o.depth[1]) continue;
              }
              if (!rule.allows(place)) continue;
              list.push_back({random.bits(), {x, y, z, n}, t, place, {b0, b[0], b[1], b[2]}});
            }
          }
    }
  });
  std::vector<Candidate> all;
  for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
  std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.priority, a.cell, a.tet.value) < std::tie(b.priority, b.cell, b.tet.value);
  });
  // A point on the side between two tets was found in both.
  all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.cell == b.cell; }),
            all.end());
  return all;
}

/// Boxes by where their middles are, for finding those near by.
class Crowd {
public:
  explicit Crowd(double reach) : reach_(reach) {}
  void add(const PlacedBox& box) {
    large_ |= 2 * box.half.norm() > reach_;
    cells_[key(cell(box.center))].push_back(static_cast<std::uint32_t>(box_.size()));
    box_.push_back(box);
  }
  /// Whether a middle at x is nearer than `distance` to another one: cheaper than crowds().
  bool near(const Vec3d& x, double distance) const {
    return any(x, distance,
               [&](const PlacedBox& other) { return (other.center - x).squaredNorm() < distance * distance; });
  }
  /// Whether a box comes nearer than `gap` to one that is there, or its middle nearer than `spacing`.
  bool crowds(const PlacedBox& box, double gap, double spacing) const {
    return any(box.center, reach_, [&](const PlacedBox& other) {
      return (spacing > 0 && (other.center - box.center).squaredNorm() < spacing * spacing) || box.meets(other, gap);
    });
  }

private:
  std::array<std::int64_t, 3> cell(const Vec3d& x) const {
    return {std::int64_t(std::floor(x[0] / reach_)), std::int64_t(std::floor(x[1] / reach_)),
            std::int64_t(std::floor(x[2] / reach_))};
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& c) { return hash_of(c[0], c[1], c[2]); }
  /// Whether some box whose middle may lie within `radius` of x is hit.
  template <class Hits>
  bool any(const Vec3d& x, double radius, const Hits& hits) const {
    if (large_) return std::any_of(box_.begin(), box_.end(), hits);
    const auto low = cell(x - Vec3d::Constant(radius)), high = cell(x + Vec3d::Constant(radius));
    for (std::int64_t k = low[2]; k <= high[2]; ++k)
      for (std::int64_t j = low[1]; j <= high[1]; ++j)
        for (std::int64_t i = low[0]; i <= high[0]; ++i) {
          const auto at = cells_.find(key({i, j, k}));
          if (at == cells_.end()) continue;
          for (const std::uint32_t n : at->second)
            if (hits(box_[n])) return true;
        }
    return false;
  }
  double reach_;
  bool large_ = false; ///< some box is larger than the cells were made for
  std::vector<PlacedBox> box_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

Mat3d turned(double angle, const Vec3d& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

/// The paste that a candidate stands for.
PasteOptions paste_of(const ScatterOptions& o, const Candidate& candidate) {
  Random random(candidate.priority, stage + 1);
  PasteOptions p;
  p.place = candidate.place;
  p.size = o.size * (1 + o.size_variation * random.uniform(-1, 1));
  const double height = random.uniform(-1, 1), around = 2 * std::numbers::pi * random.uniform();
  const double flat = std::sqrt(std::max(0.0, 1 - height * height));
  const Vec3d tilt_axis(flat * std::cos(around), height, flat * std::sin(around));
  const double tilt = o.jitter * random.uniform(), spin = o.spin * random.uniform(-1, 1);
  p.rotation = turned(tilt, tilt_axis) * o.rotation * turned(spin, Vec3d::UnitY());
  p.in_frame = o.in_frame;
  p.follow = o.follow;
  p.clip = o.clip;
  return p;
}

} // namespace

ScatterResult scatter(const ScatterGround& ground, const Thing& thing, const ScatterOptions& o,
                      std::span<const PlacedBox> taken, const std::string& where, const Progress& progress) {
  check(ground, o, where);
  const std::vector<Candidate> candidates = candidates_of(ground, o, lattice_edge(ground, thing, o, where));
  report(progress, 0.2);
  const Vec3d extent = thing.solid.extent() / thing.solid.extent().maxCoeff();
  Crowd crowd(std::max(o.spacing, extent.norm() * o.size * (1 + o.size_variation) + o.gap));
  for (const PlacedBox& box : taken) crowd.add(box);

  Paster paster(ground.paste, thing, true);
  ScatterResult result;
  // Balls of half the boxes' least width lie inside the boxes: middles nearer than that are out at once.
  const double least_distance = std::max(o.spacing, o.gap + o.size * (1 - o.size_variation) * extent.minCoeff());
  std::size_t tried = 0;
  for (const Candidate& candidate : candidates) {
    if (o.count > 0 && result.pasted.size() == static_cast<std::size_t>(o.count)) break;
    if (++tried % 4096 == 0) report(progress, 0.2 + 0.8 * tried / candidates.size());
    if (crowd.near(candidate.place, least_distance)) continue;
    const PasteOptions p = paste_of(o, candidate);
    const Location at{candidate.tet, candidate.barycentric, true};
    const PlacedBox box = paster.box(at, p);
    if (crowd.crowds(box, o.gap, o.spacing) || (!o.clip && !paster.whole(at, box))) continue;
    crowd.add(box);
    result.pasted.push_back(paster.pasted(at, box, p));
  }
  report(progress, 1);
  if (result.pasted.empty())
    throw InvalidInput(where, "finds no room for a single thing",
                       "make the bands of depth and along wider, or the things smaller");
  result.wanted = o.count > 0 ? o.count : static_cast<int>(result.pasted.size());
  return result;
}

} // namespace pith
