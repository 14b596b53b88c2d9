// pith check FILE: is this surface, recipe or model usable? Figures, and how to mend what is wrong.
#include "cli/check.h"
#include "cli/pieces_report.h"
#include "recipe/recipe.h"
#include "volume/base/error.h"
#include "volume/field/depth_extrema.h"
#include "volume/io/mesh_io.h"
#include "volume/io/model_io.h"
#include "volume/measure/coverage.h"
#include "volume/mesh/surface_plan.h"

#include <cmath>
#include <fmt/format.h>

namespace pith::cli {

Json json_from(const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const Finding& finding : findings)
    list.push_back({{"what", finding.what}, {"count", finding.count}, {"mend", finding.mend}});
  return list;
}

void say(const std::vector<Finding>& findings, const Session& session) {
  for (const Finding& finding : findings)
    session.say(fmt::format("  {} {}: {}", finding.count, finding.what, finding.mend));
}

std::string text_of_extent(const Box& box) {
  if (box.empty()) return "nothing";
  const Vec3d size = box.extent();
  return fmt::format("{:.6g} × {:.6g} × {:.6g} mm", size.x(), size.y(), size.z());
}

std::string unit_hint(const Box& box) {
  constexpr double small = 1, large = 5000; // mm
  if (box.empty()) return {};
  const double diagonal = box.diagonal();
  if (diagonal > 0 && diagonal < small)
    return fmt::format("only {:.3g} mm across: is the file in metres? then \"scale\": 1000 in the recipe's "
                       "\"surface\" makes it millimetres",
                       diagonal);
  if (diagonal > large)
    return fmt::format("{:.3g} m across: is the file in micrometres? then \"scale\": 0.001 in the recipe's "
                       "\"surface\" makes it millimetres",
                       diagonal / 1000);
  return {};
}

