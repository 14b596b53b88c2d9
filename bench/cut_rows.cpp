// cut/*: a level set's values given, until both halves are there.
#include "bench/fixtures.h"
#include "bench/program.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/cut/cut.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <numbers>
#include <variant>

namespace pith::bench {
namespace {

/// The first stroke of a recipe; where it has none, a wavy one across its picture.
StrokeCut stroke_of(const BuiltRecipe& built) {
  for (const CutStep& step : built.recipe.cuts)
    if (const auto* stroke = std::get_if<StrokeCut>(&step.shape)) return *stroke;
  const Box box = bounds_of(built.result.model.mesh);
  StrokeCut stroke;
  stroke.view = {.eye = box.center() + Vec3d(0, 0, 3 * box.diagonal()), .target = box.center()};
  for (int i = -10; i <= 10; ++i) stroke.point.push_back({0.1 * i, 0.02 * std::sin(0.5 * i)});
  return stroke;
}

Measured kiwi(const Settings& settings) {
  const BuiltRecipe built = built_recipe(settings, "table1/kiwi.json");
  const TetMesh& root = built.result.model.mesh;
  const Boundary& boundary = built.result.model.boundary;
  const auto field = level_set_of(stroke_of(built));
  std::vector<double> value(root.vertex_count());
  field->values({root.position.data(), root.position.size()}, value);

  const Pieces whole = whole_piece(root);
  Pieces pieces;
  Cutter cutter(root, boundary);
  std::size_t triangles = 0, tets_cut = 0;
  const auto time = [&](const LevelSet* level_set, bool surfaces) {
    return 1e3 * median_seconds(
                     settings.times(101), [&] { pieces = whole; },
                     [&] {
                       tets_cut = cutter.cut_by_values(pieces, value, level_set).tets_cut;
                       if (!surfaces) return;
                       triangles = 0;
                       for (std::uint32_t p = 0; p < pieces.piece.size(); ++p)
                         triangles += surface_of(pieces, p, root, boundary).triangle.size();
                     });
  };
  const double by_values = time(nullptr, true), pieces_alone = time(nullptr, false), exact = time(field.get(), true);
  return {by_values,
          fmt::format("{} tets, {} cut; the pieces {:.3f} ms, with their surfaces ({} triangles) {:.3f} ms; with "
                      "the stroke's true zeros and normals {:.3f} ms",
                      root.tet_count(), tets_cut, pieces_alone, triangles, by_values, exact)};
}

/// What VTK takes for the same: its program, where it was built.
std::optional<double> vtk_milliseconds(const Settings& settings, const TetMesh& root, std::span<const double> value,
                                       int times) {
  const std::filesystem::path program = settings.programs / "pith-bench-vtk";
  if (!std::filesystem::exists(program)) return {};
  const ScratchFolder folder(std::filesystem::temp_directory_path());
  const std::filesystem::path path = folder.path() / "cube.bin";
  {
    std::ofstream file(path, std::ios::binary);
    const auto put = [&](const auto& one) { file.write(reinterpret_cast<const char*>(&one), sizeof one); };
    put(std::uint64_t(root.vertex_count()));
    put(std::uint64_t(root.tet_count()));
    for (std::size_t v = 0; v < root.vertex_count(); ++v) {
      const Vec3d& x = root.position[VertexId(v)];
      for (const double number : {x.x(), x.y(), x.z(), value[v]}) put(number);
    }
    for (const auto& corner : root.corner)
      for (const VertexId v : corner) put(v.value);
  }
  const ProgramResult peer = run_program({program.string(), path.string(), std::to_string(times)}, true);
  long long tets = 0;
  double seconds = 0;
  const std::size_t at = peer.output.rfind("result ");
  if (peer.code != 0 || at == std::string::npos ||
      std::sscanf(peer.output.c_str() + at, "result %lld %lf", &tets, &seconds) != 2)
    throw std::runtime_error("VTK's clipper failed");
  return 1e3 * seconds;
}

Measured sphere_1m(const Settings& settings) {
  constexpr int cells = 55;
  const TetMesh root = jittered_cube(cells);
  const Boundary boundary = boundary_of(root);
  const auto field = level_set_of(SphereCut{.center = Vec3d::Constant(0.5 * cells), .radius = 0.3 * cells});
  std::vector<double> value(root.vertex_count());
  field->values({root.position.data(), root.position.size()}, value);
  const Pieces whole = whole_piece(root);
  Pieces pieces;
  Cutter cutter(root, boundary);
  std::size_t tets_cut = 0;
  const auto time_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return median_seconds(
        settings.times(21), [&] { pieces = whole; },
        [&] { tets_cut = cutter.cut_by_values(pieces, value, field.get()).tets_cut; });
  };
  const double all = 1e3 * time_with(0), one = 1e3 * time_with(1);
  const std::optional<double> vtk = vtk_milliseconds(settings, root, value, settings.times(7));
  return {all,
          fmt::format("{} tets, {} cut; 1 thread {:.2f} ms{}", root.tet_count(), tets_cut, one,
                      vtk ? fmt::format("; {:.3f} of the peer", all / *vtk) : ""),
          vtk ? "VTK clip, both halves" : "", vtk};
}

/// A stroke of 500 samples across a cube of 200,000 vertices, from its points to surfaces that can be drawn.
Measured stroke_200k(const Settings& settings) {
  constexpr int cells = 58;
  const TetMesh root = jittered_cube(cells);
  const Boundary boundary = boundary_of(root);
  const Vec3d middle = Vec3d::Constant(0.5 * cells);
  StrokeCut stroke;
  stroke.view = {.eye = middle + Vec3d(10, -30, 4 * cells), .target = middle};
  for (int i = 0; i < 500; ++i) {
    const double t = i / 499.0 - 0.5;
    stroke.point.push_back({1.2 * t, 0.08 * std::sin(20 * t) + 0.03 * std::cos(47 * t)});
  }
  Cutter cutter(root, boundary);
  const Pieces whole = whole_piece(root);
  Pieces pieces;
  std::size_t tets_cut = 0, triangles = 0;
  double fitted = 0, cut_too = 0;
  const double all = 1e3 * median_seconds(
                               settings.times(21), [&] { pieces = whole; },
                               [&] {
                                 const double begin = thread_seconds();
                                 const auto field = level_set_of(stroke);
                                 fitted = 1e3 * (thread_seconds() - begin);
                                 tets_cut = cutter.cut(pieces, *field).tets_cut;
                                 cut_too = 1e3 * (thread_seconds() - begin);
                                 triangles = 0;
                                 std::vector<std::size_t> made(pieces.piece.size());
                                 parallel_for(made.size(), 1, [&](std::size_t p) {
                                   made[p] = surface_of(pieces, p, root, boundary).triangle.size();
                                 });
                                 for (const std::size_t one : made) triangles += one;
                               });
  return {all,
          fmt::format("{} vertices, {} tets, {} cut, {} triangles; of one thread's time: fitting {:.2f} ms, cutting "
                      "{:.2f} ms",
                      root.vertex_count(), root.tet_count(), tets_cut, triangles, fitted, cut_too - fitted)};
}

/// A piece of 1 % of a million tets is cut again.
Measured recut_1m(const Settings& settings) {
  constexpr int cells = 55;
  const TetMesh root = jittered_cube(cells);
  const Boundary boundary = boundary_of(root);
  const double prepared = median_seconds(settings.times(3), {}, [&] { keep(Cutter(root, boundary)); });
  Cutter cutter(root, boundary);
  const Vec3d middle = Vec3d::Constant(0.5 * cells);
  const double radius = std::cbrt(0.01 * 3 / (4 * 3.14159265)) * cells;
  Pieces small = whole_piece(root);
  cutter.cut(small, *level_set_of(SphereCut{middle, radius}));
  const auto field = level_set_of(PlaneCut{{1, 2, 3}, Vec3d(1, 2, 3).dot(middle) + 1});
  Pieces pieces;
  std::size_t tets_cut = 0;
  const double all = 1e3 * median_seconds(
                               settings.times(51), [&] { pieces = small; },
                               [&] { tets_cut = cutter.cut(pieces, *field, {.only = {0}}).tets_cut; });
  return {all, fmt::format("{} tets, the piece {}, {} cut; the Cutter made once in {:.2f} s", root.tet_count(),
                           measure(small, 0, root).whole_tets + small.piece[0].cut.size(), tets_cut, prepared)};
}

/// What a hundred random planes in a row leave.
struct Hundred {
  double growth = 0;
  std::string note;
};

/// Each plane cuts all pieces, or the largest alone.
Hundred hundred_planes(const TetMesh& root, double size, double snap, bool largest_alone) {
  const Boundary boundary = boundary_of(root);
  Cutter cutter(root, boundary);
  Pieces pieces = whole_piece(root);
  Random random(71, 0);
  double seconds = 0;
  std::vector<Vec3d> normal;
  std::vector<double> offset, volume = {size * size * size};
  for (int k = 0; k < 100; ++k) {
    CutOptions options{.only = {}, .snap = snap};
    Vec3d n(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    n.normalize();
    Vec3d through = Vec3d(random.uniform(0.2, 0.8), random.uniform(0.2, 0.8), random.uniform(0.2, 0.8)) * size;
    if (largest_alone) {
      for (std::size_t p = volume.size() < pieces.piece.size() ? volume.size() : 0; p < pieces.piece.size(); ++p) {
        volume.resize(std::max(volume.size(), p + 1));
        volume[p] = measure(pieces, static_cast<std::uint32_t>(p), root).volume;
      }
      options.only = {static_cast<std::uint32_t>(std::max_element(volume.begin(), volume.end()) - volume.begin())};
      through = measure(pieces, options.only[0], root).centroid;
    }
    normal.push_back(n);
    offset.push_back(n.dot(through));
    seconds += seconds_of([&] { cutter.cut(pieces, *level_set_of(PlaneCut{n, offset[k]}), options); });
    if (largest_alone) volume[options.only[0]] = measure(pieces, options.only[0], root).volume;
  }
  std::size_t tets = 0;
  double dihedral = 4, off = 0, sum = 0, smallest = 1e300;
  const std::vector<PieceMeasure> measured = measures_of(pieces, root);
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    tets += measured[p].whole_tets + measured[p].cut_tets;
    dihedral = std::min(dihedral, measured[p].minimum_dihedral);
    sum += measured[p].volume;
    for (const CutTet& tet : pieces.piece[p].cut) {
      std::array<Vec3d, 4> x;
      for (int i = 0; i < 4; ++i) x[i] = pieces.position(root, tet.corner[i]);
      smallest = std::min(smallest, (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6);
      for (int i = 0; i < 4; ++i)
        for (const int v : facet_corners[i]) {
          if (!tet.face[i].is_section()) continue;
          const std::uint32_t k = tet.face[i].cut().value;
          off = std::max(off, std::abs(normal[k].dot(x[v]) - offset[k]));
        }
    }
  }
  const double whole = measure(whole_piece(root), 0, root).volume;
  const double growth = static_cast<double>(tets) / static_cast<double>(root.tet_count());
  return {growth,
          fmt::format(
              "×{:.2f}, {} pieces, smallest dihedral {:.2g}° and volume {:.2g} mm³, sections flat to {:.2g} of the "
              "diagonal, volumes sum to the whole within {:.1g}, {:.1f} ms a cut",
              growth, pieces.piece.size(), dihedral * 180 / std::numbers::pi, smallest, off / (std::sqrt(3.0) * size),
              std::abs(sum / whole - 1), 10 * seconds)};
}

Measured hundred_1m(const Settings&) {
  constexpr int cells = 55;
  const TetMesh root = jittered_cube(cells);
  const Hundred all = hundred_planes(root, cells, 0.01, false), snapped = hundred_planes(root, cells, 0.2, false),
                one = hundred_planes(root, cells, 0.01, true);
  return {all.growth, "through all pieces: " + all.note + "; with snap 0.2: " + snapped.note +
                          "; through the largest alone: " + one.note};
}

} // namespace

std::vector<Row> cut_rows() {
  return {{"cut/kiwi", "ms", "≤ 0.2", kiwi},
          {"cut/sphere_1m", "ms", "≤ 12, 0.1 peer", sphere_1m},
          {"cut/stroke_200k", "ms", "≤ 50", stroke_200k},
          {"cut/recut_1m", "ms", "≤ 1", recut_1m},
          {"cut/hundred_1m", "×", "≤ 6", hundred_1m}};
}

} // namespace pith::bench
