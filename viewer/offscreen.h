#pragma once
// An OpenGL context without a window or display: EGL, surfaceless.
#include <memory>

namespace pith {

class OffscreenContext {
public:
  /// Current on the calling thread for as long as it lives. Errors: SolverFailure where EGL has no driver for it.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace pith
