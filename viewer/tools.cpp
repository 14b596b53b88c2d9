#include "viewer/tools.h"

namespace pith {

const std::vector<ToolEntry>& tool_table() {
  static const std::vector<ToolEntry> table = [] {
    std::vector<ToolEntry> all = {{"navigate", "Look", "1", "drag turns, shift-drag pans, the wheel zooms",
                                   [] { return std::make_unique<Tool>(); }}};
    for (auto family : {cut_tools, piece_tools, solid_tools})
      for (ToolEntry& entry : family()) all.push_back(std::move(entry));
    return all;
  }();
  return table;
}

} // namespace pith
