// pith-images.so: the only file that sees OpenImageIO.
#include "image_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

using namespace pith::image_module;

namespace {

constexpr OIIO::imagesize_t most_numbers = OIIO::imagesize_t(1) << 31;

template <std::size_t n>
void set_message(char (&message)[n], const std::string& text) {
  std::snprintf(message, n, "%s", text.substr(0, text.find('\n')).c_str());
}

/// Whether a PNG is whole: every chunk is there and has its checksum. libpng would complain on standard error.
bool damaged_png(const char* path) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path, "rb"), std::fclose);
  unsigned char head[8];
  if (!file || std::fread(head, 1, 8, file.get()) != 8 || std::memcmp(head, "\x89PNG\r\n\x1a\n", 8) != 0)
    return false;
  std::array<std::uint32_t, 256> table; // CRC-32 byte by byte (PNG specification, annex D)
  for (std::uint32_t n = 0; n < 256; ++n) {
    table[n] = n;
    for (int bit = 0; bit < 8; ++bit) table[n] = table[n] & 1 ? 0xedb88320u ^ (table[n] >> 1) : table[n] >> 1;
  }
  const auto number_at = [](const unsigned char* at) {
    return std::uint32_t(at[0]) << 24 | std::uint32_t(at[1]) << 16 | std::uint32_t(at[2]) << 8 | at[3];
  };
  std::vector<unsigned char> block(1 << 16);
  for (;;) {
    if (std::fread(head, 1, 8, file.get()) != 8) return true; // length and type
    std::uint32_t left = number_at(head), sum = 0xffffffffu;
    const auto add = [&](const unsigned char* bytes, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) sum = table[(sum ^ bytes[i]) & 0xff] ^ (sum >> 8);
    };
    add(head + 4, 4);
    const bool end = std::memcmp(head + 4, "IEND", 4) == 0;
    while (left > 0) {
      const std::size_t some = std::min<std::size_t>(left, block.size());
      if (std::fread(block.data(), 1, some, file.get()) != some) return true;
      add(block.data(), some);
      left -= static_cast<std::uint32_t>(some);
    }
    if (std::fread(head, 1, 4, file.get()) != 4 || number_at(head) != (sum ^ 0xffffffffu)) return true;
    if (end) return false;
  }
}

Result read(Read& image) {
  if (damaged_png(image.path)) {
    set_message(image.message, "it is damaged or cut off");
    return not_an_image;
  }
  OIIO::ImageSpec wanted;
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(image.path, &wanted);
  if (!input) {
    set_message(image.message, OIIO::geterror());
    return not_an_image;
  }
  const OIIO::ImageSpec spec = input->spec();
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1 ||
      spec.image_pixels() * 4 > most_numbers) {
    set_message(image.message, "holds no picture of a usable size");
    return not_an_image;
  }
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.nchannels > 4 || (spec.nchannels == 4 && spec.alpha_channel >= 0 && spec.alpha_channel != 3)
                       ? (spec.alpha_channel == 3 ? 4 : 3)
                       : spec.nchannels;
  image.integer = spec.format.is_floating_point() ? 0 : 1;
  image.pages = 1;
  if (image.all && std::strcmp(input->format_name(), "tiff") == 0)
    for (; input->seek_subimage(image.pages, 0); ++image.pages) {
      const OIIO::ImageSpec& page = input->spec();
      if (page.width != spec.width || page.height != spec.height || page.nchannels != spec.nchannels) break;
    }
  const std::size_t numbers_per_page = std::size_t(spec.width) * spec.height * image.channels;
  const std::size_t numbers = numbers_per_page * image.pages;
  if (numbers > most_numbers) {
    set_message(image.message, "has more pages than can be read at once");
    return not_an_image;
  }
  image.pixel = static_cast<float*>(std::calloc(numbers, sizeof(float)));
  if (!image.pixel) {
    set_message(image.message, "does not fit into memory");
    return not_opened;
  }
  for (int page = 0; page < image.pages; ++page)
    if (!input->read_image(page, 0, 0, image.channels, OIIO::TypeDesc::FLOAT,
                           image.pixel + page * numbers_per_page)) {
      set_message(image.message, input->geterror());
      std::free(image.pixel);
      image.pixel = nullptr;
      return not_an_image;
    }
  return done;
}

Result encode(Encode& image) {
  const auto output = OIIO::ImageOutput::create(image.format);
  if (!output) {
    set_message(image.message, OIIO::geterror());
    return not_opened;
  }
  const OIIO::TypeDesc memory = image.stored == Encode::byte   ? OIIO::TypeDesc::UINT8
                                : image.stored == Encode::word ? OIIO::TypeDesc::UINT16
                                                               : OIIO::TypeDesc::FLOAT;
  OIIO::ImageSpec spec(image.width, image.height, image.channels,
                       image.stored == Encode::half ? OIIO::TypeDesc(OIIO::TypeDesc::HALF) : memory);
  spec.channelnames.assign(image.channel_name, image.channel_name + image.channels);
  spec.alpha_channel = image.alpha;
  const std::string format = image.format;
  // Some writers stamp the time of writing where none is given; the same pixels must give the same bytes.
  if (format == "exr" || format == "tif") spec.attribute("DateTime", "1980:01:01 00:00:00");
  if (format == "exr") spec.attribute("compression", "zip");
  if (format == "tif") spec.attribute("compression", "zip");
  if (format == "jpg") {
    spec.attribute("compression", "jpeg:95");
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  if (image.srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  if (image.pixels_per_mm > 0) {
    spec.attribute("XResolution", float(image.pixels_per_mm * 10));
    spec.attribute("YResolution", float(image.pixels_per_mm * 10));
    spec.attribute("ResolutionUnit", "cm");
  }
  // Encoded in memory: several of the writers do not notice a full disk, and libjpeg ends the process.
  if (!output->supports("ioproxy")) {
    set_message(image.message, "this OpenImageIO cannot encode " + format + " in memory");
    return not_opened;
  }
  OIIO::Filesystem::IOVecOutput file;
  OIIO::Filesystem::IOProxy* const proxy = &file;
  if (!output->set_ioproxy(proxy) || !output->open("picture." + format, spec) ||
      !output->write_image(memory, image.pixel) || !output->close()) {
    set_message(image.message, output->geterror());
    return not_opened;
  }
  image.count = file.buffer().size();
  image.bytes = static_cast<unsigned char*>(std::malloc(image.count));
  if (!image.bytes) {
    set_message(image.message, "does not fit into memory");
    return not_opened;
  }
  std::memcpy(image.bytes, file.buffer().data(), image.count);
  return done;
}

} // namespace

#define PITH_EXPORT extern "C" __attribute__((visibility("default")))

PITH_EXPORT Result pith_read_image_3(Read* image) {
  try {
    return read(*image);
  } catch (const std::exception& problem) {
    set_message(image->message, problem.what());
    return not_an_image;
  }
}

PITH_EXPORT Result pith_encode_image_3(Encode* image) {
  try {
    return encode(*image);
  } catch (const std::exception& problem) {
    set_message(image->message, problem.what());
    return not_opened;
  }
}

PITH_EXPORT void pith_release_image_3(void* memory) { std::free(memory); }
