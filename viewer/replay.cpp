#include "viewer/replay.h"

#include "viewer/offscreen.h"
#include "volume/base/error.h"

namespace pith {

void replay(const EventList& session, const std::string& file, const std::filesystem::path& folder,
            const ReplayOptions& options, const std::function<void(Workbench&, Screen&)>& done) {
  const std::array<int, 2> size = options.size[0] > 0 ? options.size : session.size;
  const OffscreenContext context;
  Workbench bench(options.document, static_cast<double>(size[0]) / size[1]);
  Screen screen(bench);
  std::optional<Panels> panels;
  if (options.panels) panels.emplace(nullptr, 1.0f);
  const auto write = [&](const std::filesystem::path& path) {
    write_picture(path, screen.picture(size[0], size[1], panels ? &*panels : nullptr));
  };
  const auto require_well = [&](const std::string& where) {
    if (bench.message_is_error() && !bench.message().empty())
      throw InvalidInput(where, bench.message(), "mend that event, or open what the session was recorded on");
  };
  if (!options.open.empty()) {
    bench.document().open(options.open);
    bench.handle({.kind = Event::Kind::wait});
    require_well(options.open.filename().string());
  }
  for (std::size_t i = 0; i < session.event.size() && !bench.quit; ++i) {
    Event event = session.event[i];
    if (event.kind == Event::Kind::command && (event.name == "open" || event.name == "save as"))
      event.text = (folder / event.text).string(); // an absolute path stays
    if (event.kind == Event::Kind::picture) write(folder / event.text);
    bench.handle(event);
    require_well(file + ": /events/" + std::to_string(i));
  }
  if (!options.picture.empty()) write(options.picture);
  if (done) done(bench, screen);
}

} // namespace pith
