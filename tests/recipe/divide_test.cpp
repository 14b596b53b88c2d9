// Several solids in one model: shells within shells, and regions that divides part.
#include "recipe/build.h"
#include "recipe/recipe.h"
#include "tests/support/scratch.h"
#include "tests/support/tri_shapes.h"
#include "volume/base/error.h"
#include "volume/io/mesh_io.h"
#include "volume/io/model_io.h"
#include "volume/io/surface_export.h"
#include "volume/mesh/region_measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace pith {
namespace {

using testing::ScratchFolder;
using Names = std::set<std::string>;

Names done_again(const BuildResult& result) {
  Names names;
  for (const StageReport& stage : result.stages)
    if (!stage.cached) names.insert(stage.name);
  return names;
}

Vec3d color_at(const Root& root, const Vec3d& x, std::int32_t region) {
  const Material material = material_at(root, {.position = x, .region = region, .facet = {}, .hint = {}});
  return {material.value[0], material.value[1], material.value[2]};
}

/// Every vertex of the pieces' surfaces has, bit for bit, the colour of the uncut root on that vertex's side.
void expect_colors_of_root(const BuildResult& cut, const BuildResult& uncut) {
  const Root root(Model(cut.model)), whole(Model(uncut.model));
  std::size_t on_sections = 0;
  for (std::uint32_t p = 0; p < cut.pieces.piece.size(); ++p) {
    const PieceSurface surface = surface_of(cut.pieces, p, root.model().mesh, root.model().boundary);
    for (const auto& triangle : surface.triangle)
      for (const std::uint32_t corner : triangle.corner) {
        const Vec3d& x = surface.position[corner];
        const std::int32_t region = root.model().mesh.region[triangle.root];
        const Material a = material_at(
            root, {.position = x, .region = region, .facet = triangle.tag.facet(), .hint = triangle.root});
        const Material b =
            material_at(whole, {.position = x, .region = region, .facet = triangle.tag.facet(), .hint = {}});
        ASSERT_EQ(a.value, b.value);
        ASSERT_EQ(a.coverage, b.coverage);
        on_sections += triangle.tag.is_section();
      }
  }
  EXPECT_GT(on_sections, 300u);
}

/// A stone of 8 mm in flesh of 20 mm, off the middle.
class NestedShells : public ::testing::Test {
protected:
  NestedShells() {
    write_tri_mesh(folder / "peach.obj",
                   testing::together(testing::sphere_surface(3, 20), testing::sphere_surface(2, 8, {2, 0, 0})));
    recipe = parse_recipe(R"({"pith": 1, "surface": {"file": "peach.obj"}, "tetrahedralize": {"interior_edge": 5},
      "solids": [{"type": "2-b", "region": 0,
        "depth": [{"outside": true, "value": 0}, {"interface": 1, "value": 1}],
        "orientation": [{"stroke": [[0, 0, -18], [0, 0, -10]]}],
        "exemplar": {"procedural": "kiwi", "resolution": 16}, "fill": {"coverage_order": 4}},
       {"type": "2-b", "region": 1,
        "depth": [{"skin": true, "value": 0}, {"stroke": [[2, 0, -3], [2, 0, 3]], "value": 1}],
        "orientation": [{"stroke": [[2, 0, -3], [2, 0, 3]]}],
        "exemplar": {"procedural": "kiwi", "resolution": 16, "seed": 5}, "fill": {"coverage_order": 4}}],
      "cuts": [{"plane": {"normal": [0, 1, 0.1], "offset": 0.5}, "spread": 30}]})",
                          "peach.json");
  }
  ScratchFolder folder;
  Recipe recipe;
};

