// Pieces apart from cutting: keeping, finding, measuring, checking.
#include "tests/cut/piece_checks.h"
#include "tests/support/tet_grid.h"
#include "volume/base/random.h"

namespace pith {
namespace {

struct CutBall {
  TetMesh mesh = tet_ball(8, 10);
  Boundary boundary = boundary_of(mesh);
  Pieces pieces = whole_piece(mesh);
  std::vector<PlaneCut> planes = {{{1, 0.1, 0.2}, 0.5}, {{0.1, 1, -0.2}, -0.7}, {{0.2, -0.1, 1}, 1.1}};

  CutBall() {
    for (const PlaneCut& plane : planes) cut(pieces, mesh, boundary, *level_set_of(plane));
  }
};

TEST(Pieces, KeepingSomeDropsWhatNothingUses) {
  const CutBall ball;
  ASSERT_EQ(ball.pieces.piece.size(), 8u);
  Pieces kept = ball.pieces;
  const std::vector<std::uint32_t> keep = {5, 2};
  keep_pieces(kept, ball.mesh, keep);
  validate(kept, ball.mesh, ball.boundary);
  ASSERT_EQ(kept.piece.size(), 2u);
  EXPECT_LT(kept.added.size(), ball.pieces.added.size());
  for (std::uint32_t p = 0; p < 2; ++p) {
    const double volume = check_piece(kept, p, ball.mesh, ball.boundary);
    EXPECT_EQ(volume, check_piece(ball.pieces, keep[p], ball.mesh, ball.boundary));
    const PieceSurface a = surface_of(kept, p, ball.mesh, ball.boundary),
                       b = surface_of(ball.pieces, keep[p], ball.mesh, ball.boundary);
    EXPECT_EQ(a.position, b.position);
    ASSERT_EQ(a.triangle.size(), b.triangle.size());
    for (std::size_t i = 0; i < a.triangle.size(); ++i) {
      EXPECT_EQ(a.triangle[i].corner, b.triangle[i].corner);
      EXPECT_EQ(a.triangle[i].tag, b.triangle[i].tag);
    }
    for (std::size_t i = 0; i < a.vertex.size(); ++i)
      for (std::uint32_t c = 0; c < 3; ++c)
        EXPECT_EQ(section_normal(kept, ball.mesh, a.vertex[i], CutId(c)),
                  section_normal(ball.pieces, ball.mesh, b.vertex[i], CutId(c)));
  }
  cut(kept, ball.mesh, ball.boundary, *level_set_of(PlaneCut{{1, 1, 1}, 0.2})); // and what is left can be cut
  validate(kept, ball.mesh, ball.boundary);
  for (std::uint32_t p = 0; p < kept.piece.size(); ++p) check_piece(kept, p, ball.mesh, ball.boundary);
}

TEST(Pieces, APointNamesThePieceThatContainsIt) {
  const CutBall ball;
  std::vector<std::unique_ptr<LevelSet>> planes;
  for (const PlaneCut& plane : ball.planes) planes.push_back(level_set_of(plane));
  std::size_t in_cut_tets = 0, off = 0;
  for (std::uint32_t p = 0; p < ball.pieces.piece.size(); ++p) {
    Random random(3, p);
    for (const PieceTet& tet : tets_of(ball.pieces, p, ball.mesh, ball.boundary)) {
      Vec3d x = Vec3d::Zero();
      double sum = 0;
      for (const VertexId v : tet.corner) {
        const double weight = random.uniform(0.05, 1);
        x += weight * ball.pieces.position(ball.mesh, v);
        sum += weight;
      }
      x /= sum;
      EXPECT_EQ(piece_at(ball.pieces, ball.mesh, tet.root, x), p);
      in_cut_tets += ball.pieces.label[tet.root] == Pieces::was_cut;
      // On a corner it is one of the pieces there, and never nothing.
      off += piece_at(ball.pieces, ball.mesh, tet.root, ball.pieces.position(ball.mesh, tet.corner[0])) == no_piece;
    }
  }
  EXPECT_EQ(off, 0u);
  EXPECT_GT(in_cut_tets, 1000u);
  EXPECT_EQ(piece_at(ball.pieces, ball.mesh, TetId(), Vec3d::Zero()), no_piece);

  Pieces kept = ball.pieces;
  keep_pieces(kept, ball.mesh, std::vector<std::uint32_t>{3});
  const PieceTet other = tets_of(ball.pieces, 4, ball.mesh, ball.boundary).back();
  Vec3d center = Vec3d::Zero();
  for (const VertexId v : other.corner) center += 0.25 * ball.pieces.position(ball.mesh, v);
  EXPECT_EQ(piece_at(ball.pieces, ball.mesh, other.root, center), 4u);
  EXPECT_EQ(piece_at(kept, ball.mesh, other.root, center), no_piece);
}

TEST(Pieces, MeasuresOfHalfACube) {
  const TetMesh mesh = tet_grid(4, 4, 4, 0.5);
  const Boundary boundary = boundary_of(mesh);
  Pieces pieces = whole_piece(mesh);
  const PieceMeasure whole = measure(pieces, 0, mesh);
  EXPECT_NEAR(whole.volume, 8, 1e-13);
  EXPECT_LT((whole.centroid - Vec3d(1, 1, 1)).norm(), 1e-13);
  EXPECT_EQ(whole.minimum_dihedral, std::numbers::pi);
  EXPECT_EQ(whole.whole_tets, mesh.tet_count());
  cut(pieces, mesh, boundary, *level_set_of(PlaneCut{{0, 0, 2}, 1.25}), {.only = {}, .snap = 0});
  const PieceMeasure low = measure(pieces, 0, mesh), high = measure(pieces, 1, mesh);
  EXPECT_NEAR(low.volume, 4 * 0.625, 1e-13);
  EXPECT_NEAR(high.volume, 4 * 1.375, 1e-13);
  EXPECT_LT((low.centroid - Vec3d(1, 1, 0.3125)).norm(), 1e-13);
  EXPECT_LT((low.bounds.high - Vec3d(2, 2, 0.625)).norm(), 1e-15);
  EXPECT_GT(low.minimum_dihedral, 0.1);
  EXPECT_LT(low.minimum_dihedral, 1.5);
}

TEST(Pieces, SurfaceOfTheWholeIsTheBoundary) {
  const TetMesh mesh = tet_grid(3, 2, 4);
  const Boundary boundary = boundary_of(mesh);
  const PieceSurface surface = surface_of(whole_piece(mesh), 0, mesh, boundary);
  ASSERT_EQ(surface.triangle.size(), boundary.facet_count());
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    const auto& t = surface.triangle[f];
    EXPECT_EQ(t.tag, FaceTag::skin(f));
    EXPECT_EQ(t.root, boundary.tet[f]);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(surface.vertex[t.corner[k]], boundary.corner[f][k]);
  }
  EXPECT_TRUE(std::is_sorted(surface.vertex.begin(), surface.vertex.end()));
  EXPECT_NEAR(surface_volume(surface), 24, 1e-12);
}

TEST(Pieces, ValidateNamesTheFirstOffender) {
  const CutBall ball;
  validate(ball.pieces, ball.mesh, ball.boundary);
  const auto broken = [&](const auto& damage) {
    Pieces pieces = ball.pieces;
    damage(pieces);
    const std::string message = refusal([&] { validate(pieces, ball.mesh, ball.boundary); });
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
  };
  EXPECT_NE(broken([](Pieces& p) { p.label[TetId(5)] = 99; }).find("root tet 5"), std::string::npos);
  EXPECT_NE(broken([](Pieces& p) { p.label.pop_back(); }), "");
  EXPECT_NE(broken([](Pieces& p) { p.piece[2].cut[7].corner[1] = VertexId(1u << 30); }).find("cut tet 7 of piece 2"),
            std::string::npos);
  EXPECT_NE(broken([](Pieces& p) { p.piece[2].cut[7].corner[1] = p.piece[2].cut[7].corner[0]; }), "");
  EXPECT_NE(broken([](Pieces& p) { p.piece[2].cut[7].face[1] = FaceTag::section(CutId(3)); }).find("cut 3"),
            std::string::npos);
  EXPECT_NE(broken([](Pieces& p) { p.piece[2].cut[7].face[1] = FaceTag::skin(FacetId(1u << 28)); }), "");
  EXPECT_NE(broken([](Pieces& p) { p.piece[0].cut[0].root = TetId(); }), "");
  EXPECT_NE(broken([](Pieces& p) { p.added[4].b = VertexId(p.root_vertex_count + 4); }).find("added vertex 4"),
            std::string::npos);
  EXPECT_NE(broken([](Pieces& p) { p.added_position[4].x() = NAN; }), "");
  EXPECT_NE(broken([](Pieces& p) { p.added_normal.pop_back(); }), "");
  EXPECT_NE(broken([](Pieces& p) { p.piece[1].placement.rotation(0, 0) = 2; }).find("piece 1"), std::string::npos);
  EXPECT_NE(broken([](Pieces& p) { ++p.root_vertex_count; }), "");
}

} // namespace
} // namespace pith
