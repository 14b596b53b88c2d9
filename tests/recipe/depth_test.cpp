// The depth of the recipes that come with pith: it is as its constraints ask, so that levelling extrema changes no
// bit.
#include "recipe/build.h"
#include "recipe/recipe.h"
#include "volume/field/depth.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

class RecipeDepth : public ::testing::TestWithParam<const char*> {};

TEST_P(RecipeDepth, HasNoExtremaToLevel) {
  const std::filesystem::path path = std::string(PITH_SOURCE_DIR "/data/recipes/") + GetParam() + ".json";
  const Recipe recipe = read_recipe(path);
  Recipe bare = recipe; // its mesh alone
  bare.cuts.clear();
  bare.moves.clear();
  for (Solid& solid : bare.solids) {
    Solid plain;
    plain.kind = Solid::Kind::plain;
    plain.region = solid.region;
    solid = plain;
  }
  const Model model = Builder().build(bare, path.parent_path()).model;
  std::size_t fields = 0;
  for (const Solid& solid : recipe.solids) {
    if (solid.depth.empty()) continue;
    EXPECT_TRUE(solid.depth_options.remove_extrema);
    DepthOptions keep = solid.depth_options;
    keep.remove_extrema = false;
    const DepthField usual = depth_field(model.mesh, model.boundary, solid.region, solid.depth, "depth",
                                         solid.depth_options),
                     kept = depth_field(model.mesh, model.boundary, solid.region, solid.depth, "depth", keep);
    EXPECT_EQ(usual.extrema, 0u) << kept.extrema;
    EXPECT_EQ(usual.value, kept.value);
    EXPECT_TRUE(std::equal(usual.gradient.begin(), usual.gradient.end(), kept.gradient.begin()));
    ++fields;
  }
  EXPECT_GT(fields, 0u);
}

INSTANTIATE_TEST_SUITE_P(Of, RecipeDepth,
                         ::testing::Values("banana", "bell_pepper", "brick", "carrot", "kiwi", "orange", "tree"));

} // namespace
} // namespace pith
