#pragma once
// Menus, toolbar, panels and dialogs, with Dear ImGui. They change nothing themselves: what a user chooses comes out
// as events.
#include "viewer/workbench.h"

#include <memory>

namespace pith {

class Panels {
public:
  /// Needs a current GL context; `window` is a GLFWwindow, or null for a picture without one.
  Panels(void* window, float scale);
  ~Panels();
  Panels(const Panels&) = delete;
  Panels& operator=(const Panels&) = delete;

  /// Builds one frame over width × height pixels. Returns what was chosen.
  std::vector<Event> build(Workbench& bench, int width, int height);
  /// Draws it into the current framebuffer.
  void draw();

  bool wants_mouse() const;
  bool wants_keys() const;

  /// What a command says now; none where a dialog asks first, for a file or for leave to lose unsaved work. Then it
  /// comes out of a later build().
  std::optional<Event> ask(const Workbench& bench, const Command& command);
  void ask_to_open(const Workbench& bench, const std::string& path); ///< a file was dropped
  void offer(std::vector<Recovered> left);                           ///< what a crash left behind
  const Recovered* taken_up() const; ///< the user chose to take this up; null: nothing, or not yet
  void toggle_help();

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace pith
