// Cuts of grids and balls: halves, sections, tags, repeated cuts, placements, determinism, refusals.
#include "tests/cut/piece_checks.h"
#include "tests/support/tet_grid.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"

#include <Eigen/Geometry>

namespace pith {
namespace {

Vec3d random_direction(Random& random) {
  for (;;) {
    const Vec3d d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (d.norm() > 0.1 && d.norm() < 1) return d.normalized();
  }
}

double longest_edge(const TetMesh& mesh) {
  double longest = 0;
  for (const auto& corner : mesh.corner)
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        longest = std::max(longest, (mesh.position[corner[i]] - mesh.position[corner[j]]).norm());
  return longest;
}

/// Largest |φ| over the vertices of the section of a cut.
double off_zero_set(const Pieces& pieces, const TetMesh& root, CutId cut, const LevelSet& level_set) {
  double most = 0;
  for (const Piece& piece : pieces.piece)
    for (const CutTet& tet : piece.cut)
      for (int i = 0; i < 4; ++i)
        if (tet.face[i] == FaceTag::section(cut))
          for (const int c : facet_corners[i])
            most = std::max(most, std::abs(level_set.value(pieces.position(root, tet.corner[c]))));
  return most;
}

TEST(Cut, PlanesThroughVerticesEdgesAndFacesOfAGrid) {
  const Solid grid(tet_grid(4, 4, 4));
  const std::vector<PlaneCut> planes = {
      {{0, 0, 1}, 2}, // through faces: nothing is subdivided
      {{1, 0, 0}, 1},     {{1, -1, 0}, 0},  {{1, 1, 0}, 4},   {{1, 1, 1}, 6},   {{1, 1, -1}, 2},
      {{1, 2, 0}, 4},     {{1, 2, 3}, 12},  {{2, -1, 0}, 3},  {{0, 0, 1}, 0.5}, {{0, 0, 1}, 1.999999999},
      {{0, 1e-13, 1}, 2}, {{1, 1, 1}, 0.5}, {{1e-9, 0, 1}, 3}};
  for (const PlaneCut& plane : planes) {
    SCOPED_TRACE(testing::Message() << plane.normal.transpose() << " = " << plane.offset);
    Pieces pieces = whole_piece(grid.mesh);
    const auto level_set = level_set_of(plane);
    cut(pieces, grid.mesh, grid.boundary, *level_set);
    ASSERT_EQ(pieces.piece.size(), 2u);
    check_pieces(pieces, grid.mesh, grid.boundary);
    check_sections_match(pieces, CutId(0));
    EXPECT_LE(off_zero_set(pieces, grid.mesh, CutId(0), *level_set), 1.001e-2 * longest_edge(grid.mesh));
  }
}

TEST(Cut, APlaneThroughFacesTagsTheTetsOnBothSides) {
  const Solid grid(tet_grid(3, 3, 2));
  Pieces pieces = whole_piece(grid.mesh);
  const CutResult result = cut(pieces, grid.mesh, grid.boundary, *level_set_of(PlaneCut{{0, 0, 1}, 1}));
  EXPECT_EQ(result.tets_cut, 0u);
  EXPECT_TRUE(pieces.added.empty());
  for (int side = 0; side < 2; ++side) {
    double area = 0;
    const PieceSurface surface = surface_of(pieces, side, grid.mesh, grid.boundary);
    for (const auto& t : surface.triangle)
      if (t.tag == FaceTag::section(CutId(0)))
        area += 0.5 * (surface.position[t.corner[1]] - surface.position[t.corner[0]])
                          .cross(surface.position[t.corner[2]] - surface.position[t.corner[0]])
                          .norm();
    EXPECT_NEAR(area, 9, 1e-12);
    EXPECT_NEAR(measure(pieces, side, grid.mesh).volume, 9, 1e-12);
  }
  for (const SectionNormal& known : pieces.on_section)
    EXPECT_EQ(section_normal(pieces, grid.mesh, known.vertex, known.cut), Vec3f(0, 0, 1));
  EXPECT_EQ(pieces.on_section.size(), 16u);
}

TEST(Cut, RandomPlanesThreeInARow) {
  const Solid ball(tet_ball(8, 10));
  const double edge = longest_edge(ball.mesh);
  for (int seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(11, seed);
    Pieces pieces = whole_piece(ball.mesh);
    std::vector<std::unique_ptr<LevelSet>> planes;
    for (int c = 0; c < 3; ++c) {
      planes.push_back(level_set_of(PlaneCut{random_direction(random), random.uniform(-4, 4)}));
      const CutResult result = cut(pieces, ball.mesh, ball.boundary, *planes.back());
      EXPECT_GT(result.tets_cut, 0u);
      ASSERT_EQ(result.origin.size(), pieces.piece.size());
      check_pieces(pieces, ball.mesh, ball.boundary);
      for (int k = 0; k <= c; ++k) {
        check_sections_match(pieces, CutId(k));
        EXPECT_LE(off_zero_set(pieces, ball.mesh, CutId(k), *planes[k]), 1.001e-2 * edge);
      }
    }
    if (HasFailure()) return;
  }
}

TEST(Cut, WithoutSnappingASectionIsAPlane) {
  const Solid ball(tet_ball(10, 10));
  for (int seed = 0; seed < 10; ++seed) {
    Random random(12, seed);
    Pieces pieces = whole_piece(ball.mesh);
    for (int c = 0; c < 3; ++c) {
      const auto plane = level_set_of(PlaneCut{random_direction(random), random.uniform(-4, 4)});
      cut(pieces, ball.mesh, ball.boundary, *plane, {.only = {}, .snap = 0});
      EXPECT_LE(off_zero_set(pieces, ball.mesh, CutId(c), *plane), 1e-6 * 20);
    }
    check_pieces(pieces, ball.mesh, ball.boundary);
  }
}

TEST(Cut, SpheresLieOnTheirZeroSet) {
  const Solid grid(tet_grid(8, 8, 8));
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(13, seed);
    const SphereCut sphere{{random.uniform(2, 6), random.uniform(2, 6), random.uniform(2, 6)},
                           random.uniform(1.5, 5)};
    const auto level_set = level_set_of(sphere);
    Pieces pieces = whole_piece(grid.mesh);
    cut(pieces, grid.mesh, grid.boundary, *level_set);
    ASSERT_EQ(pieces.piece.size(), 2u);
    check_pieces(pieces, grid.mesh, grid.boundary);
    check_sections_match(pieces, CutId(0));
    EXPECT_LE(off_zero_set(pieces, grid.mesh, CutId(0), *level_set), 0.02 * longest_edge(grid.mesh));
    // Away from snapped vertices the zero is exact, not a linear guess, and the normal is radial.
    std::size_t exact = 0;
    for (std::size_t i = 0; i < pieces.added.size(); ++i) {
      exact += std::abs(level_set->value(pieces.added_position[i])) < 1e-6;
      const Vec3d radial = (pieces.added_position[i] - sphere.center).normalized();
      EXPECT_NEAR(radial.dot(pieces.added_normal[i].cast<double>()), 1, 1e-5);
    }
    EXPECT_GT(exact, pieces.added.size() * 98 / 100);
    if (HasFailure()) return;
  }
}

TEST(Cut, ASphereInsideIsTakenOutAndItsVolumeIsRight) {
  const Solid grid(tet_grid(16, 16, 16));
  Pieces pieces = whole_piece(grid.mesh);
  const CutResult result = cut(pieces, grid.mesh, grid.boundary, *level_set_of(SphereCut{{8.1, 7.9, 8.2}, 5}));
  check_pieces(pieces, grid.mesh, grid.boundary);
  const double exact = 4.0 / 3 * M_PI * 125;
  EXPECT_NEAR(measure(pieces, 0, grid.mesh).volume, exact, 0.02 * exact);
  EXPECT_NEAR(measure(pieces, 0, grid.mesh).centroid.x(), 8.1, 0.02);
  EXPECT_NE(refusal([&] { spread(pieces, result, grid.mesh, 1); }).find("closed"), std::string::npos);
}

TEST(Cut, TheSignIsRightOnBothSidesAtAMillionPoints) {
  const Solid ball(tet_ball(16, 10));
  const double edge = longest_edge(ball.mesh);
  struct Case {
    std::unique_ptr<LevelSet> level_set;
    double tolerance; // by snapping; and by the sagitta of a tet's part of the sphere
  };
  std::vector<Case> cases;
  cases.push_back({level_set_of(PlaneCut{{1, 2, 3}, 1.7}), 0.0101 * edge});
  cases.push_back({level_set_of(SphereCut{{3, -2, 1}, 6}), 0.0101 * edge + edge * edge / (8 * 6)});
  for (const Case& c : cases) {
    Pieces pieces = whole_piece(ball.mesh);
    cut(pieces, ball.mesh, ball.boundary, *c.level_set);
    std::size_t wrong = 0, near = 0;
    for (int side = 0; side < 2; ++side) {
      const std::vector<PieceTet> tets = tets_of(pieces, side, ball.mesh, ball.boundary);
      Random random(14, side);
      for (int i = 0; i < 500'000; ++i) {
        // Half the points in cut tets, where errors could be.
        const std::size_t cut_tets = pieces.piece[side].cut.size();
        const PieceTet& tet =
            i % 2 ? tets[random.below(tets.size())] : tets[tets.size() - 1 - random.below(cut_tets)];
        Vec3d x = Vec3d::Zero();
        double sum = 0;
        for (const VertexId v : tet.corner) {
          const double weight = -std::log(1 - random.uniform());
          x += weight * pieces.position(ball.mesh, v);
          sum += weight;
        }
        x /= sum;
        const double value = c.level_set->value(x);
        if ((value < 0) == (side == 0)) continue;
        near += std::abs(value) <= c.tolerance;
        wrong += std::abs(value) > c.tolerance;
      }
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_LT(near, 20'000u);
    RecordProperty(c.level_set->linear() ? "plane_within_tolerance" : "sphere_within_tolerance", int(near));
  }
}

TEST(Cut, RegionsKeepTheirInterface) {
  TetMesh mesh = tet_grid(4, 4, 4);
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) mesh.region[t] = barycenter(mesh, t).x() > 2;
  const Solid two(std::move(mesh));
  for (const PlaneCut& plane :
       {PlaneCut{{1, 0, 0}, 2}, PlaneCut{{1, 1, 0.5}, 4.3}, PlaneCut{{1, -1, 0}, 0}, PlaneCut{{0, 1, 0.01}, 2.2}}) {
    Pieces pieces = whole_piece(two.mesh);
    EXPECT_EQ(bad_edges(surface_of(pieces, 0, two.mesh, two.boundary)), 0u);
    cut(pieces, two.mesh, two.boundary, *level_set_of(plane));
    check_pieces(pieces, two.mesh, two.boundary);
    cut(pieces, two.mesh, two.boundary, *level_set_of(PlaneCut{{0.2, 0.1, 1}, 2.1}));
    check_pieces(pieces, two.mesh, two.boundary);
  }
}

TEST(Cut, OnlyTheNamedPiecesAndAPieceOnOneSideStaysUntouched) {
  const Solid grid(tet_grid(6, 4, 4));
  Pieces pieces = whole_piece(grid.mesh);
  cut(pieces, grid.mesh, grid.boundary, *level_set_of(PlaneCut{{1, 0, 0}, 2.3}));
  const std::vector<CutTet> before = pieces.piece[0].cut;

  Pieces named = pieces;
  const CutResult result =
      cut(named, grid.mesh, grid.boundary, *level_set_of(PlaneCut{{0, 1, 0}, 1.7}), {.only = {1}});
  ASSERT_EQ(named.piece.size(), 3u);
  EXPECT_EQ(result.origin[0].side, 0);
  EXPECT_EQ(result.origin[1].side, -1);
  EXPECT_EQ(result.origin[2].side, 1);
  EXPECT_EQ(result.origin[2].piece, 1u);
  EXPECT_EQ(named.piece[0].cut.size(), before.size());
  check_pieces(named, grid.mesh, grid.boundary);

  const CutResult beside = cut(pieces, grid.mesh, grid.boundary, *level_set_of(PlaneCut{{1, 0, 0.1}, 4.4}));
  ASSERT_EQ(pieces.piece.size(), 3u);
  EXPECT_EQ(beside.origin[0].side, 0);
  for (std::size_t j = 0; j < before.size(); ++j) EXPECT_EQ(pieces.piece[0].cut[j].corner, before[j].corner);
  check_pieces(pieces, grid.mesh, grid.boundary);
}

TEST(Cut, SkinStaysSkinAndSectionsStaySections) {
  const Solid ball(tet_ball(8, 10));
  Pieces pieces = whole_piece(ball.mesh);
  const std::array<PlaneCut, 3> planes = {PlaneCut{{1, 0.1, 0.2}, 0.5}, PlaneCut{{0.1, 1, -0.2}, -0.7},
                                          PlaneCut{{0.2, -0.1, 1}, 1.1}};
  const auto areas = [&] {
    std::map<std::int32_t, Vec3d> sum; // by tag; a section's two faces cancel
    std::map<std::int32_t, double> size;
    for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
      const PieceSurface s = surface_of(pieces, p, ball.mesh, ball.boundary);
      for (const auto& t : s.triangle) {
        const Vec3d a = 0.5 * (s.position[t.corner[1]] - s.position[t.corner[0]])
                                  .cross(s.position[t.corner[2]] - s.position[t.corner[0]]);
        sum.try_emplace(t.tag.code, Vec3d::Zero()).first->second += a;
        size[t.tag.code] += a.norm();
      }
    }
    for (const auto& [code, a] : sum) {
      if (code < 0) {
        EXPECT_LT(a.norm(), 1e-10);
      }
    }
    return size;
  };
  std::map<std::int32_t, double> last = areas();
  for (const PlaneCut& plane : planes) {
    cut(pieces, ball.mesh, ball.boundary, *level_set_of(plane));
    const std::map<std::int32_t, double> now = areas();
    EXPECT_EQ(now.size(), last.size() + 1);
    for (const auto& [code, area] : last) EXPECT_NEAR(now.at(code), area, 1e-10 * (1 + area)) << "tag " << code;
    last = now;
  }
  // Normals of the first section at vertices of later cuts are those of the first plane.
  std::size_t later = 0;
  const Vec3f expected = planes[0].normal.normalized().cast<float>();
  for (const Piece& piece : pieces.piece)
    for (const CutTet& tet : piece.cut)
      for (int i = 0; i < 4; ++i) {
        if (tet.face[i] != FaceTag::section(CutId(0))) continue;
        for (const int c : facet_corners[i]) {
          EXPECT_LT((section_normal(pieces, ball.mesh, tet.corner[c], CutId(0)) - expected).norm(), 1e-5);
          const auto row = tet.corner[c] - pieces.root_vertex_count;
          later += tet.corner[c] >= pieces.root_vertex_count && pieces.added[row].cut != CutId(0);
        }
      }
  EXPECT_GT(later, 50u);
}

TEST(Cut, TheSameBytesWithOneAndTwoThreads) {
  const Solid ball(tet_ball(20, 10)); // several blocks
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    Pieces pieces = whole_piece(ball.mesh);
    const CutResult first = cut(pieces, ball.mesh, ball.boundary, *level_set_of(PlaneCut{{1, 2, 0.3}, 0.4}));
    spread(pieces, first, ball.mesh, 1.5);
    cut(pieces, ball.mesh, ball.boundary, *level_set_of(SphereCut{{1, 2, 0.3}, 7}));
    std::vector<double> value;
    for (std::size_t v = 0; v < ball.mesh.vertex_count() + pieces.added.size(); ++v) {
      const Vec3d& x = pieces.position(ball.mesh, VertexId(v));
      value.push_back(std::sin(0.7 * x.x()) + std::cos(0.5 * x.y()) * std::sin(0.6 * x.z()));
    }
    cut_by_values(pieces, ball.mesh, ball.boundary, value);
    return pieces;
  };
  const Pieces one = run(1), two = run(2), again = run(2);
  EXPECT_TRUE(same_bits(one, two));
  EXPECT_TRUE(same_bits(two, again));
  EXPECT_GT(one.piece.size(), 5u);
}

