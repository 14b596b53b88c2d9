// Recipe: things on solids, pasted one by one or scattered. docs/recipe.md is the manual of the format.
#include "recipe/parse_things.h"
#include "recipe/parse_steps.h"

namespace pith {

namespace {

constexpr double pi = 3.14159265358979323846;

ThingSource thing_from(const JsonNode& node) {
  ThingSource result;
  result.exemplar = exemplar_from(node.at("exemplar"));
  if (const auto mask = node.find("mask")) read_mask(*mask, result.mask.emplace());
  return result;
}

/// The keys that pastes and scatter share.
template <class Options>
void read_common(const JsonNode& node, Turn& turn, Options& options) {
  options.size = node.at("size").number(range::positive_mm);
  if (const auto axes = node.find("axes")) options.in_frame = axes->choice({"frame", "rest"}) == 0;
  if (const auto follow = node.find("follow"))
    options.follow = static_cast<Follow>(follow->choice({"rigid", "warped"}));
  if (const auto clip = node.find("clip")) options.clip = clip->boolean();
  if (const auto rotate = node.find("rotate")) {
    rotate->object({"axis", "angle"});
    read_turn(*rotate, turn.axis, turn.angle);
  }
}

PasteStep paste_from(const JsonNode& node) {
  node.object({"exemplar", "mask", "place", "size", "axes", "rotate", "follow", "clip"});
  PasteStep result;
  result.thing = thing_from(node);
  result.options.place = node.at("place").vector3();
  read_common(node, result.turn, result.options);
  return result;
}

/// [low, high], in order.
std::array<double, 2> band_from(const JsonNode& node, const NumberRange& range) {
  const Vec2d band = node.vector2();
  if (!(band[0] <= band[1])) node.fail("is empty", "give [low, high]");
  if (band[0] < range.low || band[1] > range.high) node.fail(std::string("must be ") + range.words, range.mend);
  return {band[0], band[1]};
}

ScatterStep scatter_from(const JsonNode& node) {
  node.object({"exemplar", "mask", "count", "spacing", "gap", "size", "size_variation", "depth", "axis", "along",
               "groups", "group_width", "axes", "rotate", "jitter", "spin", "follow", "clip", "seed"});
  ScatterStep result;
  ScatterOptions& o = result.options;
  result.thing = thing_from(node);
  if (!node.has("count") && !node.has("spacing"))
    node.fail("says neither how many nor how far apart", "give \"count\", or \"spacing\" in mm");
  node.optional_whole("count", o.count, 1, 10'000'000, "give a number of things");
  node.optional_number("spacing", o.spacing, range::positive_mm);
  node.optional_number("gap", o.gap, range::mm);
  read_common(node, result.turn, o);
  node.optional_number("size_variation", o.size_variation, {0, 0.9, false, "0 to 0.9", "give a part of the size"});
  if (const auto depth = node.find("depth"))
    o.depth = band_from(*depth, {0, 1, false, "0 to 1", "0 is the outermost depth, 1 the innermost"});
  if (const auto axis = node.find("axis")) {
    const std::vector<Vec3d> points = axis->points(2, "give two points [x, y, z] in mm");
    if (points.size() != 2 || points[0] == points[1])
      axis->fail("is no line between two points", "give two different points [x, y, z] in mm");
    o.axis = {points[0], points[1]};
  }
  for (const char* key : {"along", "groups"})
    if (node.has(key) && !node.has("axis"))
      node.at(key).fail("is given without \"axis\"", "say around which line: \"axis\": [[x, y, z], [x, y, z]]");
  if (const auto along = node.find("along")) o.along = band_from(*along, range::any);
  node.optional_whole("groups", o.groups, 0, 100'000, "give a number of sectors around the axis");
  node.optional_number("group_width", o.group_width, {0, 1, true, "above 0, to 1", "give the part of a sector"});
  node.optional_number("jitter", o.jitter, {0, pi, false, "0 to pi", "give radians"});
  node.optional_number("spin", o.spin, {0, pi, false, "0 to pi", "give radians"});
  node.optional_seed("seed", o.seed);
  return result;
}

} // namespace

void read_things(const JsonNode& solid, Solid& result) {
  if (const auto scatter = solid.find("scatter"))
    for (const JsonNode& entry : scatter->items(0, "")) result.scatter.push_back(scatter_from(entry));
  if (const auto pastes = solid.find("pastes"))
    for (const JsonNode& entry : pastes->items(0, "")) result.pastes.push_back(paste_from(entry));
}

} // namespace pith
