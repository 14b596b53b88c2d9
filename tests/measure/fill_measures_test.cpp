// Measures of layers, on cubes with layers written by hand: what is planted is found, in closed form.
#include "tests/layer/hand_written.h"
#include "volume/measure/copy_map.h"
#include "volume/measure/coverage.h"
#include "volume/measure/distortion.h"
#include "volume/measure/points.h"

#include <gtest/gtest.h>

#include <numbers>

namespace pith {
namespace {

using namespace testing;

constexpr double side = 10; // mm

/// A cube whose one layer maps it to one texture width; fields that fit.
Model fitting_model(int cubes = 4, std::size_t patches = 1) {
  Model model = cube_model(cubes, side);
  Layer layer = solid_layer(model, side, patches);
  layer.exemplar = {exemplar_of("ramp", 3, {8, 8, 8}, Wrap::repeat, linear_color(), [](int x, int y, int z) {
    return std::vector<int>{30 * x, 30 * y, 30 * z};
  })};
  model.field.axes.assign(model.mesh.tet_count(), Mat3d::Identity());
  model.field.scale.assign(model.mesh.tet_count(), float(side));
  model.field.singular.assign(model.mesh.tet_count(), 0);
  model.layer.push_back(std::move(layer));
  return model;
}

/// The layer with a table row of its own for each look-up's corner, so that one look-up can be changed alone.
void set_weight(Layer& layer, std::size_t lookup, float weight) {
  for (const std::uint32_t c : layer.lookup[lookup].corner) layer.corner[std::size_t(c) * 4 + 3] = weight;
}

TEST(VolumePoints, AreUniformAndInside) {
  const Model model = cube_model(3, side);
  const VolumePoints points(model.mesh);
  EXPECT_NEAR(points.volume(), side * side * side, 1e-9);
  Vec3d sum = Vec3d::Zero(), squares = Vec3d::Zero();
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const VolumePoint p = points.point(1, i);
    EXPECT_TRUE((p.position.array() >= 0).all() && (p.position.array() <= side).all());
    sum += p.position;
    squares += p.position.cwiseAbs2();
  }
  for (int k = 0; k < 3; ++k) { // four standard deviations of the mean, and of the mean square
    EXPECT_NEAR(sum[k] / n, side / 2, 4 * side / std::sqrt(12.0 * n));
    EXPECT_NEAR(squares[k] / n, side * side / 3, 4 * 0.3 * side * side / std::sqrt(double(n)));
  }
}

TEST(WeightedQuantiles, GoByWeight) {
  WeightedQuantiles q;
  q.add(3, 1), q.add(1, 1), q.add(2, 8), q.add(9, 0);
  EXPECT_EQ(q.count(), 3u);
  EXPECT_EQ(q.at(0.05), 1);
  EXPECT_EQ(q.at(0.5), 2);
  EXPECT_EQ(q.at(0.95), 3);
}

TEST(Coverage, OfACoveredCubeIsWhole) {
  const Root root(fitting_model(4, 3));
  const CoverageMeasure c = coverage_measure(root, {.points = 5000});
  EXPECT_EQ(c.points, 5000u);
  EXPECT_EQ(c.thin, 0u);
  EXPECT_EQ(c.least_coverage, 1);
  EXPECT_EQ(c.median_layers, 3); // all that have alpha
  EXPECT_EQ(c.most_layers, 3);
  EXPECT_EQ(c.median_reads, 1); // the uppermost hides the rest
}

TEST(Coverage, FindsAPlantedHole) {
  Model model = fitting_model();
  const TetId hole(100);
  set_weight(model.layer[0], 100, 0);
  const double share = signed_volume(model.mesh, hole) / (side * side * side);
  const Root root(std::move(model));
  const CoverageMeasure c = coverage_measure(root, {.points = 50'000});
  EXPECT_NEAR(double(c.holes), 50'000 * share, 4 * std::sqrt(50'000 * share));
  EXPECT_EQ(c.holes, c.thin);
  EXPECT_EQ(c.least_coverage, 0);
  EXPECT_EQ(root.locator().locate(c.worst).tet, hole);
}

TEST(Coverage, CountsOnlyMaskedWeight) {
  Model model = fitting_model();
  Layer& layer = model.layer[0];
  layer.mask = {full_mask(3, 254)}; // lets 1/255 through, no more
  layer.patch[0].mask = 0;
  EXPECT_EQ(coverage_measure(Root(model), {.points = 2000}).thin, 0u);
  layer.mask = {full_mask(3, 252)};
  const CoverageMeasure thin = coverage_measure(Root(model), {.points = 2000});
  EXPECT_EQ(thin.thin, 2000u);
  EXPECT_EQ(thin.holes, 0u);
  layer.mask = {full_mask(3, 240)};
  EXPECT_EQ(coverage_measure(Root(model), {.points = 2000}).holes, 2000u);
}

TEST(MaskUse, TellsWhatLiesOnTetsAndWhatIsSeen) {
  Model model = fitting_model(4, 2);
  Layer& layer = model.layer[0];
  layer.mask = {full_mask(3, 255)};
  for (Patch& p : layer.patch) p.mask = 0;
  const MaskUse both = mask_use(model.mesh, layer);
  EXPECT_EQ(both.patches, 2u);
  EXPECT_NEAR(both.median_on_tets, 1, 1e-5); // the cube is the mask's cube
  EXPECT_NEAR(both.p5_seen, 0, 1e-6);        // the lower paste is hidden by the upper one
  // A paste whose tets end halfway through its mask.
  Model stretched = fitting_model(4, 1);
  Layer& wide = stretched.layer[0];
  wide.mask = {full_mask(3, 255)};
  wide.patch[0].mask = 0;
  for (std::size_t i = 0; i < wide.corner.size(); i += 4) wide.corner[i] *= 0.5f;
  const MaskUse half = mask_use(stretched.mesh, wide);
  EXPECT_NEAR(half.median_on_tets, 0.5, 1e-5);
  EXPECT_NEAR(half.median_seen, 0.5, 1e-5);
}

TEST(Distortion, OfAFittingMapIsNone) {
  const Model model = fitting_model();
  const auto d = distortion_measure(model, model.layer[0]);
  ASSERT_TRUE(d);
  EXPECT_EQ(d->lookups, model.layer[0].lookup.size());
  EXPECT_EQ(d->inverted, 0u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(d->axis_angle[k].p95, 0, 1e-3);
    EXPECT_NEAR(d->axis_scale[k].p95, 0, 1e-4);
  }
  EXPECT_NEAR(d->departure.p95, 0, 1e-4);
  EXPECT_NEAR(d->symmetric_dirichlet.median, 1, 1e-4);
  EXPECT_NEAR(d->angle.p95, 0, 1e-3);
  EXPECT_NEAR(d->volume.p95, 0, 1e-4);
}

TEST(Distortion, ClosedForms) {
  Model model = fitting_model();
  // The field's frame turned by 30° about S, and half the scale: the map stays.
  const Mat3d turn = Eigen::AngleAxisd(std::numbers::pi / 6, Vec3d::UnitY()).toRotationMatrix();
  model.field.axes.assign(model.mesh.tet_count(), turn);
  model.field.scale.assign(model.mesh.tet_count(), float(side / 2));
  const auto d = distortion_measure(model, model.layer[0]);
  ASSERT_TRUE(d);
  EXPECT_NEAR(d->axis_angle[0].median, 30, 1e-3);
  EXPECT_NEAR(d->axis_angle[1].median, 0, 1e-3);
  EXPECT_NEAR(d->axis_angle[2].p95, 30, 1e-3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(d->axis_scale[k].median, 1, 1e-4); // a factor of two
  EXPECT_NEAR(d->volume.median, 3, 1e-4);
  EXPECT_NEAR(d->symmetric_dirichlet.median, (3 * 0.25 + 3 * 4) / 6, 1e-4);
  EXPECT_NEAR(d->angle.p95, 0, 1e-3);
  EXPECT_NEAR(d->departure.median, (0.5 * turn - Mat3d::Identity()).norm(), 1e-4);
  // A shear: u += v.
  Model sheared = fitting_model();
  for (std::size_t i = 0; i < sheared.layer[0].corner.size(); i += 4)
    sheared.layer[0].corner[i] += sheared.layer[0].corner[i + 1];
  const auto s = distortion_measure(sheared, sheared.layer[0]);
  EXPECT_NEAR(s->angle.median, 45, 1e-3);
  EXPECT_NEAR(s->volume.median, 0, 1e-4);
  EXPECT_NEAR(s->departure.median, 1, 1e-4);
}

TEST(Distortion, FindsAPlantedInvertedLookup) {
  Model model = fitting_model();
  Layer& layer = model.layer[0];
  const std::size_t planted = 77;
  for (const std::uint32_t c : layer.lookup[planted].corner) layer.corner[std::size_t(c) * 4] *= -1; // mirrored
  const auto d = distortion_measure(model, layer);
  EXPECT_EQ(d->inverted, 1u);
  EXPECT_EQ(d->inverted_regular, 1u);
  EXPECT_LT((d->first_inverted - barycenter(model.mesh, TetId(planted))).norm(), 1e-12);
  EXPECT_NEAR(d->inverted_seen_share, signed_volume(model.mesh, TetId(planted)) / (side * side * side), 1e-9);
  model.field.singular[TetId(planted)] = 1;
  const auto singular = distortion_measure(model, layer);
  EXPECT_EQ(singular->inverted, 1u);
  EXPECT_EQ(singular->inverted_regular, 0u);
  EXPECT_EQ(singular->lookups, layer.lookup.size() - 1);
}

/// Two patches: one left of x = side/2, the other right of it.
Model halves_model() {
  Model model = fitting_model(4, 1);
  Layer& layer = model.layer[0];
  layer.patch.resize(2);
  for (std::size_t i = 0; i < layer.lookup.size(); ++i)
    layer.lookup[i].patch = barycenter(model.mesh, TetId(i)).x() > side / 2;
  return model;
}

TEST(CopyMap, MeasuresCoherentRegions) {
  const Root root(halves_model());
  const SliceGrid grid = framed_grid(bounds_of(root.model().mesh), Vec3d::UnitZ(), 4.9, 0.1);
  EXPECT_EQ(grid.width, 100);
  EXPECT_EQ(grid.height, 100);
  const std::vector<Slice> slices{model_slice(root, grid, {.sources = true})};
  const CoherentRegions r = coherent_regions(root.model(), slices, 0.01);
  EXPECT_EQ(r.regions, 2u);
  EXPECT_NEAR(r.mean_area, 0.5, 1e-6); // the section is one texture width²
  EXPECT_NEAR(r.typical_area, 0.5, 1e-6);
}

TEST(CopyMap, TellsEvenFromUnevenUse) {
  const Model even = fitting_model();
  const SourceUse use = source_use(even, even.layer[0], 40'000, 4);
  EXPECT_EQ(use.points, 40'000u);
  EXPECT_GT(use.entropy, 0.999);
  EXPECT_EQ(use.never_used, 0);
  EXPECT_LT(use.most_used, 1.2);
  Model one_corner = fitting_model(); // the whole cube shows an eighth of the exemplar
  for (std::size_t i = 0; i < one_corner.layer[0].corner.size(); i += 4)
    for (int k = 0; k < 3; ++k) one_corner.layer[0].corner[i + k] *= 0.5f;
  const SourceUse corner = source_use(one_corner, one_corner.layer[0], 40'000, 4);
  EXPECT_NEAR(corner.entropy, std::log(8.0) / std::log(64.0), 1e-3);
  EXPECT_NEAR(corner.never_used, 7.0 / 8, 1e-9);
  EXPECT_NEAR(corner.most_used, 8, 0.6);
}

} // namespace
} // namespace pith