namespace {

struct CheckOptions {
  std::filesystem::path file;
  std::size_t points = 200'000;
};

/// In words, and as a word for programs.
struct Verdict {
  const char* name;
  std::string words;
  bool usable;
};

Verdict verdict_of(const SurfacePlan& plan) {
  switch (plan.way) {
  case SurfacePlan::Way::as_it_is:
    return {"clean", "clean", true};
  case SurfacePlan::Way::mend:
    return {"mendable",
            plan.moved > 0 ? fmt::format("not clean; make will mend it in place ({})", plan.note)
                           : fmt::format("not clean; make will mend it without moving it ({})", plan.note),
            true};
  case SurfacePlan::Way::wrap:
    return {"wrap", "NOT usable as it is; make would wrap it, so that it moves", false};
  case SurfacePlan::Way::refuse:
    break;
  }
  return {"refuse", "NOT usable; make would refuse it (" + plan.note + ")", false};
}

void check_surface(const CheckOptions& options, const Session& session) {
  const TriMesh mesh = read_tri_mesh(options.file);
  const SurfaceDefects defects = surface_defects(mesh);
  std::vector<Finding> findings;
  const auto add = [&](std::size_t count, const char* what, const char* mend) {
    if (count > 0) findings.push_back({what, count, mend});
  };
  add(defects.non_finite_vertices, "vertices that are not finite", "remove them; the file is damaged");
  add(defects.degenerate_triangles, "triangles without area", "merge vertices that lie at one place");
  add(defects.duplicate_triangles, "triangles that are there twice", "remove the copies");
  add(defects.border_edges, "border edges (the surface is open)", "fill the holes, or let make close or wrap them");
  add(defects.non_manifold_edges, "edges with more than two triangles",
      "remove inner walls, or let make wrap the surface");
  add(defects.non_manifold_vertices, "vertices where the surface touches itself",
      "split them, or let make wrap the surface");
  add(defects.misoriented_edges, "edges whose triangles face opposite ways", "make normals consistent");
  add(defects.self_intersecting_triangles, "triangles that intersect others",
      "unite the parts, or let make wrap the surface");
  add(defects.inside_out_shells, "shells that are inside out", "flip their normals");

  session.stop_if_asked();
  const SurfacePlan plan = surface_plan(mesh, options.file.filename().string());
  const Verdict verdict = verdict_of(plan);
  const Box bounds = bounds_of(mesh);
  const std::string hint = unit_hint(bounds);
  session.say(fmt::format("{}: {} triangles, {} shell(s), {}, volume {:.6g} mm³: {}", options.file.string(),
                          mesh.triangle_count(), defects.shells, text_of_extent(bounds), defects.volume,
                          verdict.words));
  say(findings, session);
  const Vec3d at = defects.first_defect;
  if (!findings.empty() && at.allFinite())
    session.say(fmt::format("  look near ({:.6g}, {:.6g}, {:.6g})", at.x(), at.y(), at.z()));
  if (!hint.empty()) session.say("  " + hint);
  const Vec3d extent = bounds.empty() ? Vec3d::Zero() : Vec3d(bounds.extent());
  session.print({{"file", options.file.string()},
                 {"kind", "surface"},
                 {"usable", verdict.usable},
                 {"verdict", verdict.name},
                 {"clean", defects.clean()},
                 {"triangles", mesh.triangle_count()},
                 {"shells", defects.shells},
                 {"extent", {extent.x(), extent.y(), extent.z()}},
                 {"unit_hint", hint},
                 {"volume", defects.volume},
                 {"mended", plan.way == SurfacePlan::Way::mend ? plan.note : ""},
                 {"moved", plan.moved},
                 {"findings", json_from(findings)},
                 {"first_defect",
                  findings.empty() || !at.allFinite() ? Json(nullptr) : Json::array({at.x(), at.y(), at.z()})}});
  if (!verdict.usable)
    throw InvalidInput(options.file.string(), plan.note,
                       plan.way == SurfacePlan::Way::wrap ? "repair the surface, or accept that make wraps it"
                                                          : "give a closed surface that encloses a volume");
}

/// Local extrema of the depth of each solid that none of its constraints asks for.
std::vector<Finding> depth_findings(const ModelFile& file) {
  std::vector<Finding> findings;
  const Model& model = file.model;
  if (file.recipe.empty() || model.field.depth.size() != model.mesh.vertex_count()) return findings;
  const Recipe recipe = parse_recipe(file.recipe, "recipe.json");
  for (const Solid& solid : recipe.solids) {
    if (solid.depth.empty()) continue;
    const PerVertex<std::uint8_t> constrained =
        constrained_vertices(model.mesh, model.boundary, solid.region, solid.depth, "depth", solid.depth_options);
    const std::vector<DepthExtremum> extrema = extrema_of(model.mesh, solid.region, model.field.depth, constrained,
                                                          std::max(solid.depth_options.persistence, 1e-3));
    if (extrema.empty()) continue;
    const DepthExtremum& worst = extrema.front();
    findings.push_back(
        {fmt::format("local extrema of depth in region {} that no constraint asks for (the worst: a {} "
                     "of {:.3g} at ({:.6g}, {:.6g}, {:.6g}) that persists by {:.3g})",
                     solid.region, worst.maximum ? "maximum" : "minimum", worst.depth, worst.place.x(),
                     worst.place.y(), worst.place.z(), worst.persistence),
         extrema.size(),
         solid.depth_options.remove_extrema
             ? "give places near them a depth"
             : "leave depth_options/extrema at \"remove\", or give places near them a depth"});
  }
  return findings;
}

void check_model(const CheckOptions& options, const Session& session) {
  ModelFile file = read_model(options.file);
  std::vector<Finding> findings;
  Json pieces = Json::array();
  double volume = 0;
  for (std::uint32_t piece = 0; piece < file.pieces.piece.size(); ++piece) {
    session.stop_if_asked();
    const PieceReport report = report_of(file.pieces, piece, file.model);
    volume += report.volume;
    const std::string name = "of piece " + std::to_string(piece);
    if (!report.watertight())
      findings.push_back(
          {"border edges " + name, report.border_edges, "cut again with a larger snap, or report the cut"});
    pieces.push_back({{"volume", report.volume},
                      {"triangles", report.triangles},
                      {"watertight", report.watertight()},
                      {"manifold", report.manifold()},
                      {"non_manifold_edges", report.non_manifold_edges},
                      {"non_manifold_vertices", report.non_manifold_vertices}});
    if (report.cut_tets > 0) pieces.back()["minimum_dihedral"] = report.minimum_dihedral;
    session.say(fmt::format("  piece {}: {:.6g} mm³, {} triangles, {}, {}", piece, report.volume, report.triangles,
                            report.watertight() ? "watertight" : "NOT watertight",
                            report.manifold()
                                ? "manifold"
                                : fmt::format("{} non-manifold edges, {} non-manifold vertices",
                                              report.non_manifold_edges, report.non_manifold_vertices)));
  }
  for (Finding& finding : depth_findings(file)) findings.push_back(std::move(finding));
  double root_volume = 0;
  for (const TetId tet : all_ids<TetId>(file.model.mesh.tet_count()))
    root_volume += signed_volume(file.model.mesh, tet);

  const Root root(std::move(file.model));
  const CoverageMeasure survey =
      coverage_measure(root, {.points = options.points, .seed = session.seed.value_or(1), .region = -1, .hole = 0.95},
                       session.progress("check"));
  if (survey.holes > 0)
    findings.push_back(
        {fmt::format("of {} points with a coverage below 0.95 (the worst at ({:.6g}, {:.6g}, {:.6g}), "
                     "coverage {:.4f})",
                     survey.points, survey.worst.x(), survey.worst.y(), survey.worst.z(), survey.least_coverage),
         survey.holes, "make the model again with a higher fill/coverage_order or a larger mask/radius"});
  session.say(fmt::format("  {} random points: {} holes (coverage below 0.95), {} thin (below 254/255), least "
                          "coverage {:.4f}; "
                          "look-ups read per point: median {}, "
                          "p99 {}, most {}",
                          survey.points, survey.holes, survey.thin, survey.least_coverage, survey.median_reads,
                          survey.p99_reads, survey.most_reads));
  session.say(fmt::format("  volume of the pieces {:.9g} mm³, of the root {:.9g} mm³", volume, root_volume));
  say(findings, session);
  session.print({{"file", options.file.string()},
                 {"kind", "model"},
                 {"usable", findings.empty()},
                 {"findings", json_from(findings)},
                 {"pieces", std::move(pieces)},
                 {"volume", volume},
                 {"root_volume", root_volume},
                 {"points", survey.points},
                 {"holes", survey.holes},
                 {"thin", survey.thin},
                 {"least_coverage", survey.least_coverage},
                 {"median_lookups_read", survey.median_reads},
                 {"p99_lookups_read", survey.p99_reads},
                 {"most_lookups_read", survey.most_reads}});
  if (!findings.empty())
    throw InvalidInput(options.file.string(), std::to_string(findings.front().count) + " " + findings.front().what,
                       findings.front().mend);
}

void run(const CheckOptions& options, const Session& session) {
  const std::string extension = extension_of(options.file);
  if (extension == "pith") return check_model(options, session);
  if (extension == "obj" || extension == "off" || extension == "ply" || extension == "stl")
    return check_surface(options, session);
  if (extension == "json") return check_recipe(options.file, session);
  throw InvalidInput(options.file.string(), "is neither a model nor a surface nor a recipe",
                     "give a .pith, .obj, .off, .ply, .stl or .json");
}

} // namespace

Verb check_verb(CLI::App& program) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* app =
      program.add_subcommand("check", "is a surface, recipe or model usable? figures, and how to mend it");
  app->description("is a surface, recipe or model usable? figures, and how to mend it.\n"
                   "Exit code 0: a surface that make takes as it is or mends in place; a recipe without findings; a "
                   "model whose pieces are closed and have no holes (coverage below 0.95 at a random point; thinner "
                   "places are counted only). 1: a surface that make would wrap or refuse; otherwise not usable.");
  app->add_option("file", options->file, "a surface (.obj, .off, .ply, .stl), RECIPE.json or MODEL.pith")->required();
  app->add_option("--points", options->points, "random points of a model at which holes are looked for")
      ->check(CLI::Range(std::size_t(0), std::size_t(100'000'000)))
      ->capture_default_str();
  return {app, [options](const Session& session) { run(*options, session); }};
}

} // namespace pith::cli
