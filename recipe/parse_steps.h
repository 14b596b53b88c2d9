#pragma once
// The parts of a recipe that are steps on a finished solid: cuts, moves, views. Only this module's parsers include
// it.
#include "recipe/json_node.h"
#include "recipe/recipe.h"

namespace pith {

SurfaceSource surface_from(const JsonNode& node);
DivideStep divide_from(const JsonNode& node);
CutStep cut_from(const JsonNode& node);
StrokeCut stroke_from(const JsonNode& node);
MoveStep move_from(const JsonNode& node);
View view_from(const JsonNode& node);
/// { "axis": [x, y, z], "angle": radians }
void read_turn(const JsonNode& node, Vec3d& axis, double& angle);

} // namespace pith
