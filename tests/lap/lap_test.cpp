// The fill of a kiwi: no holes, masks well used, few layers, the same bytes at any number of threads; and the steps
// alone on problems with known answers.
#include "tests/lap/kiwi_fixture.h"
#include "tests/support/tet_grid.h"

#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/lap/coverage.h"
#include "volume/lap/grow.h"
#include "volume/lap/pivots.h"
#include "volume/layer/composite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>

namespace pith {
namespace {

using testing::kiwi_solid;
using testing::KiwiSolid;

class Fill : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    solid = new KiwiSolid(kiwi_solid());
    result = new LapResult(lap(solid->input(), solid->exemplar, options()));
  }
  static void TearDownTestSuite() {
    delete result;
    delete solid;
  }
  static LapOptions options() { return {.frame_tolerance = 1.2}; } // as recipes/table1/kiwi
  static inline KiwiSolid* solid = nullptr;
  static inline LapResult* result = nullptr;
};

TEST_F(Fill, CoversEveryPointWithFewLayersAndUsesItsMasks) {
  EXPECT_GE(result->statistics.median_share_used, 0.7);
  const Root root = root_of(*solid, result->layer);
  const Layer& layer = root.model().layer[0];
  const LayerReader reader(layer, false);
  const Box box = bounds_of(solid->mesh);
  Random random(11);
  std::vector<int> layers;
  int holes = 0, thin = 0;
  while (layers.size() < 200000) {
    const Vec3d x(random.uniform(box.low.x(), box.high.x()), random.uniform(box.low.y(), box.high.y()),
                  random.uniform(box.low.z(), box.high.z()));
    const TetId owner = root.locator().owner(x);
    if (!owner.exists()) continue;
    const Location at = root.locator().locate(x, -1, owner);
    SimplexPoint point;
    for (int k = 0; k < 4; ++k) point.barycentric[k] = static_cast<float>(at.barycentric[k]);
    const std::span<const Lookup> row(layer.lookup.data() + layer.begin[at.tet],
                                      layer.lookup.data() + layer.begin[at.tet + 1]);
    const LayerCoverage c = coverage_of(reader, row, point);
    holes += c.coverage < 0.95f;
    thin += c.coverage < 0.99f;
    layers.push_back(c.visible);
  }
  EXPECT_EQ(holes, 0);
  EXPECT_LT(thin, 200); // 0.1 %
  std::nth_element(layers.begin(), layers.begin() + layers.size() * 99 / 100, layers.end());
  EXPECT_LE(layers[layers.size() * 99 / 100], 25);
}

TEST_F(Fill, PiecesEndAtTheAxisInsteadOfFoldingOverIt) {
  // Pieces that reach across the axis show what lies beyond it in mirror image: 7 to 16 % of the look-ups of this
  // solid before they ended there.
  EXPECT_LT(result->statistics.inverted, result->statistics.lookups / 100);
}

TEST_F(Fill, IsTheSameAtOneAndTwoThreads) {
  LapResult one, two;
  {
    ThreadLimit limit(1);
    one = lap(solid->input(), solid->exemplar, options());
  }
  {
    ThreadLimit limit(2);
    two = lap(solid->input(), solid->exemplar, options());
  }
  EXPECT_EQ(one.layer.begin, two.layer.begin);
  EXPECT_EQ(one.layer.corner, two.layer.corner);
  ASSERT_EQ(one.layer.lookup.size(), two.layer.lookup.size());
  EXPECT_EQ(std::memcmp(one.layer.lookup.data(), two.layer.lookup.data(), one.layer.lookup.size() * sizeof(Lookup)),
            0);
  ASSERT_EQ(one.layer.patch.size(), two.layer.patch.size());
  for (std::size_t i = 0; i < one.layer.patch.size(); ++i) {
    EXPECT_EQ(one.layer.patch[i].key, two.layer.patch[i].key);
    EXPECT_EQ(one.layer.patch[i].frame.offset, two.layer.patch[i].frame.offset);
  }
}

