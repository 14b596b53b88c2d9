#include "viewer/offscreen.h"

#include "volume/base/error.h"

#include <epoxy/egl.h>
#include <fmt/format.h>

namespace pith {

struct OffscreenContext::Parts {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

namespace {

[[noreturn]] void refuse(const char* what) {
  throw SolverFailure(fmt::format("cannot draw without a display: {} (EGL error {:#06x}); install a driver "
                                  "(Debian: libegl1, libgl1-mesa-dri)",
                                  what, static_cast<unsigned>(eglGetError())));
}

} // namespace

OffscreenContext::OffscreenContext() : parts_(std::make_unique<Parts>()) {
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
      EGLDeviceEXT device[16];
      EGLint count = 0;
      if (eglQueryDevicesEXT(16, device, &count))
        for (EGLint i = 0; i < count && parts_->display == EGL_NO_DISPLAY; ++i) {
          const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device[i], nullptr);
          if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) parts_->display = display;
        }
    }
    if (parts_->display == EGL_NO_DISPLAY) {
      const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
      if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) parts_->display = display;
    }
  }
  if (parts_->display == EGL_NO_DISPLAY) refuse("there is no display to open");
  if (!eglBindAPI(EGL_OPENGL_API)) refuse("there is no OpenGL");
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!eglChooseConfig(parts_->display, wanted, &config, 1, &configs) || configs == 0) config = nullptr;
  const EGLint version[] = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  parts_->context = eglCreateContext(parts_->display, config, EGL_NO_CONTEXT, version);
  if (parts_->context == EGL_NO_CONTEXT) refuse("there is no OpenGL 3.3");
  if (!eglMakeCurrent(parts_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, parts_->context))
    refuse("the context cannot be used without a surface");
}

OffscreenContext::~OffscreenContext() {
  eglMakeCurrent(parts_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(parts_->display, parts_->context);
  // The display stays: terminating it would take it from other contexts of this process.
}

} // namespace pith
