#include "viewer/workbench.h"

#include "volume/base/error.h"

#include <algorithm>
#include <numbers>

namespace pith {

Workbench::Workbench(DocumentOptions options, double aspect)
    : aspect(aspect), setting_list_(setting_table(settings_)), document_(std::move(options)) {
  choose_tool("navigate");
}

void Workbench::choose_tool(const std::string& name) {
  for (const ToolEntry& entry : tool_table())
    if (entry.name == name) {
      end_preview();
      held_.reset(); // a gesture that was begun with another tool is over
      panning_ = false;
      tool_ = entry.make();
      tool_name_ = name;
      return;
    }
  throw InvalidInput("tool", "there is no '" + name + "'", "choose one of the toolbar's");
}

void Workbench::handle(const Event& event) {
  try {
    switch (event.kind) {
    case Event::Kind::command: {
      const auto& table = command_table();
      const auto found =
          std::find_if(table.begin(), table.end(), [&](const Command& c) { return c.name == event.name; });
      if (found == table.end())
        throw InvalidInput("command", "there is no '" + event.name + "'", "see the menus for what there is");
      say({});
      if (!found->enabled || found->enabled(*this)) found->run(*this, event.text);
      break;
    }
    case Event::Kind::set: {
      const auto found = std::find_if(setting_list_.begin(), setting_list_.end(),
                                      [&](const Setting& s) { return s.name == event.name; });
      if (found == setting_list_.end())
        throw InvalidInput("setting", "there is no '" + event.name + "'", "see the panels for what there is");
      found->set(event.text);
      break;
    }
    case Event::Kind::wait:
      if (const std::string error = document_.wait(); !error.empty()) throw std::runtime_error(error);
      break;
    case Event::Kind::picture:
      break;
    default:
      handle_mouse(event);
    }
  } catch (const std::exception& error) { // whatever a tool or a command throws: the work goes on
    message_ = error.what();
    error_ = true;
    end_preview();
  }
  refresh();
}

void Workbench::poll() {
  if (const std::string error = document_.poll(); !error.empty()) {
    message_ = error;
    error_ = true;
  }
  refresh();
}

void Workbench::handle_mouse(const Event& event) {
  switch (event.kind) {
  case Event::Kind::press:
    if (held_) return; // a second button during a drag says nothing
    held_ = event.button;
    panning_ = event.button == Button::middle || event.shift;
    if (event.button == Button::left && !panning_) {
      say({});
      tool_->press(*this, event);
    }
    break;
  case Event::Kind::drag:
    if (!held_) break;
    if (panning_)
      camera_.pan(last_, event.at);
    else if (*held_ == Button::right || (*held_ == Button::left && tool_name_ == "navigate"))
      camera_.orbit(-1.2 * (event.at.x() - last_.x()), -1.2 * (event.at.y() - last_.y()));
    else if (*held_ == Button::left)
      tool_->drag(*this, event);
    break;
  case Event::Kind::release: {
    if (!held_ || *held_ != event.button) return;
    const bool to_tool = *held_ == Button::left && !panning_;
    held_.reset();
    panning_ = false;
    if (to_tool) tool_->release(*this, event);
    break;
  }
  case Event::Kind::wheel:
    if (held_ == Button::left && !panning_)
      tool_->wheel(*this, event.amount);
    else
      camera_.zoom(std::pow(1.15, event.amount), event.at);
    break;
  case Event::Kind::double_click:
    if (const auto there = hit(event.at)) camera_.center_on(there->world);
    break;
  default:
    break;
  }
  last_ = event.at;
}

void Workbench::home(const Vec3d& direction) {
  Box bounds;
  if (root() && pieces()) {
    for (const DrawnPiece& piece : surface().piece)
      for (std::size_t v = piece.begin; v < piece.end; ++v) {
        const auto& x = surface_.vertex[v].position;
        bounds.add(piece.placement(Vec3d(x[0], x[1], x[2])));
      }
  }
  const bool along_up = std::abs(direction.normalized().y()) > 0.99;
  camera_ = Camera::framing(bounds, direction, along_up ? Vec3d(0, 0, -1) : Vec3d(0, 1, 0), aspect);
}

const Root* Workbench::root() const { return document_.shown() ? &document_.shown()->root->root : nullptr; }

const Pieces* Workbench::pieces() const {
  if (preview_) return &*preview_;
  return document_.shown() ? document_.shown()->pieces.get() : nullptr;
}

const DrawnSurface& Workbench::surface() {
  if (!surface_valid_) {
    surface_ = {};
    if (root() && pieces())
      surface_ = drawn_surface(*root(), *pieces(), document_.shown()->root->skin_normal, {.scale = settings_.relief});
    surface_valid_ = true;
  }
  return surface_;
}

void Workbench::surface_changed() {
  surface_valid_ = placed_ = false;
  ++surface_version_;
}

/// Follows the document and the settings.
void Workbench::refresh() {
  const std::shared_ptr<const ReadyRoot> ready = document_.shown() ? document_.shown()->root : nullptr;
  if (shown_version_ != document_.version() || shown_relief_ != settings_.relief) {
    shown_version_ = document_.version();
    shown_relief_ = settings_.relief;
    preview_.reset();
    surface_changed();
  }
  if (ready != shown_root_) {
    shown_root_ = ready;
    surface_changed();
    ++material_version_;
  }
  if (ready && framed_ != document_.opened()) {
    framed_ = document_.opened();
    settings_.spread = std::round(8 * bounds_of(ready->root.model().mesh).diagonal()) / 100; // halves fall apart
    if (const auto& view = document_.recipe().view)
      camera_ = Camera(*view);
    else
      home();
  }
}

void Workbench::preview(const CutStep& step) {
  try {
    preview_ = document_.preview(step);
  } catch (const InvalidInput&) { // misses, so far
    preview_.reset();
  }
  surface_changed();
}

void Workbench::end_preview() {
  if (!preview_ && !placed_) return;
  preview_.reset();
  surface_changed();
}

CutStep Workbench::with_settings(CutStep step, const Vec2d& start) {
  step.keep = settings_.keep;
  const auto* stroke = std::get_if<StrokeCut>(&step.shape);
  const bool around = step.depth || (stroke && stroke->closed) || std::holds_alternative<CylinderCut>(step.shape);
  // One half alone stays where it is; what lies within another piece has no side to fall to.
  step.spread = around || step.keep != Keep::both ? 0 : settings_.spread;
  if (settings_.one_piece) {
    end_preview();
    const auto there = hit(start);
    if (!there) throw InvalidInput("cut", "the gesture does not begin on a piece", "begin it on the piece to cut");
    step.only = {rest_point_in(*pieces(), there->piece, root()->model().mesh)};
  }
  return step;
}

void Workbench::commit(CutStep step, const Vec2d& start) {
  step = with_settings(std::move(step), start);
  end_preview();
  document_.cut(std::move(step));
}

void Workbench::show_placement(std::uint32_t piece, const Rigid& placement) {
  surface();
  placed_ = true;
  for (DrawnPiece& drawn : surface_.piece)
    if (drawn.piece == piece) drawn.placement = placement;
}

std::optional<SurfaceHit> Workbench::hit(const Vec2d& at) {
  const View::Ray ray = view().ray(at.x(), at.y());
  return nearest_hit(surface(), ray.origin, ray.direction);
}

std::vector<WorldLine> Workbench::world_lines() const {
  std::vector<WorldLine> lines;
  if (document_.empty() || !settings_.strokes) return lines;
  for (const Solid& solid : document_.recipe().solids) {
    for (const DepthConstraint& one : solid.depth)
      if (!one.stroke.empty())
        lines.push_back({one.stroke, {0.85 * (1 - one.value) + 0.1, 0.15, 0.85 * one.value + 0.1}});
    for (const AxisStroke& one : solid.orientation) lines.push_back({one.point, {0.05, 0.55, 0.2}});
  }
  return lines;
}

} // namespace pith
