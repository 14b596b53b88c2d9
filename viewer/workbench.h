#pragma once
// What a window is about, without the window: a document, a camera, tools, and the commands that change them. Events
// go in, what to draw comes out. No GL and no widgets, so that all of it can be tested and replayed.
#include "viewer/camera.h"
#include "viewer/document.h"
#include "viewer/drawn_surface.h"
#include "viewer/session.h"
#include "viewer/settings.h"

namespace pith {

class Workbench;

/// One thing that a left drag can do. Made afresh when it is chosen.
class Tool {
public:
  virtual ~Tool() = default;
  virtual void press(Workbench&, const Event&) {}
  virtual void drag(Workbench&, const Event&) {} ///< between press and release
  virtual void release(Workbench&, const Event&) {}
  virtual void wheel(Workbench&, double /*notches*/) {} ///< between press and release
  /// Lines that show the gesture, in screen coordinates.
  virtual std::vector<std::vector<Vec2d>> lines(const Workbench&) const { return {}; }
};

struct ToolEntry {
  std::string name, label, shortcut, tip;
  std::function<std::unique_ptr<Tool>()> make;
};
const std::vector<ToolEntry>& tool_table();

/// A menu item, a key, a word in a session.
struct Command {
  std::string name, menu, label, shortcut, tip;
  bool takes_text = false;
  std::function<void(Workbench&, const std::string& text)> run;
  std::function<bool(const Workbench&)> enabled;
};
/// All of them, tools included ("tool stroke"), in the order of the menus.
const std::vector<Command>& command_table();

/// A line in the world that the recipe holds: strokes of depth and orientation.
struct WorldLine {
  std::vector<Vec3d> point;
  Vec3d color; ///< sRGB; depths from red (0) to blue (1)
};

class Workbench {
public:
  explicit Workbench(DocumentOptions options = {}, double aspect = 4.0 / 3.0);

  /// Never throws: what goes wrong becomes the message. A drag between press and release goes to the tool (left
  /// button), or turns (right), pans (middle, or shift) the camera. Not for Kind::picture.
  void handle(const Event& event);
  /// Call now and then: takes what the background has made.
  void poll();
  const std::string& message() const { return message_; } ///< one line; empty: nothing to say
  bool message_is_error() const { return error_; }
  void say(std::string line) { message_ = std::move(line), error_ = false; }

  Document& document() { return document_; }
  const Document& document() const { return document_; }
  Camera& camera() { return camera_; }
  const View& view() const { return camera_.view(); }
  Settings& settings() { return settings_; }
  const Settings& settings() const { return settings_; }
  const std::vector<Setting>& setting_list() const { return setting_list_; }
  const std::string& tool_name() const { return tool_name_; }
  const Tool& tool() const { return *tool_; }
  void choose_tool(const std::string& name);
  double aspect = 4.0 / 3.0; ///< width / height of what is drawn
  void home(const Vec3d& direction = {0.9, 0.55, 1.3});
  bool quit = false; ///< somebody asked for the end

  // What is drawn.
  const Root* root() const; ///< null: nothing yet
  const Pieces* pieces() const;
  const DrawnSurface& surface(); ///< of the preview, where there is one
  std::uint64_t material_version() const { return material_version_; }
  std::uint64_t surface_version() const { return surface_version_; } ///< changes when surface() does
  std::vector<WorldLine> world_lines() const;
  std::optional<SurfaceHit> hit(const Vec2d& at);

  // For tools.
  void preview(const CutStep& step); ///< shows what the cut would leave; nothing where it fails
  void end_preview();                ///< and of placements
  /// Commits with the settings' keep, spread (of open cuts) and scope; `start`: where the gesture began.
  void commit(CutStep step, const Vec2d& start);
  CutStep with_settings(CutStep step, const Vec2d& start);
  void show_placement(std::uint32_t piece, const Rigid& placement); ///< until the next commit

private:
  void handle_mouse(const Event& event);
  void refresh();
  void surface_changed();

  Settings settings_;
  std::vector<Setting> setting_list_;
  Document document_;
  Camera camera_;
  std::unique_ptr<Tool> tool_;
  std::string tool_name_, message_;
  bool error_ = false;
  std::optional<Button> held_;
  bool panning_ = false;
  Vec2d last_{0, 0};
  std::uint64_t shown_version_ = 0, framed_ = 0, material_version_ = 0, surface_version_ = 0;
  std::shared_ptr<const ReadyRoot> shown_root_; ///< held, so that no other can take its address
  std::optional<Pieces> preview_;
  DrawnSurface surface_;
  bool surface_valid_ = false, placed_ = false; ///< placed: pieces are shown where the document has them not
  double shown_relief_ = 1;
};

} // namespace pith