TEST(Cut, DoesNotDependOnTheOrderOfTetsInWhatIsOnTheSection) {
  // The same solid with its tets numbered backwards: the same new vertices, snapped vertices and volumes.
  const TetMesh mesh = tet_ball(8, 10);
  TetMesh backwards = mesh;
  std::reverse(backwards.corner.begin(), backwards.corner.end());
  connect(backwards);
  const Solid a(mesh), b(backwards);
  const auto level_set = level_set_of(SphereCut{{1, 2, 0.3}, 7});
  Pieces p = whole_piece(a.mesh), q = whole_piece(b.mesh);
  cut(p, a.mesh, a.boundary, *level_set, {.only = {}, .snap = 0.2});
  cut(q, b.mesh, b.boundary, *level_set, {.only = {}, .snap = 0.2});
  const auto places = [](const Pieces& pieces) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<double, 3>> by_edge;
    for (std::size_t i = 0; i < pieces.added.size(); ++i) {
      const Vec3d& x = pieces.added_position[i];
      by_edge[{pieces.added[i].a, pieces.added[i].b}] = {x.x(), x.y(), x.z()};
    }
    return by_edge;
  };
  EXPECT_EQ(places(p), places(q));
  ASSERT_EQ(p.on_section.size(), q.on_section.size());
  for (std::size_t i = 0; i < p.on_section.size(); ++i) EXPECT_EQ(p.on_section[i].vertex, q.on_section[i].vertex);
}

