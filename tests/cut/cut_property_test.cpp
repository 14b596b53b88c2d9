// What must hold of every cut, over thousands of fields: noise of −1, 0 and 1, fields that vanish at vertices, edges
// and faces, smooth fields and planes, on grids, balls and real meshes, one after the other; and how far sections are
// from the zero set, both ways.
#include "tests/cut/piece_checks.h"
#include "tests/support/shared_data.h"
#include "tests/support/tet_grid.h"
#include "volume/base/random.h"
#include "volume/io/mesh_io.h"
#include "volume/mesh/facet_tree.h"
#include "volume/mesh/tetrahedralize.h"

#include <Eigen/Geometry>
#include <numbers>

namespace pith {
namespace {

enum class Kind { noise, sparse_noise, lattice, smooth, snapped_smooth };

/// Values at all vertices of the pieces.
std::vector<double> values_of(Kind kind, const Pieces& pieces, const TetMesh& root, Random& random) {
  const std::size_t count = root.vertex_count() + pieces.added.size();
  std::vector<double> value(count);
  const Vec3d normal(std::floor(random.uniform(-2, 3)), std::floor(random.uniform(-2, 3)), 1);
  const double offset = std::floor(random.uniform(0, 8));
  const Vec3d wave(random.uniform(0.3, 2), random.uniform(0.3, 2), random.uniform(0.3, 2));
  const double level = random.uniform(-0.8, 0.8);
  for (std::size_t v = 0; v < count; ++v) {
    const Vec3d& x = pieces.position(root, VertexId(v));
    switch (kind) {
    case Kind::noise:
      value[v] = std::floor(random.uniform(0, 3)) - 1;
      break;
    case Kind::sparse_noise:
      value[v] = random.uniform() < 0.7 ? 0 : random.uniform(-1, 1);
      break;
    case Kind::lattice: // through vertices, edges and faces of a grid
      value[v] = normal.dot(x) - offset;
      break;
    case Kind::smooth:
    case Kind::snapped_smooth: // a gyroid
      value[v] = std::sin(wave.x() * x.x()) * std::cos(wave.y() * x.y()) +
                 std::sin(wave.y() * x.y()) * std::cos(wave.z() * x.z()) +
                 std::sin(wave.z() * x.z()) * std::cos(wave.x() * x.x()) - level;
      if (kind == Kind::snapped_smooth) value[v] = std::round(4 * value[v]);
      break;
    }
  }
  return value;
}

/// Cuts and checks until every piece has been checked after `rounds` cuts; how many fields did cut.
int cut_often(const Solid& solid, Kind kind, int seeds, int rounds, std::uint64_t stage) {
  int cuts = 0;
  for (int seed = 0; seed < seeds && !::testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(stage, seed);
    Pieces pieces = whole_piece(solid.mesh);
    for (int round = 0; round < rounds; ++round) {
      const std::vector<double> value = values_of(kind, pieces, solid.mesh, random);
      const double snap = std::array{0.0, 0.01, 0.2}[seed % 3];
      const bool refused =
          !refusal([&] {
             cut_by_values(pieces, solid.mesh, solid.boundary, value, nullptr, {.only = {}, .snap = snap});
           }).empty();
      cuts += !refused;
    }
    check_pieces(pieces, solid.mesh, solid.boundary);
  }
  return cuts;
}

class EveryCut : public ::testing::TestWithParam<Kind> {};

TEST_P(EveryCut, OfAGridIsManifoldAndConservesVolume) {
  const Solid small(tet_grid(2, 2, 2)), large(tet_grid(4, 3, 3));
  EXPECT_GT(cut_often(small, GetParam(), 400, 1, 21), 200);
  EXPECT_GT(cut_often(large, GetParam(), 90, 1, 22), 40);
  EXPECT_GT(cut_often(small, GetParam(), 90, 4, 23), 100);
}

TEST_P(EveryCut, OfABallIsManifoldAndConservesVolume) {
  EXPECT_GT(cut_often(Solid(tet_ball(4, 4)), GetParam(), 60, 2, 24), 60);
}

TEST_P(EveryCut, OfARealMeshIsManifoldAndConservesVolume) {
  PITH_REQUIRE_SHARED(path, "meshes/horse_6k.off");
  TriMesh surface = read_tri_mesh(path);
  double size = 0;
  for (const Vec3d& x : surface.position) size = std::max(size, x.norm());
  for (Vec3d& x : surface.position) x *= 6 / size;
  const Solid solid(
      tetrahedralize(surface, "horse", {.helper = std::filesystem::path(PITH_BINARY_DIR) / "pith-tetgen"}).mesh);
  EXPECT_GT(cut_often(solid, GetParam(), 2, 2, 25), 2);
}

std::string name_of(const ::testing::TestParamInfo<Kind>& info) {
  return std::array{"Noise", "SparseNoise", "Lattice", "Smooth", "RoundedSmooth"}[static_cast<int>(info.param)];
}
INSTANTIATE_TEST_SUITE_P(Fields, EveryCut,
                         ::testing::Values(Kind::noise, Kind::sparse_noise, Kind::lattice, Kind::smooth,
                                           Kind::snapped_smooth),
                         name_of);

TEST(CutProperty, WithoutPartingSuchFieldsDoPinch) {
  // The checks see what they are for: the same noise without the parting leaves pinched halves.
  const Solid grid(tet_grid(4, 3, 3));
  int pinched = 0;
  for (int seed = 0; seed < 10; ++seed) {
    Random random(22, seed);
    Pieces pieces = whole_piece(grid.mesh);
    const std::vector<double> value = values_of(Kind::noise, pieces, grid.mesh, random);
    cut_by_values(pieces, grid.mesh, grid.boundary, value, nullptr, {.only = {}, .snap = 0.01, .manifold = false});
    for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
      const PieceSurface surface = surface_of(pieces, p, grid.mesh, grid.boundary);
      pinched += bad_edges(surface) > 0 || pinched_vertices(surface) > 0;
    }
  }
  EXPECT_EQ(pinched, 20);
}

/// The section of a cut as triangles, of the left half.
std::vector<std::array<Vec3d, 3>> section_of(const Pieces& pieces, const TetMesh& root, CutId cut) {
  std::vector<std::array<Vec3d, 3>> result;
  for (const CutTet& tet : pieces.piece[0].cut)
    for (int i = 0; i < 4; ++i)
      if (tet.face[i] == FaceTag::section(cut)) {
        const auto& c = facet_corners[i];
        result.push_back({pieces.position(root, tet.corner[c[0]]), pieces.position(root, tet.corner[c[1]]),
                          pieces.position(root, tet.corner[c[2]])});
      }
  return result;
}

TEST(CutProperty, SectionAndZeroSetLieWithinASmallHausdorffDistance) {
  const Solid grid(tet_grid(16, 16, 16)); // edges up to √3
  const Vec3d middle = Vec3d::Constant(8);
  for (int seed = 0; seed < 12; ++seed) {
    Random random(26, seed);
    const Vec3d normal = Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const double radius = random.uniform(3, 7);
    const bool plane = seed % 2 == 0;
    const auto level_set = plane ? level_set_of(PlaneCut{normal, normal.dot(middle) + 0.3})
                                 : level_set_of(SphereCut{middle + normal * 0.5, radius});
    Pieces pieces = whole_piece(grid.mesh);
    cut(pieces, grid.mesh, grid.boundary, *level_set);
    const auto section = section_of(pieces, grid.mesh, CutId(0));
    double to_zero = 0, to_section = 0;
    for (const auto& t : section) // φ is a distance
      for (const Vec3d& x : {t[0], t[1], t[2], Vec3d((t[0] + t[1] + t[2]) / 3)})
        to_zero = std::max(to_zero, std::abs(level_set->value(x)));
    const FacetTree tree(section);
    for (int i = 0; i < 4000; ++i) {
      Vec3d x = Vec3d(random.uniform(0.5, 15.5), random.uniform(0.5, 15.5), random.uniform(0.5, 15.5));
      x = plane ? Vec3d(x - level_set->value(x) * normal)
                : Vec3d(middle + normal * 0.5 +
                        radius *
                            Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized());
      if ((x.array() < 0).any() || (x.array() > 16).any()) continue;
      to_section = std::max(to_section, std::sqrt(tree.nearest(x).squared_distance));
    }
    const double edge = std::sqrt(3.0), diagonal = 16 * edge;
    const double bound = plane ? 1e-6 * diagonal : 0.01 * edge + edge * edge / (8 * radius);
    EXPECT_LE(to_zero, 1.001 * bound);
    EXPECT_LE(to_section, 1.001 * bound + 1e-9);
    RecordProperty((plane ? "plane_" : "sphere_") + std::to_string(seed),
                   ::testing::PrintToString(to_zero) + " " + ::testing::PrintToString(to_section));
  }
}

/// Not a number in a part of space.
class Broken final : public LevelSet {
public:
  double value(const Vec3d& x) const override {
    return x.x() > 0 ? std::numeric_limits<double>::quiet_NaN() : x.x() - 1;
  }
  Vec3d gradient(const Vec3d&) const override { return Vec3d::UnitX(); }
};

TEST(CutProperty, ARefusedCutLeavesNothingBehindInTheCutter) {
  const Solid ball(tet_ball(10, 10));
  Cutter cutter(ball.mesh, ball.boundary);
  Pieces pieces = whole_piece(ball.mesh);
  EXPECT_NE(refusal([&] { cutter.cut(pieces, Broken()); }).find("nan"), std::string::npos);
  const auto beside = level_set_of(PlaneCut{{0, 0, 1}, 900});
  EXPECT_NE(refusal([&] { cutter.cut(pieces, *beside); }).find("nothing is cut"), std::string::npos);
  Pieces fresh = whole_piece(ball.mesh);
  cutter.cut(pieces, *level_set_of(PlaneCut{{0, 1, 1}, 1}));
  cut(fresh, ball.mesh, ball.boundary, *level_set_of(PlaneCut{{0, 1, 1}, 1}));
  EXPECT_TRUE(same_bits(pieces, fresh));
}

TEST(CutProperty, ClustersChangeNothing) {
  const Solid ball(tet_ball(14, 10));
  Cutter cutter(ball.mesh, ball.boundary);
  Pieces fast = whole_piece(ball.mesh), slow = fast;
  Random random(27, 0);
  for (int round = 0; round < 12; ++round) {
    const Vec3d normal(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto level_set = round % 2 ? level_set_of(PlaneCut{normal, random.uniform(-3, 3)})
                                     : level_set_of(SphereCut{6 * normal, random.uniform(2, 6)});
    CutOptions options;
    if (round % 3 == 2) options.only = {std::uint32_t(random.below(fast.piece.size()))};
    if (round == 6)
      for (Pieces* pieces : {&fast, &slow})
        for (std::size_t p = 0; p < pieces->piece.size(); p += 2)
          pieces->piece[p].placement.translation = {1, 2, 0.5};
    const std::string one = refusal([&] { cutter.cut(fast, *level_set, options); });
    const std::string two = refusal([&] { cut(slow, ball.mesh, ball.boundary, *level_set, options); });
    EXPECT_EQ(one, two);
    ASSERT_TRUE(same_bits(fast, slow)) << "round " << round;
  }
  EXPECT_GT(fast.piece.size(), 10u);
  check_pieces(fast, ball.mesh, ball.boundary);
}

} // namespace
} // namespace pith
