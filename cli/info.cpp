// pith info FILE
#include "cli/command.h"
#include "cli/pieces_report.h"
#include "cli/quality.h"
#include "recipe/recipe.h"
#include "recipe/surface_source.h"
#include "volume/base/error.h"
#include "volume/io/exemplar_io.h"
#include "volume/io/image_io.h"
#include "volume/io/mesh_io.h"
#include "volume/io/model_io.h"
#include "volume/io/npy.h"

#include <fmt/format.h>

namespace pith::cli {
namespace {

struct InfoOptions {
  std::filesystem::path file;
  bool quality = false;
};

Json json_from(const Vec3d& v) { return Json::array({v.x(), v.y(), v.z()}); }
Json json_from(const Box& box) {
  if (box.empty()) return nullptr;
  return {{"low", json_from(box.low)}, {"high", json_from(box.high)}};
}
std::string text_of(const Box& box) {
  const Vec3d size = box.extent();
  return fmt::format("{:.6g} × {:.6g} × {:.6g} mm", size.x(), size.y(), size.z());
}
std::string joined(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : ", ") + word;
  return result;
}

/// Adds to `pieces` how sound each is; returns the measures of the fill.
Json add_quality(const std::filesystem::path& file, Json& pieces, const Session& session) {
  ModelFile model = read_model(file);
  for (std::uint32_t piece = 0; piece < model.pieces.piece.size(); ++piece) {
    session.stop_if_asked();
    const PieceReport report = report_of(model.pieces, piece, model.model);
    Json& entry = pieces[piece];
    const Vec3d centroid = model.pieces.piece[piece].placement(report.centroid);
    entry["centroid"] = {centroid.x(), centroid.y(), centroid.z()};
    entry["triangles"] = report.triangles;
    entry["watertight"] = report.watertight();
    entry["manifold"] = report.manifold();
    const bool any_cut = report.cut_tets > 0;
    if (any_cut) entry["minimum_dihedral"] = report.minimum_dihedral;
    session.say(fmt::format(
        "  piece {}: {} triangles, {}, {}{}", piece, report.triangles,
        report.watertight() ? "watertight" : "NOT watertight", report.manifold() ? "manifold" : "not manifold",
        any_cut ? fmt::format(", smallest dihedral of a cut tet {:.3f}°", report.minimum_dihedral * 57.29577951308232)
                : ""));
  }
  return quality_of(std::move(model), session);
}

/// Tells the regions and returns them as JSON.
Json region_list(const std::vector<RegionMeasure>& regions, const Session& session) {
  Json result = Json::array();
  for (const RegionMeasure& region : regions) {
    std::string beside;
    for (const std::int32_t other : region.beside) beside += (beside.empty() ? "" : ", ") + std::to_string(other);
    session.say(fmt::format("  region {}: {:.6g} mm³, {} tets, {}, smallest dihedral {:.2f}°{}", region.region,
                            region.volume, region.tets, text_of(region.bounds),
                            region.minimum_dihedral * 57.29577951308232, beside.empty() ? "" : ", beside " + beside));
    result.push_back({{"region", region.region},
                      {"volume", region.volume},
                      {"tets", region.tets},
                      {"bounds", json_from(region.bounds)},
                      {"minimum_dihedral", region.minimum_dihedral},
                      {"outside_area", region.outside_area},
                      {"interface_area", region.interface_area},
                      {"beside", region.beside}});
  }
  return result;
}

void model_info(const InfoOptions& options, const Session& session) {
  const ModelSummary summary = read_model_summary(options.file);
  session.say(fmt::format("model {}: {} vertices, {} tets, {} boundary facets, {} region(s), {}", summary.name,
                          summary.vertices, summary.tets, summary.facets, summary.regions, text_of(summary.bounds)));
  Json layers = Json::array(), pieces = Json::array();
  Json regions = region_list(summary.region, session);
  for (const auto& layer : summary.layer) {
    layers.push_back({{"name", layer.name},
                      {"domain", layer.domain},
                      {"blend", layer.blend},
                      {"region", layer.region},
                      {"width", layer.width},
                      {"patches", layer.patches},
                      {"lookups", layer.lookups},
                      {"corners", layer.corners},
                      {"masks", layer.masks},
                      {"exemplars", layer.exemplars},
                      {"channels", layer.channels}});
    session.say(fmt::format("  layer {} ({}, {}): {} patches, {} look-ups; exemplars {}; channels {}", layer.name,
                            layer.domain, layer.blend, layer.patches, layer.lookups, joined(layer.exemplars),
                            joined(layer.channels)));
  }
  for (const auto& piece : summary.piece) {
    session.say(fmt::format("  piece {}: {:.6g} mm³, {} whole tets, {} cut tets, {}{}", pieces.size(), piece.volume,
                            piece.whole_tets, piece.cut_tets, text_of(piece.bounds), piece.moved ? ", moved" : ""));
    pieces.push_back({{"volume", piece.volume},
                      {"whole_tets", piece.whole_tets},
                      {"cut_tets", piece.cut_tets},
                      {"bounds", json_from(piece.bounds)},
                      {"moved", piece.moved}});
  }
  Json quality = Json::array();
  if (options.quality) quality = add_quality(options.file, pieces, session);
  session.say(fmt::format("  {} cut(s); {:.2f} MB", summary.cuts, summary.file_bytes / 1e6));
  Json keys = Json::object();
  for (const auto& [stage, key] : summary.key) keys[stage] = key;
  Json object = {{"file", options.file.string()},
                 {"kind", "model"},
                 {"bytes", summary.file_bytes},
                 {"version", summary.version},
                 {"name", summary.name},
                 {"vertices", summary.vertices},
                 {"tets", summary.tets},
                 {"facets", summary.facets},
                 {"regions", summary.regions},
                 {"patches", summary.patches},
                 {"lookups", summary.lookups},
                 {"cuts", summary.cuts},
                 {"bounds", json_from(summary.bounds)},
                 {"region_measures", std::move(regions)},
                 {"layers", std::move(layers)},
                 {"pieces", std::move(pieces)},
                 {"stages", std::move(keys)}};
  if (options.quality) object["quality"] = std::move(quality);
  session.print(object);
}

void mesh_info(const InfoOptions& options, const Session& session) {
  const TriMesh mesh = read_tri_mesh(options.file);
  const Box bounds = bounds_of(mesh);
  const double volume = signed_volume(mesh);
  Json object = {{"file", options.file.string()},
                 {"kind", "mesh"},
                 {"bytes", std::filesystem::file_size(options.file)},
                 {"vertices", mesh.vertex_count()},
                 {"triangles", mesh.triangle_count()},
                 {"bounds", json_from(bounds)},
                 {"volume", volume}};
  session.say(fmt::format("mesh: {} vertices, {} triangles, {}, signed volume {:.6g} mm³", mesh.vertex_count(),
                          mesh.triangle_count(), text_of(bounds), volume));
  if (options.quality) {
    const SurfaceDefects defects = surface_defects(mesh);
    object["clean"] = defects.clean();
    object["shells"] = defects.shells;
    session.say(defects.clean() ? fmt::format("  clean, {} shell(s)", defects.shells) : "  " + defects.summary());
  }
  session.print(object);
}

void exemplar_info(const InfoOptions& options, const Session& session) {
  const Exemplar exemplar = read_exemplar(options.file);
  Json size = Json::array(), wrap = Json::array(), channels = Json::array();
  static constexpr const char* wrap_names[] = {"clamp", "repeat", "mirror"};
  std::string size_text, channel_text;
  for (int axis = 0; axis < exemplar.axes; ++axis) {
    size.push_back(exemplar.size[axis]);
    wrap.push_back(wrap_names[static_cast<int>(exemplar.wrap[axis])]);
    size_text += (axis ? "×" : "") + std::to_string(exemplar.size[axis]);
  }
  for (const Channel& channel : exemplar.channel) {
    channels.push_back({{"name", channel.name}, {"components", channel.components}, {"srgb", channel.srgb}});
    channel_text += (channel_text.empty() ? "" : ", ") + channel.name;
  }
  session.say(fmt::format("exemplar {}: {}, channels {}", exemplar.name, size_text, channel_text));
  session.print({{"file", options.file.string()},
                 {"kind", "exemplar"},
                 {"bytes", std::filesystem::file_size(options.file)},
                 {"name", exemplar.name},
                 {"size", std::move(size)},
                 {"wrap", std::move(wrap)},
                 {"channels", std::move(channels)}});
}

void recipe_info(const InfoOptions& options, const Session& session) {
  const Recipe recipe = read_recipe(options.file);
  session.say(fmt::format("recipe {}: surface {}, {} divide(s), {} solid(s), {} cut(s), {} move(s)", recipe.name,
                          surface_name(recipe.surface), recipe.divides.size(), recipe.solids.size(),
                          recipe.cuts.size(), recipe.moves.size()));
  session.print({{"file", options.file.string()},
                 {"kind", "recipe"},
                 {"bytes", std::filesystem::file_size(options.file)},
                 {"name", recipe.name},
                 {"surface", surface_name(recipe.surface)},
                 {"divides", recipe.divides.size()},
                 {"solids", recipe.solids.size()},
                 {"cuts", recipe.cuts.size()},
                 {"moves", recipe.moves.size()}});
}

void array_info(const InfoOptions& options, const Session& session) {
  const NpyArray array = read_npy(options.file);
  std::string shape;
  for (const std::size_t n : array.shape) shape += (shape.empty() ? "" : " × ") + std::to_string(n);
  session.say(fmt::format("array: {} {}", shape, name_of(array.type)));
  session.print({{"file", options.file.string()},
                 {"kind", "array"},
                 {"bytes", std::filesystem::file_size(options.file)},
                 {"shape", array.shape},
                 {"type", name_of(array.type)}});
}

void image_info(const InfoOptions& options, const Session& session) {
  const Image image = read_image(options.file);
  session.say(fmt::format("image: {} × {} pixels, {} channel(s)", image.width, image.height, image.channels));
  session.print({{"file", options.file.string()},
                 {"kind", "image"},
                 {"bytes", std::filesystem::file_size(options.file)},
                 {"width", image.width},
                 {"height", image.height},
                 {"channels", image.channels}});
}

void run(const InfoOptions& options, const Session& session) {
  std::error_code error;
  if (!std::filesystem::exists(options.file, error))
    throw IoFailure(options.file.string(), "does not exist; check its name");
  if (!std::filesystem::is_regular_file(options.file, error))
    throw IoFailure(options.file.string(), "is not a file; name one");
  const std::string extension = extension_of(options.file);
  if (extension == "pith") return model_info(options, session);
  if (extension == "exemplar") return exemplar_info(options, session);
  if (extension == "json") return recipe_info(options, session);
  if (extension == "npy") return array_info(options, session);
  if (extension == "obj" || extension == "off" || extension == "ply" || extension == "stl")
    return mesh_info(options, session);
  if (is_image_path(options.file)) return image_info(options, session);
  const std::string known = "info reads .pith, .exemplar, .json, .npy, .obj, .off, .ply, .stl and images";
  for (const auto& [name, what] : {std::pair{"vdb", "OpenVDB grids; `vdb_print` of OpenVDB tells what is in them"},
                                   {"vtu", "tets for ParaView"},
                                   {"glb", "a glTF surface for viewers and Blender"}})
    if (extension == name)
      throw InvalidInput(options.file.string(), std::string("is written by `pith export` but not read: ") + what,
                         known);
  throw InvalidInput(options.file.string(), "is of no kind that pith knows", known);
}

} // namespace

Verb info_verb(CLI::App& program) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* app = program.add_subcommand("info", "what is in a model, mesh, exemplar, recipe, array or image");
  app->add_option("file", options->file, "the file")->required();
  app->add_flag(
      "--quality", options->quality,
      "also what takes a while: are pieces or surfaces watertight, manifold ...; how good a model's fill is");
  return {app, [options](const Session& session) { run(*options, session); }};
}

} // namespace pith::cli
