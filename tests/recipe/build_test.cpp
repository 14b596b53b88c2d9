// Building recipes: what is done again after an edit, and what a cache that was damaged, cut short or too small does.
#include "recipe/build.h"
#include "recipe/steps.h"
#include "tests/support/scratch.h"
#include "tests/support/tri_shapes.h"
#include "volume/base/error.h"
#include "volume/io/mesh_io.h"

#include <gtest/gtest.h>
#include <set>

namespace pith {
namespace {

using testing::ScratchFolder;

/// A ball of 20 mm with a core along z, filled with a small exemplar.
class Build : public ::testing::Test {
protected:
  Build() {
    write_tri_mesh(folder / "ball.obj", testing::sphere_surface(3, 20));
    recipe = parse_recipe(R"({"pith": 1, "surface": {"file": "ball.obj"}, "tetrahedralize": {"interior_edge": 6},
      "solids": [{"type": "2-b",
        "depth": [{"skin": true, "value": 0}, {"stroke": [[0, 0, -8], [0, 0, 8]], "value": 1}],
        "orientation": [{"stroke": [[0, 0, -8], [0, 0, 8]]}],
        "exemplar": {"procedural": "kiwi", "resolution": 16}, "fill": {"coverage_order": 4}}],
      "cuts": [{"plane": {"normal": [1, 0, 0], "offset": 1}}, {"plane": {"normal": [0, 1, 0], "offset": 2}}],
      "moves": [{"piece": [10, 0, 0], "translate": [5, 0, 0]}]})",
                          "ball.json");
  }

  BuildOptions with_disk() const {
    BuildOptions options;
    options.cache = folder / "cache";
    return options;
  }
  BuildOptions in_memory() const { return {}; }

  static std::set<std::string> done_again(const BuildResult& result) {
    std::set<std::string> names;
    for (const StageReport& stage : result.stages)
      if (!stage.cached) names.insert(stage.name);
    return names;
  }

  static void expect_alike(const BuildResult& a, const BuildResult& b) {
    EXPECT_EQ(a.keys(), b.keys());
    EXPECT_EQ(a.model.mesh.position, b.model.mesh.position);
    EXPECT_EQ(a.model.mesh.corner, b.model.mesh.corner);
    EXPECT_EQ(a.model.field.depth, b.model.field.depth);
    ASSERT_EQ(a.model.layer.size(), b.model.layer.size());
    EXPECT_EQ(a.model.layer[0].corner, b.model.layer[0].corner);
    EXPECT_EQ(a.model.layer[0].begin, b.model.layer[0].begin);
    EXPECT_EQ(a.model.layer[0].exemplar.at(0).texel, b.model.layer[0].exemplar.at(0).texel);
    EXPECT_EQ(a.pieces.label, b.pieces.label);
    EXPECT_EQ(a.pieces.added_position, b.pieces.added_position);
    ASSERT_EQ(a.pieces.piece.size(), b.pieces.piece.size());
    for (std::size_t i = 0; i < a.pieces.piece.size(); ++i) {
      EXPECT_EQ(a.pieces.piece[i].cut.size(), b.pieces.piece[i].cut.size());
      EXPECT_EQ(a.pieces.piece[i].placement.translation, b.pieces.piece[i].placement.translation);
    }
  }

  ScratchFolder folder;
  Recipe recipe;
  const std::set<std::string> all{"surface",    "tets",   "refine", "depth 0", "frames 0",
                                  "exemplar 0", "fill 0", "cut 0",  "cut 1",   "move 0"};
};

using Names = std::set<std::string>;

TEST_F(Build, DoesEveryStageOnceAndThenNone) {
  Builder builder(in_memory());
  const BuildResult first = builder.build(recipe, folder.path());
  EXPECT_EQ(done_again(first), all);
  EXPECT_EQ(first.stages.front().name, "surface");
  EXPECT_EQ(first.stages.back().name, "move 0");
  EXPECT_EQ(first.pieces.piece.size(), 4u);
  validate(first.model);
  validate(first.pieces, first.model.mesh, first.model.boundary);
  const BuildResult second = builder.build(recipe, folder.path());
  EXPECT_EQ(done_again(second), Names{});
  expect_alike(first, second);
}

