// Everything that can be done besides gestures: menus, keys and sessions read this one table.
#include "viewer/workbench.h"
#include "volume/base/error.h"
#include "volume/exemplar/procedural.h"

namespace pith {
namespace {

bool has_document(const Workbench& bench) { return !bench.document().empty(); }
bool has_pieces(const Workbench& bench) { return has_document(bench) && !bench.document().stale(); }

Command plain(std::string name, std::string menu, std::string label, std::string shortcut, std::string tip,
              std::function<void(Workbench&)> run, std::function<bool(const Workbench&)> enabled = {}) {
  return {std::move(name),
          std::move(menu),
          std::move(label),
          std::move(shortcut),
          std::move(tip),
          false,
          [run](Workbench& bench, const std::string&) { run(bench); },
          std::move(enabled)};
}

Command with_text(std::string name, std::string menu, std::string label, std::string shortcut, std::string tip,
                  std::function<void(Workbench&, const std::string&)> run,
                  std::function<bool(const Workbench&)> enabled = {}) {
  return {std::move(name), std::move(menu),   std::move(label), std::move(shortcut), std::move(tip), true,
          std::move(run),  std::move(enabled)};
}

void save(Workbench& bench) {
  if (bench.document().file().empty())
    throw InvalidInput("save", "the document has no file yet", "use Save as (Ctrl+Shift+S)");
  bench.document().save(bench.document().file());
  bench.say("saved " + bench.document().file().string());
}

/// Makes every lapped solid of the type and exemplar that are set; where there is none, region 0 becomes one.
void fill(Workbench& bench) {
  const Settings& settings = bench.settings();
  Recipe recipe = bench.document().recipe();
  if (recipe.solids.empty()) recipe.solids.emplace_back();
  for (Solid& solid : recipe.solids) {
    solid.kind = Solid::Kind::lapped;
    const TextureTraits& traits = traits_of(settings.type);
    solid.fill.type = settings.type;
    solid.exemplar = {};
    solid.exemplar.procedural = settings.exemplar;
    solid.scale = traits.uses_scale ? settings.scale : 0;
    if (!traits.uses_depth) {
      solid.depth.clear();
      for (ScatterStep& scatter : solid.scatter) scatter.options.depth = ScatterOptions().depth;
    }
    if (!traits.uses_stroke) solid.orientation.clear();
  }
  bench.document().edit(std::move(recipe), "fill");
}

/// A command that changes the recipe; its label is the history's.
Command edit(std::string name, std::string menu, std::string label, std::string tip, Document::Build build,
             void (*change)(Recipe&)) {
  return plain(
      name, std::move(menu), std::move(label), "", std::move(tip),
      [name, build, change](Workbench& bench) {
        Recipe recipe = bench.document().recipe();
        change(recipe);
        bench.document().edit(std::move(recipe), name, build);
      },
      has_document);
}

std::vector<Command> all_commands() {
  std::vector<Command> list = {
      with_text("open", "File", "Open...", "Ctrl+O", "a recipe, a model or a surface",
                [](Workbench& bench, const std::string& path) { bench.document().open(path); }),
      plain("save", "File", "Save", "Ctrl+S", "to the document's own file", save, has_document),
      with_text(
          "save as", "File", "Save as...", "Ctrl+Shift+S", "a recipe (.json), or a model with its recipe (.pith)",
          [](Workbench& bench, const std::string& path) {
            bench.document().save(path);
            bench.say("saved " + path);
          },
          has_document),
      plain("quit", "File", "Quit", "Ctrl+Q", "", [](Workbench& bench) { bench.quit = true; }),

      plain(
          "undo", "Edit", "Undo", "Ctrl+Z", "", [](Workbench& bench) { bench.document().undo(); },
          [](const Workbench& bench) { return bench.document().can_undo(); }),
      plain(
          "redo", "Edit", "Redo", "Ctrl+Shift+Z", "", [](Workbench& bench) { bench.document().redo(); },
          [](const Workbench& bench) { return bench.document().can_redo(); }),
      plain("undo all", "Edit", "Undo all", "", "",
            [](Workbench& bench) {
              while (bench.document().can_undo()) bench.document().undo();
            }),
      plain("redo all", "Edit", "Redo all", "", "",
            [](Workbench& bench) {
              while (bench.document().can_redo()) bench.document().redo();
            }),
      plain(
          "update", "Edit", "Update", "U", "makes the model of what was drawn",
          [](Workbench& bench) { bench.document().update(); }, has_document),
      plain(
          "cancel", "Edit", "Stop", "Escape", "gives up what is being made",
          [](Workbench& bench) { bench.document().cancel(); }, has_document),

      plain("fill solids", "Solids", "Fill", "F", "fills with the exemplar and type that are set", fill,
            has_document),
      edit("clear depth", "Solids", "Clear depth", "takes all depth constraints back", Document::Build::later,
           [](Recipe& recipe) {
             for (Solid& solid : recipe.solids) solid.depth.clear();
           }),
      edit("clear orientation", "Solids", "Clear orientation", "takes all orientation strokes back",
           Document::Build::later,
           [](Recipe& recipe) {
             for (Solid& solid : recipe.solids) solid.orientation.clear();
           }),

      plain(
          "explode", "Pieces", "Explode", "E", "moves all pieces apart",
          [](Workbench& bench) {
            MoveStep step;
            step.explode = bench.settings().explode;
            bench.document().move(step);
          },
          has_pieces),
      plain(
          "drop", "Pieces", "Drop", "D", "puts every piece on the ground",
          [](Workbench& bench) {
            MoveStep step;
            step.drop = bench.settings().drop_height;
            bench.document().move(step);
          },
          has_pieces),
      edit("whole again", "Pieces", "Whole again", "takes all cuts and moves back", Document::Build::now,
           [](Recipe& recipe) {
             recipe.cuts.clear();
             recipe.moves.clear();
           }),

      plain("home", "View", "Home", "Home", "shows everything", [](Workbench& bench) { bench.home(); }),
      plain("orthographic", "View", "Orthographic", "O", "on and off",
            [](Workbench& bench) { bench.camera().set_orthographic(!bench.view().orthographic()); }),
      plain("copy view", "View", "Copy view", "Ctrl+C", "as text",
            [](Workbench& bench) { bench.say(bench.camera().text()); }),
      with_text(
          "paste view", "View", "Paste view", "Ctrl+V", "from text",
          [](Workbench& bench, const std::string& text) { bench.camera() = Camera(parse_view(text, "view")); })};
  const std::array<const char*, 3> axis = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    for (const int sign : {1, -1})
      list.push_back(plain(std::string("view ") + (sign > 0 ? "+" : "-") + axis[k], "View",
                           std::string("From ") + (sign > 0 ? "+" : "-") + axis[k],
                           (sign > 0 ? "" : "Shift+") + std::string(1, static_cast<char>('X' + k)), "along an axis",
                           [k, sign](Workbench& bench) { bench.home(sign * Vec3d::Unit(k)); }));
  for (const ToolEntry& tool : tool_table())
    list.push_back(plain("tool " + tool.name, "Tools", tool.label, tool.shortcut, tool.tip,
                         [name = tool.name](Workbench& bench) { bench.choose_tool(name); }));
  return list;
}

} // namespace

const std::vector<Command>& command_table() {
  static const std::vector<Command> table = all_commands();
  return table;
}

} // namespace pith
