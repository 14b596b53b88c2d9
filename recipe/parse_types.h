#pragma once
// What each type of solid texture takes of a solid's keys (private to this module).
#include "recipe/json_node.h"
#include "recipe/recipe.h"

namespace pith {

/// Refuses keys that the type has no use for, and the lack of those that it needs, telling what they are for.
void check_keys_of_type(const JsonNode& solid, TextureType type);

/// "local_scale"
std::vector<ScaleConstraint> local_scale_from(const JsonNode& node);

} // namespace pith
