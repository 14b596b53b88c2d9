#pragma once
// Inside volume/io: what the writers of coloured surfaces share.
#include "volume/io/surface_export.h"

#include <string>

namespace pith {

/// The vertices of a piece merged where point and 8-bit colour agree: what a format without separate normals needs to
/// be watertight by index.
struct WeldedSurface {
  struct Vertex {
    std::uint32_t point;
    std::array<std::uint8_t, 3> color; ///< sRGB
    Vec3f normal;                      ///< mean of those merged, unit
  };
  std::vector<Vertex> vertex;
  std::vector<std::uint32_t> of; ///< for each vertex of the surface, the merged one
};
WeldedSurface welded(const ColoredSurface& surface);

/// 8-bit sRGB of a linear component; clamped.
std::uint8_t srgb_byte(float linear);

/// Bytes of numbers, little-endian, appended.
template <class T>
void append(std::string& bytes, const T& number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(T));
}

/// The number as text with as few digits as give it back, alike in every locale.
void append_text(std::string& text, float number);

/// One past the last part of the piece that part `first` belongs to.
std::size_t piece_end(const ColoredSurface& surface, std::size_t first);

} // namespace pith