TEST_F(NestedShells, EachHasItsOwnDepthFramesAndColours) {
  Recipe whole = recipe;
  whole.cuts.clear();
  Builder builder;
  const BuildResult uncut = builder.build(whole, folder.path());
  const BuildResult cut = builder.build(recipe, folder.path());
  expect_colors_of_root(cut, uncut);
  ASSERT_EQ(cut.pieces.piece.size(), 2u);

  const Model& model = cut.model;
  const Boundary& boundary = model.boundary;
  // The solid that is listed first owns the depth on the interface: 1 there, 0 outside.
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count()))
    for (const VertexId v : boundary.corner[f])
      EXPECT_EQ(model.field.depth[v], boundary.behind[f].exists() ? 1.0f : 0.0f);
  // S of the flesh points towards the stone, S of the stone towards its axis; both are right-handed and of unit size.
  for (const TetId t : all_ids<TetId>(model.mesh.tet_count())) {
    const Mat3d& axes = model.field.axes[t];
    EXPECT_NEAR(axes.determinant(), 1, 1e-6);
    const Vec3d x = barycenter(model.mesh, t);
    const Vec3d inwards = (Vec3d(2, 0, 0) - x).normalized();
    if (model.mesh.region[t] == 0) {
      EXPECT_GT(axes.col(1).dot(inwards), 0.3) << x.transpose();
    } else if (!model.field.singular[t] && std::abs(x.z()) < 3 && std::hypot(x.x() - 2, x.y()) > 2) {
      EXPECT_GT(axes.col(1).dot(Vec3d(2 - x.x(), -x.y(), 0).normalized()), 0.5);
    }
  }

  // On the section the colours change at the interface: each side is its own layer's.
  const Root root(Model(cut.model));
  int differ = 0;
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    if (!boundary.behind[f].exists() || model.mesh.region[boundary.tet[f]] != 0) continue;
    const Vec3d x = (model.mesh.position[boundary.corner[f][0]] + model.mesh.position[boundary.corner[f][1]] +
                     model.mesh.position[boundary.corner[f][2]]) /
                    3;
    differ += (color_at(root, x, 0) - color_at(root, x, 1)).norm() > 0.05; // core white against skin brown
  }
  EXPECT_GT(differ, 100);

  const ColoredSurface surface = colored_surface(root, cut.pieces, {.max_edge = 1});
  for (const auto& vertex : surface.vertex) EXPECT_GT(vertex.color.norm(), 0.001f); // nothing black
}

/// A block of three wavy layers, the middle one parted across.
class LayeredBlock : public ::testing::Test {
protected:
  LayeredBlock() {
    write_tri_mesh(folder / "block.obj", testing::box_surface({0, 0, 0}, {30, 20, 18}));
    recipe = parse_recipe(R"({"pith": 1, "surface": {"file": "block.obj"},
      "tetrahedralize": {"interior_edge": 4, "boundary_edge": 3},
      "divide": [
        {"plane": {"normal": [0, 0, 1], "offset": 6, "waves": {"amplitude": 1, "length": 15, "seed": 2}}},
        {"plane": {"normal": [0, 0, 1], "offset": 12, "waves": {"amplitude": 1, "length": 15, "seed": 2}}, "only": 1},
        {"sphere": {"center": [15, 10, 9], "radius": 8}, "only": [1], "snap": 0.1}],
      "solids": [{"type": "2-b", "region": 0, "depth": [{"interface": 1, "value": 0}, {"stroke": [[15, 10, 0]], "value": 1}],
        "orientation": [{"stroke": [[1, 10, 3], [29, 10, 3]]}],
        "exemplar": {"procedural": "kiwi", "resolution": 16}, "fill": {"coverage_order": 4}},
       {"type": "plain", "region": 1, "color": [0.9, 0.1, 0.1]},
       {"type": "plain", "region": 2, "color": [0.1, 0.9, 0.1]},
       {"type": "plain", "region": 3, "color": [0.1, 0.1, 0.9]}],
      "cuts": [{"plane": {"normal": [1, 0.3, 0], "offset": 17}, "spread": 5}]})",
                          "block.json");
  }
  std::string message(const Recipe& broken) const {
    try {
      Builder().build(broken, folder.path());
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  }
  ScratchFolder folder;
  Recipe recipe;
};

