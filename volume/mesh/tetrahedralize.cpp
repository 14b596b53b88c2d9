// The way from a surface to tets: mend what can be mended in place, check, TetGen; else wrap, then TetGen on the
// wrap.
#include "volume/mesh/tetrahedralize.h"

#include "volume/base/error.h"
#include "volume/mesh/boundary.h"
#include "volume/mesh/surface_defects_intersections.h"
#include "volume/mesh/surface_plan.h"
#include "volume/mesh/surface_size.h"
#include "volume/mesh/tetrahedralize_regions.h"
#include "volume/mesh/tetrahedralize_tetgen.h"
#include "volume/mesh/tetrahedralize_wrap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

namespace pith {
namespace {

constexpr double most_tets = 100e6;
constexpr double wrap_seconds = 2e-4; // per square of edge alpha: about what CGAL needs
constexpr double patience = 600;      // seconds of wrapping that are granted under any time limit
constexpr double most_moved =
    0.03; // of the diagonal: what cutting out faults may cost outside, before wrapping is the better way

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void join(std::string& note, const std::string& more) {
  if (more.empty()) return;
  if (!note.empty()) note += "; ";
  note += more;
}

void comma(std::string& list, const std::string& more) { list += list.empty() ? more : ", " + more; }

void check_input(const TriMesh& mesh, const std::string& name, const TetrahedralizeOptions& options) {
  if (mesh.corner.empty()) throw InvalidInput(name, "the surface has no triangles", "give a closed surface");
  for (const TriangleId t : all_ids<TriangleId>(mesh.triangle_count()))
    for (const VertexId v : mesh.corner[t]) {
      if (v.value >= mesh.vertex_count())
        throw InvalidInput(name,
                           "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + " of " +
                               std::to_string(mesh.vertex_count()),
                           "export the mesh again");
      if (!mesh.position[v].allFinite())
        throw InvalidInput(name, "vertex " + std::to_string(v) + " is not finite", "export the mesh again");
    }
  require_usable_size(mesh, name);
  const auto at_least = [&](double value, double least, const char* field) {
    if (!(value >= least) || !std::isfinite(value))
      throw InvalidInput(name, std::string(field) + " is " + short_number(value),
                         "give a finite number of at least " + short_number(least));
  };
  at_least(options.interior_edge, 0, "interior_edge");
  at_least(options.boundary_edge, 0, "boundary_edge");
  at_least(options.core_edge, 0, "core_edge");
  at_least(options.core_growth, 0.01, "core_growth");
  at_least(options.radius_edge, 1.1, "radius_edge");
  at_least(options.wrap_alpha, 1e-4, "wrap_alpha");
  at_least(options.wrap_offset, 1e-5, "wrap_offset");
  at_least(options.time_limit, 0, "time_limit");
}

double mean_edge(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& c : mesh.corner)
    for (int k = 0; k < 3; ++k) sum += (mesh.position[c[(k + 1) % 3]] - mesh.position[c[k]]).norm();
  return sum / (3 * static_cast<double>(mesh.triangle_count()));
}

double area_of(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& c : mesh.corner)
    sum += 0.5 * (mesh.position[c[1]] - mesh.position[c[0]]).cross(mesh.position[c[2]] - mesh.position[c[0]]).norm();
  return sum;
}

/// Turns the triangles of `original` to face away from material, as those of `ready` do once cavities are turned
/// back.
void face_away_from_material(const surface::Repaired& ready, const surface::Regions& regions, TriMesh& original) {
  const auto area = [](const TriMesh& mesh, TriangleId triangle) {
    const auto& c = mesh.corner[triangle];
    return Vec3d((mesh.position[c[1]] - mesh.position[c[0]]).cross(mesh.position[c[2]] - mesh.position[c[0]]));
  };
  for (const TriangleId t : all_ids<TriangleId>(ready.mesh.triangle_count())) {
    const TriangleId source = ready.source[t];
    const bool against = area(ready.mesh, t).dot(area(original, source)) < 0;
    const bool cavity = regions.region[regions.shell[t]] < 0;
    if (against != cavity) std::swap(original.corner[source][1], original.corner[source][2]);
  }
}

