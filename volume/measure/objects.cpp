#include "volume/measure/objects.h"

#include "volume/measure/points.h"
#include "volume/measure/slice.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>

namespace pith {

namespace {

Vec3f encoded_color(const Vec3f& linear) {
  Vec3f e;
  for (int c = 0; c < 3; ++c) e[c] = srgb_from_linear(std::clamp(linear[c], 0.0f, 1.0f));
  return e;
}

bool picks(const ObjectRule& rule, const Vec3f& encoded) {
  return (encoded - rule.color).squaredNorm() <= rule.tolerance * rule.tolerance;
}

/// A grid of samples: what each is.
struct Grid {
  static constexpr std::uint8_t outside = 2;
  std::array<int, 3> size{};
  std::array<bool, 3> repeats{};
  std::vector<std::uint8_t> kind; ///< 0: inside, no object; 1: object; outside
};

/// The samples of one object: unwrapped grid places.
struct Region {
  std::vector<std::array<int, 3>> place;
  bool clipped = false;
};

/// Calls body(region) for each region of objects, by flood fill in order of first samples.
template <class Body>
void each_region(const Grid& grid, const Body& body) {
  const auto& n = grid.size;
  std::vector<std::uint8_t> done(grid.kind.size());
  Region region;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const std::size_t start = (std::size_t(z) * n[1] + y) * n[0] + x;
        if (grid.kind[start] != 1 || done[start]) continue;
        region.place.assign(1, {x, y, z});
        region.clipped = false;
        done[start] = 1;
        for (std::size_t at = 0; at < region.place.size(); ++at)
          for (int axis = 0; axis < 3; ++axis)
            for (const int step : {-1, 1}) {
              std::array<int, 3> p = region.place[at], wrapped;
              p[axis] += step;
              bool ends = false;
              for (int k = 0; k < 3; ++k) {
                ends |= !grid.repeats[k] && (p[k] < 0 || p[k] >= n[k]);
                wrapped[k] = ((p[k] % n[k]) + n[k]) % n[k];
              }
              if (ends) {
                region.clipped = true;
                continue;
              }
              const std::size_t i = (std::size_t(wrapped[2]) * n[1] + wrapped[1]) * n[0] + wrapped[0];
              if (grid.kind[i] == Grid::outside) region.clipped = true;
              if (grid.kind[i] != 1 || done[i]) continue;
              done[i] = 1;
              region.place.push_back(p);
            }
        for (int axis = 0; axis < 3; ++axis) { // one that reaches around meets itself
          const auto [low, high] = std::minmax_element(region.place.begin(), region.place.end(),
                                                       [&](auto& a, auto& b) { return a[axis] < b[axis]; });
          region.clipped |= grid.repeats[axis] && (*high)[axis] - (*low)[axis] + 1 >= n[axis];
        }
        body(region);
      }
}

/// Square roots of the eigenvalues of a region's covariance, plus that of one voxel, in units of the step.
std::array<double, 3> spread_of(const std::vector<std::array<int, 3>>& place, Vec3d& mean) {
  mean = Vec3d::Zero();
  for (const auto& p : place) mean += Vec3d(p[0], p[1], p[2]);
  mean /= static_cast<double>(place.size());
  Mat3d covariance = Mat3d::Zero();
  for (const auto& p : place) {
    const Vec3d d = Vec3d(p[0], p[1], p[2]) - mean;
    covariance += d * d.transpose();
  }
  covariance /= static_cast<double>(place.size());
  covariance += Mat3d::Identity() / 12;
  const Eigen::SelfAdjointEigenSolver<Mat3d> solver(covariance, Eigen::EigenvaluesOnly);
  std::array<double, 3> spread;
  for (int k = 0; k < 3; ++k) spread[k] = std::sqrt(std::max(0.0, solver.eigenvalues()[k]));
  return spread;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Without the clipped and without crumbs below `crumb` times the median of what is left.
std::vector<FoundObject> countable(std::vector<FoundObject> objects, double crumb) {
  std::erase_if(objects, [](const FoundObject& o) { return o.clipped; });
  double all = 0;
  for (const FoundObject& o : objects) all += o.volume;
  // The median by volume: that of the object in which a random point of an object lies. Crumbs do not move it.
  std::sort(objects.begin(), objects.end(), [](auto& a, auto& b) { return a.volume < b.volume; });
  double sum = 0, typical = 0;
  for (const FoundObject& o : objects)
    if ((sum += o.volume) >= 0.5 * all) {
      typical = o.volume;
      break;
    }
  std::erase_if(objects, [&](const FoundObject& o) { return o.volume < crumb * typical; });
  return objects;
}

} // namespace

std::vector<FoundObject> exemplar_objects(const Exemplar& exemplar, const ObjectRule& rule, int resolution) {
  const ExemplarSlicer slicer(exemplar);
  Grid grid;
  grid.size = {resolution, resolution, resolution};
  for (int k = 0; k < 3; ++k) grid.repeats[k] = exemplar.wrap[k] == Wrap::repeat;
  grid.kind.resize(std::size_t(resolution) * resolution * resolution);
  parallel_for(resolution, 1, [&](std::size_t z) {
    for (int y = 0; y < resolution; ++y)
      for (int x = 0; x < resolution; ++x) {
        const Vec3d u = (Vec3d(x, y, double(z)) + Vec3d::Constant(0.5)) / resolution;
        grid.kind[(z * resolution + y) * resolution + x] = picks(rule, encoded_color(slicer.color(u)));
      }
  });
  std::vector<FoundObject> objects;
  each_region(grid, [&](const Region& region) {
    FoundObject object;
    object.volume = static_cast<double>(region.place.size()) / std::pow(resolution, 3);
    object.spread = spread_of(region.place, object.center);
    for (double& s : object.spread) s /= resolution;
    object.center = (object.center + Vec3d::Constant(0.5)) / resolution;
    object.clipped = region.clipped;
    objects.push_back(object);
  });
  return objects;
}

std::optional<ObjectRule> object_rule_of(const Exemplar& exemplar) {
  Exemplar small = exemplar;
  small.gaussian.clear();
  small.inverse.clear();
  while (std::max({small.size[0], small.size[1], small.size[2]}) > 64) small = half_size(small);
  const ExemplarSlicer slicer(small);
  const int n = std::max({small.size[0], small.size[1], small.size[2]});
  std::vector<Vec3f> colors;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        colors.push_back(encoded_color(slicer.color((Vec3d(x, y, z) + Vec3d::Constant(0.5)) / n)));

  std::optional<ObjectRule> best;
  double best_score = 0.35;
  const std::array<Vec3f, 3> directions{Vec3f(1, 1, 1), Vec3f(1, -1, 0), Vec3f(0.5f, 0.5f, -1)};
  for (const Vec3f& direction : directions)
    for (const float sign : {-1.0f, 1.0f}) {
      std::vector<Vec3f> sorted = colors;
      const std::size_t extreme = std::max<std::size_t>(8, sorted.size() / 500);
      if (extreme >= sorted.size()) return std::nullopt;
      std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(extreme), sorted.end(),
                       [&](const Vec3f& a, const Vec3f& b) {
                         const float x = sign * direction.dot(a), y = sign * direction.dot(b);
                         return x != y ? x > y
                                       : std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
                       });
      std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(extreme), [](auto& a, auto& b) {
        return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
      });
      ObjectRule rule;
      for (std::size_t i = 0; i < extreme; ++i) rule.color += sorted[i];
      rule.color /= static_cast<float>(extreme);
      for (const float tolerance : {0.25f, 0.2f, 0.15f, 0.1f}) {
        rule.tolerance = tolerance;
        const std::vector<FoundObject> all = exemplar_objects(small, rule, n);
        const std::vector<FoundObject> objects = countable(all, 0.05);
        if (objects.size() < 3) continue;
        double picked = 0, sum = 0, squares = 0;
        for (const FoundObject& o : all) picked += o.volume;
        for (const FoundObject& o : objects) sum += o.volume, squares += o.volume * o.volume;
        const double mean = sum / static_cast<double>(objects.size());
        if (picked > 0.2 || mean * std::pow(n, 3) < 8 || sum < 0.7 * picked) continue;
        const double score = std::sqrt(std::max(0.0, squares / (mean * sum) - 1)); // coefficient of variation
        if (score < 0.9 * best_score) best_score = score, best = rule;             // the widest of equals
      }
    }
  return best;
}

