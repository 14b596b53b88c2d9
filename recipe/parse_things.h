#pragma once
// The parts of a recipe's solids that are exemplars and the things made of them: pasted one by one, or scattered.
// Only this module's parsers include it.
#include "recipe/json_node.h"
#include "recipe/recipe.h"

namespace pith {

ExemplarSource exemplar_from(const JsonNode& node);
void read_mask(const JsonNode& node, SplotchOptions& mask);

/// Reads a solid's "scatter" and "pastes", where it has them.
void read_things(const JsonNode& solid, Solid& result);

} // namespace pith
