#include "volume/measure/things.h"

#include "volume/base/random.h"
#include "volume/measure/sighting.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pith {

namespace {

constexpr std::uint64_t stage = 0x7419; // of random numbers

/// A place in a mask's cube, and how much of the thing it stands for.
struct AlphaPoint {
  Vec3d u;
  double weight;
};

/// Stratified points over a mask's alpha; weights sum to 1. Empty where the mask is 0 everywhere.
std::vector<AlphaPoint> points_of(const Mask& mask, const MaskGrid& grid, const ThingOptions& options) {
  std::vector<double> up_to;
  double sum = 0;
  for (const std::uint8_t alpha : mask.alpha) up_to.push_back(sum += alpha);
  std::vector<AlphaPoint> points;
  double weights = 0;
  for (std::size_t i = 0; sum > 0 && i < options.samples; ++i) {
    Random random(options.seed, stage, i);
    const double at = sum * (static_cast<double>(i) + random.uniform()) / static_cast<double>(options.samples);
    const std::size_t texel =
        std::min<std::size_t>(std::upper_bound(up_to.begin(), up_to.end(), at) - up_to.begin(), up_to.size() - 1);
    if (mask.alpha[texel] == 0) continue;
    const std::size_t nx = mask.size[0], ny = mask.size[1];
    const std::array<std::size_t, 3> place{texel % nx, texel / nx % ny, texel / (nx * ny)};
    AlphaPoint point;
    for (int k = 0; k < 3; ++k) point.u[k] = (static_cast<double>(place[k]) + random.uniform()) / mask.size[k];
    // Alpha is interpolated between the middles of texels.
    const float alpha = grid.alpha(Lanes{float(point.u[0]), float(point.u[1]), float(point.u[2]), 0});
    point.weight = alpha / (mask.alpha[texel] / 255.0);
    if (!(point.weight > 0)) continue;
    weights += point.weight;
    points.push_back(point);
  }
  for (AlphaPoint& p : points) p.weight /= weights;
  return points;
}

/// One look-up of a thing: its tet, and the map from the mask's cube to barycentric coordinates.
struct Part {
  const Lookup* lookup = nullptr;
  TetId tet;
  Mat3d inverse = Mat3d::Zero(); ///< barycentric coordinates 1 to 3 = inverse · (u − origin)
  Vec3d origin = Vec3d::Zero();
  Mat3d rest;                    ///< columns: edges of the tet in rest space, mm
  Vec3d stretch = Vec3d::Zero(); ///< singular values of the map from the cube to rest space, mm
  bool regular = false;          ///< it can be inverted
  bool mirrored = false;

  std::array<double, 4> barycentric(const Vec3d& u) const {
    const Vec3d b = inverse * (u - origin);
    return {1 - b.sum(), b[0], b[1], b[2]};
  }
};

Part part_of(const TetMesh& mesh, const Layer& layer, const Lookup& lookup, TetId tet) {
  Part part;
  part.lookup = &lookup;
  part.tet = tet;
  Mat3d cube;
  const auto at = [&](int i) {
    const float* row = layer.corner.data() + std::size_t(lookup.corner[i]) * 4;
    return Vec3d(row[0], row[1], row[2]);
  };
  part.origin = at(0);
  for (int k = 0; k < 3; ++k) {
    cube.col(k) = at(k + 1) - part.origin;
    part.rest.col(k) = mesh.position[mesh.corner[tet][k + 1]] - mesh.position[mesh.corner[tet][0]];
  }
  const double determinant = cube.determinant();
  part.regular = std::abs(determinant) > 1e-300;
  if (!part.regular) return part;
  part.inverse = cube.inverse();
  part.mirrored = determinant * part.rest.determinant() < 0;
  const Mat3d map = part.rest * part.inverse;
  const Eigen::SelfAdjointEigenSolver<Mat3d> squares(map.transpose() * map, Eigen::EigenvaluesOnly);
  part.stretch = squares.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return part;
}

/// What became of a thing's alpha: parts that sum to 1.
struct Fate {
  double seen = 0, sliced = 0, hidden = 0, bent = 0, outside = 0;
  Vec3d middle = Vec3d::Zero();
};

class Watcher {
public:
  Watcher(const Root& root, const Layer& layer, const ThingOptions& options)
      : root_(root), mesh_(root.model().mesh), layer_(layer), options_(options), reader_(layer, false) {
    bool above = false;
    for (const Layer& l : root.model().layer) {
      if (above && l.domain == Domain::solid && (l.region < 0 || layer.region < 0 || l.region == layer.region))
        above_.emplace_back(l, false);
      above |= &l == &layer;
    }
  }

