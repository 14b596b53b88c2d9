// Displaced skins: where points go, that surfaces stay closed, that parts fit.
#include "tests/cut/piece_checks.h"
#include "tests/support/tet_grid.h"
#include "volume/base/parallel.h"
#include "volume/cut/displace.h"

#include <cmath>
#include <numbers>
#include <set>

namespace pith {
namespace {

constexpr double radius = 10;

struct Ball {
  TetMesh mesh = tet_ball(10, radius);
  Boundary boundary = boundary_of(mesh);
  Pieces pieces = whole_piece(mesh);

  DisplacedSurface displaced(std::uint32_t piece, const ReliefFunction& height,
                             const DisplaceOptions& options) const {
    const PieceSurface surface = surface_of(pieces, piece, mesh, boundary);
    std::vector<SurfaceFace> face;
    for (const PieceSurface::Triangle& t : surface.triangle) {
      SurfaceFace& f = face.emplace_back(SurfaceFace{t.corner, {}, t.root, t.tag});
      const Vec3d area = (surface.position[t.corner[1]] - surface.position[t.corner[0]])
                             .cross(surface.position[t.corner[2]] - surface.position[t.corner[0]]);
      for (int i = 0; i < 3; ++i)
        f.normal[i] = (t.tag.is_skin() ? surface.position[t.corner[i]] : area).normalized().cast<float>();
    }
    return displace(surface.position, std::move(face), mesh, boundary, height, options);
  }
};

double bumps(const Vec3d& x, FacetId, TetId) { return 0.4 + 0.3 * std::sin(x.x()) * std::cos(1.3 * x.z()); }

/// As a piece's surface, for the checks of those.
PieceSurface surface_of(const DisplacedSurface& displaced) {
  PieceSurface surface;
  surface.position = displaced.position;
  for (const SurfaceFace& f : displaced.face) surface.triangle.push_back({f.point, f.root, f.tag});
  return surface;
}

TEST(Displace, AConstantHeightMakesALargerBall) {
  const Ball ball;
  const DisplacedSurface result = ball.displaced(0, [](auto&&...) { return 0.5; }, {.scale = 2, .max_edge = 0.8});
  EXPECT_EQ(result.walls, 0u);
  EXPECT_EQ(result.turned, 0u);
  for (std::size_t p = 0; p < result.position.size(); ++p)
    EXPECT_NEAR((result.position[p] - result.rest[p]).norm(), 1, 1e-12);
  for (const SurfaceFace& f : result.face)
    for (int i = 0; i < 3; ++i) {
      EXPECT_LE((result.rest[f.point[i]] - result.rest[f.point[(i + 1) % 3]]).norm(), 0.8);
      EXPECT_GT(f.normal[i].cast<double>().dot(result.position[f.point[i]].normalized()), 0.98);
    }
  EXPECT_EQ(bad_edges(surface_of(result)), 0u);
  // A polyhedron is a little smaller than its ball, by the same factor before and after.
  const double before = surface_volume(surface_of(ball.pieces, 0, ball.mesh, ball.boundary));
  EXPECT_NEAR(surface_volume(surface_of(result)) / before, std::pow(1.1, 3), 0.005);
}

TEST(Displace, PiecesStayClosedAndSectionsExact) {
  Ball ball;
  for (const PlaneCut& plane : {PlaneCut{{1, 0.1, 0.2}, 0.5}, {{0.1, 1, -0.2}, -0.7}, {{0.2, -0.1, 1}, 1.1}})
    cut(ball.pieces, ball.mesh, ball.boundary, *level_set_of(plane));
  ASSERT_EQ(ball.pieces.piece.size(), 8u);
  double grown = 0, area = 0;
  std::vector<std::set<std::array<double, 3>>> rim(8);
  for (std::uint32_t p = 0; p < 8; ++p) {
    const PieceSurface plain = surface_of(ball.pieces, p, ball.mesh, ball.boundary);
    const DisplacedSurface result = ball.displaced(p, bumps, {.max_edge = 1});
    const PieceSurface surface = surface_of(result);
    EXPECT_EQ(bad_edges(surface), 0u);
    EXPECT_GT(result.walls, 50u);
    grown += surface_volume(surface) - surface_volume(plain);
    // Sections as they were: every corner of theirs is a point that did not move, and they have their area.
    double section = 0, section_before = 0;
    const auto area_of = [](const PieceSurface& s, const PieceSurface::Triangle& t) {
      return 0.5 * (s.position[t.corner[1]] - s.position[t.corner[0]])
                       .cross(s.position[t.corner[2]] - s.position[t.corner[0]])
                       .norm();
    };
    for (const auto& t : plain.triangle) (t.tag.is_section() ? section_before : area) += area_of(plain, t);
    for (const auto& t : surface.triangle) {
      if (!t.tag.is_section()) continue;
      section += area_of(surface, t);
      for (const std::uint32_t c : t.corner) EXPECT_EQ(result.position[c], result.rest[c]);
    }
    EXPECT_NEAR(section, section_before, 1e-9 * section_before);
    // Walls run from a rim to its twin, which has the same place in the material.
    for (std::size_t f = result.face.size() - result.walls; f < result.face.size(); ++f) {
      EXPECT_TRUE(result.face[f].tag.is_skin());
      for (const std::uint32_t c : result.face[f].point)
        if (result.position[c] != result.rest[c]) {
          const Vec3d& x = result.position[c];
          rim[p].insert({x.x(), x.y(), x.z()});
          EXPECT_NEAR((x - result.rest[c]).norm(), bumps(result.rest[c], {}, {}), 1e-12);
        }
    }
  }
  EXPECT_NEAR(grown, 0.4 * area * 1.04, 0.06 * area); // mean height times area, a little larger outside
  // What was parted fits: the moved rim of each piece is made of points of the others'.
  for (std::size_t p = 0; p < 8; ++p)
    for (const auto& x : rim[p]) {
      double nearest = 1e9;
      for (std::size_t q = 0; q < 8; ++q)
        if (q != p)
          for (const auto& y : rim[q])
            nearest = std::min(nearest, (Vec3d(x[0], x[1], x[2]) - Vec3d(y[0], y[1], y[2])).norm());
      EXPECT_LT(nearest, 1e-12);
    }
}

TEST(Displace, WithoutHeightEverythingKeepsItsBits) {
  Ball ball;
  cut(ball.pieces, ball.mesh, ball.boundary, *level_set_of(PlaneCut{{1, 0.1, 0.2}, 0.5}));
  const PieceSurface plain = surface_of(ball.pieces, 0, ball.mesh, ball.boundary);
  for (const auto& [height, scale] : {std::pair(0.0, 1.0), {0.3, 0.0}}) {
    const DisplacedSurface result =
        ball.displaced(0, [h = height](auto&&...) { return h; }, {.scale = scale, .max_edge = 100});
    EXPECT_EQ(result.position, plain.position);
    EXPECT_EQ(result.rest, plain.position);
    EXPECT_EQ(result.walls, 0u);
    ASSERT_EQ(result.face.size(), plain.triangle.size());
    for (std::size_t f = 0; f < result.face.size(); ++f) EXPECT_EQ(result.face[f].point, plain.triangle[f].corner);
  }
}

TEST(Displace, AReliefThatEndsAtTheRimNeedsNoWallThere) {
  Ball ball;
  cut(ball.pieces, ball.mesh, ball.boundary, *level_set_of(PlaneCut{{1, 0, 0}, 0.5}));
  const auto half = [](const Vec3d& x, FacetId, TetId) { return std::max(0.0, 0.1 * x.y()); };
  const DisplacedSurface all = ball.displaced(0, bumps, {.max_edge = 1}),
                         some = ball.displaced(0, half, {.max_edge = 1});
  EXPECT_EQ(bad_edges(surface_of(some)), 0u);
  EXPECT_LT(some.walls, 2 * all.walls / 3);
  EXPECT_GT(some.walls, all.walls / 3);
  const auto next_to_nothing = [](auto&&...) { return 1e-7; }; // walls that a file of single precision would flatten
  EXPECT_EQ(ball.displaced(0, next_to_nothing, {.max_edge = 1}).walls, 0u);
}

TEST(Displace, IsTheSameOnAnyNumberOfThreads) {
  const Ball ball;
  const auto one = [&] {
    const ThreadLimit limit(1);
    return ball.displaced(0, bumps, {});
  }();
  const DisplacedSurface two = ball.displaced(0, bumps, {});
  EXPECT_EQ(one.position, two.position);
  ASSERT_EQ(one.face.size(), two.face.size());
  for (std::size_t f = 0; f < one.face.size(); ++f) EXPECT_EQ(one.face[f].normal, two.face[f].normal);
}

TEST(Displace, TellsOfFacesThatTurnOverAndRefusesNonsense) {
  const Ball ball;
  const auto steep = [](const Vec3d& x, FacetId, TetId) { return 8 * std::abs(std::sin(5 * x.x() + 7 * x.y())); };
  const auto spikes = ball.displaced(0, steep, {.max_edge = 0.5});
  EXPECT_EQ(bad_edges(surface_of(spikes)), 0u);
  EXPECT_THROW(ball.displaced(0, bumps, {.scale = -1}), InvalidInput);
  EXPECT_THROW(ball.displaced(0, bumps, {.max_edge = NAN}), InvalidInput);
  EXPECT_THROW(ball.displaced(0, bumps, {.max_edge = 0.01, .max_triangles = 1000}), InvalidInput);
}

} // namespace
} // namespace pith
