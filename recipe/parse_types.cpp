// Recipe: keys by type of solid texture. docs/recipe.md has the same as a table.
#include "recipe/parse_types.h"

namespace pith {
namespace {

/// One key, whether a type takes it, and what it says there.
struct TypeKey {
  const char* key;
  bool (*taken)(const TextureTraits&);
  bool required;
  const char* purpose; ///< "lacks "depth", along which S runs"
  const char* mend;    ///< where it lacks
  const char* others;  ///< types that take it
};

bool lapped(const TextureTraits& t) { return !(t.imposed[0] && t.imposed[1] && t.imposed[2]); }

constexpr TypeKey keys[] = {
    {"depth", [](const TextureTraits& t) { return t.uses_depth; }, true, "along which the texture's S axis runs",
     "give two places and their depths, the skin at 0 and the core at 1, say", "1-b, 2-a, 2-b, 2-c and 2-d"},
    {"along", [](const TextureTraits& t) { return t.imposed[2]; }, true,
     "from which the texture's T coordinate comes",
     "give two places and their values, one end at 0 and the other at 1, say", "2-c and 2-d"},
    {"around", [](const TextureTraits& t) { return t.imposed[0]; }, true,
     "from which the texture's R coordinate comes", "give two places and their values from 0 to 1", "2-d"},
    {"orientation", [](const TextureTraits& t) { return t.uses_stroke; }, true,
     "along which the texture's T axis runs", "draw a stroke or more", "1-a, 2-a and 2-b"},
    {"scale", [](const TextureTraits& t) { return t.uses_scale; }, true, "the size of the texture",
     "give millimetres per texture width",
     "0, 1-a and 2-a (in the others the texture spans the depth: use "
     "\"local_scale\")"},
    {"local_scale", lapped, false, "", "", "all but 2-d, whose three fields leave nothing to scale"},
    {"depth_options", [](const TextureTraits& t) { return t.uses_depth; }, false, "", "", "those with \"depth\""},
    {"frame", [](const TextureTraits& t) { return t.fixed_axes > 0; }, false, "", "",
     "all but 0, which has no direction"},
    {"mask", lapped, false, "", "", "all but 2-d, which is a single piece"},
    {"fill", lapped, false, "", "", "all but 2-d, which is a single piece"},
};

} // namespace

void check_keys_of_type(const JsonNode& solid, TextureType type) {
  const TextureTraits& traits = traits_of(type);
  const std::string name = traits.name;
  for (const TypeKey& one : keys) {
    if (one.taken(traits)) {
      if (one.required && !solid.has(one.key))
        solid.fail("lacks \"" + std::string(one.key) + "\", " + one.purpose + " in type " + name, one.mend);
    } else if (solid.has(one.key)) {
      solid.at(one.key).fail("is not for type " + name,
                             "remove it, or choose another type; it is for " + std::string(one.others));
    }
  }
}

std::vector<ScaleConstraint> local_scale_from(const JsonNode& node) {
  std::vector<ScaleConstraint> result;
  for (const JsonNode& entry : node.items(1, "give { \"point\" or \"stroke\", \"factor\" }")) {
    entry.object({"point", "stroke", "factor"});
    if (entry.has("point") == entry.has("stroke"))
      entry.fail(entry.has("point") ? "names more than one place" : "names no place",
                 "give exactly one of \"point\" and \"stroke\"");
    ScaleConstraint one;
    if (const auto point = entry.find("point")) one.stroke = {point->vector3()};
    if (const auto stroke = entry.find("stroke")) one.stroke = stroke->points(2, "give points [x, y, z] in mm");
    one.factor = entry.at("factor").number(
        {0.01, 100, false, "0.01 to 100", "2 doubles the size of the texture there, 1 leaves it"});
    result.push_back(std::move(one));
  }
  return result;
}

} // namespace pith