/// Tets inside a clean surface; fills `mesh` and `input` of the result. Returns why not, or nothing.
/// `meanwhile` runs beside TetGen; when it returns false TetGen is stopped and nothing else is tried.
std::string fill_clean(surface::Repaired ready, const std::string& name, const TetrahedralizeOptions& options,
                       const Progress& progress, TetrahedralizeResult& result,
                       const std::function<bool()>& meanwhile = {}) {
  surface::drop_unused_vertices(ready.mesh);
  if (options.boundary_edge > 0) surface::split_long_edges(ready, options.boundary_edge, name);
  std::size_t turned = 0;
  const surface::Regions regions = surface::outward_with_regions(ready.mesh, turned);
  if (turned > 0)
    join(result.note,
         std::to_string(turned) + (turned == 1 ? " shell was" : " shells were") + " inside out and turned");

  face_away_from_material(ready, regions, result.surface);

  double edge = options.interior_edge;
  if (edge == 0) edge = std::min(12 * mean_edge(ready.mesh), bounds_of(ready.mesh).diagonal() / 12);
  tetgen::Settings settings;
  settings.max_volume = edge * edge * edge / (6 * std::sqrt(2.0)); // of the regular tet
  settings.radius_edge = options.radius_edge;
  settings.time_limit = options.time_limit;
  settings.helper = options.helper;
  if (options.core_edge > 0 && options.core_edge < edge)
    for (const std::vector<Vec3d>& line : options.core)
      for (std::size_t k = 1; k < line.size(); ++k) settings.core.push_back({line[k - 1], line[k]});
  settings.core_edge = options.core_edge;
  settings.core_growth = options.core_growth;
  double tets = std::abs(signed_volume(ready.mesh)) / settings.max_volume;
  if (tets > most_tets)
    throw InvalidInput(name,
                       "an interior edge of " + short_number(edge) + " mm would make " + short_number(tets) + " tets",
                       "ask for a longer interior edge");
  for (const auto& [a, b] : settings.core) // ∫ 2πr dr over the volume of a regular tet, its edge growing with r
    tets += (b - a).norm() * 6 * std::sqrt(2.0) * std::numbers::pi /
            (options.core_growth * options.core_growth * options.core_edge);
  if (tets > most_tets)
    throw InvalidInput(
        name, "a core edge of " + short_number(options.core_edge) + " mm would make " + short_number(tets) + " tets",
        "ask for a longer core edge, or a faster growth");

  // First with good shapes; where that fails (or leaves a tet without volume) with the size bound alone, then plain.
  std::string failure;
  for (int attempt = 0; attempt < 3; ++attempt) {
    if (attempt == 1) settings.radius_edge = 0;
    if (attempt == 2) settings.max_volume = 0;
    tetgen::Outcome outcome = tetgen::run(ready.mesh, settings, progress, attempt == 0 ? meanwhile : nullptr);
    std::string wrong = outcome.failure;
    if (outcome.stopped) return wrong;
    TetMesh mesh;
    std::vector<TriangleId> input;
    if (wrong.empty()) {
      mesh.position = std::move(outcome.position);
      mesh.corner = std::move(outcome.corner);
      try {
        wrong = surface::label_tets(ready.mesh, regions, mesh, input);
      } catch (const InvalidInput& error) { // tets that overlap
        wrong = error.what();
      }
    }
    if (wrong.empty()) {
      result.input.clear();
      for (const TetId t : all_ids<TetId>(mesh.tet_count()))
        for (int i = 0; i < 4; ++i) { // as boundary_of numbers the facets
          const TetId behind = mesh.neighbor[t][i];
          if (behind.exists() && mesh.region[behind] == mesh.region[t]) continue;
          result.input.push_back(ready.source[input[4 * std::size_t(t) + i]]);
        }
      result.mesh = std::move(mesh);
      if (attempt > 0) join(result.note, "tets are of poor shape, as TetGen could not refine them (" + failure + ")");
      return {};
    }
    if (attempt == 0) failure = wrong;
  }
  return failure;
}

/// Whether every part of the original that lies far from the mended surface is buried inside it (crumbs, inner
/// walls).
bool nothing_lost(const TriMesh& original, const TriMesh& mended) {
  surface::Shell all;
  for (const TriangleId t : all_ids<TriangleId>(mended.triangle_count())) all.triangle.push_back(t);
  const double limit = most_moved * bounds_of(original).diagonal();
  const std::vector<Vec3d> far = wrap::samples_farther(original, mended, limit);
  if (far.size() * mended.triangle_count() > 20'000'000) return false; // too much is gone to look at it all
  return std::all_of(far.begin(), far.end(),
                     [&](const Vec3d& p) { return std::abs(surface::winding_number(mended, all, p)) > 0.5; });
}

