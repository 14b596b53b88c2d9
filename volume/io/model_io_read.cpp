#include "volume/io/layer_json.h"
#include "volume/io/model_io.h"
#include "volume/io/zip_file.h"

#include <fstream>
#include <new>
#include <nlohmann/json.hpp>

namespace pith {

using nlohmann::json;

namespace {

constexpr std::int64_t most = 0xfffffffe; // of anything that a 32-bit index names
constexpr std::int64_t most_region = 0x7fffffff;
constexpr std::size_t any = ZipReader::any;

ZipReader opened(const std::filesystem::path& path) {
  return ZipReader(path, ".pith file", "make the model again with `pith make`");
}

/// model.json, its format and version checked.
json description_of(const ZipReader& zip, const std::string& where) {
  if (!zip.has("model.json")) zip.fail("is a zip, but not a .pith file (it has no model.json)");
  json description = json::parse(zip.text("model.json"), nullptr, false);
  if (description.is_discarded() || !description.is_object()) zip.fail("has a model.json that is not JSON");
  if (!description.contains("format") || description["format"] != "pith model") zip.fail("is not a pith model");
  const auto version = integer(description, "version", 1, most, where);
  if (version > model_format_version)
    throw InvalidInput(where,
                       "was written in format " + std::to_string(version) + ", and this program reads up to " +
                           std::to_string(model_format_version),
                       "use a later pith");
  return description;
}

std::vector<std::size_t> texel_shape(const Exemplar& exemplar) {
  std::vector<std::size_t> shape;
  for (int axis = exemplar.axes; axis-- > 0;) shape.push_back(static_cast<std::size_t>(exemplar.size[axis]));
  shape.push_back(static_cast<std::size_t>(exemplar.component_count()));
  return shape;
}

std::vector<Exemplar> exemplars_of(const ZipReader& zip, const json& description, const std::string& where) {
  std::vector<Exemplar> all;
  for (const json& entry : list(description, "exemplars", 0, where)) {
    const std::string number = std::to_string(all.size());
    Exemplar& exemplar = all.emplace_back(exemplar_of(entry, where));
    const auto shape = texel_shape(exemplar);
    exemplar.texel = zip.array<std::uint8_t>("exemplar/" + number, shape);
    if (flag(entry, "gaussian", where)) {
      exemplar.gaussian = zip.array<std::uint8_t>("gaussian/" + number, shape);
      exemplar.inverse = zip.array<float>("inverse/" + number, {shape.back(), 256});
    }
  }
  return all;
}

std::vector<Mask> masks_of(const ZipReader& zip, const json& description, const std::string& where) {
  std::vector<Mask> all;
  for (const json& entry : list(description, "masks", 0, where)) {
    const std::string number = std::to_string(all.size());
    Mask& mask = all.emplace_back(mask_of(entry, where));
    std::vector<std::size_t> shape;
    for (int axis = mask.axes; axis-- > 0;) shape.push_back(static_cast<std::size_t>(mask.size[axis]));
    mask.alpha = zip.array<std::uint8_t>("mask/" + number, shape);
  }
  return all;
}

/// Copies those of `all` that a layer lists.
template <class T>
std::vector<T> listed(const std::vector<T>& all, const json& layer, const char* key, const std::string& where) {
  std::vector<T> chosen;
  for (const json& number : list(layer, key, 0, where)) {
    if (!number.is_number_unsigned() || number.get<std::uint64_t>() >= all.size())
      refuse_json(where, std::string("has a layer with ") + key + " that it does not hold");
    chosen.push_back(all[number.get<std::size_t>()]);
  }
  return chosen;
}

Layer layer_at(const ZipReader& zip, const json& entry, std::size_t number, const std::vector<Exemplar>& exemplars,
               const std::vector<Mask>& masks, const std::string& where) {
  const std::string folder = "layer/" + std::to_string(number) + "/";
  Layer layer = layer_of(entry, where);
  layer.exemplar = listed(exemplars, entry, "exemplars", where);
  layer.mask = listed(masks, entry, "masks", where);
  layer.corner = zip.array<float>(folder + "corner", {any, static_cast<std::size_t>(layer.width) + 1});
  zip.rows<std::uint32_t>(folder + "begin", layer.begin);
  if (flag(entry, "sparse", where)) zip.rows<std::uint32_t>(folder + "simplex", layer.simplex);
  zip.rows<std::uint32_t>(folder + "lookup", layer.lookup);

  std::vector<std::array<std::uint32_t, 2>> reads;
  zip.rows<std::uint32_t>(folder + "patch", reads);
  const auto frame = zip.array<float>(folder + "frame", {reads.size(), 2, 4});
  const auto key = zip.array<std::uint64_t>(folder + "key", {reads.size()});
  layer.patch.resize(reads.size());
  for (std::size_t i = 0; i < reads.size(); ++i) {
    Patch& patch = layer.patch[i];
    patch.exemplar = reads[i][0];
    patch.mask = reads[i][1];
    for (int axis = 0; axis < 4; ++axis) {
      patch.frame.scale[axis] = frame[8 * i + axis];
      patch.frame.offset[axis] = frame[8 * i + 4 + axis];
    }
    patch.key = key[i];
  }
  return layer;
}

Pieces pieces_of(const ZipReader& zip, const json& description, std::size_t vertices, const std::string& where) {
  Pieces pieces;
  pieces.root_vertex_count = static_cast<std::uint32_t>(vertices);
  pieces.cut_count =
      static_cast<std::uint32_t>(integer(member(description, "counts", where), "cuts", 0, 0x7ffffffd, where));
  zip.rows<std::uint32_t>("pieces/label", pieces.label);
  zip.rows<std::uint32_t>("pieces/edge", pieces.added);
  zip.rows<double>("pieces/position", pieces.added_position);
  zip.rows<float>("pieces/normal", pieces.added_normal);
  std::vector<std::array<std::uint32_t, 2>> section;
  zip.rows<std::uint32_t>("pieces/section", section);
  const auto section_normal = zip.array<float>("pieces/section_normal", {section.size(), 3});
  for (std::size_t i = 0; i < section.size(); ++i)
    pieces.on_section.push_back({VertexId(section[i][0]), CutId(section[i][1]),
                                 Vec3f(section_normal[3 * i], section_normal[3 * i + 1], section_normal[3 * i + 2])});

  std::vector<std::uint32_t> begin, root;
  std::vector<std::array<VertexId, 4>> corner;
  std::vector<std::array<FaceTag, 4>> face;
  zip.rows<std::uint32_t>("pieces/cut_begin", begin);
  zip.rows<std::uint32_t>("pieces/cut_root", root);
  zip.rows<std::uint32_t>("pieces/cut_corner", corner);
  zip.rows<std::int32_t>("pieces/cut_face", face);
  const std::size_t count = begin.empty() ? 0 : begin.size() - 1;
  const auto placement = zip.array<double>("pieces/placement", {count, 3, 4});
  bool fits = !begin.empty() && begin.front() == 0 && begin.back() == root.size() && corner.size() == root.size() &&
              face.size() == root.size();
  for (std::size_t p = 0; p < count; ++p) fits = fits && begin[p] <= begin[p + 1];
  if (!fits) zip.fail("has pieces whose parts differ in length");

  pieces.piece.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    Piece& piece = pieces.piece[p];
    for (std::size_t i = begin[p]; i < begin[p + 1]; ++i) piece.cut.push_back({corner[i], TetId(root[i]), face[i]});
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) piece.placement.rotation(i, j) = placement[12 * p + 4 * i + j];
      piece.placement.translation[i] = placement[12 * p + 4 * i + 3];
    }
  }
  return pieces;
}

