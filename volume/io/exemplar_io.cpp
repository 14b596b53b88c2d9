#include "volume/io/exemplar_io.h"

#include "volume/io/image_io.h"
#include "volume/io/layer_json.h"
#include "volume/io/zip_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace pith {

using nlohmann::json;

namespace {

constexpr int exemplar_format_version = 1;
constexpr const char* mend = "make the exemplar again with `pith exemplar`";

std::vector<std::size_t> shape_of(const Exemplar& exemplar) {
  std::vector<std::size_t> shape;
  for (int axis = exemplar.axes; axis-- > 0;) shape.push_back(static_cast<std::size_t>(exemplar.size[axis]));
  shape.push_back(static_cast<std::size_t>(exemplar.component_count()));
  return shape;
}

Exemplar read_zipped(const std::filesystem::path& path) {
  const std::string where = path.string();
  const ZipReader zip(path, ".exemplar file", mend);
  if (!zip.has("exemplar.json")) zip.fail("is a zip, but not an .exemplar file (it has no exemplar.json)");
  const json description = json::parse(zip.text("exemplar.json"), nullptr, false);
  if (!description.is_object() || !description.contains("format") || description["format"] != "pith exemplar")
    zip.fail("is not a pith exemplar");
  if (integer(description, "version", 1, 0x7fffffff, where) > exemplar_format_version)
    throw InvalidInput(where, "was written by a later version of pith", "use a later pith");
  Exemplar exemplar = exemplar_of(description, where);
  exemplar.texel = zip.array<std::uint8_t>("texel", shape_of(exemplar));
  return exemplar;
}

/// What bare components mean: colour first, alpha fourth.
std::vector<Channel> channels_for(int components) {
  if (components == 3) return {Channel{}};
  const Channel alpha{.name = "alpha", .semantic = Semantic::scalar, .components = 1, .srgb = false};
  if (components == 4) return {Channel{}, alpha};
  return {Channel{.name = "value", .semantic = Semantic::scalar, .components = components, .srgb = false}};
}

Exemplar read_bare(const std::filesystem::path& path) {
  const std::string where = path.string();
  const NpyArray array = read_npy(path);
  if (array.type != NpyType::u1)
    throw InvalidInput(where, "holds " + name_of(array.type) + ", where texels are uint8", "convert it to uint8");
  const std::size_t axes = array.shape.empty() ? 0 : array.shape.size() - 1;
  bool fits = axes >= 2 && axes <= 4 && array.shape.back() >= 1 && array.shape.back() <= max_components;
  for (std::size_t i = 0; fits && i < axes; ++i) fits = array.shape[i] >= 1 && array.shape[i] <= 65536;
  if (!fits)
    throw InvalidInput(where, "does not have the shape of texels",
                       "give y × x × c or z × y × x × c with 1 to " + std::to_string(max_components) + " components");
  Exemplar exemplar;
  exemplar.axes = static_cast<int>(axes);
  for (std::size_t i = 0; i < axes; ++i) exemplar.size[i] = static_cast<int>(array.shape[axes - 1 - i]);
  exemplar.channel = channels_for(static_cast<int>(array.shape.back()));
  exemplar.texel.resize(array.data.size());
  std::memcpy(exemplar.texel.data(), array.data.data(), array.data.size());
  return exemplar;
}

Exemplar read_picture(const std::filesystem::path& path) {
  const std::vector<Image> pages = read_pages(path);
  const Image& first = pages.front();
  Exemplar exemplar;
  exemplar.axes = pages.size() > 1 ? 3 : 2;
  exemplar.size = {first.width, first.height, static_cast<int>(pages.size()), 1};
  exemplar.channel = {Channel{}};
  const bool alpha = first.channels == 2 || first.channels == 4, grey = first.channels < 3;
  if (alpha) exemplar.channel = channels_for(4);
  exemplar.texel.reserve(exemplar.texel_count() * static_cast<std::size_t>(exemplar.component_count()));
  for (const Image& image : pages)
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const float* pixel = image.at(x, y);
        for (int c = 0; c < 3; ++c) exemplar.texel.push_back(encoded(exemplar.channel[0], pixel[grey ? 0 : c]));
        if (alpha) exemplar.texel.push_back(encoded(exemplar.channel[1], pixel[image.channels - 1]));
      }
  return exemplar;
}

} // namespace

Exemplar read_exemplar(const std::filesystem::path& path) {
  Exemplar exemplar = path.extension() == ".npy" ? read_bare(path)
                      : is_image_path(path)      ? read_picture(path)
                                                 : read_zipped(path);
  if (exemplar.name.empty()) exemplar.name = path.stem().string();
  try {
    validate(exemplar);
  } catch (const InvalidInput& problem) {
    throw InvalidInput(path.string(), std::string("does not fit together (") + problem.what() + ")", mend);
  }
  return exemplar;
}

void write_exemplar(const std::filesystem::path& path, const Exemplar& exemplar) {
  validate(exemplar);
  if (path.extension() == ".npy") return write_npy<std::uint8_t>(path, exemplar.texel, shape_of(exemplar));
  if (path.extension() != ".exemplar")
    throw InvalidInput(path.string(), "is no name for an exemplar", "end it in .exemplar or .npy");
  json description = json_of(exemplar);
  description["format"] = "pith exemplar";
  description["version"] = exemplar_format_version;
  ZipWriter zip;
  zip.add_text("exemplar.json", description.dump(1) + "\n");
  zip.add_array<std::uint8_t>("texel", exemplar.texel, shape_of(exemplar));
  zip.write(path);
}

} // namespace pith
