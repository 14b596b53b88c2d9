// pith cut MODEL.pith (--plane nx,ny,nz,d | --sphere x,y,z,r | --box … | --cylinder … | --stroke S.json |
//   --surface FILE | --depth value[,region] | --join x,y,z,x,y,z)... [--undo N] [--explode PART] [--drop Z] -o
//   OUT.pith
#include "cli/command.h"
#include "recipe/build.h"
#include "recipe/steps.h"
#include "volume/base/error.h"
#include "volume/io/atomic_file.h"
#include "volume/io/model_io.h"

#include <chrono>
#include <fmt/format.h>
#include <map>
#include <optional>

namespace pith::cli {
namespace {

struct CutVerbOptions {
  std::filesystem::path model, output;
  std::map<std::string, std::vector<std::string>> shapes; ///< by option, in the order of its uses
  std::vector<std::string> only;
  int undo = 0;
  std::optional<double> explode, drop;
  std::string keep = "both";
  double spread = 0, snap = CutStep().snap;
};

/// One use of a shape's option.
CutStep step_of(const std::string& option, const std::string& text) {
  CutStep step;
  if (option == "--stroke") return parse_cut(file_content(text), std::filesystem::path(text).filename().string());
  if (option == "--surface") {
    step.surface.emplace();
    step.surface->file = std::filesystem::absolute(text).lexically_normal().string();
    return step;
  }
  if (option == "--depth") {
    const std::size_t comma = text.find(',');
    step.depth.emplace();
    step.depth->value = numbers_of(option, text.substr(0, comma), 1)[0];
    if (!(step.depth->value > 0 && step.depth->value < 1))
      throw CLI::ValidationError(option, "the depth in '" + text + "' is not between 0 and 1");
    if (comma != std::string::npos)
      step.depth->region = static_cast<std::int32_t>(numbers_of(option, text.substr(comma + 1), 1)[0]);
    return step;
  }
  if (option == "--join") {
    const std::vector<double> n = numbers_of(option, text, 6);
    step.join = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    return step;
  }
  const std::vector<double> n = numbers_of(option, text, option == "--box" ? 6 : option == "--cylinder" ? 7 : 4);
  if (option == "--plane") step.shape = PlaneCut{.normal = {n[0], n[1], n[2]}, .offset = n[3]};
  if (option == "--sphere") step.shape = SphereCut{.center = {n[0], n[1], n[2]}, .radius = n[3]};
  if (option == "--box") step.shape = BoxCut{.center = {n[0], n[1], n[2]}, .size = {n[3], n[4], n[5]}};
  if (option == "--cylinder")
    step.shape = CylinderCut{.from = {n[0], n[1], n[2]}, .to = {n[3], n[4], n[5]}, .radius = n[6]};
  try {
    level_set_of(step.shape, option + " " + text);
  } catch (const InvalidInput& error) {
    throw CLI::ValidationError(error.what());
  }
  return step;
}

/// The cuts in the order in which they stand on the command line.
std::vector<CutStep> steps_of(const CLI::App& app, const CutVerbOptions& options) {
  std::vector<CutStep> steps;
  std::map<std::string, std::size_t> used;
  for (const CLI::Option* option : app.parse_order())
    if (const auto shape = options.shapes.find(option->get_name()); shape != options.shapes.end())
      steps.push_back(step_of(shape->first, shape->second.at(used[shape->first]++)));
  if (steps.empty() && options.undo == 0 && !options.explode && !options.drop)
    throw CLI::RequiredError("a shape, --join, --undo, --explode or --drop");
  for (CutStep& step : steps) {
    if (!step.join.empty()) continue;
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

/// Takes back the last cuts of the recipe, and the moves after them, by doing all cuts before them again.
void undo(ModelFile& file, std::optional<Recipe>& recipe, int count, const StepContext& context) {
  if (!recipe) throw InvalidInput("--undo", "the model has no recipe", "go back to the file before the cut");
  if (static_cast<std::size_t>(count) > recipe->cuts.size())
    throw InvalidInput("--undo", "the model has " + std::to_string(recipe->cuts.size()) + " cuts", "undo fewer");
  recipe->cuts.resize(recipe->cuts.size() - count);
  recipe->moves.clear();
  Pieces pieces = whole_piece(file.model.mesh);
  for (std::size_t k = 0; k < recipe->cuts.size(); ++k)
    apply_cut(pieces, context, recipe->cuts[k], "cut " + std::to_string(k + 1) + " of the recipe");
  file.pieces = std::move(pieces);
  for (int k = 0; k < count; ++k) file.key.erase("cut " + std::to_string(recipe->cuts.size() + k));
  std::erase_if(file.key, [](const auto& entry) { return entry.first.starts_with("move "); });
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

  const StepContext context{file.model, locator, options.model.parent_path()};
  if (options.undo > 0) undo(file, recipe, options.undo, context);
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
    tets_cut += apply_cut(file.pieces, context, steps[i], where).tets_cut;
    cutting += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  for (const bool explodes : {true, false})
    if (const std::optional<double>& value = explodes ? options.explode : options.drop) {
      MoveStep move;
      (explodes ? move.explode : move.drop) = *value;
      apply_move(file.pieces, mesh, locator, move, explodes ? "--explode" : "--drop");
      if (!recipe) continue;
      recipe->moves.push_back(move);
      add_last_move(file.key, *recipe);
    }
  if (recipe) file.recipe = recipe_text(*recipe);
  session.stop_if_asked();
  write_model(options.output, file);

  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Json pieces = Json::array();
  for (const PieceMeasure& measured : measures_of(file.pieces, mesh)) {
    const std::size_t piece = pieces.size();
    const Vec3d centroid = file.pieces.piece[piece].placement(measured.centroid);
    pieces.push_back({{"volume", measured.volume},
                      {"centroid", {centroid.x(), centroid.y(), centroid.z()}},
                      {"whole_tets", measured.whole_tets},
                      {"cut_tets", measured.cut_tets}});
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
  for (const auto& [name, text] :
       {std::pair{"--plane", "nx,ny,nz,d: the plane n·x = d; right is where n points"},
        std::pair{"--sphere", "x,y,z,r: right is outside"},
        std::pair{"--box", "x,y,z,a,b,c: around x,y,z with edges a, b, c; right is outside"},
        std::pair{"--cylinder", "x,y,z,x,y,z,r: from end to end, a corer; right is outside"},
        std::pair{"--surface", "FILE: a triangle mesh as a knife; left is inside a closed one"},
        std::pair{"--depth", "value[,region]: peels off what is less deep than value (0 to 1)"},
        std::pair{"--join", "x,y,z,x,y,z: makes the pieces that hold two rest points one again"},
        std::pair{"--stroke", "S.json: {\"points\": [[u, v], ...], \"view\": {...}}, or any cut of "
                              "a recipe"}})
    app->add_option(name, options->shapes[name], text)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app->add_option("--only", options->only, "x,y,z: cut only the piece that holds this rest point")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app->add_option("--undo", options->undo, "first take back the last N cuts of the recipe, and the moves after them")
      ->check(CLI::Range(0, 1000000));
  app->add_option("--explode", options->explode,
                  "at the end, move every piece away from the middle by this part of its distance");
  app->add_option("--drop", options->drop,
                  "at the end, move every piece along z until it stands on the plane z = this");
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
