// view/*: what a user waits for in the window, without the time that the graphics driver takes.
#include "bench/fixtures.h"
#include "bench/program.h"
#include "recipe/recipe_paths.h"
#include "viewer/offscreen.h"
#include "viewer/panels.h"
#include "viewer/screen.h"
#include "volume/io/atomic_file.h"

#include <fmt/format.h>

namespace pith::bench {
namespace {

/// A workbench with the kiwi open, whole. `interior_edge` 0: as the recipe has it.
class Opened {
public:
  Opened(const Settings& settings, double interior_edge) : folder_(std::filesystem::temp_directory_path()) {
    const std::filesystem::path recipes = settings.source / "data/recipes";
    Recipe recipe = rebased(read_recipe(recipes / "kiwi.json"), recipes, folder_.path());
    if (interior_edge > 0) recipe.tetrahedralize.interior_edge = interior_edge;
    recipe.cuts.clear();
    recipe.moves.clear();
    recipe.view.reset();
    write_file(folder_.path() / "kiwi.json", recipe_text(recipe));
    bench.handle({.kind = Event::Kind::command, .name = "open", .text = (folder_.path() / "kiwi.json").string()});
    bench.handle({.kind = Event::Kind::wait});
    if (!bench.root()) throw std::runtime_error(bench.message());
  }
  std::size_t tets() const { return bench.root()->model().mesh.tet_count(); }
  void does(const std::string& command) { bench.handle({.kind = Event::Kind::command, .name = command}); }
  void mouse(Event::Kind kind, double u, double v) { bench.handle({.kind = kind, .at = {u, v}}); }

  Workbench bench;

private:
  ScratchFolder folder_;
};

/// From the release of a stroke until its triangles are handed over; beside it undo to a state that is still there.
Measured stroke(const Settings& settings, double interior_edge) {
  Opened opened(settings, interior_edge);
  const OffscreenContext context;
  Drawing drawing;
  drawing.set_material(material_tables(*opened.bench.root()));
  opened.does("tool stroke");
  const int times = settings.times(15);
  std::vector<double> released, undone;
  std::size_t triangles = 0;
  for (int i = 0; i <= times; ++i) {
    opened.mouse(Event::Kind::press, -0.05, 0.95);
    for (int k = 1; k < 60; ++k) opened.mouse(Event::Kind::drag, 0.04 * std::sin(0.2 * k), 0.95 - 1.9 * k / 60.0);
    const double to_gl = seconds_of([&] {
      opened.mouse(Event::Kind::release, 0.02, -0.95);
      drawing.set_surface(opened.bench.surface());
    });
    if (opened.bench.pieces()->piece.size() != 2) throw std::runtime_error("the stroke did not cut");
    triangles = opened.bench.surface().tag.size();
    const double back = seconds_of([&] {
      opened.does("undo");
      drawing.set_surface(opened.bench.surface());
    });
    if (i == 0) continue;
    released.push_back(1e3 * to_gl);
    undone.push_back(1e3 * back);
  }
  return {median(released), fmt::format("{} tets, {} triangles; undo to a state in memory {:.1f} ms (≤ 50)",
                                        opened.tets(), triangles, median(undone))};
}

Measured plane_drag(const Settings& settings) {
  Opened opened(settings, 1.95);
  const OffscreenContext context;
  Drawing drawing;
  opened.does("tool plane");
  opened.bench.handle({.kind = Event::Kind::set, .name = "plane", .text = "x"});
  opened.mouse(Event::Kind::press, 0, 0);
  std::vector<double> seconds;
  const int times = settings.times(41);
  for (int i = 0; i <= times; ++i) {
    const double taken = seconds_of([&] {
      opened.mouse(Event::Kind::drag, 0.15 * std::sin(0.7 * i) - 0.25, 0);
      drawing.set_surface(opened.bench.surface());
    });
    if (opened.bench.pieces()->piece.size() != 2) throw std::runtime_error("the plane misses the kiwi");
    if (i > 0) seconds.push_back(taken);
  }
  return {1 / median(seconds), fmt::format("{} tets, {} triangles handed over each time; {:.1f} ms", opened.tets(),
                                           opened.bench.surface().tag.size(), 1e3 * median(seconds))};
}

/// The panels and all that a frame asks of the workbench; nothing is drawn but the panels, in a few pixels.
Measured frame_cpu(const Settings& settings) {
  Opened opened(settings, 0);
  const OffscreenContext context;
  Screen screen(opened.bench);
  Panels panels(nullptr, 1);
  screen.picture(16, 16);
  std::vector<double> seconds;
  const int times = settings.times(101);
  for (int i = 0; i <= times; ++i) {
    const double begin = thread_seconds();
    opened.bench.poll();
    screen.follow(1200, 800);
    panels.build(opened.bench, 1200, 800);
    seconds.push_back(1e3 * (thread_seconds() - begin));
  }
  std::vector<double> pictures;
  for (int i = 0; i < settings.times(5); ++i) pictures.push_back(seconds_of([&] { screen.picture(800, 600); }));
  opened.does("tool stroke");
  return {median(seconds), fmt::format("a whole picture of 800 × 600 with {}: {:.1f} a second (≥ 4)", screen.driver(),
                                       1 / median(pictures))};
}

} // namespace

std::vector<Row> view_rows() {
  return {{"view/stroke_kiwi", "ms", "≤ 30", [](const Settings& s) { return stroke(s, 0); }},
          {"view/stroke_200k", "ms", "≤ 100", [](const Settings& s) { return stroke(s, 1.95); }},
          {"view/plane_drag_200k", "/s", "≥ 60", plane_drag},
          {"view/frame_cpu", "ms", "≤ 2", frame_cpu}};
}

} // namespace pith::bench
