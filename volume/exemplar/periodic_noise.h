#pragma once
// Smooth random fields over the unit cube that repeat along x and z and are clamped along y.
#include <cstdint>
#include <vector>

namespace pith {

/// Value noise: independent uniform numbers in [−1, 1] at the corners of a lattice, joined by cubic fades (Perlin
/// 1985 describes the lattice; Lewis 1989 the value form). `cells_x` and `cells_z` cells cover one period; `cells_y`
/// cells cover y ∈ [0, 1]. Every number is a pure function of (key, corner).
class PeriodicNoise {
public:
  PeriodicNoise(std::uint64_t key, int cells_x, int cells_y, int cells_z);

  /// The field along one line of constant y and z. Building it costs O(cells_x); a read costs two loads.
  class Row {
  public:
    /// The value at x; periodic, any finite x.
    float at(float x) const {
      const float scaled = x * float(cells_);
      const int below = int(scaled) - (scaled < float(int(scaled)) ? 1 : 0);
      const float t = scaled - float(below);
      int i = below % cells_;
      if (i < 0) i += cells_;
      const float fade = t * t * (3.0f - 2.0f * t);
      return value_[i] + (value_[i + 1] - value_[i]) * fade;
    }
    /// The value at lattice corner i, 0 ≤ i < cells_x: what belongs to one cell as a whole.
    float corner(int i) const { return value_[i]; }

  private:
    friend class PeriodicNoise;
    int cells_ = 1;
    std::vector<float> value_; ///< cells + 1: the last repeats the first
  };

  /// Sets `row` to the line at (y, z); reuses its storage.
  void read(float y, float z, Row& row) const;

  /// One value; for few reads.
  float value(float x, float y, float z) const;

private:
  int cells_x_, cells_y_, cells_z_;
  std::vector<float> corner_; ///< x fastest, then y (cells_y + 1 rows), then z
};

} // namespace pith
