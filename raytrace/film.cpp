#include "raytrace/film.h"

#include "volume/base/error.h"

#include <algorithm>

namespace pith {

void merge(Film& film, const Film& later) {
  if (film.width != later.width || film.height != later.height)
    throw InvalidInput("film",
                       "sizes differ: " + std::to_string(film.width) + " × " + std::to_string(film.height) + " and " +
                           std::to_string(later.width) + " × " + std::to_string(later.height),
                       "merge films of one picture");
  for (std::size_t i = 0; i < film.pixel.size(); ++i) {
    FilmPixel& a = film.pixel[i];
    const FilmPixel& b = later.pixel[i];
    for (int c = 0; c < 3; ++c) {
      a.color[c] += b.color[c];
      a.square[c] += b.square[c];
      a.albedo[c] += b.albedo[c];
      a.normal[c] += b.normal[c];
      a.position[c] += b.position[c];
    }
    a.alpha += b.alpha;
    a.depth += b.depth;
    a.samples += b.samples;
    a.hits += b.hits;
    if (a.piece == FilmPixel::none) a.piece = b.piece;
  }
}

namespace {
/// Fills one picture from the pixels; write(pixel, destination).
template <class Write>
Image picture(const Film& film, int channels, const Write& write) {
  Image image(film.width, film.height, channels);
  for (std::size_t i = 0; i < film.pixel.size(); ++i)
    if (film.pixel[i].samples > 0) write(film.pixel[i], image.pixel.data() + i * channels);
  return image;
}
} // namespace

Image color_of(const Film& film) {
  return picture(film, 4, [](const FilmPixel& p, float* to) {
    for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(p.color[c] / p.samples);
    to[3] = static_cast<float>(std::clamp(p.alpha / p.samples, 0.0, 1.0));
  });
}

std::vector<FilmLayer> layers_of(const Film& film) {
  std::vector<FilmLayer> layers;
  layers.push_back({"color", {"R", "G", "B", "A"}, color_of(film)});
  layers.push_back({"albedo", {"R", "G", "B"}, picture(film, 3, [](const FilmPixel& p, float* to) {
                      for (int c = 0; c < 3; ++c) to[c] = p.albedo[c] / p.samples;
                    })});
  layers.push_back({"normal", {"X", "Y", "Z"}, picture(film, 3, [](const FilmPixel& p, float* to) {
                      const Vec3f n(p.normal[0], p.normal[1], p.normal[2]);
                      const float length = n.norm();
                      for (int c = 0; c < 3; ++c) to[c] = length > 0 ? n[c] / length : 0.0f;
                    })});
  layers.push_back({"position", {"X", "Y", "Z"}, picture(film, 3, [](const FilmPixel& p, float* to) {
                      for (int c = 0; c < 3; ++c) to[c] = p.hits ? static_cast<float>(p.position[c] / p.hits) : 0.0f;
                    })});
  layers.push_back({"depth", {"Z"}, picture(film, 1, [](const FilmPixel& p, float* to) {
                      *to = p.hits ? static_cast<float>(p.depth / p.hits) : std::numeric_limits<float>::infinity();
                    })});
  layers.push_back({"piece", {"id"}, picture(film, 1, [](const FilmPixel& p, float* to) {
                      *to = p.piece == FilmPixel::none ? -1.0f : static_cast<float>(p.piece);
                    })});
  layers.push_back({"variance", {"R", "G", "B"}, picture(film, 3, [](const FilmPixel& p, float* to) {
                      for (int c = 0; c < 3; ++c) {
                        const double mean = p.color[c] / p.samples;
                        const double spread = std::max(0.0, p.square[c] / p.samples - mean * mean);
                        to[c] = p.samples > 1 ? static_cast<float>(spread / (p.samples - 1)) : 0.0f;
                      }
                    })});
  layers.push_back({"samples", {"count"}, picture(film, 1, [](const FilmPixel& p, float* to) {
                      *to = static_cast<float>(p.samples);
                    })});
  return layers;
}

} // namespace pith
