// sample/*: material_at in points per second on one core.
#include "bench/fixtures.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/exemplar/procedural.h"

#include <fmt/format.h>

namespace pith::bench {
namespace {

/// Random points inside a model, uniform in its volume, each with its owner.
std::vector<MaterialPoint> random_points(const Root& root, std::size_t count) {
  const Box box = bounds_of(root.model().mesh);
  std::vector<MaterialPoint> points;
  Random random(11);
  while (points.size() < count) {
    Vec3d x;
    for (int a = 0; a < 3; ++a) x[a] = random.uniform(box.low[a], box.high[a]);
    const Location location = root.locator().locate(x);
    if (!location.inside) continue;
    points.push_back({.position = x, .facet = {}, .hint = location.tet});
  }
  return points;
}

/// Points along straight lines across a model, an eight-hundredth of its diagonal apart: as a slice is drawn. The
/// hint of each is the owner of the one before.
std::vector<MaterialPoint> scan_lines(const Root& root, std::size_t count) {
  const Box box = bounds_of(root.model().mesh);
  const double step = box.diagonal() / 800;
  const double z = box.center().z() + 0.0123 * box.extent().z();
  std::vector<MaterialPoint> points;
  while (points.size() < count)
    for (double y = box.low.y(); y <= box.high.y() && points.size() < count; y += step) {
      TetId last;
      for (double x = box.low.x(); x <= box.high.x() && points.size() < count; x += step) {
        const Location location = root.locator().locate({x, y, z}, -1, last);
        if (!location.inside) continue;
        points.push_back({.position = {x, y, z}, .facet = {}, .hint = last.exists() ? last : location.tet});
        last = location.tet;
      }
    }
  return points;
}

Measured rate(const Settings& settings, const Root& root, const std::vector<MaterialPoint>& points,
              std::string note) {
  const ThreadLimit one(1);
  double reads = 0, coverage = 0;
  const int times = settings.times(5);
  std::vector<double> computed;
  const double seconds = median_seconds(times, {}, [&] {
    const double begin = thread_seconds();
    reads = coverage = 0;
    std::array<Material, 256> material; // a block at a time: what a caller with many points does
    for (std::size_t begin = 0; begin < points.size(); begin += material.size()) {
      const std::size_t count = std::min(material.size(), points.size() - begin);
      materials_at(root, std::span(points).subspan(begin, count), material);
      for (std::size_t i = 0; i < count; ++i) {
        reads += material[i].lookups_read;
        coverage += material[i].coverage;
      }
    }
    keep(coverage);
    computed.push_back(thread_seconds() - begin);
  });
  const double n = static_cast<double>(points.size());
  return {n / seconds,
          fmt::format("{} tets, {} points, {:.2f} exemplar reads each{}; by CPU time {:.3g}/s",
                      root.model().mesh.tet_count(), points.size(), reads / n, note, n / median(computed))};
}

Measured random_row(const Settings& settings) {
  const Root root(built_recipe(settings, "kiwi.json").result.model);
  return rate(settings, root, random_points(root, 500'000), "; random, the owner given");
}

Measured coherent_row(const Settings& settings) {
  const Root root(built_recipe(settings, "kiwi.json").result.model);
  return rate(settings, root, scan_lines(root, 500'000), "; scan lines, the last owner given");
}

Measured located_row(const Settings& settings) {
  constexpr int cells = 55;
  Model model;
  model.name = "cube";
  model.mesh = jittered_cube(cells);
  model.boundary = boundary_of(model.mesh);
  model.layer.push_back(
      lattice_of_patches(model.mesh, cells, procedural_exemplar(procedural_names().at(0), {.resolution = 64})));
  const Root root(std::move(model));
  std::vector<MaterialPoint> points(500'000);
  Random random(12);
  for (MaterialPoint& point : points)
    for (int a = 0; a < 3; ++a) point.position[a] = random.uniform(0, cells);
  return rate(settings, root, points, "; random, no hint; 8 look-ups per tet");
}

} // namespace

std::vector<Row> sample_rows() {
  return {{"sample/coherent", "/s", "≥ 5e6", coherent_row},
          {"sample/random", "/s", "≥ 3e6", random_row},
          {"sample/located", "/s", "≥ 5e5", located_row}};
}

} // namespace pith::bench
