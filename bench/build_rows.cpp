// build/full and info/startup: whole commands, timed from outside.
#include "bench/fixtures.h"
#include "bench/program.h"
#include "bench/row.h"
#include "volume/io/mesh_io.h"
#include "volume/mesh/boundary.h"

#include <thread>

namespace pith::bench {
namespace {

/// Everything from nothing: a fresh folder is configured and built, without ccache.
Measured build_full(const Settings& settings) {
  const std::string cores = std::to_string(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<double> seconds;
  for (int i = 0; i < settings.times(3); ++i) {
    const ScratchFolder folder(settings.source / "build");
    const std::vector<std::string> no_ccache = {"PITH_NO_CCACHE=1", "CCACHE_DISABLE=1"};
    seconds.push_back(seconds_of([&] {
      const std::string source = settings.source.string(), build = folder.path().string();
      const auto configured = run_program(
          {"cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"}, false, no_ccache);
      if (configured.code != 0) throw std::runtime_error("cmake could not configure");
      if (run_program({"cmake", "--build", build, "--parallel", cores}, false, no_ccache).code != 0)
        throw std::runtime_error("the build failed");
    }));
  }
  return {median(seconds), cores + " cores, tests and benchmarks included, " + std::to_string(seconds.size()) +
                               (seconds.size() == 1 ? " build" : " builds")};
}

Measured info_startup(const Settings& settings) {
  const ScratchFolder folder(std::filesystem::temp_directory_path());
  const TetMesh cube = jittered_cube(10);
  const std::filesystem::path mesh = folder.path() / "small.off";
  write_tri_mesh(mesh, surface_of(cube, boundary_of(cube)).surface);
  const std::filesystem::path program = settings.programs / "pith";
  if (!std::filesystem::exists(program)) throw Skipped("there is no " + program.string());
  const int times = settings.times(21);
  const double seconds = median_seconds(times, {}, [&] {
    if (run_program({program.string(), "info", mesh.string()}).code != 0)
      throw std::runtime_error("pith info failed");
  });
  return {1e3 * seconds, "1,200 triangles, median of " + std::to_string(times)};
}

} // namespace

std::vector<Row> build_rows() {
  return {{"info/startup", "ms", "≤ 50", info_startup}, {"build/full", "s", "≤ 600", build_full}};
}

} // namespace pith::bench