TEST_F(Build, AnEditDoesAgainOnlyWhatDependsOnIt) {
  Builder builder(in_memory());
  builder.build(recipe, folder.path());

  Recipe edited = recipe;
  edited.solids[0].orientation[0].point[1] = {1, 0, 8};
  EXPECT_EQ(done_again(builder.build(edited, folder.path())), (Names{"frames 0", "fill 0"}));

  edited = recipe;
  edited.solids[0].depth[1].stroke[1] = {0, 0, 7};
  // An axis stroke runs through vertices of the root: what stands on the root follows, the meshing itself does not.
  Names on_the_root = all;
  for (const char* name : {"surface", "tets", "exemplar 0"}) on_the_root.erase(name);
  EXPECT_EQ(done_again(builder.build(edited, folder.path())), on_the_root);

  edited = recipe;
  edited.solids[0].fill.seed = 2;
  EXPECT_EQ(done_again(builder.build(edited, folder.path())), (Names{"fill 0"}));

  edited = recipe;
  edited.solids[0].exemplar.seed = 2;
  EXPECT_EQ(done_again(builder.build(edited, folder.path())), (Names{"exemplar 0", "fill 0"}));

  edited = recipe;
  edited.moves[0].translate = {6, 0, 0};
  EXPECT_EQ(done_again(builder.build(edited, folder.path())), (Names{"move 0"}));

  edited = recipe;
  edited.tetrahedralize.interior_edge = 7;
  Names but_inputs = all;
  but_inputs.erase("surface");
  but_inputs.erase("exemplar 0");
  EXPECT_EQ(done_again(builder.build(edited, folder.path())), but_inputs);

  // Back to the beginning: everything is still remembered.
  EXPECT_EQ(done_again(builder.build(recipe, folder.path())), Names{});
}

