// tetrahedralize/bunny: tets per second from surface to checked mesh, against TetGen alone with the same switches.
#include "bench/program.h"
#include "bench/row.h"
#include "volume/io/mesh_io.h"
#include "volume/mesh/tetrahedralize.h"

#include <cstdio>
#include <fmt/format.h>

namespace pith::bench {
namespace {

/// TetGen reports on standard output too; the result comes last.
const char* last_line(const std::string& output) {
  const std::size_t at = output.rfind("result ");
  return at == std::string::npos ? "" : output.c_str() + at;
}

Measured bunny(const Settings& settings) {
  const std::filesystem::path path = settings.shared_data / "meshes/bunny_12k.off";
  if (settings.shared_data.empty() || !std::filesystem::exists(path))
    throw Skipped("needs meshes/bunny_12k.off in PITH_SHARED_DATA");
  const TriMesh surface = read_tri_mesh(path);
  // An interior as fine as the surface, so that tets are made rather than triangles checked.
  TetrahedralizeOptions options;
  options.interior_edge = bounds_of(surface).diagonal() / 60;
  options.method = TetrahedralizeOptions::Method::tetgen;
  options.helper = settings.programs / "pith-tetgen";
  const double max_volume =
      options.interior_edge * options.interior_edge * options.interior_edge / (6 * std::sqrt(2.0));

  const ScratchFolder folder(std::filesystem::temp_directory_path());
  const std::filesystem::path copy = folder.path() / "bunny.off";
  write_tri_mesh(copy, surface);
  const std::vector<std::string> alone = {(settings.programs / "pith-bench-tetgen").string(), copy.string(),
                                          fmt::format("{:.17g}", max_volume),
                                          fmt::format("{:.17g}", options.radius_edge)};

  std::vector<double> ours, theirs; // turn by turn, so that both meet the same machine
  std::size_t tets = 0;
  int tets_alone = 0;
  for (int i = 0; i < settings.times(5); ++i) {
    ours.push_back(seconds_of([&] { tets = tetrahedralize(surface, "bunny", options).mesh.tet_count(); }));
    const ProgramResult peer = run_program(alone, true);
    double seconds = 0;
    if (peer.code != 0 || std::sscanf(last_line(peer.output), "result %d %lf", &tets_alone, &seconds) != 2)
      throw std::runtime_error("TetGen alone failed");
    theirs.push_back(seconds);
  }
  return {static_cast<double>(tets) / median(ours),
          fmt::format("{} triangles, {} tets in {:.2f} s; TetGen alone {} tets in {:.2f} s", surface.triangle_count(),
                      tets, median(ours), tets_alone, median(theirs)),
          "TetGen alone", tets_alone / median(theirs)};
}

} // namespace

std::vector<Row> mesh_rows() { return {{"tetrahedralize/bunny", "/s", "≥ 0.9 peer", bunny}}; }

} // namespace pith::bench
