#pragma once
// What a user does, as a list of events: recorded from real use, replayed without a display.
//
// Gestures are in screen coordinates of the view (volume/base/view.h), so a session replays alike in a picture of any
// size. Everything else (menus, keys, buttons, sliders) is a named command or setting, never a click on a widget.
#include "volume/base/types.h"

#include <array>
#include <string>
#include <vector>

namespace pith {

enum class Button { left, right, middle };

struct Event {
  enum class Kind {
    press, ///< a mouse button at `at`
    drag,  ///< the mouse has moved to `at`; between presses: it hovers there
    release,
    wheel,        ///< by `amount` notches, up is positive, at `at`
    double_click, ///< left button
    command,      ///< `name` (command_table), `text` its argument, if it takes one
    set,          ///< the setting `name` (setting_table) to `text`
    wait,         ///< until all that runs in the background is done
    picture       ///< writes what the window shows to the file `text`, without panels, with transparency
  };
  Kind kind = Kind::wait;
  Vec2d at{0, 0};
  Button button = Button::left;
  bool shift = false, control = false;
  double amount = 0;
  std::string name = {}, text = {};
};

struct EventList {
  std::array<int, 2> size{800, 600}; ///< of the window when it was recorded
  std::vector<Event> event;
};

/// JSON: { "pith session": 1, "size": [w, h], "events": [ { "press": [u, v], "button": "left", "shift": true }, {
/// "drag": [u, v] }, { "release": [u, v] }, { "wheel": 1, "at": [u, v] }, { "double_click": [u, v] }, { "do": "undo"
/// }, { "do": "open", "with": "kiwi.json" }, { "set": "keep", "to": "left" }, { "wait": true }, { "picture":
/// "out.png" } ] }. Errors: InvalidInput, naming the event.
EventList parse_session(const std::string& text, const std::string& file);
std::string session_text(const EventList& session);

} // namespace pith