std::optional<ObjectMeasure> object_measure(const Root& root, const Layer& layer, const ObjectRule& rule,
                                            const ObjectOptions& options, const Progress& progress) {
  const Model& model = root.model();
  const TetMesh& mesh = model.mesh;
  if (model.field.scale.empty()) return std::nullopt;
  Box box;
  WeightedQuantiles scales;
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    if (layer.region >= 0 && mesh.region[t] != layer.region) continue;
    for (const VertexId v : mesh.corner[t]) box.add(mesh.position[v]);
    scales.add(model.field.scale[t], signed_volume(mesh, t));
  }
  if (box.empty() || options.voxels == 0) return std::nullopt;

  ObjectMeasure measure;
  measure.spacing = std::cbrt(box.extent().prod() / static_cast<double>(options.voxels));
  const double h = measure.spacing;
  const int resolution = std::clamp(static_cast<int>(std::lround(scales.at(0.5) / h)), 24, 256);
  const std::vector<FoundObject> own =
      countable(exemplar_objects(layer.exemplar.front(), rule, resolution), options.crumb);
  if (own.empty()) return std::nullopt;
  measure.exemplar_objects = own.size();

  Grid grid;
  for (int k = 0; k < 3; ++k) grid.size[k] = 1 + static_cast<int>(box.extent()[k] / h);
  grid.kind.assign(std::size_t(grid.size[0]) * grid.size[1] * grid.size[2], Grid::outside);
  std::vector<float> scale_at(grid.kind.size());
  const Vec3d first = box.center() - 0.5 * h * Vec3d(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
  std::vector<SliceGrid> planes;
  for (int z = 0; z < grid.size[2]; ++z)
    planes.push_back(
        {first + z * h * Vec3d::UnitZ(), h * Vec3d::UnitX(), h * Vec3d::UnitY(), grid.size[0], grid.size[1]});
  constexpr std::size_t at_once = 32; // planes in memory
  for (std::size_t z = 0; z < planes.size(); z += at_once) {
    const std::vector<SliceGrid> some(planes.begin() + static_cast<std::ptrdiff_t>(z),
                                      planes.begin() +
                                          static_cast<std::ptrdiff_t>(std::min(planes.size(), z + at_once)));
    const std::vector<Slice> slices =
        model_slices(root, some, {.region = layer.region, .footprint = 0, .sources = true});
    parallel_for(slices.size(), 1, [&](std::size_t k) {
      const Slice& s = slices[k];
      const std::size_t base = (z + k) * s.inside.size();
      for (std::size_t i = 0; i < s.inside.size(); ++i) {
        if (!s.inside[i]) continue;
        const float* c = s.color.pixel.data() + 3 * i;
        grid.kind[base + i] = picks(rule, encoded_color({c[0], c[1], c[2]}));
        scale_at[base + i] = model.field.scale[s.source[i].tet];
      }
    });
    report(progress, static_cast<double>(z) / static_cast<double>(planes.size()));
  }

  std::vector<FoundObject> objects;
  each_region(grid, [&](const Region& region) {
    FoundObject object;
    double scale = 0;
    for (const auto& p : region.place) {
      const double s = scale_at[(std::size_t(p[2]) * grid.size[1] + p[1]) * grid.size[0] + p[0]];
      object.volume += std::pow(h / s, 3);
      scale += s;
    }
    scale /= static_cast<double>(region.place.size());
    object.spread = spread_of(region.place, object.center);
    for (double& s : object.spread) s *= h / scale;
    object.center = first + h * object.center;
    object.clipped = region.clipped;
    objects.push_back(object);
  });

  // The range of the exemplar's own objects, widened by the tolerances.
  double low = INFINITY, high = 0;
  std::array<double, 3> thin{INFINITY, INFINITY, INFINITY}, thick{};
  std::vector<double> own_volume, volume;
  for (const FoundObject& o : own) {
    own_volume.push_back(o.volume);
    low = std::min(low, o.volume), high = std::max(high, o.volume);
    for (int k = 0; k < 3; ++k) thin[k] = std::min(thin[k], o.spread[k]), thick[k] = std::max(thick[k], o.spread[k]);
  }
  const double typical = median(own_volume);
  bool broken = false;
  for (const FoundObject& o : objects) {
    if (o.volume < options.crumb * typical) continue;
    if (o.clipped) {
      ++measure.clipped;
      continue;
    }
    ++measure.objects;
    volume.push_back(o.volume);
    bool shaped = true;
    for (int k = 0; k < 3; ++k)
      shaped &= o.spread[k] >= thin[k] * (1 - options.shape_tolerance) &&
                o.spread[k] <= thick[k] * (1 + options.shape_tolerance);
    if (o.volume < low * (1 - options.volume_tolerance)) {
      ++measure.too_small;
    } else if (o.volume > high * (1 + options.volume_tolerance)) {
      ++measure.too_large;
    } else if (!shaped) {
      ++measure.misshapen;
    } else {
      ++measure.whole;
      continue;
    }
    if (!broken) measure.first_broken = o.center;
    broken = true;
  }
  measure.median_volume = typical > 0 ? median(volume) / typical : 0;
  return measure;
}

} // namespace pith