TEST(Cut, SnappingMakesBetterTets) {
  const Solid ball(tet_ball(12, 10));
  std::array<double, 2> smallest = {4, 4};
  std::array<std::size_t, 2> tets = {0, 0};
  for (int seed = 0; seed < 5; ++seed) {
    Random random(15, seed);
    const auto plane = level_set_of(PlaneCut{random_direction(random), random.uniform(-3, 3)});
    for (int i = 0; i < 2; ++i) {
      Pieces pieces = whole_piece(ball.mesh);
      cut(pieces, ball.mesh, ball.boundary, *plane, {.only = {}, .snap = i ? 0.2 : 0.0});
      for (std::uint32_t p = 0; p < 2; ++p) {
        const PieceMeasure m = measure(pieces, p, ball.mesh);
        smallest[i] = std::min(smallest[i], m.minimum_dihedral);
        tets[i] += m.cut_tets;
      }
    }
  }
  EXPECT_GT(smallest[1], 10 * smallest[0]);
  EXPECT_LT(tets[1], tets[0]);
}

TEST(Cut, AMovedPieceIsCutByTheFieldWhereItStands) {
  const Solid ball(tet_ball(8, 10));
  Random random(16, 0);
  Rigid move;
  move.rotation = Eigen::AngleAxisd(0.7, random_direction(random)).toRotationMatrix();
  move.translation = {3, -2, 5};
  const Vec3d normal = random_direction(random);
  const double offset = normal.dot(move.translation) + 0.8;

  Pieces moved = whole_piece(ball.mesh), still = whole_piece(ball.mesh);
  moved.piece[0].placement = move;
  cut(moved, ball.mesh, ball.boundary, *level_set_of(PlaneCut{normal, offset}));
  // normal · (R x + t) = offset is (Rᵀ normal) · x = offset − normal · t.
  const Vec3d turned_normal = move.rotation.transpose() * normal;
  cut(still, ball.mesh, ball.boundary, *level_set_of(PlaneCut{turned_normal, offset - normal.dot(move.translation)}));
  ASSERT_EQ(moved.added.size(), still.added.size());
  EXPECT_EQ(moved.label, still.label);
  for (std::size_t i = 0; i < moved.added.size(); ++i) {
    EXPECT_LT((moved.added_position[i] - still.added_position[i]).norm(), 1e-12);
    EXPECT_LT((moved.added_normal[i] - still.added_normal[i]).norm(), 1e-6f);
  }
  EXPECT_EQ(moved.piece[1].placement.translation, move.translation);
  check_pieces(moved, ball.mesh, ball.boundary);
}

