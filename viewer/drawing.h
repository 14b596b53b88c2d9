#pragma once
// Draws a model's pieces with OpenGL 3.3 core. The only door to GL besides the window's and the panels'.
#include "viewer/drawn_surface.h"
#include "viewer/material_tables.h"
#include "volume/base/image.h"
#include "volume/base/view.h"

#include <functional>
#include <memory>
#include <string>

namespace pith {

struct DrawOptions {
  bool lit = true;          ///< false: the material's colours alone
  bool filtered = true;     ///< coarser texels where texels are smaller than a pixel
  bool occlusion = true;    ///< crevices are darker; only where lit
  bool transparent = false; ///< no background
  Vec3d uncovered{0.5, 0.5, 0.5};
};

/// Everything that GL holds for one window or picture. Make it, use it and let it go with the same context current.
/// Errors of all: SolverFailure where the driver refuses (too old, out of memory, a shader that does not compile),
/// with what it said.
class Drawing {
public:
  /// Needs a current context of OpenGL 3.3 or later.
  Drawing();
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  /// Who draws: "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
  std::string driver() const;

  /// Hands a model's tables over. InvalidInput when they are larger than this driver's buffer textures.
  void set_material(const MaterialTables& tables);
  /// Hands the triangles over.
  void set_surface(const DrawnSurface& surface);
  /// Moves pieces without handing them over again.
  void set_placement(std::uint32_t piece, const Rigid& placement);

  /// Draws into the current framebuffer's viewport of width × height pixels.
  void draw(const View& view, int width, int height, const DrawOptions& options = {});

  /// Draws into a picture of its own: 4 channels, sRGB-encoded values 0 … 1 (not linear), top row first.
  /// `over` draws on top before it is read back.
  Image picture(const View& view, int width, int height, const DrawOptions& options = {},
                const std::function<void()>& over = {});

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Distances from the eye along the direction of sight between which `bounds` (world) lie.
struct DepthRange {
  double near = 0, far = 1;
};
DepthRange depth_range(const View& view, const Box& bounds);

/// From world to clip space.
Eigen::Matrix4d clip_matrix(const View& view, double aspect, const DepthRange& range);

} // namespace pith
