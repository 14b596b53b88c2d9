#include "viewer/window.h"

#include "viewer/panels.h"
#include "viewer/screen.h"
#include "volume/base/error.h"
#include "volume/io/atomic_file.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace pith {
namespace fs = std::filesystem;
namespace {

/// "Ctrl+Shift+Z": does this key with these modifiers say that?
bool is_shortcut(const std::string& shortcut, int key, int mods) {
  if (shortcut.empty()) return false;
  int wanted = 0;
  std::string rest = shortcut;
  for (const auto& [prefix, bit] : {std::pair("Ctrl+", GLFW_MOD_CONTROL), std::pair("Shift+", GLFW_MOD_SHIFT)})
    if (rest.starts_with(prefix)) wanted |= bit, rest = rest.substr(std::string(prefix).size());
  if ((mods & (GLFW_MOD_CONTROL | GLFW_MOD_SHIFT)) != wanted) return false;
  if (rest == "Home") return key == GLFW_KEY_HOME;
  if (rest == "Escape") return key == GLFW_KEY_ESCAPE;
  return rest.size() == 1 && key == rest[0];
}

class Window {
public:
  explicit Window(const WindowOptions& options) : options_(options) {
    static thread_local std::string reason;
    glfwSetErrorCallback([](int, const char* text) { reason = text; });
    if (!glfwInit())
      throw SolverFailure("cannot open a window: " + reason + "; without a display use pith view --replay");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SAMPLES, 4);
    window_ = glfwCreateWindow(options.size[0], options.size[1], "pith", nullptr, nullptr);
    if (!window_) {
      glfwTerminate();
      throw SolverFailure("cannot open a window with OpenGL 3.3: " + reason);
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    listen();
  }
  ~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
  }

  void run() {
    float scale = 1;
    glfwGetWindowContentScale(window_, &scale, nullptr);
    Panels panels(window_, scale);
    Workbench bench(options_.document);
    Screen screen(bench);
    bench_ = &bench, panels_ = &panels, screen_ = &screen;
    panels.offer(recoverable(options_.document.recovery));
    if (!options_.open.empty())
      handle({.kind = Event::Kind::command, .name = "open", .text = options_.open.string()});
    while (!bench.quit) {
      if (bench.document().building() || busy_frames_ > 0)
        glfwWaitEventsTimeout(0.05);
      else
        glfwWaitEventsTimeout(0.5);
      busy_frames_ = std::max(0, busy_frames_ - 1);
      bench.poll();
      waited_ |= was_building_ && !bench.document().building();
      was_building_ = bench.document().building();
      int width = 0, height = 0;
      glfwGetFramebufferSize(window_, &width, &height);
      if (width > 0 && height > 0) {
        screen.draw(width, height);
        const std::vector<Event> chosen = panels.build(bench, width, height);
        panels.draw();
        glfwSwapBuffers(window_);
        for (const Event& event : chosen) handle(event);
      }
      if (panels.taken_up() && !took_up_) {
        took_up_ = true;
        try {
          bench.document().open(*panels.taken_up());
        } catch (const std::exception& error) {
          bench.say(error.what());
        }
      }
      title();
    }
    bench_ = nullptr;
  }

private:
  Vec2d view_point(double x, double y) const {
    int width = 1, height = 1;
    glfwGetWindowSize(window_, &width, &height);
    return {(2 * x - width) / std::max(height, 1), 1 - 2 * y / std::max(height, 1)};
  }

  void handle(const Event& event) {
    busy_frames_ = 3;
    const bool building = bench_->document().building();
    if (event.kind == Event::Kind::picture) {
      int width = 0, height = 0;
      glfwGetFramebufferSize(window_, &width, &height);
      try {
        write_picture(event.text, screen_->picture(width, height));
        bench_->say("wrote " + event.text);
      } catch (const std::exception& error) {
        bench_->say(error.what());
      }
    } else {
      bench_->handle(event);
    }
    was_building_ |= !building && bench_->document().building(); // it may end before the next frame
    if (options_.record.empty()) return;
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    session_.size = {width, height};
    if (std::exchange(waited_, false)) session_.event.push_back({.kind = Event::Kind::wait}); // as the user did
    session_.event.push_back(event);
    if (event.kind != Event::Kind::drag) {
      try {
        write_file(options_.record, session_text(session_));
      } catch (const IoFailure& error) {
        bench_->say(error.what());
      }
    }
  }