TEST(Cut, PiecesThatStandApartAreCutEachByItsOwnField) {
  const Solid ball(tet_ball(8, 10));
  Pieces pieces = whole_piece(ball.mesh);
  const CutResult first = cut(pieces, ball.mesh, ball.boundary, *level_set_of(PlaneCut{{1, 0.2, 0.1}, 0.3}));
  const Vec3d n = Vec3d(1, 0.2, 0.1).normalized();
  spread(pieces, first, ball.mesh, 6);
  EXPECT_LT((pieces.piece[0].placement.translation + 3 * n).norm(), 0.01);
  EXPECT_LT((pieces.piece[1].placement.translation - 3 * n).norm(), 0.01);
  const auto level_set = level_set_of(PlaneCut{{0.5, 1, 0.3}, 0.2});
  cut(pieces, ball.mesh, ball.boundary, *level_set);
  ASSERT_EQ(pieces.piece.size(), 4u);
  check_pieces(pieces, ball.mesh, ball.boundary);
  double off = 0;
  for (const Piece& piece : pieces.piece)
    for (const CutTet& tet : piece.cut)
      for (int i = 0; i < 4; ++i)
        if (tet.face[i] == FaceTag::section(CutId(1)))
          for (const int c : facet_corners[i])
            off =
                std::max(off, std::abs(level_set->value(piece.placement(pieces.position(ball.mesh, tet.corner[c])))));
  EXPECT_LT(off, 0.0101 * longest_edge(ball.mesh));

  // Pieces that stand together share the vertices of their common section.
  Pieces together = whole_piece(ball.mesh);
  cut(together, ball.mesh, ball.boundary, *level_set_of(PlaneCut{{1, 0.2, 0.1}, 0.3}));
  cut(together, ball.mesh, ball.boundary, *level_set);
  check_sections_match(together, CutId(0));
}

