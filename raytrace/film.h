#pragma once
// What a render accumulates: sums per pixel, so that films of different sample ranges can be added.
#include "volume/base/image.h"
#include "volume/base/types.h"

#include <string>

namespace pith {

/// Sums over the samples of one pixel. Divide by `samples`; surface sums by `hits`.
struct FilmPixel {
  std::array<double, 3> color{};    ///< radiance, background included where the film is not transparent
  std::array<double, 3> square{};   ///< Σ radiance²
  double alpha = 0;                 ///< samples that saw a piece or opaque ground or backdrop
  std::array<float, 3> albedo{};    ///< of the first hit; the background's colour elsewhere
  std::array<float, 3> normal{};    ///< of pieces and ground, world
  std::array<double, 3> position{}; ///< of pieces and ground, world, mm
  double depth = 0;                 ///< distance from the eye, mm
  std::uint32_t samples = 0, hits = 0;
  std::uint32_t piece = none; ///< of the first sample that met a piece
  static constexpr std::uint32_t none = 0xffffffffu;
};

struct Film {
  int width = 0, height = 0;
  std::vector<FilmPixel> pixel; ///< row-major, top row first

  Film() = default;
  Film(int width, int height) : width(width), height(height), pixel(std::size_t(width) * height) {}
  FilmPixel& at(int x, int y) { return pixel[std::size_t(y) * width + x]; }
  const FilmPixel& at(int x, int y) const { return pixel[std::size_t(y) * width + x]; }
};

/// Adds a film of later samples. Throws InvalidInput when the sizes differ. Merge in ascending sample order: sums are
/// rounded, and piece ids are the first one's.
void merge(Film& film, const Film& later);

/// Mean radiance: red, green, blue, alpha (colour premultiplied by alpha).
Image color_of(const Film& film);

/// One auxiliary picture with the names of its channels.
struct FilmLayer {
  std::string name;
  std::vector<std::string> channel;
  Image image;
};

/// All pictures of a film, for a file of many layers: color (R G B A), albedo (R G B), normal (X Y Z), position (X Y
/// Z), depth (Z), piece (id; −1 where none), variance (R G B, of the mean), samples (count).
std::vector<FilmLayer> layers_of(const Film& film);

} // namespace pith
