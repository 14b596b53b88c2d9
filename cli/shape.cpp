// pith shape NAME -o FILE: writes a surface that pith makes itself.
#include "cli/command.h"
#include "volume/exemplar/shapes.h"
#include "volume/io/mesh_io.h"

#include <chrono>
#include <fmt/format.h>

namespace pith::cli {
namespace {

struct ShapeOptions {
  std::string name;
  std::filesystem::path output;
  int triangles = 20'000;
};

void run(const ShapeOptions& options, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  check_output(options.output, {"obj", "off", "ply", "stl"});
  const TriMesh mesh = named_shape(options.name, options.triangles);
  session.stop_if_asked();
  write_tri_mesh(options.output, mesh);
  session.say(fmt::format("{}: {} triangles", options.output.string(), mesh.triangle_count()));
  session.print({{"output", options.output.string()},
                 {"name", options.name},
                 {"triangles", mesh.triangle_count()},
                 {"vertices", mesh.vertex_count()},
                 {"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()}});
}

} // namespace

Verb shape_verb(CLI::App& program) {
  auto options = std::make_shared<ShapeOptions>();
  std::string names;
  for (const std::string& name : shape_names()) names += (names.empty() ? "" : ", ") + name;
  CLI::App* app = program.add_subcommand("shape", "make a closed surface: " + names);
  app->add_option("name", options->name, names)->required();
  app->add_option("-o,--output", options->output, "FILE.obj, .off, .ply or .stl")->required();
  app->add_option("--triangles", options->triangles, "about how many")
      ->check(CLI::Range(100, 2'000'000))
      ->capture_default_str();
  return {app, [options](const Session& session) { run(*options, session); }};
}

} // namespace pith::cli