ModelFile file_of(const ZipReader& zip, const std::string& where) {
  const json description = description_of(zip, where);
  ModelFile file;
  Model& model = file.model;
  model.name = text(description, "name", where);
  file.recipe = zip.text("recipe.json");
  const json& stages = member(description, "stages", where);
  for (const auto& [stage, key] : stages.items()) file.key[stage] = text(stages, stage.c_str(), where);

  zip.rows<double>("mesh/position", model.mesh.position);
  zip.rows<std::uint32_t>("mesh/corner", model.mesh.corner);
  zip.rows<std::int32_t>("mesh/region", model.mesh.region);
  if (model.mesh.region.size() != model.mesh.tet_count()) zip.fail("has another number of regions than of tets");
  connect(model.mesh);
  model.boundary = boundary_of(model.mesh);

  const json& fields = member(description, "fields", where);
  if (flag(fields, "input", where)) zip.rows<std::uint32_t>("boundary/input", model.boundary.input);
  if (flag(fields, "depth", where)) zip.rows<float>("field/depth", model.field.depth);
  if (flag(fields, "axes", where)) zip.rows<double>("field/axes", model.field.axes);
  if (flag(fields, "scale", where)) zip.rows<float>("field/scale", model.field.scale);
  if (flag(fields, "singular", where)) zip.rows<std::uint8_t>("field/singular", model.field.singular);

  const auto exemplars = exemplars_of(zip, description, where);
  const auto masks = masks_of(zip, description, where);
  const json& layers = list(description, "layers", 0, where);
  for (std::size_t i = 0; i < layers.size(); ++i)
    model.layer.push_back(layer_at(zip, layers[i], i, exemplars, masks, where));
  validate(model);
  file.pieces = pieces_of(zip, description, model.mesh.vertex_count(), where);
  validate(file.pieces, model.mesh, model.boundary);
  return file;
}