  static Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

  void listen() {
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) { of(w).moved(x, y); });
    glfwSetMouseButtonCallback(window_,
                               [](GLFWwindow* w, int b, int action, int mods) { of(w).button(b, action, mods); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { of(w).scrolled(y); });
    glfwSetKeyCallback(window_,
                       [](GLFWwindow* w, int key, int, int action, int mods) { of(w).key(key, action, mods); });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
      if (count > 0 && of(w).bench_) of(w).panels_->ask_to_open(*of(w).bench_, paths[0]);
    });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) {
      glfwSetWindowShouldClose(w, GLFW_FALSE);
      of(w).command("quit");
    });
  }

  void moved(double x, double y) {
    at_ = view_point(x, y); // the position now; asked for within a button's callback it would be a later one
    if (bench_ && held_) handle({.kind = Event::Kind::drag, .at = at_});
  }

  void button(int b, int action, int mods) {
    if (!bench_ || b > 2) return;
    if (action == GLFW_PRESS && panels_->wants_mouse()) return;
    Event event{.kind = action == GLFW_PRESS ? Event::Kind::press : Event::Kind::release, .at = at_};
    event.button = b == GLFW_MOUSE_BUTTON_RIGHT    ? Button::right
                   : b == GLFW_MOUSE_BUTTON_MIDDLE ? Button::middle
                                                   : Button::left;
    event.shift = mods & GLFW_MOD_SHIFT;
    event.control = mods & GLFW_MOD_CONTROL;
    if (action == GLFW_RELEASE && !held_) return;
    held_ = action == GLFW_PRESS;
    handle(event);
    if (action != GLFW_PRESS || event.button != Button::left) return;
    const double now = glfwGetTime();
    if (now - pressed_ < 0.35 && (at_ - pressed_at_).norm() < 0.02) {
      event.kind = Event::Kind::double_click;
      handle(event);
    }
    pressed_ = now;
    pressed_at_ = at_;
  }

  void scrolled(double y) {
    if (bench_ && !panels_->wants_mouse()) handle({.kind = Event::Kind::wheel, .at = at_, .amount = y});
  }

  void key(int key, int action, int mods) {
    if (!bench_ || action != GLFW_PRESS || panels_->wants_keys()) return;
    busy_frames_ = 3;
    if (key == GLFW_KEY_H && mods == 0) return panels_->toggle_help();
    if (key == GLFW_KEY_F12) {
      int number = 1;
      while (fs::exists(fmt::format("pith-{:03}.png", number))) ++number;
      return handle({.kind = Event::Kind::picture, .text = fmt::format("pith-{:03}.png", number)});
    }
    for (const Command& one : command_table())
      if (is_shortcut(one.shortcut, key, mods)) return command(one.name);
  }

  void command(const std::string& name) {
    busy_frames_ = 3;
    for (const Command& one : command_table())
      if (one.name == name && bench_ && (!one.enabled || one.enabled(*bench_)))
        if (const std::optional<Event> event = panels_->ask(*bench_, one)) handle(*event);
  }

  void title() {
    const Document& document = bench_->document();
    const std::string text = document.empty()
                                 ? "pith"
                                 : (document.modified() ? "* " : "") +
                                       (document.file().empty() ? "untitled" : document.file().filename().string()) +
                                       " – pith";
    if (text != title_) glfwSetWindowTitle(window_, (title_ = text).c_str());
  }

  const WindowOptions& options_;
  GLFWwindow* window_ = nullptr;
  Workbench* bench_ = nullptr;
  Panels* panels_ = nullptr;
  Screen* screen_ = nullptr;
  EventList session_;
  std::string title_;
  Vec2d at_{0, 0}, pressed_at_{0, 0};
  double pressed_ = -1;
  bool held_ = false, took_up_ = false;
  bool was_building_ = false, waited_ = false; ///< what was made has ended since the last event
  int busy_frames_ = 3;
};

} // namespace

void run_window(const WindowOptions& options) { Window(options).run(); }

} // namespace pith
