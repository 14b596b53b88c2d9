#include "volume/io/image_io.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/io/atomic_file.h"
#include "volume/io/image_module/image_module.h"
#include "volume/io/module.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

namespace pith {

namespace {

constexpr const char* module_file = "pith-images.so";
constexpr const char* purpose = "reading and writing images";
constexpr std::size_t block = 16384; // pixels

/// "png", "jpg", "exr", "hdr", "tif", or empty.
std::string format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  if (extension == ".jpeg") return "jpg";
  if (extension == ".tiff") return "tif";
  for (const char* known : {".png", ".jpg", ".exr", ".hdr", ".tif"})
    if (extension == known) return known + 1;
  return {};
}

bool has_alpha(int channels) { return channels == 2 || channels == 4; }

/// Rounded to 8 or 16 bits, after the sRGB curve except for alpha. NaN becomes 0.
template <class Number>
std::vector<Number> encoded_pixels(const Image& image, int channels, bool linear) {
  std::vector<Number> encoded(std::size_t(image.width) * image.height * channels);
  constexpr float most = std::numeric_limits<Number>::max();
  const int alpha = has_alpha(channels) ? channels - 1 : -1;
  parallel_for(std::size_t(image.width) * image.height, block, [&](std::size_t i) {
    for (int c = 0; c < channels; ++c) {
      float value = image.pixel[i * image.channels + c];
      value = value > 0 ? std::min(value, 1.0f) : 0.0f;
      if (!linear && c != alpha) value = srgb_from_linear(value);
      encoded[i * channels + c] = static_cast<Number>(value * most + 0.5f);
    }
  });
  return encoded;
}

std::vector<std::string> main_channel_names(int channels) {
  switch (channels) {
  case 1:
    return {"Y"};
  case 2:
    return {"Y", "A"};
  case 3:
    return {"R", "G", "B"};
  default:
    return {"R", "G", "B", "A"};
  }
}

void check(const std::string& where, const Image& image) {
  if (image.width < 1 || image.height < 1 || image.channels < 1 || image.channels > 4 ||
      image.pixel.size() != std::size_t(image.width) * image.height * image.channels)
    throw InvalidInput(where,
                       "cannot hold a picture of " + std::to_string(image.width) + " × " +
                           std::to_string(image.height) + " pixels with " + std::to_string(image.channels) +
                           " channels and " + std::to_string(image.pixel.size()) + " numbers",
                       "give one with 1 to 4 channels");
}

/// The pages of a file: `all`, or the first alone.
std::vector<Image> pages_of(const std::filesystem::path& path, const ReadImageOptions& options, bool all) {
  const std::string where = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw IoFailure(where, "there is no such file; check its name");
  if (!std::filesystem::is_regular_file(path, error)) throw IoFailure(where, "is not a file; name one");
  if (std::filesystem::file_size(path, error) == 0)
    throw InvalidInput(where, "is empty", "give a PNG, JPEG, EXR, HDR or TIFF image");

  const auto read =
      reinterpret_cast<image_module::ReadFunction*>(module_function(module_file, "pith_read_image_3", purpose));
  const auto release =
      reinterpret_cast<image_module::ReleaseFunction*>(module_function(module_file, "pith_release_image_3", purpose));
  image_module::Read request{};
  request.path = where.c_str();
  request.all = all;
  const auto result = read(&request);
  const std::unique_ptr<float, image_module::ReleaseFunction*> pixel(request.pixel, release);
  if (result == image_module::not_opened) throw IoFailure(where, std::string(request.message) + "; free memory");
  if (result != image_module::done)
    throw InvalidInput(where, std::string("is not a picture that can be read (") + request.message + ")",
                       "give a PNG, JPEG, EXR, HDR or TIFF image");

  std::vector<Image> pages;
  const bool decode = request.integer && !options.linear;
  for (int page = 0; page < request.pages; ++page) {
    Image& image = pages.emplace_back(request.width, request.height, request.channels);
    const int alpha = has_alpha(image.channels) ? image.channels - 1 : -1;
    const float* from = pixel.get() + image.pixel.size() * page;
    parallel_for(std::size_t(image.width) * image.height, block, [&](std::size_t i) {
      for (int c = 0; c < image.channels; ++c) {
        const std::size_t at = i * image.channels + c;
        image.pixel[at] = decode && c != alpha ? linear_from_srgb(from[at]) : from[at];
      }
    });
  }
  return pages;
}

} // namespace

bool is_image_path(const std::filesystem::path& path) { return !format_of(path).empty(); }

Image read_image(const std::filesystem::path& path) { return read_image(path, {}); }

