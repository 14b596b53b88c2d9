#pragma once
// The window: GLFW's events in, frames out.
#include "viewer/document.h"

#include <array>

namespace pith {

struct WindowOptions {
  std::filesystem::path open;   ///< may be empty
  std::filesystem::path record; ///< writes the session here at the end and after every gesture; may be empty
  std::array<int, 2> size{1200, 800};
  DocumentOptions document;
};

/// Runs until it is closed. Errors: SolverFailure where there is no display or no OpenGL 3.3.
void run_window(const WindowOptions& options);

} // namespace pith
