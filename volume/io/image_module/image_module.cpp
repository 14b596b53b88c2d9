// pith-images.so: the only file that sees OpenImageIO.
#include "image_module.h"

#include <OpenImageIO/imageio.h>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

using namespace pith::image_module;

namespace {

constexpr OIIO::imagesize_t most_numbers = OIIO::imagesize_t(1) << 31;

template <std::size_t n>
void set_message(char (&message)[n], const std::string& text) {
  std::snprintf(message, n, "%s", text.substr(0, text.find('\n')).c_str());
}

Result read(Read& image) {
  OIIO::ImageSpec wanted;
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(image.path, &wanted);
  if (!input) {
    set_message(image.message, OIIO::geterror());
    return not_an_image;
  }
  const OIIO::ImageSpec& spec = input->spec();
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
  const std::size_t numbers = std::size_t(spec.width) * spec.height * image.channels;
  image.pixel = static_cast<float*>(std::calloc(numbers, sizeof(float)));
  if (!image.pixel) {
    set_message(image.message, "does not fit into memory");
    return not_opened;
  }
  if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.pixel)) {
    set_message(image.message, input->geterror());
    std::free(image.pixel);
    image.pixel = nullptr;
    return not_an_image;
  }
  return done;
}

Result write(Write& image) {
  const auto output = OIIO::ImageOutput::create(image.format);
  if (!output) {
    set_message(image.message, OIIO::geterror());
    return not_opened;
  }
  const OIIO::TypeDesc memory = image.stored == Write::byte   ? OIIO::TypeDesc::UINT8
                                : image.stored == Write::word ? OIIO::TypeDesc::UINT16
                                                              : OIIO::TypeDesc::FLOAT;
  OIIO::ImageSpec spec(image.width, image.height, image.channels,
                       image.stored == Write::half ? OIIO::TypeDesc(OIIO::TypeDesc::HALF) : memory);
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
  if (!output->open(image.path, spec) || !output->write_image(memory, image.pixel) || !output->close()) {
    set_message(image.message, output->geterror());
    return not_opened;
  }
  return done;
}

} // namespace

#define PITH_EXPORT extern "C" __attribute__((visibility("default")))

PITH_EXPORT Result pith_read_image_1(Read* image) {
  try {
    return read(*image);
  } catch (const std::exception& problem) {
    set_message(image->message, problem.what());
    return not_an_image;
  }
}

PITH_EXPORT Result pith_write_image_1(Write* image) {
  try {
    return write(*image);
  } catch (const std::exception& problem) {
    set_message(image->message, problem.what());
    return not_opened;
  }
}

PITH_EXPORT void pith_release_image_1(float* pixel) { std::free(pixel); }
