#pragma once
// A workbench drawn with GL: hands over what has changed, and draws.
#include "viewer/drawing.h"
#include "viewer/panels.h"
#include "viewer/workbench.h"

namespace pith {

class Screen {
public:
  explicit Screen(Workbench& bench) : bench_(bench) {}

  /// Into the current framebuffer.
  void draw(int width, int height);
  /// A picture, as Drawing::picture: of the model alone, transparent where nothing is; or with panels, as in the
  /// window.
  Image picture(int width, int height, Panels* panels = nullptr);
  std::string driver() const { return drawing_.driver(); }

  /// Hands over what has changed; draw() and picture() do it by themselves.
  DrawOptions follow(int width, int height);

private:
  Workbench& bench_;
  Drawing drawing_;
  std::uint64_t material_ = 0, surface_ = 0;
};

/// Writes Drawing::picture's values as they are. Errors: as write_image.
void write_picture(const std::filesystem::path& path, const Image& image);

} // namespace pith