/// A wrap that has an inside worth the name, with a wider alpha where the surface's holes let the wrap in.
TriMesh solid_wrap(const TriMesh& mesh, const std::string& name, const TetrahedralizeOptions& options,
                   double& alpha_used) {
  const double diagonal = bounds_of(mesh).diagonal(), offset = options.wrap_offset * diagonal;
  // CGAL cannot be stopped, so its time is estimated: a wrap has some triangles of size alpha along the whole
  // surface.
  const double cells = std::min(area_of(mesh), diagonal * diagonal) / std::pow(options.wrap_alpha * diagonal, 2);
  if (const double most = std::max(patience, options.time_limit) / wrap_seconds; cells > most)
    throw InvalidInput(name,
                       "a wrap with wrap_alpha " + short_number(options.wrap_alpha) + " would have about " +
                           short_number(cells) + " triangles, more than the " + short_number(most) +
                           " that the time limit allows",
                       "give a wrap_alpha above " + short_number(options.wrap_alpha * std::sqrt(cells / most)) +
                           ", or repair the surface");
  bool any = false;
  for (const double wider : {1.0, 2.0, 4.0, 8.0}) {
    alpha_used = wider * options.wrap_alpha * diagonal;
    TriMesh wrap = wrap::wrapped(mesh, alpha_used, offset);
    if (wrap.corner.empty()) continue;
    any = true;
    // Around a mere sheet the wrap is a pillow 2 · offset thick: volume = offset · area.
    if (signed_volume(wrap) > 1.5 * offset * area_of(wrap)) return wrap;
  }
  if (!any) throw SolverFailure(name + ": neither TetGen nor CGAL's alpha wrap can take the surface");
  throw InvalidInput(
      name, "the surface encloses no volume, even with holes up to " + short_number(alpha_used) + " mm closed",
      "give a closed surface");
}

/// `original` is what distances are measured from; `mesh`, the same with its holes closed, is what is wrapped.
void mesh_wrap(const TriMesh& original, const TriMesh& mesh, const std::string& name, const std::string& reason,
               const TetrahedralizeOptions& options, const Progress& progress, TetrahedralizeResult& result) {
  double alpha = 0;
  report(progress, 0.05);
  TriMesh wrap = solid_wrap(mesh, name, options, alpha);
  report(progress, 0.4);
  result.surface = wrap;
  result.method = "wrap";
  result.surface_moved = wrap::largest_distance(original, wrap);
  result.note = reason;
  join(result.note, "wrapped instead, closing holes up to " + short_number(alpha) +
                        " mm: the surface moved by up to " + short_number(result.surface_moved) +
                        " mm, and no part of the new one is farther than " +
                        short_number(wrap::largest_distance(wrap, original)) + " mm from the old");
  surface::Repaired ready;
  for (const TriangleId t : all_ids<TriangleId>(wrap.triangle_count())) ready.source.push_back(t);
  ready.mesh = std::move(wrap);
  const Progress rest = progress ? Progress([&](double f) { return progress(0.4 + 0.6 * f); }) : Progress();
  const std::string failure = fill_clean(std::move(ready), name, options, rest, result);
  if (!failure.empty())
    throw SolverFailure(name + ": the surface cannot be filled (" + reason + "), nor can its wrap: " + failure);
}

/// A surface with its holes closed and a few faults cut out, as far as that goes.
struct Mended {
  surface::Repaired ready, uncut; ///< uncut: before faults were cut out, for the wrap
  SurfaceDefects defects;         ///< of `ready`
  std::string note;               ///< what was done
  double moved = 0;               ///< mm
};

Mended mended(const TriMesh& input, surface::Repaired ready, SurfaceDefects defects) {
  Mended result{.ready = std::move(ready), .uncut = {}, .defects = defects, .note = {}};
  result.note = result.ready.note;
  double widest = 0;
  const std::size_t holes = defects.border_edges > 0 ? surface::close_holes(result.ready, widest) : 0;
  if (holes > 0) {
    surface::mend(result.ready);
    comma(result.note, (holes == 1 ? "1 hole" : std::to_string(holes) + " holes") + " closed, up to " +
                           short_number(widest) + " mm across");
    result.defects = surface_defects(result.ready.mesh);
  }
  result.uncut = result.ready;
  if (surface::can_be_filled(result.defects)) return result;
  const std::size_t cut_out = surface::cut_out_faults(result.ready);
  if (cut_out == 0) return result;
  result.moved = wrap::largest_distance(input, result.ready.mesh);
  if (nothing_lost(input, result.ready.mesh)) {
    result.defects = surface_defects(result.ready.mesh);
    comma(result.note, std::to_string(cut_out) +
                           " triangles at fault cut out and closed, which moved the surface by up to " +
                           short_number(result.moved) + " mm");
  }
  return result;
}

} // namespace

