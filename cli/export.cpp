// pith export MODEL.pith -o FILE: by extension ply, obj, stl, glb (coloured surfaces), vtu (tets), vdb (voxels).
#include "cli/command.h"
#include "volume/io/model_io.h"
#include "volume/io/surface_export.h"
#include "volume/io/vdb_io.h"

#include <chrono>
#include <fmt/format.h>

namespace pith::cli {
namespace {

struct ExportOptions {
  std::filesystem::path model, output;
  double max_edge = 0;
  DisplaceOptions displacement;
  VdbOptions vdb;
};

void run(const ExportOptions& options, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  check_output(options.output, {"ply", "obj", "stl", "glb", "vtu", "vdb"});
  ModelFile file = read_model(options.model);
  const Pieces pieces = std::move(file.pieces);
  const std::string name = file.model.name;
  const Root root(std::move(file.model));
  const std::string extension = extension_of(options.output);
  Json object = {{"output", options.output.string()}};
  if (extension == "vdb") {
    const VdbResult result = write_vdb(options.output, root, pieces, options.vdb, session.progress("export"));
    object["voxel"] = result.voxel;
    object["active"] = result.active;
    object["extent"] = result.extent;
    session.say(fmt::format("{}: {} × {} × {} voxels of {:.4g} mm, {} inside", options.output.string(),
                            result.extent[0], result.extent[1], result.extent[2], result.voxel, result.active));
  } else if (extension == "vtu") {
    session.stop_if_asked();
    const TetCounts written = write_vtu(options.output, root, pieces);
    object["tets"] = written.tets;
    object["vertices"] = written.vertices;
    session.say(fmt::format("{}: {} tets of {} piece(s), {} vertices", options.output.string(), written.tets,
                            pieces.piece.size(), written.vertices));
  } else {
    const ColoredSurface surface =
        colored_surface(root, pieces, {.max_edge = options.max_edge, .displacement = options.displacement},
                        session.progress("export"));
    if (surface.turned > 0)
      session.say(
          fmt::format("note: {} triangles face inwards, as the relief is higher there than the skin is round; "
                      "give less --displacement",
                      surface.turned));
    session.stop_if_asked();
    const SurfaceCounts written = write_surface(options.output, surface, name.empty() ? "pith" : name);
    object["triangles"] = written.triangles;
    if (written.vertices > 0) object["vertices"] = written.vertices;
    session.say(fmt::format("{}: {} triangles{}", options.output.string(), written.triangles,
                            written.vertices > 0 ? fmt::format(", {} vertices", written.vertices) : ""));
  }
  object["bytes"] = std::filesystem::file_size(options.output);
  object["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  session.print(object);
}

} // namespace

Verb export_verb(CLI::App& program) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* app = program.add_subcommand("export", "write a model's pieces for other programs, by extension");
  app->add_option("model", options->model, "MODEL.pith")->required();
  app->add_option("-o,--output", options->output, "FILE.ply, .obj, .stl, .glb, .vtu or .vdb")->required();
  app->add_option("--max-edge", options->max_edge, "surfaces: subdivide until no edge is longer, mm; 0: as they are")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  add_displacement_options(*app, options->displacement);
  app->add_option("--voxel", options->vdb.voxel, "vdb: edge of a voxel, mm; 0: longest extent / 256")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app->add_option("--scale", options->vdb.scale, "vdb: file units per mm; 0.001: metres")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app->add_option("--density", options->vdb.density, "vdb: density inside, per file unit")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app->add_option("--color-name", options->vdb.color_name, "vdb: name of the colour grid (Cd for Houdini)")
      ->capture_default_str();
  return {app, [options](const Session& session) { run(*options, session); }};
}

} // namespace pith::cli
