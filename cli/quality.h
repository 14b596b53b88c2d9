#pragma once
// The measures of a model's fill, for `pith info --quality`.
#include "cli/command.h"
#include "volume/io/model_io.h"

namespace pith::cli {

/// Says each figure as soon as it is known (those that take least first) and returns them all for --json: a list of
/// {"measure", "layer", "value", "unit", "bar", "holds"}, bar and holds only where there is one.
Json quality_of(ModelFile file, const Session& session);

} // namespace pith::cli
