#pragma once
// Random fields and scattered points over the unit cube that repeat along chosen axes, read at single points.
#include "volume/base/random.h"

#include <array>
#include <cmath>
#include <vector>

namespace pith {

using Point3f = std::array<float, 3>;

/// Which axes repeat; along the others the field is clamped to the cube.
struct Tiling {
  bool x = true, y = true, z = true;
};
inline constexpr Tiling tile_all{true, true, true};
inline constexpr Tiling tile_around{true, false, true}; ///< free along depth: the exemplars of types 1-b and 2-b

/// Value noise as PeriodicNoise's, for any tiling: independent uniform numbers in [−1, 1] at the corners of a
/// lattice, joined by cubic fades. `cells` cells of the lattice cover the unit cube along each axis.
class TileNoise {
public:
  TileNoise(std::uint64_t key, std::array<int, 3> cells, Tiling tiling = tile_all);

  /// The field at a point of any finite coordinates, in [−1, 1]. Costs eight loads.
  float operator()(float x, float y, float z) const {
    const Along a = along(x, 0), b = along(y, 1), c = along(z, 2);
    const auto line = [&](int j, int k) {
      const float* row = corner_.data() + j + k;
      return row[a.low] + (row[a.high] - row[a.low]) * a.fade;
    };
    const float near = line(b.low, c.low), far = line(b.low, c.high);
    const float low = near + (line(b.high, c.low) - near) * b.fade,
                high = far + (line(b.high, c.high) - far) * b.fade;
    return low + (high - low) * c.fade;
  }

private:
  struct Along {
    int low, high;
    float fade;
  };
  Along along(float p, int axis) const {
    const int n = cells_[axis];
    float scaled = p * float(n) + shift_[axis];
    if (!repeat_[axis]) scaled = std::fmin(std::fmax(scaled, 0.0f), float(n));
    const float floor = std::floor(scaled);
    const float t = scaled - floor;
    int i = int(floor);
    if (repeat_[axis]) {
      i %= n;
      if (i < 0) i += n;
    }
    const int last = count_[axis] - 1;
    const int j = i < last ? i + 1 : (repeat_[axis] ? 0 : last);
    return {i * stride_[axis], j * stride_[axis], t * t * (3.0f - 2.0f * t)};
  }

  std::array<int, 3> cells_, count_, stride_;
  std::array<bool, 3> repeat_;
  Point3f
      shift_{}; ///< of the lattice along axes that repeat, cells: fades are flat at corners, which shall not line up
  std::vector<float> corner_; ///< x fastest
};

/// A sum of noises, each of twice the cells and half the strength of the one before, scaled to stay in [−1, 1].
class FractalNoise {
public:
  FractalNoise(std::uint64_t key, std::array<int, 3> cells, int octaves, Tiling tiling = tile_all);
  float operator()(float x, float y, float z) const {
    float sum = 0, strength = 0.5f;
    for (const TileNoise& octave : octave_) {
      sum += strength * octave(x, y, z);
      strength *= 0.5f;
    }
    return sum * scale_;
  }

private:
  std::vector<TileNoise> octave_;
  float scale_;
};

/// One point in each cell of a lattice, displaced at random: what grains, pores and pebbles sit at. `jitter` is the
/// greatest displacement, in cells.
class ScatteredPoints {
public:
  ScatteredPoints(std::uint64_t key, std::array<int, 3> cells, float jitter, Tiling tiling = tile_all);

  /// Calls body(offset, hash) for the points of the 27 cells around p: offset = p − point in texture widths; the hash
  /// is the point's own. Cells beyond the cube along an axis that does not repeat have no point.
  template <class Body>
  void near(float x, float y, float z, const Body& body) const {
    const Point3f p{x, y, z};
    std::array<int, 3> home;
    for (int a = 0; a < 3; ++a) home[a] = int(std::floor(p[a] * float(cells_[a])));
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) visit(p, {home[0] + i, home[1] + j, home[2] + k}, body);
  }

  struct Nearest {
    float first = 1e9f, second = 1e9f; ///< distances to the nearest and the next point, in cells of the x axis
    Point3f offset{};                  ///< from the nearest, texture widths
    std::uint64_t hash = 0;            ///< of the nearest
  };
  /// The two nearest points, measured in cells along each axis (Worley 1996): what cells and grains are made of.
  Nearest nearest(float x, float y, float z) const;

private:
  template <class Body>
  void visit(const Point3f& p, const std::array<int, 3>& cell, const Body& body) const {
    std::array<int, 3> wrapped = cell;
    for (int a = 0; a < 3; ++a) {
      if (cell[a] >= 0 && cell[a] < cells_[a]) continue;
      if (!repeat_[a]) return;
      wrapped[a] = ((cell[a] % cells_[a]) + cells_[a]) % cells_[a];
    }
    const Own& own = own_[(std::size_t(wrapped[2]) * cells_[1] + wrapped[1]) * cells_[0] + wrapped[0]];
    Point3f offset;
    for (int a = 0; a < 3; ++a) offset[a] = p[a] - (float(cell[a]) + own.place[a]) * size_[a];
    body(offset, own.hash);
  }

  struct Own {
    std::uint64_t hash;
    Point3f place; ///< in its cell, of the cell's size
  };
  std::array<int, 3> cells_;
  Point3f size_; ///< of a cell
  std::array<bool, 3> repeat_;
  std::vector<Own> own_; ///< x fastest
};

/// The i-th uniform number in [0, 1) of a hash.
inline float uniform_of(std::uint64_t hash, int i = 0) { return float(unit_double(hash_of(hash, i))); }

} // namespace pith
