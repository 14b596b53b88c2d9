#pragma once
// Recorded sessions played without a display.
#include "viewer/screen.h"

namespace pith {

struct ReplayOptions {
  std::filesystem::path open;    ///< before the first event; may be empty
  std::filesystem::path picture; ///< of the end; may be empty
  bool panels = false;           ///< pictures with panels and background, as in the window
  std::array<int, 2> size{0, 0}; ///< of pictures; 0: the session's
  DocumentOptions document;
};

/// Plays a session without a display. `file` names it in messages; pictures that it writes count from `folder`.
/// Errors: InvalidInput, naming the event, when one fails; SolverFailure where nothing can draw; IoFailure where a
/// picture cannot be written. `done` is called at the end, while everything is still there.
void replay(const EventList& session, const std::string& file, const std::filesystem::path& folder,
            const ReplayOptions& options, const std::function<void(Workbench&, Screen&)>& done = {});

} // namespace pith
