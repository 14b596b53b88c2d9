#pragma once
// Pictures from and to files: PNG, JPEG, EXR, Radiance HDR, TIFF. The library behind it is large, so it sits in a
// module of its own (pith-images.so, beside the program) that is opened when the first image is read or written.
#include "volume/base/image.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace pith {

/// Linear float pixels with 1 to 4 channels (more are dropped). Integer formats are decoded from sRGB (not the
/// alpha); EXR, HDR and float TIFF hold linear light already. Alpha is unassociated in PNG and TIFF, as stored
/// elsewhere. Errors: IoFailure when the file or the module cannot be opened; InvalidInput when it is not an image,
/// or damaged.
Image read_image(const std::filesystem::path& path);

struct ReadImageOptions {
  bool linear = false; ///< take integers as they are (byte / 255), no sRGB decoding: masks, heights, normals
};
Image read_image(const std::filesystem::path& path, const ReadImageOptions& options);

/// All pages of a TIFF, as far as they are as large as the first (a volume, slice by slice: so scanners write them; a
/// small preview behind a picture is no page of it); of other formats the one picture. Errors as read_image.
std::vector<Image> read_pages(const std::filesystem::path& path, const ReadImageOptions& options = {});

/// Further channels of an EXR, named LAYER.R, LAYER.G, LAYER.B or, for a single channel, LAYER.
struct ImageLayer {
  std::string name; ///< "depth", "normal", "albedo" ...
  Image image;      ///< of the same size as the main image
};

struct WriteImageOptions {
  int bits = 8;             ///< of PNG: 8 or 16
  bool linear = false;      ///< PNG, JPEG: write values as they are, without the sRGB curve
  bool half = false;        ///< EXR: 16-bit floats
  double pixels_per_mm = 0; ///< PNG, TIFF: stored as resolution when positive
};

/// Writes by extension: .png and .jpg are encoded to sRGB and clamped to [0, 1]; .exr, .hdr and .tif hold linear
/// floats. 1, 2 (grey, alpha), 3 or 4 channels. The file appears whole or not at all; the same pixels give the same
/// bytes (no time stamps). Errors: InvalidInput for an extension it does not know, layers in a format other than EXR,
/// or a size that does not match; IoFailure when it cannot be written or the module is missing.
void write_image(const std::filesystem::path& path, const Image& image, const WriteImageOptions& options = {},
                 std::span<const ImageLayer> layers = {});

/// True for the extensions that write_image and read_image know.
bool is_image_path(const std::filesystem::path& path);

} // namespace pith