TEST(Cut, RefusesWhatItCannotDoAndChangesNothing) {
  const Solid grid(tet_grid(3, 3, 3));
  Pieces pieces = whole_piece(grid.mesh);
  cut(pieces, grid.mesh, grid.boundary, *level_set_of(PlaneCut{{1, 0, 0}, 1.4}));
  const Pieces before = pieces;
  const std::size_t values = grid.mesh.vertex_count() + pieces.added.size();
  const auto plane = level_set_of(PlaneCut{{0, 1, 0}, 1.4});

  std::vector<std::string> messages;
  messages.push_back(refusal([&] { cut(pieces, grid.mesh, grid.boundary, *level_set_of(PlaneCut{{0, 1, 0}, 7})); }));
  EXPECT_NE(messages.back().find("all on one side"), std::string::npos) << messages.back();
  messages.push_back(refusal([&] { cut(pieces, grid.mesh, grid.boundary, *level_set_of(PlaneCut{{0, 1, 0}, 3})); }));
  messages.push_back(
      refusal([&] { cut_by_values(pieces, grid.mesh, grid.boundary, std::vector<double>(values, 0.0)); }));
  std::vector<double> odd(values, 1.0);
  odd[3] = -1;
  odd[17] = std::numeric_limits<double>::quiet_NaN();
  messages.push_back(refusal([&] { cut_by_values(pieces, grid.mesh, grid.boundary, odd); }));
  EXPECT_NE(messages.back().find("vertex 17"), std::string::npos) << messages.back();
  messages.push_back(refusal([&] { cut_by_values(pieces, grid.mesh, grid.boundary, std::vector<double>(5, 1.0)); }));
  messages.push_back(refusal([&] { cut(pieces, grid.mesh, grid.boundary, *plane, {.only = {2}}); }));
  EXPECT_NE(messages.back().find("no piece 2"), std::string::npos) << messages.back();
  messages.push_back(refusal([&] { cut(pieces, grid.mesh, grid.boundary, *plane, {.only = {}, .snap = 0.5}); }));
  messages.push_back(refusal([&] { level_set_of(PlaneCut{{0, 0, 0}, 1}); }));
  messages.push_back(refusal([&] { level_set_of(PlaneCut{{0, 0, NAN}, 1}, "cuts[2].plane"); }));
  EXPECT_EQ(messages.back().rfind("cuts[2].plane: ", 0), 0u) << messages.back();
  messages.push_back(refusal([&] { level_set_of(SphereCut{{0, 0, 0}, 0}); }));
  messages.push_back(refusal([&] { level_set_of(SphereCut{{0, INFINITY, 0}, 1}); }));
  messages.push_back(refusal([&] { keep_pieces(pieces, grid.mesh, std::vector<std::uint32_t>{}); }));
  messages.push_back(refusal([&] { keep_pieces(pieces, grid.mesh, std::vector<std::uint32_t>{0, 2}); }));
  messages.push_back(refusal([&] { keep_pieces(pieces, grid.mesh, std::vector<std::uint32_t>{1, 1}); }));
  messages.push_back(refusal([&] { surface_of(pieces, 2, grid.mesh, grid.boundary); }));
  messages.push_back(refusal([&] { measure(pieces, 2, grid.mesh); }));
  for (const std::string& message : messages) {
    EXPECT_NE(message, "");
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << message;
  }
  EXPECT_TRUE(same_bits(pieces, before));
}

} // namespace
} // namespace pith