TetrahedralizeResult tetrahedralize(const TriMesh& input, const std::string& name,
                                    const TetrahedralizeOptions& options, const Progress& progress) {
  check_input(input, name, options);
  report(progress, 0);
  surface::Repaired ready = surface::repaired(input);
  const PerTriangle<char> collinear = surface::collinear_triangles(ready.mesh);
  if (std::count(collinear.begin(), collinear.end(), 1) == std::ptrdiff_t(collinear.size()))
    throw InvalidInput(name, "all of its " + std::to_string(input.triangle_count()) + " triangles are degenerate",
                       "give a closed surface that encloses a volume");

  TetrahedralizeResult result;
  using Method = TetrahedralizeOptions::Method;
  if (options.method == Method::wrap) {
    mesh_wrap(input, ready.mesh, name, "a wrap was asked for", options, progress, result);
    return result;
  }
  // Where all else is in order, self-intersections are looked for while TetGen already works.
  SurfaceDefects defects = surface::defects_but_intersections(ready.mesh);
  if (surface::can_be_filled(defects)) {
    bool crossing = false;
    result.surface = input;
    result.method = "tetgen";
    if (!ready.note.empty()) result.note = "mended in place: " + ready.note;
    const std::string failure = fill_clean(ready, name, options, progress, result, [&] {
      const PerTriangle<char> found = surface::intersecting_triangles(ready.mesh, collinear);
      crossing = std::count(found.begin(), found.end(), 1) > 0;
      return !crossing;
    });
    if (failure.empty()) return result;
    result = {};
    if (!crossing) { // a clean surface that is beyond TetGen
      if (options.method == Method::tetgen) throw SolverFailure(name + ": " + failure);
      mesh_wrap(input, ready.mesh, name, failure, options, progress, result);
      return result;
    }
  }
  defects = surface_defects(ready.mesh);
  if (options.method == Method::tetgen)
    throw InvalidInput(name, "the surface has " + defects.summary(), "repair the surface, or allow pith to mend it");
  const std::string fault = "the surface has " + defects.summary();
  Mended mend = mended(input, std::move(ready), defects);

  std::string reason = fault;
  if (surface::can_be_filled(mend.defects)) {
    result.surface = input;
    result.method = "tetgen";
    result.note = fault;
    if (!mend.note.empty()) join(result.note, "mended in place: " + mend.note);
    surface::append_added(mend.ready, result.surface);
    result.surface_moved = mend.moved;
    const std::string failure = fill_clean(mend.ready, name, options, progress, result);
    if (failure.empty()) return result;
    join(reason, failure);
  }
  result = {};
  mesh_wrap(input, mend.uncut.mesh, name, reason, options, progress, result);
  return result;
}

SurfacePlan surface_plan(const TriMesh& surface, const std::string& name) {
  SurfacePlan plan;
  try {
    check_input(surface, name, {});
    surface::Repaired ready = surface::repaired(surface);
    const PerTriangle<char> collinear = surface::collinear_triangles(ready.mesh);
    if (std::count(collinear.begin(), collinear.end(), 1) == std::ptrdiff_t(collinear.size())) {
      plan = {SurfacePlan::Way::refuse, 0, "all of its triangles are degenerate"};
      return plan;
    }
    const SurfaceDefects defects = surface_defects(ready.mesh);
    if (surface::can_be_filled(defects)) {
      const bool turned = defects.inside_out_shells > 0;
      plan.way = ready.note.empty() && !turned ? SurfacePlan::Way::as_it_is : SurfacePlan::Way::mend;
      plan.note = ready.note;
      if (turned) comma(plan.note, "inside-out shells turned");
      return plan;
    }
    const Mended mend = mended(surface, std::move(ready), defects);
    const bool filled = surface::can_be_filled(mend.defects);
    plan.way = filled ? SurfacePlan::Way::mend : SurfacePlan::Way::wrap;
    plan.moved = filled ? mend.moved : 0;
    plan.note = filled ? mend.note : "the surface has " + defects.summary();
  } catch (const InvalidInput& error) {
    plan = {SurfacePlan::Way::refuse, 0, error.what()};
  }
  return plan;
}

} // namespace pith