TEST_F(Build, ThingsDoAgainOnlyThemselves) {
  Builder builder(with_disk());
  const auto paste_at = [](const Vec3d& place) {
    PasteStep step;
    step.thing.exemplar.procedural = "kiwi-seed";
    step.thing.exemplar.resolution = 16;
    step.options.place = place;
    step.options.size = 4;
    return step;
  };
  recipe.solids[0].pastes = {paste_at({8, 0, 0})};
  Names with_paste = all;
  with_paste.insert({"thing 0", "paste 0.0"});
  const BuildResult first = builder.build(recipe, folder.path());
  EXPECT_EQ(done_again(first), with_paste);
  ASSERT_EQ(first.model.layer.size(), 2u);
  EXPECT_EQ(first.model.layer[1].patch.size(), 1u);
  EXPECT_LT(first.model.layer[1].simplex.size(), first.model.mesh.tet_count() / 4);

  recipe.solids[0].pastes.push_back(paste_at({-8, 0, 0})); // a fold: what was there stays
  EXPECT_EQ(done_again(builder.build(recipe, folder.path())), (Names{"paste 0.1"}));
  recipe.solids[0].pastes[0].options.size = 3;
  const BuildResult edited = builder.build(recipe, folder.path());
  EXPECT_EQ(done_again(edited), (Names{"paste 0.0"}));
  EXPECT_EQ(edited.model.layer[1].patch.size(), 2u);
  EXPECT_EQ(edited.model.layer[1].exemplar.size(), 2u);

  ScatterStep scatter;
  scatter.thing = recipe.solids[0].pastes[0].thing;
  scatter.options.count = 20;
  scatter.options.size = 3;
  recipe.solids[0].scatter = {scatter};
  const BuildResult scattered = builder.build(recipe, folder.path());
  EXPECT_EQ(done_again(scattered), (Names{"scatter 0.0"}));
  ASSERT_EQ(scattered.scatters.size(), 1u);
  EXPECT_EQ(scattered.scatters[0].placed, 20);
  EXPECT_EQ(scattered.model.layer[1].patch.size(), 22u);
  recipe.solids[0].scatter[0].options.jitter = 0.5;
  EXPECT_EQ(done_again(builder.build(recipe, folder.path())), (Names{"scatter 0.0"}));
  recipe.solids[0].scatter.push_back(scatter);
  recipe.solids[0].scatter[1].options.seed = 2;
  EXPECT_EQ(done_again(builder.build(recipe, folder.path())), (Names{"scatter 0.1"}));
  recipe.solids[0].pastes.pop_back(); // scatters keep clear of pastes
  const BuildResult last = builder.build(recipe, folder.path());
  EXPECT_EQ(done_again(last), (Names{"scatter 0.0", "scatter 0.1"}));

  // The next process finds it all on disk.
  const BuildResult next = Builder(with_disk()).build(recipe, folder.path());
  EXPECT_EQ(done_again(next), Names{});
  EXPECT_EQ(next.model.layer[1].corner, last.model.layer[1].corner);
  EXPECT_EQ(next.model.layer[1].mask.at(0).alpha, last.model.layer[1].mask.at(0).alpha);

  // A plain solid takes things too; what it has no fields for is refused.
  Recipe plain = recipe;
  plain.solids[0].kind = Solid::Kind::plain;
  EXPECT_EQ(builder.build(plain, folder.path()).model.layer.size(), 2u);
  const auto message = [&](const Recipe& broken) -> std::string {
    try {
      builder.build(broken, folder.path());
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  };
  plain.solids[0].scatter[0].options.depth = {0.5, 1};
  EXPECT_EQ(message(plain).find("ball.json: /solids/0/scatter/0/depth: is given for a solid that has no depth"), 0u)
      << message(plain);
  Recipe broken = recipe;
  broken.solids[0].pastes[0].options.place = {0, 0, 90};
  EXPECT_EQ(message(broken).find("ball.json: /solids/0/pastes/0/place: lies outside region 0"), 0u)
      << message(broken);
  broken = recipe;
  broken.solids[0].pastes[0].thing.exemplar.procedural = "kiwi";
  EXPECT_NE(message(broken).find("does not say where it is opaque"), std::string::npos) << message(broken);
}

TEST_F(Build, CutsAreAFold) {
  Builder builder(in_memory());
  recipe.moves.clear();
  builder.build(recipe, folder.path());

  Recipe appended = recipe;
  appended.cuts.push_back(parse_cut(R"({"sphere": {"center": [0, 0, 0], "radius": 9}})", "cut"));
  const BuildResult longer = builder.build(appended, folder.path());
  EXPECT_EQ(done_again(longer), Names{"cut 2"});

  Recipe second_changed = appended;
  std::get<PlaneCut>(second_changed.cuts[1].shape).offset = 3;
  EXPECT_EQ(done_again(builder.build(second_changed, folder.path())), (Names{"cut 1", "cut 2"}));

  appended.cuts.pop_back(); // undo
  EXPECT_EQ(done_again(builder.build(appended, folder.path())), Names{});

  // The same pieces come of cutting by hand and of building the recipe.
  BuildResult by_hand = builder.build(recipe, folder.path());
  const Locator locator(by_hand.model.mesh, by_hand.model.boundary);
  apply_cut(by_hand.pieces, {by_hand.model, locator},
            parse_cut(R"({"sphere": {"center": [0, 0, 0], "radius": 9}})", "cut"), "cut");
  EXPECT_EQ(by_hand.pieces.label, longer.pieces.label);
  EXPECT_EQ(by_hand.pieces.added_position, longer.pieces.added_position);
}

TEST_F(Build, TheFolderServesTheNextProcess) {
  const BuildResult first = Builder(with_disk()).build(recipe, folder.path());
  EXPECT_EQ(done_again(first), all);
  const BuildResult second = Builder(with_disk()).build(recipe, folder.path());
  EXPECT_EQ(done_again(second), Names{});
  expect_alike(first, second);

  BuildOptions later_version = with_disk();
  later_version.code = "another build of the program";
  EXPECT_EQ(done_again(Builder(later_version).build(recipe, folder.path())), all);
}

TEST_F(Build, InputsCountByContent) {
  Builder builder(in_memory());
  builder.build(recipe, folder.path());
  std::filesystem::last_write_time(folder / "ball.obj", std::filesystem::file_time_type::clock::now());
  EXPECT_EQ(done_again(builder.build(recipe, folder.path())), Names{});
  write_tri_mesh(folder / "ball.obj", testing::sphere_surface(3, 21));
  Names but_exemplar = all;
  but_exemplar.erase("exemplar 0");
  EXPECT_EQ(done_again(builder.build(recipe, folder.path())), but_exemplar);
}

TEST_F(Build, DamagedEntriesAreMadeAgain) {
  const BuildResult whole = Builder(with_disk()).build(recipe, folder.path());
  std::size_t entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cache")) {
    std::string bytes = testing::content_of(entry.path());
    switch (entries++ % 4) {
    case 0:
      bytes[bytes.size() / 2] ^= 1;
      break; // one bit
    case 1:
      bytes.resize(bytes.size() / 2);
      break; // cut short
    case 2:
      bytes = "foreign";
      break; // something else
    default:
      bytes.clear(); // empty
    }
    testing::write_text(entry.path(), bytes);
  }
  EXPECT_EQ(entries, 9u); // every stage but the surface
  const BuildResult again = Builder(with_disk()).build(recipe, folder.path());
  EXPECT_EQ(done_again(again), all);
  expect_alike(whole, again);
  EXPECT_EQ(done_again(Builder(with_disk()).build(recipe, folder.path())), Names{}); // and mended
}

