// Parting halves that do not hang together, joining pieces again, moving all.
#include "tests/cut/piece_checks.h"
#include "tests/support/tet_grid.h"
#include "volume/base/random.h"

namespace pith {
namespace {

/// A horseshoe: a grid with a notch.
TetMesh horseshoe() {
  TetMesh mesh = tet_grid(6, 6, 2);
  TetMesh result;
  result.position = mesh.position;
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    const Vec3d x = barycenter(mesh, t);
    if (x.x() > 2 && x.x() < 4 && x.y() > 2) continue;
    result.corner.push_back(mesh.corner[t]);
    result.region.push_back(0);
  }
  connect(result);
  return result;
}

TEST(Arrange, HalvesThatDoNotHangTogetherBecomePieces) {
  const TetMesh mesh = horseshoe();
  const Boundary boundary = boundary_of(mesh);
  for (const double y : {4.0, 4.3}) { // through faces, and through tets
    Pieces pieces = whole_piece(mesh);
    CutResult result = cut(pieces, mesh, boundary, *level_set_of(PlaneCut{{0, 1, 0}, y}));
    ASSERT_EQ(pieces.piece.size(), 2u);
    separate_pieces(pieces, mesh, result);
    ASSERT_EQ(pieces.piece.size(), 3u);
    EXPECT_EQ(result.origin[1].side, 1);
    EXPECT_EQ(result.origin[2].side, 1);
    check_pieces(pieces, mesh, boundary);
    EXPECT_NEAR(measure(pieces, 1, mesh).volume, measure(pieces, 2, mesh).volume, 1e-4);
    spread(pieces, result, mesh, 2);
    EXPECT_NEAR(pieces.piece[2].placement.translation.y(), 1, 1e-4);
  }
}

TEST(Arrange, JoiningGivesTheSamePoints) {
  const TetMesh mesh = tet_ball(8, 10);
  const Boundary boundary = boundary_of(mesh);
  Pieces pieces = whole_piece(mesh);
  cut(pieces, mesh, boundary, *level_set_of(PlaneCut{{1, 0.1, 0.2}, 0.5}));
  cut(pieces, mesh, boundary, *level_set_of(PlaneCut{{0.1, 1, -0.2}, -0.7}));
  ASSERT_EQ(pieces.piece.size(), 4u);
  const double whole = measure(whole_piece(mesh), 0, mesh).volume;
  for (std::uint32_t p = 0; p < 4; ++p) pieces.piece[p].placement.translation = {double(p), 0, 0};
  const Pieces before = pieces;
  EXPECT_EQ(join_pieces(pieces, std::vector<std::uint32_t>{3, 1}), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(pieces.piece[1].placement.translation.x(), 3);
  EXPECT_NEAR(measure(pieces, 1, mesh).volume, measure(before, 1, mesh).volume + measure(before, 3, mesh).volume,
              1e-9);
  check_pieces(pieces, mesh, boundary);
  const std::vector<PieceMeasure> all = measures_of(pieces, mesh);
  for (std::uint32_t p = 0; p < 3; ++p) {
    EXPECT_EQ(all[p].volume, measure(pieces, p, mesh).volume);
    EXPECT_EQ(all[p].centroid, measure(pieces, p, mesh).centroid);
  }
  join_pieces(pieces, std::vector<std::uint32_t>{0, 1, 2});
  ASSERT_EQ(pieces.piece.size(), 1u);
  check_pieces(pieces, mesh, boundary);
  EXPECT_NEAR(measure(pieces, 0, mesh).volume, whole, 1e-12 * whole);
  const PieceSurface surface = surface_of(pieces, 0, mesh, boundary);
  for (const auto& triangle : surface.triangle) ASSERT_TRUE(triangle.tag.is_skin());
  // Joined pieces can be cut again.
  cut(pieces, mesh, boundary, *level_set_of(SphereCut{{1, 2, 3}, 6}));
  check_pieces(pieces, mesh, boundary);

  const std::string one = refusal([&] { join_pieces(pieces, std::vector<std::uint32_t>{0, 0}); });
  EXPECT_NE(one.find("fewer than two"), std::string::npos);
  Pieces slices = whole_piece(mesh);
  cut(slices, mesh, boundary, *level_set_of(PlaneCut{{1, 0, 0}, -3}));
  cut(slices, mesh, boundary, *level_set_of(PlaneCut{{1, 0, 0}, 3}));
  const Pieces same = slices;
  EXPECT_NE(refusal([&] {
              join_pieces(slices, std::vector<std::uint32_t>{0, 2});
            }).find("shares no section"),
            std::string::npos);
  EXPECT_TRUE(same_bits(slices, same));
}

TEST(Arrange, ExplodingAndDropping) {
  const TetMesh mesh = tet_grid(4, 4, 4);
  const Boundary boundary = boundary_of(mesh);
  Pieces pieces = whole_piece(mesh);
  cut(pieces, mesh, boundary, *level_set_of(PlaneCut{{1, 0, 0}, 1}));
  explode(pieces, mesh, 0.5); // middles at 0.5 and 2.5, of all at 2
  EXPECT_NEAR(pieces.piece[0].placement.translation.x(), -0.75, 1e-9);
  EXPECT_NEAR(pieces.piece[1].placement.translation.x(), 0.25, 1e-9);
  pieces.piece[1].placement.translation.z() = 7;
  drop(pieces, mesh, -1);
  EXPECT_NEAR(pieces.piece[0].placement.translation.z(), -1, 1e-12);
  EXPECT_NEAR(pieces.piece[1].placement.translation.z(), -1, 1e-12);
}

} // namespace
} // namespace pith
