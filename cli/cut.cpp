// pith cut MODEL.pith (--plane nx,ny,nz,d | --sphere x,y,z,r | --stroke S.json)... -o OUT.pith
#include "cli/command.h"
#include "recipe/build.h"
#include "recipe/steps.h"
#include "volume/base/error.h"
#include "volume/io/atomic_file.h"
#include "volume/io/model_io.h"

#include <chrono>
#include <fmt/format.h>

namespace pith::cli {
namespace {

struct CutVerbOptions {
  std::filesystem::path model, output;
  std::vector<std::string> planes, spheres, strokes, only;
  std::string keep = "both";
  double spread = 0, snap = CutStep().snap;
};

CutStep plane_step(const std::string& text) {
  const std::vector<double> n = numbers_of("--plane", text, 4);
  const PlaneCut plane{.normal = {n[0], n[1], n[2]}, .offset = n[3]};
  if (!(plane.normal.norm() > 0)) throw CLI::ValidationError("--plane", "the normal '" + text + "' has no length");
  CutStep step;
  step.shape = plane;
  return step;
}

CutStep sphere_step(const std::string& text) {
  const std::vector<double> n = numbers_of("--sphere", text, 4);
  if (!(n[3] > 0)) throw CLI::ValidationError("--sphere", "the radius in '" + text + "' is not positive");
  CutStep step;
  step.shape = SphereCut{.center = {n[0], n[1], n[2]}, .radius = n[3]};
  return step;
}

/// The cuts in the order in which they stand on the command line.
std::vector<CutStep> steps_of(const CLI::App& app, const CutVerbOptions& options) {
  std::vector<CutStep> steps;
  std::size_t planes = 0, spheres = 0, strokes = 0;
  for (const CLI::Option* option : app.parse_order()) {
    if (option->get_name() == "--plane") steps.push_back(plane_step(options.planes.at(planes++)));
    if (option->get_name() == "--sphere") steps.push_back(sphere_step(options.spheres.at(spheres++)));
    if (option->get_name() == "--stroke") {
      const std::filesystem::path file = options.strokes.at(strokes++);
      steps.push_back(parse_cut(file_content(file), file.filename().string()));
    }
  }
  if (steps.empty()) throw CLI::RequiredError("--plane, --sphere or --stroke");
  for (CutStep& step : steps) {
    if (app.count("--keep") > 0)
      step.keep = options.keep == "left" ? Keep::left : options.keep == "right" ? Keep::right : Keep::both;
    if (app.count("--spread") > 0) step.spread = options.spread;
    if (app.count("--snap") > 0) step.snap = options.snap;
    for (const std::string& point : options.only) {
      const std::vector<double> x = numbers_of("--only", point, 3);
      step.only.emplace_back(x[0], x[1], x[2]);
    }
    if (step.spread > 0 && step.keep != Keep::both)
      throw CLI::ValidationError("--spread", "halves are moved apart only where both are kept");
  }
  return steps;
}

void run(const CLI::App& app, const CutVerbOptions& options, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  check_output(options.output, {"pith"});
  const std::vector<CutStep> steps = steps_of(app, options);
  ModelFile file = read_model(options.model);
  const TetMesh& mesh = file.model.mesh;
  const Locator locator(mesh, file.model.boundary);
  std::optional<Recipe> recipe;
  if (!file.recipe.empty()) recipe = parse_recipe(file.recipe, options.model.filename().string() + " (recipe)");

  std::size_t tets_cut = 0;
  double cutting = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    session.stop_if_asked();
    const std::string where = "cut " + std::to_string(i + 1) + " of " + std::to_string(steps.size());
    if (recipe) {
      append_cut(*recipe, steps[i], file.pieces, mesh);
      add_last_cut(file.key, *recipe);
    }
    const auto begin = std::chrono::steady_clock::now();
    tets_cut += apply_cut(file.pieces, mesh, file.model.boundary, locator, steps[i], where).tets_cut;
    cutting += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  if (recipe) file.recipe = recipe_text(*recipe);
  session.stop_if_asked();
  write_model(options.output, file);

  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Json pieces = Json::array();
  for (std::uint32_t piece = 0; piece < file.pieces.piece.size(); ++piece) {
    const PieceMeasure measured = measure(file.pieces, piece, mesh);
    pieces.push_back(
        {{"volume", measured.volume}, {"whole_tets", measured.whole_tets}, {"cut_tets", measured.cut_tets}});
    session.say(fmt::format("  piece {}: {:.6g} mm³, {} whole tets, {} cut tets", piece, measured.volume,
                            measured.whole_tets, measured.cut_tets));
  }
  session.say(fmt::format("{}: {} piece(s), {} tets cut in {:.2f} ms", options.output.string(), pieces.size(),
                          tets_cut, cutting * 1000));
  session.print({{"model", options.output.string()},
                 {"seconds", seconds},
                 {"cutting_seconds", cutting},
                 {"tets_cut", tets_cut},
                 {"pieces", std::move(pieces)}});
}

} // namespace

Verb cut_verb(CLI::App& program) {
  auto options = std::make_shared<CutVerbOptions>();
  CLI::App* app = program.add_subcommand("cut", "cut a model; shapes may be repeated and are made in their order");
  app->add_option("model", options->model, "MODEL.pith")->required();
  app->add_option("-o,--output", options->output, "the model to write, OUT.pith")->required();
  // Each use takes exactly one value, so that parse_order tells which shape stands where.
  for (auto [name, into, text] :
       {std::tuple{"--plane", &options->planes, "nx,ny,nz,d: the plane n·x = d; right is where n points"},
        std::tuple{"--sphere", &options->spheres, "x,y,z,r: right is outside"},
        std::tuple{"--stroke", &options->strokes,
                   "S.json: {\"points\": [[u, v], ...], \"view\": {...}}, or any cut of a recipe"},
        std::tuple{"--only", &options->only, "x,y,z: cut only the piece that holds this rest point"}})
    app->add_option(name, *into, text)->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app->add_option("--keep", options->keep, "both, left or right")
      ->check(CLI::IsMember({"both", "left", "right"}))
      ->capture_default_str();
  app->add_option("--spread", options->spread, "mm by which the halves are moved apart")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app->add_option("--snap", options->snap, "fraction of an edge, 0 to 0.4, within which a cut snaps to vertices")
      ->check(CLI::Range(0.0, 0.4))
      ->capture_default_str();
  return {app, [app, options](const Session& session) { run(*app, *options, session); }};
}

} // namespace pith::cli
