#pragma once
// The tools, by family; tools.cpp lists them.
#include "viewer/workbench.h"

namespace pith {

std::vector<ToolEntry> cut_tools();
std::vector<ToolEntry> piece_tools();
std::vector<ToolEntry> solid_tools();

} // namespace pith