Box box_of(const json& value, const std::string& where) {
  Box box;
  if (value.is_null()) return box;
  try {
    const auto corner = value.get<std::array<std::array<double, 3>, 2>>();
    for (const auto& c : corner) box.add(Vec3d(c[0], c[1], c[2]));
  } catch (const json::exception&) {
    refuse_json(where, "has bounds that are not two points");
  }
  return box;
}

std::string sizes(const Exemplar& exemplar) {
  std::string text;
  for (int axis = 0; axis < exemplar.axes; ++axis)
    text += (axis > 0 ? "×" : "") + std::to_string(exemplar.size[axis]);
  return text;
}

} // namespace

ModelFile read_model(const std::filesystem::path& path) {
  const ZipReader zip = opened(path);
  const std::string where = path.string();
  try {
    return file_of(zip, where);
  } catch (const InvalidInput& problem) {
    const std::string message = problem.what();
    if (message.starts_with(where)) throw;
    zip.fail("holds a model that does not fit together (" + message + ")");
  } catch (const std::bad_alloc&) {
    throw InvalidInput(where, "does not fit into memory", "use a machine with more, or a coarser model");
  } catch (const json::exception&) {
    zip.fail("has a model.json that does not fit its format");
  }
}

ModelSummary read_model_summary(const std::filesystem::path& path) {
  const ZipReader zip = opened(path);
  const std::string where = path.string();
  const json description = description_of(zip, where);
  ModelSummary summary;
  summary.version = static_cast<int>(integer(description, "version", 1, model_format_version, where));
  summary.name = text(description, "name", where);
  summary.recipe = zip.text("recipe.json");
  const json& stages = member(description, "stages", where);
  for (const auto& [stage, key] : stages.items()) summary.key[stage] = text(stages, stage.c_str(), where);
  summary.file_bytes = zip.file_bytes();
  const json& counts = member(description, "counts", where);
  const auto count = [&](const json& of, const char* key) { return std::size_t(integer(of, key, 0, most, where)); };
  summary.vertices = count(counts, "vertices");
  summary.tets = count(counts, "tets");
  summary.facets = count(counts, "facets");
  summary.regions = count(counts, "regions");
  summary.cuts = count(counts, "cuts");
  summary.added_vertices = count(counts, "added_vertices");
  summary.bounds = box_of(member(description, "bounds", where), where);

  std::vector<Exemplar> exemplars; // without texels
  for (const json& entry : list(description, "exemplars", 0, where)) exemplars.push_back(exemplar_of(entry, where));
  for (const json& entry : list(description, "layers", 0, where)) {
    const Layer layer = layer_of(entry, where);
    auto& about = summary.layer.emplace_back();
    about.name = layer.name;
    about.domain = text(entry, "domain", where);
    const json& blend = member(entry, "blend", where);
    about.blend = text(blend, "mix", where);
    if (layer.blend.select != Blend::Select::none) about.blend = text(blend, "select", where) + " " + about.blend;
    about.region = layer.region;
    about.width = layer.width;
    about.patches = count(entry, "patches");
    about.lookups = count(entry, "lookups");
    about.corners = count(entry, "corners");
    about.masks = list(entry, "masks", 0, where).size();
    for (const Exemplar& exemplar : listed(exemplars, entry, "exemplars", where)) {
      about.exemplars.push_back(exemplar.name + " " + sizes(exemplar));
      if (about.channels.empty())
        for (const Channel& channel : exemplar.channel) about.channels.push_back(channel.name);
    }
    summary.patches += about.patches;
    summary.lookups += about.lookups;
  }
  for (const json& entry : list(description, "pieces", 0, where)) {
    auto& about = summary.piece.emplace_back();
    about.whole_tets = count(entry, "whole_tets");
    about.cut_tets = count(entry, "cut_tets");
    about.volume = number(entry, "volume", where);
    about.bounds = box_of(member(entry, "bounds", where), where);
    about.moved = flag(entry, "moved", where);
  }
  if (description.contains("regions"))
    for (const json& entry : list(description, "regions", 0, where)) {
      RegionMeasure& about = summary.region.emplace_back();
      about.region = static_cast<std::int32_t>(integer(entry, "region", -most_region, most_region, where));
      about.tets = count(entry, "tets");
      about.volume = number(entry, "volume", where);
      about.bounds = box_of(member(entry, "bounds", where), where);
      about.minimum_dihedral = number(entry, "minimum_dihedral", where);
      about.outside_area = number(entry, "outside_area", where);
      about.interface_area = number(entry, "interface_area", where);
      for (const json& other : list(entry, "beside", 0, where)) {
        if (!other.is_number_integer())
          throw InvalidInput(where, "a region beside another is no number", "make it again");
        about.beside.push_back(other.get<std::int32_t>());
      }
    }
  return summary;
}

bool looks_like_zip(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  char first[4] = {};
  file.read(first, 4);
  return file.gcount() == 4 && first[0] == 'P' && first[1] == 'K' && first[2] == 3 && first[3] == 4;
}

} // namespace pith