Image read_image(const std::filesystem::path& path, const ReadImageOptions& options) {
  return std::move(pages_of(path, options, false).front());
}

std::vector<Image> read_pages(const std::filesystem::path& path, const ReadImageOptions& options) {
  return pages_of(path, options, true);
}

void write_image(const std::filesystem::path& path, const Image& image, const WriteImageOptions& options,
                 std::span<const ImageLayer> layers) {
  const std::string where = path.string();
  const std::string format = format_of(path);
  if (format.empty())
    throw InvalidInput(where, "is no name for an image", "end it in .png, .jpg, .exr, .hdr or .tif");
  check(where, image);
  if (!layers.empty() && format != "exr")
    throw InvalidInput(where, "cannot hold further layers", "write them to an .exr");
  if (options.bits != 8 && options.bits != 16)
    throw InvalidInput(where, "cannot have " + std::to_string(options.bits) + " bits", "use 8 or 16");

  image_module::Encode request{};
  request.format = format.c_str();
  request.width = image.width;
  request.height = image.height;
  request.pixels_per_mm = options.pixels_per_mm;
  request.stored = format == "png" && options.bits == 16 ? image_module::Encode::word
                   : format == "png" || format == "jpg"  ? image_module::Encode::byte
                   : format == "exr" && options.half     ? image_module::Encode::half
                                                         : image_module::Encode::real;
  const bool integers = request.stored == image_module::Encode::byte || request.stored == image_module::Encode::word;
  request.srgb = integers && !options.linear;

  int channels = image.channels;
  if (format == "jpg") channels = channels < 3 ? 1 : 3; // no alpha there
  std::vector<std::string> name = main_channel_names(channels);
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint16_t> words;
  std::vector<float> reals;
  if (request.stored == image_module::Encode::byte) {
    bytes = encoded_pixels<std::uint8_t>(image, channels, options.linear);
    request.pixel = bytes.data();
  } else if (request.stored == image_module::Encode::word) {
    words = encoded_pixels<std::uint16_t>(image, channels, options.linear);
    request.pixel = words.data();
  } else {
    // All channels of a pixel beside one another, those of the layers after the picture's own.
    struct Source {
      const Image* image;
      int channel;
    };
    std::vector<Source> source;
    for (int c = 0; c < channels; ++c) source.push_back({&image, c});
    if (format == "hdr") { // three channels, nothing else
      source = {{&image, 0}, {&image, channels < 3 ? 0 : 1}, {&image, channels < 3 ? 0 : 2}};
      name = main_channel_names(3);
    }
    for (const ImageLayer& layer : layers) {
      check(where + ", layer " + layer.name, layer.image);
      if (layer.image.width != image.width || layer.image.height != image.height || layer.name.empty())
        throw InvalidInput(where, "cannot hold the layer '" + layer.name + "', which has no name or another size",
                           "give layers of the picture's size");
      for (int c = 0; c < layer.image.channels; ++c) {
        source.push_back({&layer.image, c});
        name.push_back(layer.image.channels == 1 ? layer.name
                                                 : layer.name + "." + main_channel_names(layer.image.channels)[c]);
      }
    }
    channels = static_cast<int>(source.size());
    reals.resize(std::size_t(image.width) * image.height * channels);
    parallel_for(std::size_t(image.width) * image.height, block, [&](std::size_t i) {
      for (int c = 0; c < channels; ++c)
        reals[i * channels + c] = source[c].image->pixel[i * source[c].image->channels + source[c].channel];
    });
    request.pixel = reals.data();
  }
  std::vector<const char*> names;
  for (const std::string& n : name) names.push_back(n.c_str());
  request.channels = channels;
  request.channel_name = names.data();
  request.alpha = format != "hdr" && has_alpha(image.channels) && format != "jpg" ? image.channels - 1 : -1;

  AtomicFile file(path); // first, so that a path that cannot be written is found before the work
  const auto encode =
      reinterpret_cast<image_module::EncodeFunction*>(module_function(module_file, "pith_encode_image_3", purpose));
  const auto release =
      reinterpret_cast<image_module::ReleaseFunction*>(module_function(module_file, "pith_release_image_3", purpose));
  const auto result = encode(&request);
  const std::unique_ptr<unsigned char, image_module::ReleaseFunction*> content(request.bytes, release);
  if (result != image_module::done)
    throw IoFailure(where, std::string("cannot be encoded (") + request.message +
                               "); ask for a smaller picture or another format");
  file.write(content.get(), request.count);
  file.commit();
}

} // namespace pith
