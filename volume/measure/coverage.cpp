#include "volume/measure/coverage.h"

#include "volume/layer/tables.h"
#include "volume/measure/points.h"
#include "volume/measure/sighting.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace pith {

namespace {

constexpr double covered = 254.0 / 255.0;

/// Sorts its copy.
std::array<double, 3> median_p99_most(std::vector<int> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {double(values[values.size() / 2]), double(values[std::min(values.size() - 1, values.size() * 99 / 100)]),
          double(values.back())};
}

} // namespace

CoverageMeasure coverage_measure(const Root& root, const CoverageOptions& options, const Progress& progress) {
  const Model& model = root.model();
  const VolumePoints source(model.mesh, options.region);
  CoverageMeasure measure;
  if (!(source.volume() > 0)) return measure;
  measure.points = options.points;

  std::vector<float> coverage(options.points);
  std::vector<int> layers(options.points), reads(options.points);
  SharedProgress finished(progress, options.points);
  parallel_blocks(options.points, 2048, [&](std::size_t begin, std::size_t end) {
    Sighting sighting;
    for (std::size_t i = begin; i < end; ++i) {
      const VolumePoint point = source.point(options.seed, i);
      const std::int32_t region = model.mesh.region[point.tet];
      float shines = 1;
      for (const auto& entry : root.tables().layers) {
        const LayerReader& reader = entry.reader;
        const Layer& layer = *reader.layer;
        if (layer.domain != Domain::solid || (layer.region >= 0 && layer.region != region)) continue;
        look_at(reader, point.tet, point.barycentric, sighting);
        shines *= 1 - sighting.coverage;
        layers[i] += sighting.masked;
      }
      coverage[i] = 1 - shines;
      reads[i] = material_at(root, {.position = point.position, .region = region, .facet = {}, .hint = point.tet},
                             {point.tet, point.barycentric, true})
                     .lookups_read;
    }
    finished.add(end - begin);
  });

  std::size_t worst = 0;
  for (std::size_t i = 0; i < options.points; ++i) {
    measure.holes += coverage[i] < options.hole;
    measure.thin += coverage[i] < covered;
    if (coverage[i] < coverage[worst]) worst = i;
  }
  if (options.points > 0) {
    measure.least_coverage = coverage[worst];
    measure.worst = source.point(options.seed, worst).position;
  }
  const auto l = median_p99_most(std::move(layers)), r = median_p99_most(std::move(reads));
  measure.median_layers = l[0], measure.p99_layers = l[1], measure.most_layers = l[2];
  measure.median_reads = r[0], measure.p99_reads = r[1], measure.most_reads = r[2];
  return measure;
}

MaskUse mask_use(const TetMesh& mesh, const Layer& layer) {
  // 16 points that share a tet evenly (a rank-1 lattice folded into the simplex).
  constexpr int points = 16;
  std::array<std::array<float, 4>, points> barycentric;
  for (int i = 0; i < points; ++i) {
    const auto part = [&](double step) { return std::fmod((i + 0.5) * step, 1.0); };
    std::array<double, 3> cut{part(0.8191725134), part(0.6710436067), part(0.5497004779)};
    std::sort(cut.begin(), cut.end());
    barycentric[i] = {float(cut[0]), float(cut[1] - cut[0]), float(cut[2] - cut[1]), float(1 - cut[2])};
  }

  const LayerReader reader(layer, false);
  // Per look-up: its alpha in the mask's cube, on the tet and as seen.
  std::vector<double> on_tet(layer.lookup.size()), shown(layer.lookup.size());
  parallel_for(mesh.tet_count(), 1024, [&](std::size_t t) {
    const std::span<const Lookup> row = lookups_of(layer, static_cast<std::uint32_t>(t));
    if (row.empty()) return;
    const std::size_t first = row.data() - layer.lookup.data();
    const int stride = layer.width + 1, axes = std::min(3, layer.width);
    std::vector<double> size(row.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      Mat3d edges = Mat3d::Identity();
      const float* origin = layer.corner.data() + std::size_t(row[i].corner[0]) * stride;
      for (int k = 0; k < 3; ++k)
        for (int a = 0; a < axes; ++a)
          edges(a, k) = layer.corner[std::size_t(row[i].corner[k + 1]) * stride + a] - origin[a];
      size[i] = std::abs(edges.determinant()) / 6 / points;
    }
    for (const auto& b : barycentric) {
      double shines = 1;
      for (std::size_t i = row.size(); i-- > 0;) {
        const LookupSight sight = sight_of(reader, row[i], b);
        if (!(sight.alpha > 0)) continue;
        const double alpha = std::min(sight.alpha, 1.0f);
        bool in_cube = true;
        for (int a = 0; a < axes; ++a) in_cube &= sight.w[a] >= 0 && sight.w[a] <= 1;
        if (in_cube) {
          on_tet[first + i] += size[i] * alpha;
          shown[first + i] += size[i] * alpha * shines;
        }
        shines *= 1 - alpha;
      }
    }
  });

  std::vector<double> mask_alpha;
  for (const Mask& mask : layer.mask)
    mask_alpha.push_back(std::accumulate(mask.alpha.begin(), mask.alpha.end(), 0.0) / 255 / mask.alpha.size());
  std::vector<double> patch_on(layer.patch.size()), patch_shown(layer.patch.size());
  for (std::size_t i = 0; i < layer.lookup.size(); ++i) {
    patch_on[layer.lookup[i].patch] += on_tet[i];
    patch_shown[layer.lookup[i].patch] += shown[i];
  }
  WeightedQuantiles on, visible;
  for (std::size_t p = 0; p < layer.patch.size(); ++p) {
    if (layer.patch[p].mask == Patch::no_mask || !(mask_alpha[layer.patch[p].mask] > 0)) continue;
    on.add(patch_on[p] / mask_alpha[layer.patch[p].mask], 1);
    visible.add(patch_shown[p] / mask_alpha[layer.patch[p].mask], 1);
  }
  MaskUse use;
  use.patches = on.count();
  if (use.patches > 0) {
    use.median_on_tets = on.at(0.5);
    use.median_seen = visible.at(0.5);
    use.p5_seen = visible.at(0.05);
  }
  return use;
}

} // namespace pith
