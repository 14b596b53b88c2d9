// pith view [FILE] [--replay SESSION.json] [--screenshot OUT.png] [--record SESSION.json]
#include "cli/command.h"
#include "recipe/cache.h"
#include "viewer/replay.h"
#include "viewer/window.h"
#include "volume/base/error.h"
#include "volume/io/atomic_file.h"

namespace pith::cli {
namespace {

struct ViewVerbOptions {
  std::filesystem::path file, session, screenshot, record, cache;
  std::string size;
  bool panels = false;
};

} // namespace

Verb view_verb(CLI::App& program) {
  auto options = std::make_shared<ViewVerbOptions>();
  CLI::App* app = program.add_subcommand("view", "the window: look, cut, design");
  app->add_option("file", options->file, "a recipe (.json), a model (.pith) or a closed surface");
  app->add_option("--replay", options->session, "play a recorded session without a display");
  app->add_option("--screenshot", options->screenshot,
                  "write a PNG of what shows (at the end of --replay, if given)");
  app->add_flag("--panels", options->panels, "pictures show menus and panels too, as the window does");
  app->add_option("--record", options->record, "write what is done in the window as a session");
  app->add_option("--size", options->size, "WIDTHxHEIGHT of the window or picture");
  app->add_option("--cache", options->cache, "folder for results of stages");
  return {app, [options](const Session& session) {
            DocumentOptions document;
            document.build.cache = options->cache.empty() ? default_cache_folder() : options->cache;
            std::array<int, 2> size{0, 0};
            if (!options->size.empty()) size = size_of("--size", options->size, 16, 16384);
            if (!options->session.empty() || !options->screenshot.empty()) {
              if (!options->screenshot.empty()) check_output(options->screenshot, {"png"});
              EventList events;
              if (!options->session.empty())
                events = parse_session(file_content(options->session), options->session.filename().string());
              ReplayOptions replaying;
              replaying.open = options->file;
              replaying.picture = options->screenshot;
              replaying.size = size;
              replaying.panels = options->panels;
              replaying.document = document;
              replay(events, options->session.filename().string(), {}, replaying,
                     [&](Workbench& bench, Screen& screen) {
                       Json json = {{"driver", screen.driver()}, {"events", events.event.size()}};
                       if (bench.pieces()) json["pieces"] = bench.pieces()->piece.size();
                       session.print(json);
                     });
              return;
            }
            if (const auto cache = default_cache_folder(); !cache.empty()) document.recovery = cache / "recovery";
            WindowOptions window;
            window.open = options->file;
            window.record = options->record;
            if (size[0] > 0) window.size = size;
            window.document = document;
            run_window(window);
          }};
}

} // namespace pith::cli