  Fate fate_of(const std::vector<Part>& parts, const std::vector<AlphaPoint>& points) const {
    Fate fate;
    struct Place {
      const Part* part;
      std::array<double, 4> barycentric;
      bool held;
    };
    std::vector<Place> places;
    double log_scale = 0, log_weight = 0;
    for (const AlphaPoint& point : points) {
      Place place{nullptr, {}, false};
      double best = -INFINITY;
      for (const Part& part : parts) {
        if (!part.regular) continue;
        const std::array<double, 4> b = part.barycentric(point.u);
        const double least = *std::min_element(b.begin(), b.end());
        if (least > best) best = least, place.part = &part, place.barycentric = b;
      }
      place.held = best > -1e-4; // corners are single precision
      places.push_back(place);
      if (!place.held) continue;
      log_scale += point.weight * std::log(place.part->stretch.prod()) / 3;
      log_weight += point.weight;
    }
    const double scale = log_weight > 0 ? std::exp(log_scale / log_weight) : 0;
    Sighting sighting;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double weight = points[i].weight;
      const Place& place = places[i];
      if (!place.part) {
        fate.sliced += weight;
        continue;
      }
      const Part& part = *place.part;
      const Vec3d x = mesh_.position[mesh_.corner[part.tet][0]] +
                      part.rest * Vec3d(place.barycentric[1], place.barycentric[2], place.barycentric[3]);
      fate.middle += weight * x;
      if (!place.held) {
        const bool inside = root_.locator().owner(x, mesh_.region[part.tet]).exists();
        (inside ? fate.sliced : fate.outside) += weight;
        continue;
      }
      look_at(reader_, part.tet, place.barycentric, sighting);
      double share = 0, through = 1;
      for (const SeenLookup& s : sighting.seen)
        if (s.lookup == part.lookup) share = s.share;
      for (const LayerReader& reader : above_) {
        look_at(reader, part.tet, place.barycentric, sighting);
        through *= 1 - sighting.coverage;
      }
      std::array<float, 4> b;
      for (int k = 0; k < 4; ++k) b[k] = static_cast<float>(place.barycentric[k]);
      const double own = sight_of(reader_, *part.lookup, b).alpha; // after the weight
      const double full = reader_.patch[part.lookup->patch].mask->alpha(
          Lanes{float(points[i].u[0]), float(points[i].u[1]), float(points[i].u[2]), 0});
      const double kept = std::min(1.0, own / full), visible = std::min(kept, share * through / full);
      fate.sliced += weight * (1 - kept);
      fate.hidden += weight * (kept - visible);
      const double limit = 1 + options_.bend_tolerance;
      const bool bent =
          part.mirrored || part.stretch.maxCoeff() > limit * scale || part.stretch.minCoeff() * limit < scale;
      (bent ? fate.bent : fate.seen) += weight * visible;
    }
    return fate;
  }

private:
  const Root& root_;
  const TetMesh& mesh_;
  const Layer& layer_;
  const ThingOptions& options_;
  LayerReader reader_;
  std::vector<LayerReader> above_; ///< of the solid layers over this one
};

/// The look-ups of each patch, with the tets that they lie on: one list after the other.
struct PatchParts {
  std::vector<std::size_t> begin;
  std::vector<std::pair<std::uint32_t, TetId>> lookup;
};
PatchParts parts_by_patch(const Layer& layer) {
  PatchParts parts;
  parts.begin.assign(layer.patch.size() + 1, 0);
  for (const Lookup& l : layer.lookup) ++parts.begin[l.patch + 1];
  for (std::size_t p = 0; p < layer.patch.size(); ++p) parts.begin[p + 1] += parts.begin[p];
  parts.lookup.resize(layer.lookup.size());
  std::vector<std::size_t> next(parts.begin.begin(), parts.begin.end() - 1);
  for (std::size_t row = 0; row + 1 < layer.begin.size(); ++row) {
    const TetId tet(layer.simplex.empty() ? row : layer.simplex[row]);
    for (std::uint32_t i = layer.begin[row]; i < layer.begin[row + 1]; ++i)
      parts.lookup[next[layer.lookup[i].patch]++] = {i, tet};
  }
  return parts;
}

} // namespace

std::optional<ThingMeasure> thing_measure(const Root& root, const Layer& layer, const ThingOptions& options,
                                          const Progress& progress) {
  if (layer.domain != Domain::solid || layer.width != 3 || layer.blend.mix != Blend::Mix::over) return std::nullopt;
  const Watcher watcher(root, layer, options);
  std::vector<std::vector<AlphaPoint>> points;
  for (const Mask& mask : layer.mask) points.push_back(points_of(mask, MaskGrid(mask), options));
  const PatchParts parts = parts_by_patch(layer);
  std::vector<std::uint32_t> patches;
  for (std::uint32_t p = 0; p < layer.patch.size(); ++p)
    if (layer.patch[p].mask != Patch::no_mask && !points[layer.patch[p].mask].empty()) patches.push_back(p);
  if (patches.empty()) return std::nullopt;

  std::vector<Fate> fate(patches.size());
  constexpr std::size_t at_once = 4096; // between two reports
  for (std::size_t from = 0; from < patches.size(); from += at_once) {
    parallel_for(std::min(at_once, patches.size() - from), 4, [&](std::size_t i) {
      const std::uint32_t p = patches[from + i];
      std::vector<Part> own;
      for (std::size_t k = parts.begin[p]; k < parts.begin[p + 1]; ++k)
        own.push_back(part_of(root.model().mesh, layer, layer.lookup[parts.lookup[k].first], parts.lookup[k].second));
      fate[from + i] = watcher.fate_of(own, points[layer.patch[p].mask]);
    });
    report(progress, static_cast<double>(from) / static_cast<double>(patches.size()));
  }

  ThingMeasure measure;
  measure.things = patches.size();
  WeightedQuantiles missing;
  bool broken = false;
  for (const Fate& f : fate) {
    if (f.outside > options.inside_tolerance) {
      ++measure.cut_by_skin;
      continue;
    }
    const double lost = std::max(0.0, 1 - f.seen);
    missing.add(lost, 1);
    measure.worst = std::max(measure.worst, lost);
    if (f.seen >= options.seen) {
      ++measure.whole;
      continue;
    }
    // What the skin takes of it is below the tolerance and alone does not break it.
    if (f.sliced >= f.hidden && f.sliced >= f.bent)
      ++measure.sliced;
    else
      ++(f.hidden >= f.bent ? measure.hidden : measure.bent);
    if (!broken) measure.first_broken = f.middle;
    broken = true;
  }
  if (missing.count() > 0) measure.missing = spread_of(missing);
  return measure;
}

} // namespace pith
