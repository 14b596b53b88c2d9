#pragma once
// What pith-images.so offers: plain C, so that nothing of the image library shows. Used by image_io.cpp alone.
#include <cstddef>

namespace pith::image_module {

/// Results of both functions; `message` then holds one line.
enum Result { done = 0, not_opened = 1, not_an_image = 2 };

struct Read {
  const char* path;
  int all; ///< 1: of a TIFF, all pages that are as large as the first; `pixel` holds one after the other
  int width, height, channels, pages; ///< filled
  int integer;  ///< filled: 1 where the file holds integers, which `pixel` gives as fractions of the largest
  float* pixel; ///< filled; freed with `release`
  char message[512];
};

struct Encode {
  const char* format; ///< "png", "jpg", "exr", "hdr", "tif"
  int width, height, channels;
  const char* const* channel_name;
  enum { byte = 0, word = 1, real = 2, half = 3 } stored; ///< byte and word: `pixel` holds these; else float
  const void* pixel;
  int srgb;                 ///< 1: marked as sRGB
  int alpha;                ///< index of the alpha channel, −1: none
  double pixels_per_mm;     ///< 0: not stored
  unsigned char* bytes;     ///< filled: the whole file; freed with `release`
  unsigned long long count; ///< filled: of bytes
  char message[512];
};

using ReadFunction = Result(Read*);
using EncodeFunction = Result(Encode*);
using ReleaseFunction = void(void*);

} // namespace pith::image_module