TEST_F(LayeredBlock, RegionsAreNumberedInOrderAndFillTheBlock) {
  Recipe whole = recipe;
  whole.cuts.clear();
  Builder builder;
  const BuildResult uncut = builder.build(whole, folder.path());
  const BuildResult result = builder.build(recipe, folder.path());
  const auto regions = measure_regions(result.model.mesh);
  ASSERT_EQ(regions.size(), 4u);
  double sum = 0;
  for (const RegionMeasure& region : regions) {
    sum += region.volume;
    EXPECT_GT(region.minimum_dihedral, 0.003); // where the waves pass close by boundary vertices
  }
  EXPECT_NEAR(sum, 30 * 20 * 18, 1e-12 * 30 * 20 * 18);
  // 0: below; 1: the middle inside the ball; 2: above; 3: the middle outside the ball.
  EXPECT_EQ(regions[0].beside, (std::vector<std::int32_t>{1, 3}));
  EXPECT_EQ(regions[1].beside, (std::vector<std::int32_t>{0, 2, 3}));
  EXPECT_NEAR(regions[0].volume, 3600, 400);
  EXPECT_NEAR(regions[2].volume, 3600, 400);
  EXPECT_NEAR(regions[1].volume + regions[3].volume, 3600, 100); // alongside one another: the waves cancel
  expect_colors_of_root(result, uncut);

  const Root root(Model(result.model));
  EXPECT_LT((color_at(root, {15, 10, 9}, -1) - Vec3d(0.9, 0.1, 0.1)).norm(), 0.01);
  EXPECT_LT((color_at(root, {15, 10, 15}, -1) - Vec3d(0.1, 0.9, 0.1)).norm(), 0.01);
  EXPECT_LT((color_at(root, {3, 10, 9}, -1) - Vec3d(0.1, 0.1, 0.9)).norm(), 0.01);
}

TEST_F(LayeredBlock, DividesAreAFoldThatIsRemembered) {
  Builder builder;
  const BuildResult first = builder.build(recipe, folder.path());
  const Names every = done_again(first);
  for (const char* name : {"tets", "divide 0", "divide 1", "divide 2", "refine", "fill 0", "cut 0"})
    EXPECT_TRUE(every.contains(name)) << name;
  EXPECT_TRUE(done_again(builder.build(recipe, folder.path())).empty());

  Recipe other = recipe;
  std::get<SphereCut>(other.divides[2].shape).radius = 7;
  const Names after = done_again(builder.build(other, folder.path()));
  EXPECT_TRUE(after.contains("divide 2"));
  EXPECT_TRUE(after.contains("refine"));
  EXPECT_FALSE(after.contains("divide 1"));
  EXPECT_FALSE(after.contains("tets"));

  // Every option counts.
  std::set<std::string> keys = {first.keys().at("divide 2")};
  const auto key_with = [&](auto change) {
    Recipe changed = recipe;
    changed.solids.clear(); // their places may lie in other regions now
    change(changed);
    return builder.build(changed, folder.path()).keys().at("divide 2");
  };
  EXPECT_TRUE(keys.insert(key_with([](Recipe& r) { r.divides[2].snap = 0.11; })).second);
  EXPECT_TRUE(keys.insert(key_with([](Recipe& r) { r.divides[2].only = {0, 1}; })).second);
  EXPECT_TRUE(keys.insert(key_with([](Recipe& r) { std::get<PlaneCut>(r.divides[0].shape).waves.seed = 3; })).second);
  EXPECT_TRUE(
      keys.insert(key_with([](Recipe& r) { std::get<PlaneCut>(r.divides[0].shape).waves.length = 16; })).second);
  EXPECT_TRUE(
      keys.insert(key_with([](Recipe& r) { std::get<PlaneCut>(r.divides[0].shape).waves.amplitude = 0.9; })).second);

  const std::string text = recipe_text(recipe);
  EXPECT_EQ(recipe_text(parse_recipe(text, "block.json")), text);
  EXPECT_EQ(builder.build(parse_recipe(text, "block.json"), folder.path()).keys(), first.keys());
}

TEST_F(LayeredBlock, TheModelFileTellsTheRegions) {
  const BuildResult result = Builder().build(recipe, folder.path());
  write_model(folder / "block.pith", result.model, result.pieces, recipe_text(recipe), result.keys());
  const ModelSummary summary = read_model_summary(folder / "block.pith");
  const auto regions = measure_regions(result.model.mesh);
  ASSERT_EQ(summary.region.size(), regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    EXPECT_EQ(summary.region[i].region, regions[i].region);
    EXPECT_EQ(summary.region[i].volume, regions[i].volume);
    EXPECT_EQ(summary.region[i].tets, regions[i].tets);
    EXPECT_EQ(summary.region[i].minimum_dihedral, regions[i].minimum_dihedral);
    EXPECT_EQ(summary.region[i].beside, regions[i].beside);
  }
}

