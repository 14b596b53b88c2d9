// Random sessions: cuts by every kind of shape and by odd values, parts kept, joined, moved, cut again, for a bounded
// time. A session is a pure function of its number; PITH_FUZZ_SECONDS makes the search longer, PITH_FUZZ_FIRST begins
// elsewhere. What is refused must leave the pieces as they were; whatever is left must be sound.
#include "tests/cut/piece_checks.h"
#include "tests/support/tet_grid.h"
#include "volume/base/random.h"

#include <Eigen/Geometry>
#include <chrono>
#include <cstdlib>
#include <numbers>

namespace pith {
namespace {

double number_from(const char* variable, double otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atof(text) : otherwise;
}

/// A number that is often odd: 0, a whole one, tiny, huge, not finite.
double odd_number(Random& random, double size) {
  switch (random.below(12)) {
  case 0:
    return 0;
  case 1:
    return std::floor(random.uniform(-size, size));
  case 2:
    return random.uniform(-1e-12, 1e-12);
  case 3:
    return random.below(20) == 0 ? std::numeric_limits<double>::quiet_NaN() : 1e18;
  default:
    return random.uniform(-size, size);
  }
}
Vec3d odd_point(Random& random, double size) {
  return {odd_number(random, size), odd_number(random, size), odd_number(random, size)};
}

LevelSetShape odd_shape(Random& random) {
  switch (random.below(6)) {
  case 0:
    return PlaneCut{odd_point(random, 1), odd_number(random, 4)};
  case 1:
    return SphereCut{odd_point(random, 4), std::abs(odd_number(random, 4))};
  case 2: {
    StrokeCut stroke;
    stroke.view = {.eye = odd_point(random, 30), .target = odd_point(random, 3)};
    if (random.below(2)) stroke.view.vertical_angle = 0.6;
    stroke.view.height = 10;
    stroke.closed = random.below(3) == 0;
    Vec2d at(-1, 0);
    for (std::size_t i = random.below(30); i-- > 0;) {
      at += Vec2d(random.uniform(-0.05, 0.3), random.uniform(-0.2, 0.2));
      stroke.point.push_back(at);
    }
    return stroke;
  }
  case 3:
    return BoxCut{odd_point(random, 4), odd_point(random, 5).cwiseAbs(), odd_point(random, 1), odd_number(random, 3)};
  case 4:
    return CylinderCut{odd_point(random, 4), odd_point(random, 4), std::abs(odd_number(random, 3)),
                       random.below(2) == 0};
  default: {
    SheetCut sheet;
    for (std::size_t i = random.below(8); i-- > 0;) {
      sheet.point.push_back(odd_point(random, 4));
      sheet.normal.push_back(odd_point(random, 1));
    }
    return sheet;
  }
  }
}

/// One session; how many of its steps did something.
int session(std::uint64_t number) {
  Random random(91, number);
  TetMesh mesh = random.below(2)
                     ? tet_grid(1 + int(random.below(4)), 1 + int(random.below(4)), 1 + int(random.below(3)))
                     : tet_ball(2 + int(random.below(3)), 3);
  if (random.below(3) == 0)
    for (const TetId t : all_ids<TetId>(mesh.tet_count())) mesh.region[t] = barycenter(mesh, t).x() > 1;
  const Boundary boundary = boundary_of(mesh);
  Cutter cutter(mesh, boundary);
  Pieces pieces = whole_piece(mesh);
  int done = 0;
  for (int step = 0; step < 4; ++step) {
    const Pieces before = pieces;
    const auto refused = [&](const auto& work) {
      try {
        work();
        ++done;
      } catch (const InvalidInput&) {
        EXPECT_TRUE(same_bits(pieces, before)) << "a refused step changed the pieces";
      } catch (const SolverFailure&) {
        EXPECT_TRUE(same_bits(pieces, before)) << "a failed step changed the pieces";
      }
    };
    CutOptions options;
    options.snap = std::array{0.0, 0.01, 0.2, 0.4}[random.below(4)];
    if (random.below(4) == 0) options.only = {static_cast<std::uint32_t>(random.below(pieces.piece.size() + 1))};
    switch (random.below(8)) {
    case 0:
    case 1: { // odd values
      std::vector<double> value(mesh.vertex_count() + pieces.added.size());
      const bool whole = random.below(2) == 0;
      for (double& v : value) v = whole ? std::floor(random.uniform(-1, 2)) : odd_number(random, 1);
      refused([&] { cutter.cut_by_values(pieces, value, nullptr, options); });
      break;
    }
    case 2: {
      std::vector<std::uint32_t> named;
      for (std::size_t i = random.below(4); i-- > 0;)
        named.push_back(static_cast<std::uint32_t>(random.below(pieces.piece.size() + 1)));
      refused([&] { join_pieces(pieces, named); });
      break;
    }
    case 3: {
      const std::size_t p = random.below(pieces.piece.size());
      pieces.piece[p].placement.translation = Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), 0);
      pieces.piece[p].placement.rotation =
          Eigen::AngleAxisd(random.uniform(-1, 1), Vec3d::UnitX()).toRotationMatrix();
      break;
    }
    default: {
      const LevelSetShape shape = odd_shape(random);
      CutResult result;
      refused([&] { result = cutter.cut(pieces, *level_set_of(shape, "fuzz"), options); });
      if (!result.origin.empty() && random.below(2)) separate_pieces(pieces, mesh, result);
    }
    }
  }
  // Joined pieces may touch in an edge; all else is manifold.
  check_pieces(pieces, mesh, boundary, false);
  return done;
}

TEST(CutFuzz, RandomSessionsLeaveSoundPieces) {
  const double seconds = number_from("PITH_FUZZ_SECONDS", 10);
  const auto first = static_cast<std::uint64_t>(number_from("PITH_FUZZ_FIRST", 0));
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t number = first;
  int done = 0;
  while (!HasFailure() && std::chrono::steady_clock::now() - begin < std::chrono::duration<double>(seconds)) {
    SCOPED_TRACE("session " + std::to_string(number));
    done += session(number++);
  }
  RecordProperty("sessions", static_cast<int>(number - first));
  std::printf("%d sessions, %d steps done\n", static_cast<int>(number - first), done);
  EXPECT_GT(done, 0);
}

} // namespace
} // namespace pith