TEST_F(Build, TheFolderKeepsToItsBudget) {
  BuildOptions options = with_disk();
  options.cache_bytes = 200'000;
  const BuildResult first = Builder(options).build(recipe, folder.path());
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cache")) bytes += entry.file_size();
  EXPECT_LE(bytes, options.cache_bytes);
  EXPECT_GT(bytes, 0u);
  expect_alike(first, Builder(options).build(recipe, folder.path()));
}

TEST_F(Build, AFolderThatCannotBeWrittenIsNoError) {
  testing::write_text(folder / "file", "");
  BuildOptions options;
  options.cache = folder / "file/cache";
  EXPECT_NO_THROW(Builder(options).build(recipe, folder.path()));
}

TEST_F(Build, MemoryKeepsToItsBudget) {
  BuildOptions options;
  options.memory_bytes = 1;
  Builder builder(options);
  const BuildResult first = builder.build(recipe, folder.path());
  const BuildResult second = builder.build(recipe, folder.path());
  EXPECT_EQ(done_again(second), all);
  expect_alike(first, second);
}

TEST_F(Build, WhatDoesNotFitItsInputsIsRefusedByPlace) {
  const auto message = [&](const Recipe& broken) -> std::string {
    try {
      Builder(in_memory()).build(broken, folder.path());
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  };
  Recipe broken = recipe;
  broken.surface.file = "gone.obj";
  EXPECT_EQ(message(broken).find("ball.json: /surface/file: \"gone.obj\" does not exist; "), 0u) << message(broken);
  broken = recipe;
  broken.solids[0].region = 4;
  EXPECT_EQ(message(broken).find("ball.json: /solids/0/region: is 4; the solid has 1 region"), 0u)
      << message(broken);
  broken = recipe;
  broken.solids[0].exemplar.file = "gone.exemplar";
  EXPECT_EQ(message(broken).find("ball.json: /solids/0/exemplar/file: \"gone.exemplar\" does not exist"), 0u)
      << message(broken);
  broken = recipe;
  broken.cuts[1].only = {{100, 0, 0}};
  EXPECT_EQ(message(broken).find("ball.json: /cuts/1/only: (100, 0, 0) lies outside the solid"), 0u)
      << message(broken);
  broken = recipe;
  std::get<PlaneCut>(broken.cuts[0].shape).offset = 100;
  EXPECT_EQ(message(broken).find("ball.json: /cuts/0"), 0u) << message(broken);
  broken = recipe;
  broken.moves[0].piece = {0, 0, 90};
  EXPECT_EQ(message(broken).find("ball.json: /moves/0/piece: (0, 0, 90) lies outside"), 0u) << message(broken);
}

TEST_F(Build, StopsWhenAskedTo) {
  int calls = 0;
  EXPECT_THROW(
      Builder(in_memory()).build(recipe, folder.path(), [&](const std::string&, double) { return ++calls < 3; }),
      Cancelled);
}

TEST_F(Build, APlainRecipeIsGreyAllTheWayThrough) {
  recipe = parse_recipe(R"({"pith": 1, "surface": {"file": "ball.obj"}})", "plain.json");
  BuildResult result = Builder(in_memory()).build(recipe, folder.path());
  const Root root(std::move(result.model));
  for (const Vec3d& x : {Vec3d(0, 0, 0), Vec3d(10, 3, -2), Vec3d(0, -19, 0)}) {
    const Material material = material_at(root, {.position = x, .region = -1, .facet = {}, .hint = {}});
    EXPECT_EQ(material.coverage, 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(material.value[c], 0.5, 0.003);
  }
}

TEST_F(Build, HasTheStagesThatATypeNeeds) {
  recipe.cuts.clear();
  recipe.moves.clear();
  const Solid kiwi = recipe.solids[0];
  const auto stages = [&](const BuildResult& result) {
    Names names;
    for (const StageReport& stage : result.stages)
      if (stage.name.ends_with(" 0")) names.insert(stage.name);
    return names;
  };
  Builder builder(in_memory());
  const auto type = [&](TextureType to) {
    Solid solid;
    solid.fill = kiwi.fill;
    solid.fill.type = to;
    solid.exemplar = kiwi.exemplar;
    const TextureTraits& traits = traits_of(to);
    if (traits.uses_depth) solid.depth = kiwi.depth;
    if (traits.uses_stroke) solid.orientation = kiwi.orientation;
    if (traits.uses_scale) solid.scale = 20;
    const auto from_to = [](const Vec3d& a, const Vec3d& b) -> std::vector<DepthConstraint> {
      return {{.value = 0, .skin = false, .triangles = {}, .stroke = {a}},
              {.value = 1, .skin = false, .triangles = {}, .stroke = {b}}};
    };
    if (traits.imposed[2]) solid.along = from_to({0, 0, -20}, {0, 0, 20});
    if (traits.imposed[0]) solid.around = from_to({-20, 0, 0}, {20, 0, 0});
    return solid;
  };
  // The kiwi exemplar does not repeat along S: types that tile there refuse it, by the solid's key.
  recipe.solids = {type(TextureType::isotropic_0)};
  try {
    builder.build(recipe, folder.path());
    ADD_FAILURE() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(
        std::string(error.what())
            .find("ball.json: /solids/0/exemplar: 'kiwi' does not repeat along axis 1 (S), along which type 0 tiles"),
        0u)
        << error.what();
  }
  recipe.solids = {type(TextureType::axis_1b)};
  BuildResult result = builder.build(recipe, folder.path());
  EXPECT_EQ(stages(result), (Names{"depth 0", "frames 0", "exemplar 0", "fill 0"}));
  ASSERT_EQ(result.fills.size(), 1u);
  EXPECT_EQ(result.fills[0].type, TextureType::axis_1b);
  recipe.solids = {type(TextureType::tensor_2c)};
  EXPECT_EQ(stages(builder.build(recipe, folder.path())),
            (Names{"depth 0", "along 0", "frames 0", "exemplar 0", "fill 0"}));
  recipe.solids = {type(TextureType::tensor_2d)};
  result = builder.build(recipe, folder.path());
  EXPECT_EQ(stages(result), (Names{"depth 0", "along 0", "around 0", "frames 0", "exemplar 0", "fill 0"}));
  EXPECT_EQ(result.fills[0].statistics.pastes, 1u);
  validate(result.model);
  // A change of one field repeats that field and what stands on it.
  recipe.solids[0].around[0].stroke = {{0, -20, 0}};
  EXPECT_EQ(done_again(builder.build(recipe, folder.path())), (Names{"around 0", "frames 0", "fill 0"}));
}

TEST_F(Build, KeptHalvesAndMovedPiecesAreTakenInByLaterCuts) {
  recipe.solids.clear();
  recipe.cuts.resize(1); // x = 1: left half piece 0, right half piece 1
  Builder builder(in_memory());
  const BuildResult moved = builder.build(recipe, folder.path());
  ASSERT_EQ(moved.pieces.piece.size(), 2u);

  // In world space the right half begins at x = 6: the plane x = 3.5 lies between the halves, x = 8 meets only the
  // right one.
  Recipe later = recipe;
  CutStep cut;
  cut.shape = PlaneCut{.normal = {1, 0, 0}, .offset = 8};
  append_cut(later, cut, moved.pieces, moved.model.mesh);
  EXPECT_TRUE(later.moves.empty());
  const BuildResult result = builder.build(parse_recipe(recipe_text(later), "later.json"), folder.path());
  ASSERT_EQ(result.pieces.piece.size(), 3u);
  EXPECT_EQ(result.pieces.piece[1].placement.translation, Vec3d(5, 0, 0));
  EXPECT_EQ(result.pieces.piece[2].placement.translation, Vec3d(5, 0, 0));
  EXPECT_NEAR(measure(result.pieces, 1, result.model.mesh).bounds.low.x(), 1, 0.05); // rest space
  EXPECT_NEAR(measure(result.pieces, 1, result.model.mesh).bounds.high.x(), 3, 0.05);

  cut.keep = Keep::left;
  later = recipe;
  append_cut(later, cut, moved.pieces, moved.model.mesh);
  const BuildResult left = builder.build(later, folder.path());
  ASSERT_EQ(left.pieces.piece.size(), 2u); // the left half of the ball, and the slice
  cut.keep = Keep::right;
  later = recipe;
  append_cut(later, cut, moved.pieces, moved.model.mesh);
  const BuildResult right = builder.build(later, folder.path());
  ASSERT_EQ(right.pieces.piece.size(), 1u);
  EXPECT_NEAR(measure(right.pieces, 0, right.model.mesh).bounds.low.x(), 3, 0.05);
}

} // namespace
} // namespace pith
