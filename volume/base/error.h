#pragma once
// The errors that pith's libraries throw. Nothing else leaves a public function: libraries never print, exit, or return
// codes. A message is one line and says what is wrong (with figures), where, and how to mend it.
#include <stdexcept>
#include <string>

namespace pith {

/// What was handed in cannot be used: a file, a field of a recipe, an option.
struct InvalidInput : std::runtime_error {
  /// `where` names the file or field; `what` says what is wrong with it; `mend` says what to do.
  InvalidInput(const std::string& where, const std::string& what, const std::string& mend)
      : std::runtime_error(where + ": " + what + "; " + mend) {}
};

/// A numerical method did not reach its goal.
struct SolverFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
  /// `residual`: what was left of the error.
  SolverFailure(const std::string& what, double residual)
      : std::runtime_error(what + " (residual " + std::to_string(residual) + ")") {}
};

/// A file could not be read or written.
struct IoFailure : std::runtime_error {
  IoFailure(const std::string& path, const std::string& what) : std::runtime_error(path + ": " + what) {}
};

/// The caller asked for work to stop (Progress).
struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled") {}
};

} // namespace pith