TEST_F(LayeredBlock, WhatDoesNotFitIsRefusedByPlace) {
  Recipe broken = recipe;
  std::get<PlaneCut>(broken.divides[1].shape).offset = 40;
  EXPECT_EQ(message(broken).find("block.json: /divide/1: misses region 1: "), 0u) << message(broken);
  broken = recipe;
  std::get<PlaneCut>(broken.divides[0].shape).offset = 40;
  EXPECT_EQ(message(broken).find("block.json: /divide/0: divides no region: "), 0u) << message(broken);
  broken = recipe;
  broken.divides[2].only = {1, 7};
  EXPECT_EQ(message(broken).find("block.json: /divide/2/only: there is no region 7; the regions here are 0, 1, 2"),
            0u)
      << message(broken);
  broken = recipe;
  broken.solids[0].depth[0].interface = 2;
  EXPECT_EQ(message(broken).find("block.json: /solids/0/depth[0]: region 0 does not touch region 2"), 0u)
      << message(broken);
}

std::string parse_message(const std::string& text) {
  try {
    parse_recipe(text, "block.json");
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DivideRecipe, MistakesAreRefusedByPlace) {
  const auto with = [](const std::string& divide, const std::string& depth) {
    return R"({"pith": 1, "surface": {"file": "a.obj"}, "divide": [)" + divide +
           R"(], "solids": [{"type": "2-b", "depth": )" + depth +
           R"(, "orientation": [{"stroke": [[0,0,0],[1,0,0]]}], "exemplar": {"procedural": "kiwi"}}]})";
  };
  const std::string plane = R"({"plane": {"normal": [0, 0, 1]}})",
                    depth = R"([{"outside": true, "value": 0}, {"interface": 1, "value": 1}])";
  EXPECT_EQ(parse_message(with(plane, depth)), "accepted");
  const std::pair<std::string, std::string> divides[] = {
      {R"({})", "/divide/0: has no shape"},
      {R"({"plane": {"normal": [0, 0, 1]}, "sphere": {"center": [0, 0, 0], "radius": 1}})",
       "/divide/0: has more than one shape"},
      {R"({"plane": {"normal": [0, 0, 1]}, "only": []})", "/divide/0/only"},
      {R"({"plane": {"normal": [0, 0, 1]}, "only": [-1]})", "/divide/0/only/0"},
      {R"({"plane": {"normal": [0, 0, 1]}, "snap": 0.5})", "/divide/0/snap"},
      {R"({"plane": {"normal": [0, 0, 1]}, "keep": "left"})", "/divide/0"},
      {R"({"plane": {"normal": [0, 0, 1], "waves": {"amplitude": 1}}})", "/divide/0/plane/waves"},
      {R"({"plane": {"normal": [0, 0, 1], "waves": {"amplitude": -1, "length": 3}}})",
       "/divide/0/plane/waves/amplitude"},
      {R"({"plane": {"normal": [0, 0, 1], "waves": {"amplitude": 1, "length": 0}}})",
       "/divide/0/plane/waves/length"}};
  for (const auto& [text, where] : divides)
    EXPECT_EQ(parse_message(with(text, depth)).find("block.json: " + where), 0u) << parse_message(with(text, depth));
  const std::pair<std::string, std::string> depths[] = {
      {R"([{"outside": false, "value": 0}, {"interface": 1, "value": 1}])", "is false"},
      {R"([{"outside": true, "interface": 1, "value": 0}, {"interface": 1, "value": 1}])", "more than one place"},
      {R"([{"outside": true, "value": 0}, {"outside": true, "value": 1}])", "gives the outside two depths"},
      {R"([{"interface": 2, "value": 0}, {"interface": 2, "value": 1}])",
       "gives the interface with region 2 two depths"},
      {R"([{"skin": true, "value": 0}, {"interface": 2, "value": 1}])", "beside \"skin\""}};
  for (const auto& [text, what] : depths)
    EXPECT_NE(parse_message(with(plane, text)).find(what), std::string::npos) << parse_message(with(plane, text));
}

} // namespace
} // namespace pith
