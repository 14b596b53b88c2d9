#pragma once
// Pictures of a solid: the colours on any plane of a model (through material_at), or of an exemplar volume, with what
// measures need to know of every pixel.
#include "volume/base/image.h"
#include "volume/base/parallel.h"
#include "volume/layer/model.h"
#include "volume/layer/sample.h"

namespace pith {

/// Where the pixels of a slice lie: pixel (x, y) at first + x · right + y · down. Millimetres of rest space for a
/// model, texture widths for an exemplar.
struct SliceGrid {
  Vec3d first = Vec3d::Zero();
  Vec3d right = Vec3d::UnitX(), down = Vec3d::UnitY();
  int width = 0, height = 0;

  Vec3d at(int x, int y) const { return first + x * right + y * down; }
};

/// A square grid around a centre: `right` and `down` give the directions and the step.
SliceGrid centered_grid(const Vec3d& center, const Vec3d& right, const Vec3d& down, int width, int height);

/// A grid that frames what a plane n·x = d can show of a box, with pixels of `pitch`: width and height follow from
/// the box; the picture's axes are the two coordinate axes nearest to the plane, projected onto it, where the plane
/// is axis-parallel. Errors: InvalidInput for a zero normal, a pitch that is not positive, or more than 100 million
/// pixels.
SliceGrid framed_grid(const Box& box, const Vec3d& normal, double offset, double pitch);

/// Which patch a pixel shows.
struct PixelSource {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t layer = none;        ///< the uppermost solid layer that covers at least half there
  std::uint32_t patch = none;        ///< its patch with the largest share
  float share = 0;                   ///< of that patch: 1 where nothing else mixes in
  float over = 0;                    ///< coverage of the layers above that one, where they show a little
  std::array<float, 3> coordinate{}; ///< where in the exemplar it reads, not yet wrapped
  TetId tet;                         ///< the pixel's owner; none outside
};

struct Slice {
  Image color;                      ///< 3 channels, linear; 0 outside
  std::vector<std::uint8_t> inside; ///< per pixel: 1 in the solid (an exemplar: within [0, 1] along axes that end)
  std::vector<float> depth;         ///< per pixel, 0 … 1; 0 outside and where there is no depth
  std::vector<PixelSource> source;  ///< per pixel; empty unless asked for

  int width() const { return color.width; }
  int height() const { return color.height; }
  std::size_t index(int x, int y) const { return std::size_t(y) * color.width + x; }
};

struct SliceOptions {
  std::int32_t region = -1; ///< only what lies in it counts as inside; −1: all
  double footprint = 0;     ///< mm (material_at)
  bool sources = false;     ///< fill Slice::source
};

/// In parallel over rows. 0.3–1 µs per pixel inside. The depth is model.field.depth, linear in each tet. Errors:
/// InvalidInput when the model has no colour.
Slice model_slice(const Root& root, const SliceGrid& grid, const SliceOptions& options = {});

/// Many small slices, in parallel over slices: the same as model_slice for each.
std::vector<Slice> model_slices(const Root& root, const std::vector<SliceGrid>& grids,
                                const SliceOptions& options = {}, const Progress& progress = {});

/// Reads slices of an exemplar volume; wraps as the exemplar does. Refers to the exemplar.
class ExemplarSlicer {
public:
  /// Errors: InvalidInput when it is no volume or has no colour.
  explicit ExemplarSlicer(const Exemplar& exemplar);

  /// The linear colour at exemplar coordinates.
  Vec3f color(const Vec3d& u) const;
  /// `depth_axis`: whose coordinate becomes the depth; −1: none.
  Slice slice(const SliceGrid& grid, int depth_axis = -1) const;

private:
  const Exemplar& exemplar_;
  TexelGrid grid_;
  int color_ = 0;
};

} // namespace pith