TEST_F(Fill, ShowsTheExemplarsDepth) {
  // Brown on the skin, green half way, pale in the core, whatever the phase of each paste.
  const Root root = root_of(*solid, result->layer);
  double green = 0, core = 0, skin = 0;
  int count = 0;
  for (int k = 0; k < 200; ++k) {
    Random random(3, k);
    const double angle = 6.283185307179586 * random.uniform();
    const Vec3d direction(std::cos(angle), std::sin(angle), 0);
    const auto at = [&](double radius, double z) {
      return material_at(root, {radius * direction + Vec3d(0, 0, z), -1, {}, {}});
    };
    const double z = random.uniform(-10, 10);
    const Material flesh = at(17, z), middle = at(1.5, z), outside = at(60, z);
    green += flesh.value[1] - flesh.value[0];
    core += middle.value[0] + middle.value[1] + middle.value[2];
    skin += outside.value[0] - outside.value[1];
    ++count;
  }
  EXPECT_GT(green / count, 0.05); // green exceeds red
  EXPECT_GT(skin / count, 0.02);  // red exceeds green
  EXPECT_GT(core / count, 1.0);   // bright
}

TEST_F(Fill, AnotherSeedGivesAnotherFillOfTheSameQuality) {
  LapOptions other = options();
  other.seed = 2;
  const LapResult second = lap(solid->input(), solid->exemplar, other);
  EXPECT_NE(second.layer.lookup.size(), result->layer.lookup.size());
  EXPECT_GE(second.statistics.median_share_used, 0.7);
}

TEST_F(Fill, RefusesWhatDoesNotFit) {
  Exemplar clamped = solid->exemplar;
  clamped.wrap[0] = Wrap::clamp;
  EXPECT_THROW(lap(solid->input(), clamped), InvalidInput);
  LapInput no_depth = solid->input();
  no_depth.coordinate = {};
  EXPECT_THROW(lap(no_depth, solid->exemplar), InvalidInput);
  LapInput no_frames = solid->input();
  no_frames.axes = {};
  EXPECT_THROW(lap(no_frames, solid->exemplar), InvalidInput);
  EXPECT_THROW(lap(solid->input(), solid->exemplar, {}, [](double) { return false; }), Cancelled);
}

TEST(Grow, OnConstantFramesTheMapIsTheFrameAndTheClumpIsTheMask) {
  const TetMesh mesh = tet_grid(14, 14, 14, 0.5);
  const Simplices simplices = simplices_of(mesh, 0);
  Mat3d frame;
  frame << 0, -1, 0, 1, 0, 0, 0, 0, 1; // a quarter turn about z
  const std::vector<Mat3d> axes(mesh.tet_count(), frame);
  const std::vector<float> scale(mesh.tet_count(), 4.0f);
  SplotchOptions splotch;
  const Mask mask = splotch_mask(splotch);
  GrowField field{.frames = {.axes = axes}, .scale = scale};
  field.extent.fill(splotch_extent(splotch, SplotchPart::whole));
  std::uint32_t seed = 0;
  for (TetId t : all_ids<TetId>(mesh.tet_count()))
    if ((barycenter(mesh, t) - Vec3d(3.5, 3.5, 3.5)).norm() <
        (barycenter(mesh, TetId(seed)) - Vec3d(3.5, 3.5, 3.5)).norm())
      seed = t;
  GrowWorkspace workspace;
  const Growth growth = grow(simplices, field, mask, seed, {0.5, 0.5, 0.5}, {0.25f, 0.25f, 0.25f, 0.25f},
                             {.seed_frame = frame}, workspace);
  const Vec3d center = barycenter(mesh, TetId(seed));
  for (std::size_t v = 0; v < growth.clump.vertex.size(); ++v) {
    const Vec3d expected = Vec3d::Constant(0.5) + frame.transpose() *
                                                      (mesh.position[VertexId(growth.clump.vertex[v])] - center) /
                                                      4.0 / field.extent[0];
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(growth.clump.coordinate[3 * v + a], expected[a], 2e-3);
    EXPECT_EQ(growth.weight[v], 1.0f); // nothing stops growth but the mask
  }
  // Every tet whose barycentre lies under the mask belongs to it.
  const MaskGrid grid(mask);
  const std::set<std::uint32_t> members(growth.clump.simplex.begin(), growth.clump.simplex.end());
  EXPECT_EQ(members.size(), growth.clump.simplex.size());
  for (TetId t : all_ids<TetId>(mesh.tet_count())) {
    const Vec3d w = Vec3d::Constant(0.5) + frame.transpose() * (barycenter(mesh, t) - center) / 4.0 / field.extent[0];
    if (grid.alpha(Lanes{float(w.x()), float(w.y()), float(w.z()), 0}) > 0.02f) {
      EXPECT_TRUE(members.count(t));
    }
  }
}

