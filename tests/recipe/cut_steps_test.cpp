// Cuts and moves of recipes: every shape is read and written alike, peels, knives, joins, and what follows from
// edits.
#include "recipe/build.h"
#include "recipe/steps.h"
#include "tests/support/scratch.h"
#include "tests/support/tri_shapes.h"
#include "volume/base/error.h"
#include "volume/io/mesh_io.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace pith {
namespace {

using testing::ScratchFolder;

std::string refusal_of(const std::string& cut) {
  try {
    parse_cut(cut, "cut.json");
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

const std::vector<std::string> all_cuts = {
    R"({"plane": {"normal": [0, 1, 0], "offset": 2}, "keep": "left"})",
    R"({"box": {"center": [1, 2, 3], "size": [4, 5, 6], "rotate": {"axis": [0, 1, 1], "angle": 0.5}}, "snap": 0.2})",
    R"({"cylinder": {"from": [0, 0, -9], "to": [0, 0, 9], "radius": 3, "endless": true}, "spread": 2})",
    R"({"sheet": {"points": [[0, 0, 0], [1, 0, 0]], "normals": [[0, 0, 1], [0, 0.1, 1]]}})",
    R"({"stroke": {"points": [[0, 0], [1, 0], [0, 1]], "view": {"eye": [0, 0, 50]}, "closed": true, "from": 3, "to": 60}})",
    R"({"surface": {"file": "knife.obj", "scale": 2}})",
    R"({"surface": {"shape": "kiwi", "triangles": 500}})",
    R"({"depth": {"region": 0, "value": 0.25}})",
    R"({"join": [[1, 2, 3], [4, 5, 6]]})"};

TEST(CutSteps, EveryShapeIsReadAndWrittenAlike) {
  for (const std::string& text : all_cuts) {
    SCOPED_TRACE(text);
    Recipe recipe = parse_recipe(R"({"pith": 1, "surface": {"file": "ball.obj"}, "cuts": [)" + text + "]}", "a.json");
    const std::string once = recipe_text(recipe);
    const Recipe again = parse_recipe(once, "a.json");
    EXPECT_EQ(recipe_text(again), once);
    const std::string key = text.substr(2, text.find('"', 2) - 2);
    EXPECT_NE(once.find('"' + key + '"'), std::string::npos);
  }
  const Recipe moves = parse_recipe(
      R"({"pith": 1, "surface": {"file": "ball.obj"}, "moves": [{"explode": 0.5}, {"drop": -3}]})", "a.json");
  EXPECT_EQ(moves.moves[0].explode, 0.5);
  EXPECT_EQ(parse_recipe(recipe_text(moves), "a.json").moves[1].drop, -3);
}

TEST(CutSteps, WhatIsNoCutIsRefusedByName) {
  const auto refuses = [](const std::string& cut, const std::string& what) {
    EXPECT_NE(refusal_of(cut).find(what), std::string::npos) << refusal_of(cut);
  };
  refuses(R"({"keep": "left"})", "has no shape");
  refuses(R"({"depth": {"value": 0.5}, "join": [[0,0,0],[1,1,1]]})", "more than one shape");
  refuses(R"({"depth": {"value": 0}})", "/depth/value");
  refuses(R"({"join": [[0,0,0],[1,1,1]], "keep": "left"})", "joins pieces");
  refuses(R"({"join": [[0,0,0]]})", "/join");
  refuses(R"({"box": {"center": [0,0,0], "size": [1,-1,1]}})", "/box/size");
  refuses(R"({"cylinder": {"from": [1,1,1], "to": [1,1,1], "radius": 1}})", "one place");
  refuses(R"({"sheet": {"points": [[0,0,0]], "normals": [[0,0,1],[0,0,1]]}})", "/sheet/normals");
  refuses(R"({"stroke": {"points": [[0,0],[1,0]], "view": {"eye": [0,0,9]}, "from": 2}})", "only closed strokes");
}

/// A ball of 20 mm with a core along z.
class BallCuts : public ::testing::Test {
protected:
  BallCuts() {
    write_tri_mesh(folder / "ball.obj", testing::sphere_surface(3, 20));
    write_tri_mesh(folder / "knife.obj", testing::sphere_surface(2, 8, {4, 0, 0}));
  }
  BuildResult build(const std::string& steps) {
    return builder.build(parse_recipe(R"({"pith": 1, "surface": {"file": "ball.obj"},
      "tetrahedralize": {"interior_edge": 5},
      "solids": [{"type": "2-b",
        "depth": [{"skin": true, "value": 0}, {"stroke": [[0, 0, -8], [0, 0, 8]], "value": 1}],
        "orientation": [{"stroke": [[0, 0, -8], [0, 0, 8]]}],
        "exemplar": {"procedural": "kiwi", "resolution": 16}, "fill": {"coverage_order": 4}}], )" +
                                          steps + "}",
                                      "ball.json"),
                         folder.path());
  }
  double volume(const BuildResult& built, std::uint32_t piece) {
    return measure(built.pieces, piece, built.model.mesh).volume;
  }
  ScratchFolder folder;
  Builder builder;
};

TEST_F(BallCuts, APeelLeavesWhatIsDeeper) {
  const BuildResult built = build(R"("cuts": [{"depth": {"value": 0.4}}])");
  ASSERT_EQ(built.pieces.piece.size(), 2u);
  EXPECT_GT(volume(built, 0), volume(built, 1));
  // Every vertex of the section has the depth: added ones lie where the linear field does.
  const auto& depth = built.model.field.depth;
  for (std::size_t i = 0; i < built.pieces.added.size(); ++i) {
    const auto& [a, b, cut] = built.pieces.added[i];
    const Vec3d &from = built.model.mesh.position[a], along = built.model.mesh.position[b] - from;
    const double t = (built.pieces.added_position[i] - from).dot(along) / along.squaredNorm();
    EXPECT_NEAR(depth[a] + t * (depth[b] - depth[a]), 0.4, 0.01 * std::abs(depth[b] - depth[a]) + 1e-6);
  }
  // It follows the material when pieces have moved, and another cut of it.
  const BuildResult moved = build(R"("cuts": [{"plane": {"normal": [0, 0, 1], "offset": 1}, "spread": 30},
    {"depth": {"value": 0.4}}, {"depth": {"value": 0.7}, "keep": "right"}])");
  ASSERT_EQ(moved.pieces.piece.size(), 2u);
  EXPECT_LT(volume(moved, 0) + volume(moved, 1), volume(built, 1));
  EXPECT_THROW(build(R"("cuts": [{"depth": {"value": 0.4, "region": 3}}])"), InvalidInput);
}

TEST_F(BallCuts, ASurfaceIsAKnifeByItsContent) {
  const std::string steps = R"("cuts": [{"surface": {"file": "knife.obj"}, "keep": "left"}])";
  const BuildResult built = build(steps);
  EXPECT_NEAR(volume(built, 0), 4.0 / 3 * 3.14159 * 512, 0.2 * 2145);
  write_tri_mesh(folder / "knife.obj", testing::sphere_surface(2, 9, {4, 0, 0}));
  EXPECT_GT(volume(build(steps), 0), 1.2 * volume(built, 0));
  EXPECT_THROW(build(R"("cuts": [{"surface": {"file": "none.obj"}}])"), std::runtime_error);
}

TEST_F(BallCuts, AShapeDividesAndCutsAsAFileDoes) {
  const std::string kiwi = R"({"surface": {"shape": "kiwi", "triangles": 800, "scale": 0.3}})";
  const BuildResult divided = build(R"("divide": [)" + kiwi + "]");
  EXPECT_EQ(*std::max_element(divided.model.mesh.region.begin(), divided.model.mesh.region.end()), 1);
  EXPECT_EQ(build(R"("cuts": [)" + kiwi + "]").pieces.piece.size(), 2u);
}

TEST_F(BallCuts, JoinsExplodesAndDrops) {
  const std::string cuts = R"("cuts": [{"plane": {"normal": [1, 0, 0], "offset": 1}},
    {"plane": {"normal": [0, 1, 0], "offset": 1}}, {"join": [[9, 9, 0], [-9, 9, 0]]}])";
  const BuildResult built = build(cuts);
  ASSERT_EQ(built.pieces.piece.size(), 3u);
  const BuildResult apart = build(cuts + R"(, "moves": [{"explode": 1}, {"drop": 5}])");
  for (std::uint32_t p = 0; p < 3; ++p) {
    const PieceMeasure measured = measure(apart.pieces, p, apart.model.mesh);
    EXPECT_NEAR(measured.bounds.low.z() + apart.pieces.piece[p].placement.translation.z(), 5, 1e-9);
    EXPECT_GT(apart.pieces.piece[p].placement.translation.head<2>().norm(), 1);
  }
  EXPECT_THROW(build(R"("cuts": [{"plane": {"normal": [1, 0, 0], "offset": 1}}, {"join": [[9, 9, 0], [9, -9, 0]]}])"),
               InvalidInput);
}

} // namespace
} // namespace pith
