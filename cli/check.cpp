// pith check FILE: is this surface or model usable? Figures, and how to mend what is wrong.
#include "cli/command.h"
#include "cli/pieces_report.h"
#include "recipe/recipe.h"
#include "volume/base/error.h"
#include "volume/field/depth_extrema.h"
#include "volume/io/mesh_io.h"
#include "volume/io/model_io.h"
#include "volume/measure/coverage.h"

#include <cmath>
#include <fmt/format.h>

namespace pith::cli {
namespace {

struct CheckOptions {
  std::filesystem::path file;
  std::size_t points = 200'000;
};

struct Finding {
  std::string what;
  std::size_t count = 0;
  std::string mend;
};

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
  add(defects.border_edges, "border edges (the surface is open)", "fill the holes, or let make wrap the surface");
  add(defects.non_manifold_edges, "edges with more than two triangles",
      "remove inner walls, or let make wrap the surface");
  add(defects.non_manifold_vertices, "vertices where the surface touches itself",
      "split them, or let make wrap the surface");
  add(defects.misoriented_edges, "edges whose triangles face opposite ways", "make normals consistent");
  add(defects.self_intersecting_triangles, "triangles that intersect others",
      "unite the parts, or let make wrap the surface");
  add(defects.inside_out_shells, "shells that are inside out", "flip their normals");

  const bool clean = defects.clean();
  const bool usable = mesh.triangle_count() > 0 && defects.non_finite_vertices == 0;
  session.say(fmt::format("{}: {} triangles, {} shell(s), volume {:.6g} mm³: {}", options.file.string(),
                          mesh.triangle_count(), defects.shells, defects.volume,
                          clean    ? "clean"
                          : usable ? "not clean; make will mend or wrap it"
                                   : "not usable"));
  say(findings, session);
  const Vec3d at = defects.first_defect;
  if (!findings.empty() && at.allFinite())
    session.say(fmt::format("  look near ({:.6g}, {:.6g}, {:.6g})", at.x(), at.y(), at.z()));
  session.print({{"file", options.file.string()},
                 {"kind", "surface"},
                 {"usable", usable},
                 {"clean", clean},
                 {"triangles", mesh.triangle_count()},
                 {"shells", defects.shells},
                 {"volume", defects.volume},
                 {"findings", json_from(findings)},
                 {"first_defect",
                  findings.empty() || !at.allFinite() ? Json(nullptr) : Json::array({at.x(), at.y(), at.z()})}});
  if (!usable) throw InvalidInput(options.file.string(), defects.summary(), "the file is damaged, export it again");
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
         extrema.size(), "leave depth_options/extrema at \"remove\", or give places near them a depth"});
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
                      {"non_manifold_vertices", report.non_manifold_vertices},
                      {"minimum_dihedral", report.minimum_dihedral}});
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
  const CoverageMeasure survey = coverage_measure(
      root, {.points = options.points, .seed = session.seed.value_or(1), .region = -1}, session.progress("check"));
  if (survey.holes > 0)
    findings.push_back(
        {fmt::format("of {} points that something shines through (the worst at ({:.6g}, {:.6g}, {:.6g}), "
                     "coverage {:.4f})",
                     survey.points, survey.worst.x(), survey.worst.y(), survey.worst.z(), survey.least_coverage),
         survey.holes, "make the model again with a higher fill/coverage_order or a larger mask/radius"});
  session.say(fmt::format("  {} random points: {} holes, {} thin (by more than 1/255), least coverage {:.4f}; "
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
  throw InvalidInput(options.file.string(), "is neither a model nor a surface",
                     "give a .pith, .obj, .off, .ply or .stl");
}

} // namespace

Verb check_verb(CLI::App& program) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* app = program.add_subcommand("check", "is a surface or model usable? figures, and how to mend it");
  app->add_option("file", options->file, "MODEL.pith, or a surface")->required();
  app->add_option("--points", options->points, "random points of a model at which holes are looked for")
      ->check(CLI::Range(std::size_t(0), std::size_t(100'000'000)));
  return {app, [options](const Session& session) { run(*options, session); }};
}

} // namespace pith::cli
