#pragma once
// What the kinds of `pith check` share.
#include "cli/command.h"
#include "volume/base/types.h"

namespace pith::cli {

struct Finding {
  std::string what;
  std::size_t count = 0;
  std::string mend;
};
Json json_from(const std::vector<Finding>& findings);
void say(const std::vector<Finding>& findings, const Session& session);

/// "60 × 60 × 72 mm"
std::string text_of_extent(const Box& box);

/// A question for surfaces that are smaller than a millimetre or larger than five metres; empty for others.
std::string unit_hint(const Box& box);

/// All that can be said about a recipe without meshing: are its files there and usable, do strokes lie near the
/// surface, do triangles and regions exist, do cuts pass through it. Errors: as read_recipe's; InvalidInput when
/// there are findings, after they have been said.
void check_recipe(const std::filesystem::path& path, const Session& session);

} // namespace pith::cli
