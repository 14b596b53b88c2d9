// Reading and writing recipes: every kind of mistake is refused with the place where it stands.
#include "recipe/recipe.h"
#include "volume/base/error.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

/// A recipe in which one part is exchanged.
std::string kiwi(const std::string& from = "", const std::string& to = "") {
  std::string text = R"({
    "pith": 1, "name": "kiwi",
    "surface": {"file": "../meshes/kiwi.obj", "scale": 2},
    "tetrahedralize": {"interior_edge": 4, "boundary_edge": 0, "method": "automatic", "core_edge": 1.5, "core_growth": 0.3},
    "solids": [{
      "region": 0, "type": "2-b",
      "depth": [{"skin": true, "value": 0}, {"stroke": [[0, 0, -26], [0, 0, 26]], "value": 1}],
      "orientation": [{"stroke": [[0, 0, -26], [0, 0, 26]]}],
      "exemplar": {"procedural": "kiwi", "resolution": 64, "seed": 3},
      "mask": {"radius": 0.38, "drop_off": 0.05},
      "fill": {"coverage_order": 6, "length_weight": 0.1}, "depth_options": {"overshoot": "guard"},
      "frame": {"largest_scale": 40},
      "seed": 7,
      "scatter": [{"exemplar": {"procedural": "kiwi-seed", "resolution": 32}, "count": 90, "spacing": 1.5, "size": 2.2,
        "size_variation": 0.2, "gap": 0.1, "depth": [0.6, 0.9], "axis": [[0, 0, -20], [0, 0, 20]], "along": [0.1, 0.8],
        "groups": 24, "group_width": 0.5, "jitter": 0.3, "spin": 0.4, "clip": true, "seed": 5}],
      "pastes": [{"exemplar": {"procedural": "watermelon-seed"}, "place": [8, 1, 2], "size": 6, "axes": "rest",
        "rotate": {"axis": [1, 1, 0], "angle": 0.25}, "follow": "warped", "clip": false}]
    }, {"region": 1, "type": "plain", "color": [0.3, 0.2, 0.1],
      "pastes": [{"exemplar": {"procedural": "kiwi"}, "mask": {"radius": 0.25}, "place": [0, 0, 1.5], "size": 3}]}],
    "cuts": [
      {"plane": {"normal": [0, 0, 1], "offset": 0.5}, "spread": 10},
      {"sphere": {"center": [1, 2, 3], "radius": 4}, "keep": "left", "only": [0, 0, 9]},
      {"stroke": {"points": [[-1, 0], [1, 0.1]], "view": {"eye": [0, -100, 0], "up": [0, 0, 1]}},
       "placements": [{"piece": [0, 0, 1], "rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "translation": [1, 2, 3]}]}
    ],
    "moves": [{"piece": [0, 0, 9], "translate": [0, 0, 5], "rotate": {"axis": [0, 0, 1], "angle": 0.5}}],
    "view": {"eye": [100, 0, 0], "vertical_angle": 0, "height": 80},
    "scene": "studio.json"
  })";
  if (from.empty()) return text;
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the test's recipe lacks " + from);
  return text.replace(at, from.size(), to);
}

std::string message_of(const std::string& text) {
  try {
    parse_recipe(text, "kiwi.json");
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Recipe, IsReadInFull) {
  const Recipe recipe = parse_recipe(kiwi(), "kiwi.json");
  EXPECT_EQ(recipe.name, "kiwi");
  EXPECT_EQ(recipe.surface.file, "../meshes/kiwi.obj");
  EXPECT_EQ(recipe.surface.scale, 2);
  EXPECT_EQ(recipe.tetrahedralize.interior_edge, 4);
  ASSERT_EQ(recipe.solids.size(), 2u);
  const Solid& flesh = recipe.solids[0];
  EXPECT_EQ(flesh.kind, Solid::Kind::lapped);
  ASSERT_EQ(flesh.depth.size(), 2u);
  EXPECT_TRUE(flesh.depth[0].skin);
  EXPECT_EQ(flesh.depth[1].stroke.size(), 2u);
  EXPECT_EQ(flesh.depth[1].value, 1);
  EXPECT_EQ(flesh.orientation.at(0).point.at(1), Vec3d(0, 0, 26));
  EXPECT_EQ(flesh.exemplar.procedural, "kiwi");
  EXPECT_EQ(flesh.exemplar.resolution, 64);
  EXPECT_EQ(flesh.fill.splotch.radius, 0.38);
  EXPECT_EQ(flesh.fill.coverage_order, 6);
  EXPECT_EQ(flesh.frame.largest_scale, 40);
  EXPECT_EQ(flesh.fill.seed, 7u);
  const ScatterOptions& scatter = flesh.scatter.at(0).options;
  EXPECT_EQ(flesh.scatter.at(0).thing.exemplar.procedural, "kiwi-seed");
  EXPECT_EQ(scatter.count, 90);
  EXPECT_EQ(scatter.spacing, 1.5);
  EXPECT_EQ(scatter.gap, 0.1);
  EXPECT_EQ(scatter.size_variation, 0.2);
  EXPECT_EQ(scatter.depth, (std::array{0.6, 0.9}));
  EXPECT_EQ(scatter.axis[1], Vec3d(0, 0, 20));
  EXPECT_EQ(scatter.along, (std::array{0.1, 0.8}));
  EXPECT_EQ(scatter.groups, 24);
  EXPECT_EQ(scatter.group_width, 0.5);
  EXPECT_EQ(scatter.jitter, 0.3);
  EXPECT_EQ(scatter.spin, 0.4);
  EXPECT_TRUE(scatter.clip);
  EXPECT_EQ(scatter.seed, 5u);
  const PasteStep& paste = flesh.pastes.at(0);
  EXPECT_EQ(paste.options.place, Vec3d(8, 1, 2));
  EXPECT_EQ(paste.options.size, 6);
  EXPECT_FALSE(paste.options.in_frame);
  EXPECT_EQ(paste.options.follow, Follow::warped);
  EXPECT_FALSE(paste.options.clip);
  EXPECT_EQ(paste.turn.angle, 0.25);
  EXPECT_EQ(recipe.solids[1].pastes.at(0).thing.mask->radius, 0.25);
  EXPECT_EQ(recipe.solids[1].kind, Solid::Kind::plain);
  EXPECT_EQ(recipe.solids[1].color, Vec3d(0.3, 0.2, 0.1));
  ASSERT_EQ(recipe.cuts.size(), 3u);
  EXPECT_EQ(std::get<PlaneCut>(recipe.cuts[0].shape).offset, 0.5);
  EXPECT_EQ(recipe.cuts[0].spread, 10);
  EXPECT_EQ(std::get<SphereCut>(recipe.cuts[1].shape).radius, 4);
  EXPECT_EQ(recipe.cuts[1].keep, Keep::left);
  EXPECT_EQ(recipe.cuts[1].only.at(0), Vec3d(0, 0, 9));
  EXPECT_EQ(std::get<StrokeCut>(recipe.cuts[2].shape).view.eye, Vec3d(0, -100, 0));
  EXPECT_EQ(recipe.cuts[2].placements.at(0).placement(Vec3d(1, 0, 0)), Vec3d(1, 3, 3));
  EXPECT_EQ(recipe.moves.at(0).angle, 0.5);
  EXPECT_TRUE(recipe.view->orthographic());
  EXPECT_EQ(recipe.scene, "studio.json");
}

TEST(Recipe, WrittenTextReadsBackAlike) {
  const std::string once = recipe_text(parse_recipe(kiwi(), "kiwi.json"));
  const std::string twice = recipe_text(parse_recipe(once, "kiwi.json"));
  EXPECT_EQ(once, twice);
  for (const char* part : {"\"radius\": 0.38", "\"coverage_order\": 6", "\"length_weight\": 0.1", "\"core_edge\": 1.5", "\"overshoot\": \"guard\"", "\"largest_scale\": 40", "\"seed\": 7",
                           "\"spread\": 10", "\"keep\": \"left\"", "[0, 0, 9]", "\"angle\": 0.5", "\"height\": 80",
                           "studio.json", "\"scale\": 2", "\"resolution\": 64", "[0, -1, 0]", "[0.3, 0.2, 0.1]",
                           "\"count\": 90", "\"spacing\": 1.5", "\"gap\": 0.1", "\"along\": [0.1, 0.8]",
                           "\"groups\": 24", "\"group_width\": 0.5", "\"jitter\": 0.3", "\"spin\": 0.4",
                           "\"size_variation\": 0.2", "\"depth\": [0.6, 0.9]", "\"place\": [8, 1, 2]",
                           "\"axes\": \"rest\"", "\"follow\": \"warped\"", "\"clip\": true", "\"clip\": false",
                           "\"radius\": 0.25", "\"angle\": 0.25"})
    EXPECT_NE(once.find(part), std::string::npos) << part << " is lost in\n" << once;
}

TEST(Recipe, SmallestOneTakesItsNameFromTheFile) {
  const Recipe recipe = parse_recipe(R"({"pith": 1, "surface": {"file": "bunny.off"}})", "bunny.json");
  EXPECT_EQ(recipe.name, "bunny");
  EXPECT_TRUE(recipe.solids.empty());
}

struct Mistake {
  const char *name, *from, *to, *message; ///< the message's beginning
};

class RecipeMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(RecipeMistakes, AreRefusedWhereTheyStand) {
  const Mistake& mistake = GetParam();
  const std::string message = message_of(kiwi(mistake.from, mistake.to));
  EXPECT_EQ(message.substr(0, std::string(mistake.message).size()), mistake.message) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_NE(message.find("; "), std::string::npos) << "says how to mend it: " << message;
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Recipe, RecipeMistakes, ::testing::ValuesIn(std::vector<Mistake>{
  {"Negative", "\"interior_edge\": 4", "\"interior_edge\": -3", "kiwi.json: /tetrahedralize/interior_edge: is -3, must be positive"},
  {"NoCount", "\"count\": 90, \"spacing\": 1.5,", "", "kiwi.json: /solids/0/scatter/0: says neither how many nor how far apart"},
  {"ThingSize", "\"size\": 2.2", "\"size\": 0", "kiwi.json: /solids/0/scatter/0/size: is 0, must be positive"},
  {"NoThing", "\"watermelon-seed\"", "\"melon-seed\"", "kiwi.json: /solids/0/pastes/0/exemplar/procedural: is \"melon-seed\", which no generator makes"},
  {"TiledGenerator", "\"resolution\": 64, \"seed\": 3", "\"tile\": {}", "kiwi.json: /solids/0/exemplar/tile: is for files only"},
  {"TileAxes", "\"procedural\": \"kiwi\", \"resolution\": 64, \"seed\": 3", "\"file\": \"a.tif\", \"tile\": {\"along\": \"RXT\"}", "kiwi.json: /solids/0/exemplar/tile/along: is \"RXT\""},
  {"TileBorder", "\"procedural\": \"kiwi\", \"resolution\": 64, \"seed\": 3", "\"file\": \"a.tif\", \"tile\": {\"border\": 0.6}", "kiwi.json: /solids/0/exemplar/tile/border: is 0.6, must be above 0, to 0.5"},
  {"PasteWithoutPlace", "\"place\": [8, 1, 2],", "", "kiwi.json: /solids/0/pastes/0: lacks \"place\""},
  {"EmptyBand", "\"depth\": [0.6, 0.9]", "\"depth\": [0.9, 0.6]", "kiwi.json: /solids/0/scatter/0/depth: is empty"},
  {"WideBand", "\"depth\": [0.6, 0.9]", "\"depth\": [0.6, 1.9]", "kiwi.json: /solids/0/scatter/0/depth: must be 0 to 1"},
  {"ScatterWithoutAxis", "\"axis\": [[0, 0, -20], [0, 0, 20]],", "", "kiwi.json: /solids/0/scatter/0/along: is given without \"axis\""},
  {"UnknownAxes", "\"axes\": \"rest\"", "\"axes\": \"world\"", "kiwi.json: /solids/0/pastes/0/axes: is \"world\", which is not known"},
  {"Text", "\"interior_edge\": 4", "\"interior_edge\": \"4\"", "kiwi.json: /tetrahedralize/interior_edge: is \"4\", must be a number; give millimetres"},
  {"NotANumber", "\"interior_edge\": 4", "\"interior_edge\": NaN", "kiwi.json: is not JSON: line 4, column"},
  {"LengthWeight", "\"length_weight\": 0.1", "\"length_weight\": 0", "kiwi.json: /solids/0/fill/length_weight: is 0, must be above 0, to 1"},
  {"CoreGrowth", "\"core_growth\": 0.3", "\"core_growth\": 0", "kiwi.json: /tetrahedralize/core_growth: is 0, must be 0.01 or more"},
  {"CoreWithoutStroke", "{\"stroke\": [[0, 0, -26], [0, 0, 26]], \"value\": 1}", "{\"stroke\": [[0, 0, 0]], \"value\": 1}", "kiwi.json: /tetrahedralize: has a core_edge, but no solid has a stroke of depth 1"},
  {"Overshoot", "\"guard\"", "\"sometimes\"", "kiwi.json: /solids/0/depth_options/overshoot: is \"sometimes\""},
  {"Endless", "\"interior_edge\": 4", "\"interior_edge\": 1e999", "kiwi.json: holds a number too large"},
  {"Null", "\"interior_edge\": 4", "\"interior_edge\": null", "kiwi.json: /tetrahedralize/interior_edge: is null, must be a number"},
  {"UnknownTopKey", "\"solids\"", "\"solid\"", "kiwi.json: /solid: is not a known key; did you mean \"solids\"?"},
  {"UnknownKey", "\"exemplar\"", "\"exempler\"", "kiwi.json: /solids/0/exempler: is not a known key; did you mean \"exemplar\"?"},
  {"UnlikeKey", "\"spread\"", "\"xyzzyplugh\"", "kiwi.json: /cuts/0/xyzzyplugh: is not a known key; known keys: plane, sphere"},
  {"UnknownMethod", "\"automatic\"", "\"tetgem\"", "kiwi.json: /tetrahedralize/method: is \"tetgem\", which is not known; did you mean \"tetgen\"?"},
  {"RepeatedKey", "\"name\": \"kiwi\"", "\"pith\": 1", "kiwi.json: key \"pith\" appears twice"},
  {"NoVersion", "\"pith\": 1,", "", "kiwi.json: lacks \"pith\""},
  {"LaterVersion", "\"pith\": 1", "\"pith\": 2", "kiwi.json: /pith: is 2, must be 1 to 1"},
  {"NoSurface", "\"file\": \"../meshes/kiwi.obj\",", "", "kiwi.json: /surface: lacks \"file\""},
  {"EmptyFile", "../meshes/kiwi.obj", "", "kiwi.json: /surface/file: is empty"},
  {"SurfaceList", "{\"file\": \"../meshes/kiwi.obj\", \"scale\": 2}", "[]", "kiwi.json: /surface: is a list, must be an object"},
  {"ZeroScale", "\"scale\": 2", "\"scale\": 0", "kiwi.json: /surface/scale: is 0, must be positive"},
  {"SolidsObject", "\"cuts\": [", "\"cuts\": 3, \"moves2\": [", "kiwi.json: /moves2: is not a known key; did you mean \"moves\"?"},
  {"UnknownType", "\"2-b\"", "\"2-z\"", "kiwi.json: /solids/0/type: is \"2-z\", which is not known"},
  {"StrokesWithoutUse", "\"2-b\"", "\"1-b\"", "kiwi.json: /solids/0/orientation: is not for type 1-b; remove it, or choose another type; it is for 1-a, 2-a and 2-b"},
  {"DepthWithoutUse", "\"2-b\"", "\"1-a\"", "kiwi.json: /solids/0/depth: is not for type 1-a; remove it"},
  {"NoScale", "\"2-b\"", "\"2-a\"", "kiwi.json: /solids/0: lacks \"scale\", the size of the texture in type 2-a; give millimetres"},
  {"NoAlong", "\"2-b\"", "\"2-c\"", "kiwi.json: /solids/0: lacks \"along\", from which the texture's T coordinate comes in type 2-c"},
  {"ScaleOfDepth", "\"seed\": 7", "\"seed\": 7, \"scale\": 3", "kiwi.json: /solids/0/scale: is not for type 2-b; remove it, or choose another type; it is for 0, 1-a and 2-a"},
  {"AlongOfStrokes", "\"seed\": 7", "\"seed\": 7, \"along\": []", "kiwi.json: /solids/0/along: is not for type 2-b"},
  {"LocalScaleNowhere", "\"seed\": 7", "\"seed\": 7, \"local_scale\": [{\"factor\": 2}]", "kiwi.json: /solids/0/local_scale/0: names no place"},
  {"LocalScaleZero", "\"seed\": 7", "\"seed\": 7, \"local_scale\": [{\"point\": [0, 0, 0], \"factor\": 0}]", "kiwi.json: /solids/0/local_scale/0/factor: is 0, must be 0.01 to 100"},
  {"UnknownAxis", "\"largest_scale\": 40", "\"axis\": \"none\"", "kiwi.json: /solids/0/frame/axis: is \"none\", which is not known"},
  {"DepthTooHigh", "\"value\": 1}", "\"value\": 1.5}", "kiwi.json: /solids/0/depth/1/value: is 1.5, must be 0 to 1"},
  {"SameDepth", "\"value\": 1}", "\"value\": 0}", "kiwi.json: /solids/0/depth: gives every place the same depth"},
  {"TwoPlaces", "\"skin\": true,", "\"skin\": true, \"triangles\": [1],", "kiwi.json: /solids/0/depth/0: names more than one place"},
  {"CreaseAlone", "\"skin\": true,", "\"skin\": true, \"crease\": 1,", "kiwi.json: /solids/0/depth/0/crease: belongs to a \"fill\""},
  {"CreaseTooWide", "\"skin\": true,", "\"fill\": [0, 0, 1], \"crease\": 4,", "kiwi.json: /solids/0/depth/0/crease: is 4, must be 0 to pi"},
  {"FillOfText", "\"skin\": true,", "\"fill\": \"top\",", "kiwi.json: /solids/0/depth/0/fill: is \"top\", must be"},
  {"NoPlace", "\"skin\": true,", "", "kiwi.json: /solids/0/depth/0: names no place"},
  {"SkinTwice", "{\"skin\": true, \"value\": 0}", "{\"skin\": true, \"value\": 0}, {\"skin\": true, \"value\": 0.5}", "kiwi.json: /solids/0/depth: gives the skin two depths"},
  {"TriangleTwice", "{\"skin\": true, \"value\": 0}", "{\"triangles\": [4, 5], \"value\": 0}, {\"triangles\": [5], \"value\": 0.5}", "kiwi.json: /solids/0/depth: gives input triangle 5 two depths"},
  {"NegativeTriangle", "\"skin\": true", "\"triangles\": [-1]", "kiwi.json: /solids/0/depth/0/triangles/0: is -1, must be 0 to"},
  {"BrokenTriangle", "\"skin\": true", "\"triangles\": [1.5]", "kiwi.json: /solids/0/depth/0/triangles/0: is 1.5, must be a whole number"},
  {"SkinFalse", "\"skin\": true", "\"skin\": false", "kiwi.json: /solids/0/depth/0/skin: is false"},
  {"SkinNumber", "\"skin\": true", "\"skin\": 1", "kiwi.json: /solids/0/depth/0/skin: is 1, must be true or false"},
  {"ShortPoint", "[0, 0, 26]], \"value\"", "[0, 26]], \"value\"", "kiwi.json: /solids/0/depth/1/stroke/1: is a list, must be [x, y, z]"},
  {"FarPoint", "[0, 0, 26]], \"value\"", "[0, 0, 1e200]], \"value\"", "kiwi.json: /solids/0/depth/1/stroke/1/2: is 1e+200, must be between -1e12 and 1e12"},
  {"TextPoint", "[0, 0, 26]], \"value\"", "[0, \"0\", 26]], \"value\"", "kiwi.json: /solids/0/depth/1/stroke/1/1: is \"0\", must be a number"},
  {"NoOrientation", "[{\"stroke\": [[0, 0, -26], [0, 0, 26]]}]", "[]", "kiwi.json: /solids/0/orientation: has 0 entries, needs 1 or more"},
  {"StillOrientation", "[{\"stroke\": [[0, 0, -26], [0, 0, 26]]}]", "[{\"stroke\": [[0, 0, 1], [0, 0, 1]]}]", "kiwi.json: /solids/0/orientation/0/stroke: stays at one point"},
  {"TwoExemplars", "\"procedural\": \"kiwi\",", "\"procedural\": \"kiwi\", \"file\": \"x\",", "kiwi.json: /solids/0/exemplar: has both"},
  {"NoExemplar", "\"procedural\": \"kiwi\",", "", "kiwi.json: /solids/0/exemplar: has neither"},
  {"UnknownExemplar", "\"procedural\": \"kiwi\"", "\"procedural\": \"kiwy\"", "kiwi.json: /solids/0/exemplar/procedural: is \"kiwy\", which no generator makes; known names: kiwi"},
  {"CoarseExemplar", "\"resolution\": 64", "\"resolution\": 4", "kiwi.json: /solids/0/exemplar/resolution: is 4, must be 16 to 512"},
  {"NegativeSeed", "\"seed\": 7", "\"seed\": -7", "kiwi.json: /solids/0/seed: is -7, must be a whole number of 0 or more"},
  {"WideDropOff", "\"drop_off\": 0.05", "\"drop_off\": 0.45", "kiwi.json: /solids/0/mask: has a drop_off wider than its radius"},
  {"ScalesSwapped", "\"largest_scale\": 40", "\"largest_scale\": 1, \"smallest_scale\": 2", "kiwi.json: /solids/0/frame: has a smallest_scale above"},
  {"RegionTwice", "\"region\": 1", "\"region\": 0", "kiwi.json: /solids/1: fills region 0, which /solids/0 fills already"},
  {"WrongColor", "[0.3, 0.2, 0.1]", "[0.3, 2, 0.1]", "kiwi.json: /solids/1/color: has a component outside 0 to 1"},
  {"OffsetAboveAlpha", "\"boundary_edge\": 0", "\"wrap_alpha\": 0.001, \"wrap_offset\": 0.01", "kiwi.json: /tetrahedralize: has a wrap_offset above its wrap_alpha"},
  {"NoNormal", "\"normal\": [0, 0, 1]", "\"normal\": [0, 0, 0]", "kiwi.json: /cuts/0/plane/normal: has no length"},
  {"NoRadius", "\"radius\": 4", "\"radius\": 0", "kiwi.json: /cuts/1/sphere/radius: is 0, must be positive"},
  {"TwoShapes", "\"spread\": 10", "\"sphere\": {\"center\": [0, 0, 0], \"radius\": 1}", "kiwi.json: /cuts/0: has more than one shape"},
  {"NoShape", "\"plane\": {\"normal\": [0, 0, 1], \"offset\": 0.5}, ", "", "kiwi.json: /cuts/0: has no shape"},
  {"SpreadOneHalf", "\"spread\": 10", "\"spread\": 10, \"keep\": \"left\"", "kiwi.json: /cuts/0: spreads halves but keeps only one"},
  {"WrongKeep", "\"keep\": \"left\"", "\"keep\": \"lefty\"", "kiwi.json: /cuts/1/keep: is \"lefty\", which is not known; did you mean \"left\"?"},
  {"ShortStroke", "[[-1, 0], [1, 0.1]]", "[[-1, 0]]", "kiwi.json: /cuts/2/stroke/points: has 1 entries, needs 2 or more"},
  {"StillStroke", "[[-1, 0], [1, 0.1]]", "[[1, 0], [1, 0]]", "kiwi.json: /cuts/2/stroke/points: stay at one place"},
  {"BlindView", "\"eye\": [0, -100, 0]", "\"eye\": [0, 0, 0]", "kiwi.json: /cuts/2/stroke/view: has its eye at its target"},
  {"LyingView", "\"up\": [0, 0, 1]}", "\"up\": [0, 1, 0]}", "kiwi.json: /cuts/2/stroke/view: has an up that is parallel"},
  {"NoRotation", "[[0, -1, 0], [1, 0, 0], [0, 0, 1]]", "[[0, -1, 0], [1, 0, 0], [0, 0, 2]]", "kiwi.json: /cuts/2/placements/0/rotation: is not a rotation"},
  {"Mirror", "[[0, -1, 0], [1, 0, 0], [0, 0, 1]]", "[[0, 1, 0], [1, 0, 0], [0, 0, 1]]", "kiwi.json: /cuts/2/placements/0/rotation: is not a rotation"},
  {"NoMove", "\"translate\": [0, 0, 5], \"rotate\": {\"axis\": [0, 0, 1], \"angle\": 0.5}", "\"about\": [0, 0, 0]", "kiwi.json: /moves/0: moves nothing"},
  {"NoAxis", "{\"axis\": [0, 0, 1], \"angle\": 0.5}", "{\"axis\": [0, 0, 0], \"angle\": 0.5}", "kiwi.json: /moves/0/rotate/axis: has no length"},
  {"NoAngle", "{\"axis\": [0, 0, 1], \"angle\": 0.5}", "{\"axis\": [0, 0, 1]}", "kiwi.json: /moves/0/rotate: lacks \"angle\""},
  {"Comma", "\"name\": \"kiwi\",", "\"name\": \"kiwi\",,", "kiwi.json: is not JSON: line 2, column"},
}), [](const auto& info) { return std::string(info.param.name); });
// clang-format on

TEST(Recipe, TextThatIsNoRecipeIsRefused) {
  EXPECT_EQ(message_of("").substr(0, 19), "kiwi.json: is empty");
  EXPECT_EQ(message_of(" \n ").substr(0, 19), "kiwi.json: is empty");
  EXPECT_EQ(message_of("[]").substr(0, 36), "kiwi.json: is a list, must be an obj");
  EXPECT_NE(message_of(kiwi().substr(0, 200)).find("truncated"), std::string::npos);
  EXPECT_EQ(message_of("PK\3\4").substr(0, 24), "kiwi.json: is not JSON: ");
  EXPECT_EQ(message_of("{\"pith\": 1, \"name\": \"\xff\"}").substr(0, 24), "kiwi.json: is not JSON: ");
  const std::string deep = std::string(100'000, '[');
  EXPECT_EQ(message_of(deep).substr(0, 29), "kiwi.json: is nested more tha");
}

/// A recipe of one solid.
std::string with_solid(const std::string& solid) {
  return R"({"pith": 1, "surface": {"file": "a.obj"}, "solids": [)" + solid + "]}";
}

constexpr const char* exemplar = R"("exemplar": {"procedural": "kiwi"})";
constexpr const char* two_depths = R"([{"skin": true, "value": 0}, {"stroke": [[0, 0, 0]], "value": 1}])";
constexpr const char* a_stroke = R"([{"stroke": [[0, 0, 0], [0, 0, 1]]}])";

TEST(Recipe, EveryTypeOfTextureIsReadAndWritten) {
  const std::string depth = std::string(R"("depth": )") + two_depths,
                    strokes = std::string(R"("orientation": )") + a_stroke,
                    along = std::string(R"("along": )") + two_depths,
                    around = std::string(R"("around": )") + two_depths;
  const std::vector<std::pair<TextureType, std::string>> cases{
      {TextureType::isotropic_0, R"("type": "0", "scale": 4.5, "local_scale": [{"point": [1, 2, 3], "factor": 2}])"},
      {TextureType::axis_1a, R"("type": "1-a", "scale": 4, "frame": {"axis": "unsigned"}, )" + strokes},
      {TextureType::axis_1b, R"("type": "1-b", )" + depth},
      {TextureType::tensor_2a,
       R"("type": "2-a", "scale": 4, "fill": {"scale_tolerance": 3}, )" + depth + ", " + strokes},
      {TextureType::tensor_2b,
       R"("type": "2-b", "local_scale": [{"stroke": [[1, 2, 3], [4, 5, 6]], "factor": 0.5}], )" + depth + ", " +
           strokes},
      {TextureType::tensor_2c, R"("type": "2-c", )" + depth + ", " + along},
      {TextureType::tensor_2d, R"("type": "2-d", )" + depth + ", " + along + ", " + around}};
  for (const auto& [type, keys] : cases) {
    const Recipe recipe = parse_recipe(with_solid("{" + keys + ", " + exemplar + "}"), "a.json");
    const std::string text = recipe_text(recipe);
    const Recipe again = parse_recipe(text, "a.json");
    EXPECT_EQ(recipe_text(again), text);
    const Solid &a = recipe.solids[0], &b = again.solids[0];
    EXPECT_EQ(a.fill.type, type);
    EXPECT_EQ(b.fill.type, type);
    EXPECT_EQ(b.scale, a.scale);
    EXPECT_EQ(b.depth.size(), a.depth.size());
    EXPECT_EQ(b.along.size(), type >= TextureType::tensor_2c ? 2u : 0u);
    EXPECT_EQ(b.around.size(), type == TextureType::tensor_2d ? 2u : 0u);
    EXPECT_EQ(b.orientation.size(), a.orientation.size());
    EXPECT_EQ(b.frame.unsigned_axis, type == TextureType::axis_1a);
    EXPECT_EQ(b.fill.scale_tolerance, type == TextureType::tensor_2a ? 3 : 1.5);
    ASSERT_EQ(b.local_scale.size(), a.local_scale.size());
    for (std::size_t i = 0; i < a.local_scale.size(); ++i) {
      EXPECT_EQ(b.local_scale[i].stroke, a.local_scale[i].stroke);
      EXPECT_EQ(b.local_scale[i].factor, a.local_scale[i].factor);
    }
  }
  EXPECT_EQ(parse_recipe(with_solid("{" + cases[0].second + ", " + exemplar + "}"), "a").solids[0].scale, 4.5);
}

TEST(Recipe, KeysThatATypeHasNoUseForAreRefused) {
  const auto refused = [&](const std::string& keys, const std::string& message) {
    const std::string text = message_of(with_solid("{" + keys + ", " + exemplar + "}"));
    EXPECT_EQ(text.substr(0, message.size()), message) << text;
  };
  const std::string fields =
      std::string(R"("depth": )") + two_depths + R"(, "along": )" + two_depths + R"(, "around": )" + two_depths;
  refused(R"("type": "0")", "kiwi.json: /solids/0: lacks \"scale\"");
  refused(R"("type": "0", "scale": 0)", "kiwi.json: /solids/0/scale: is 0, must be positive");
  refused(R"("type": "0", "scale": 1, "frame": {})", "kiwi.json: /solids/0/frame: is not for type 0");
  refused(R"("type": "2-d", "mask": {}, )" + fields, "kiwi.json: /solids/0/mask: is not for type 2-d");
  refused(R"("type": "2-d", "local_scale": [], )" + fields, "kiwi.json: /solids/0/local_scale: is not for type 2-d");
  refused(R"("type": "1-b", "frame": {"axis": "unsigned"}, "depth": )" + std::string(two_depths),
          "kiwi.json: /solids/0/frame/axis: is unsigned in a type without strokes");
  refused(R"("type": "2-c", "along": [{"skin": true, "value": 1}, {"stroke": [[0, 0, 0]], "value": 1}], "depth": )" +
              std::string(two_depths),
          "kiwi.json: /solids/0/along: gives every place the same value");
}

TEST(Recipe, FillsUpToCreasesAreReadAndWritten) {
  const std::string text = kiwi("{\"skin\": true, \"value\": 0}", "{\"fill\": [1, 2, 3], \"crease\": 0.25, \"value\": 0}, "
                                                                "{\"fill\": 12, \"value\": 0.5}");
  const std::string more = [&] {
    std::string t = text;
    const std::string key = "\"overshoot\":";
    return t.replace(t.find(key), key.size(),
                     "\"extrema\": \"keep\", \"persistence\": 0.05, \"max_centers\": 300, " + key);
  }();
  const Recipe recipe = parse_recipe(more, "kiwi.json");
  const Recipe again = parse_recipe(recipe_text(recipe), "kiwi.json");
  for (const Recipe* one : {&recipe, &again}) {
    const Solid& solid = one->solids[0];
    ASSERT_EQ(solid.depth.size(), 3u);
    ASSERT_TRUE(solid.depth[0].fill && solid.depth[1].fill);
    EXPECT_EQ(solid.depth[0].fill->near, Vec3d(1, 2, 3));
    EXPECT_EQ(solid.depth[0].fill->crease, 0.25);
    EXPECT_FALSE(solid.depth[0].fill->triangle.exists());
    EXPECT_EQ(solid.depth[1].fill->triangle, TriangleId(12));
    EXPECT_EQ(solid.depth[1].fill->crease, FaceFill().crease);
    EXPECT_FALSE(solid.depth_options.remove_extrema);
    EXPECT_TRUE(solid.depth_options.guard_overshoot);
    EXPECT_EQ(solid.depth_options.persistence, 0.05);
    EXPECT_EQ(solid.depth_options.max_centers, 300);
  }
}

TEST(Recipe, BareStrokesAndCutsAreRead) {
  const CutStep bare = parse_cut(R"({"points": [[0, 0], [1, 1]], "view": {"eye": [0, 0, 50]}})", "s.json");
  EXPECT_EQ(std::get<StrokeCut>(bare.shape).point.size(), 2u);
  const CutStep full = parse_cut(R"({"sphere": {"center": [0, 0, 0], "radius": 2}, "keep": "right"})", "s.json");
  EXPECT_EQ(full.keep, Keep::right);
  EXPECT_THROW(parse_cut(R"({"points": [[0, 0], [1, 1]]})", "s.json"), InvalidInput);
}

} // namespace
} // namespace pith