TEST(Pivots, AreTheVerticesOfTheAxisThatFramesTurnAround) {
  TetMesh grid = tet_grid(8, 8, 4, 1);
  for (Vec3d& x : grid.position) x -= Vec3d(4, 4, 2);
  const Simplices mesh = simplices_of(grid, 0);
  std::vector<Mat3d> axes(mesh.count);
  for (std::uint32_t s = 0; s < mesh.count; ++s) {
    const Vec3d inwards = Vec3d(-mesh.center[s].x(), -mesh.center[s].y(), 0).normalized();
    axes[s] << inwards.cross(Vec3d::UnitZ()), inwards, Vec3d::UnitZ();
  }
  const FrameSource frames{.axes = axes};
  const std::vector<std::uint8_t> pivot = pivots_of(mesh, frames, {});
  for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
    const double radius = std::hypot(mesh.position[v].x(), mesh.position[v].y());
    if (radius > 0.1 && radius < 1.6) continue;
    EXPECT_EQ(pivot[v] != 0, radius < 0.1) << mesh.position[v].transpose();
  }
  // Axes alike along T and −T do not cancel.
  for (std::uint32_t s = 0; s < mesh.count; ++s)
    axes[s] = s % 2 ? Mat3d::Identity() : Mat3d(Vec3d(-1, 1, -1).asDiagonal());
  const std::vector<std::uint8_t> none(mesh.vertex_count, 0);
  EXPECT_EQ(pivots_of(mesh, {.axes = axes, .unsigned_axis = true}, {}), none);
  EXPECT_NE(pivots_of(mesh, {.axes = axes}, {}), none);
}

TEST(Coverage, ClosesASimplexOnlyWhenEverySampleIsOpaque) {
  EXPECT_EQ(SampleLattice(4, 8).barycentric.size(), 165u); // the paper's points
  const std::vector<float> size{1.0f, -1.0f};
  Coverage coverage(4, size, 0.2, 8);
  EXPECT_TRUE(coverage.open(0));
  EXPECT_FALSE(coverage.open(1));
  EXPECT_EQ(coverage.open_count(), 1u);
  std::vector<float> half(coverage.samples(0).size(), 0.5f), none(half.size(), 0.0f);
  coverage.cover(0, half);
  EXPECT_TRUE(coverage.open(0));
  none.back() = 1; // one sample stays as it was
  coverage.cover(0, none);
  EXPECT_TRUE(coverage.open(0));
  none.back() = 0;
  coverage.cover(0, none);
  EXPECT_FALSE(coverage.open(0));
  EXPECT_EQ(coverage.open_count(), 0u);
}

TEST(Coverage, SeesWhereTwoPiecesEndInOneSmallSimplex) {
  const std::vector<float> size{0.01f};
  Coverage coverage(4, size, 0.03, 12);
  for (const int side : {0, 1}) { // both fade along the way from corner 1 to corner 0
    std::vector<float> through;
    for (const auto& b : coverage.samples(0)) through.push_back(side == 0 ? b[0] : 1 - b[0]);
    coverage.cover(0, through);
  }
  EXPECT_TRUE(coverage.open(0));
  EXPECT_EQ(SampleLattice(4, 2).barycentric.size(), 10u);
  EXPECT_EQ(Coverage(4, size, 0.03, 2).samples(0).size(), 10u); // not beyond what is asked for
}

} // namespace
} // namespace pith
