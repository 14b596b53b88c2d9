// Tools that cut: stroke, loop, plane, corer, peel.
#include "viewer/tools.h"
#include "volume/base/error.h"

#include <utility>

namespace pith {
namespace {

constexpr double shortest = 0.004; ///< screen units between points of a stroke

/// Collects the points of a drag.
class Drawn : public Tool {
public:
  void press(Workbench&, const Event& event) override { point_ = {event.at}; }
  void drag(Workbench&, const Event& event) override {
    if (!point_.empty()) drag_to(event.at);
  }
  std::vector<std::vector<Vec2d>> lines(const Workbench&) const override {
    if (point_.size() < 2) return {};
    return {point_};
  }

protected:
  /// The points so far; none are kept.
  std::vector<Vec2d> taken(const Event& event) {
    if (!point_.empty()) drag_to(event.at);
    return std::exchange(point_, {});
  }

private:
  void drag_to(const Vec2d& at) {
    if ((at - point_.back()).norm() >= shortest) point_.push_back(at);
  }
  std::vector<Vec2d> point_;
};

class StrokeTool : public Drawn {
public:
  void release(Workbench& bench, const Event& event) override {
    const std::vector<Vec2d> point = taken(event);
    if (point.size() < 2) return; // a click
    CutStep step;
    step.shape = StrokeCut{.point = point, .view = bench.view()};
    bench.commit(std::move(step), point.front());
  }
};

class LoopTool : public Drawn {
public:
  void release(Workbench& bench, const Event& event) override {
    const std::vector<Vec2d> point = taken(event);
    if (point.size() < 3) return;
    StrokeCut loop{.point = point, .view = bench.view(), .closed = true};
    if (const double depth = bench.settings().scoop_depth; depth > 0) {
      Vec2d middle(0, 0);
      for (const Vec2d& p : point) middle += p / double(point.size());
      auto there = bench.hit(middle);
      if (!there) there = bench.hit(point.front());
      if (!there) throw InvalidInput("loop", "it encloses no piece", "draw it on a piece");
      loop.to = (there->world - bench.view().eye).dot(bench.view().forward()) + depth;
    }
    CutStep step;
    step.shape = std::move(loop);
    bench.commit(std::move(step), point.front());
  }
};

/// A plane that follows the mouse: across a drawn line, or at right angles to an axis.
class PlaneTool : public Tool {
public:
  void press(Workbench& bench, const Event& event) override {
    from_ = event.at;
    const auto there = bench.hit(event.at);
    const View& view = bench.view();
    start_ = there ? there->world : Vec3d(view.target);
    drag(bench, event);
  }
  void drag(Workbench& bench, const Event& event) override {
    to_ = event.at;
    step_.reset();
    const View& view = bench.view();
    PlaneCut plane;
    if (bench.settings().plane_axis == 3) {
      if ((to_ - from_).norm() < 4 * shortest) return;
      const View::Ray a = view.ray(from_.x(), from_.y()), b = view.ray(to_.x(), to_.y());
      const Vec3d along = b.origin + b.direction - a.origin - a.direction;
      plane.normal = along.cross(a.direction).normalized();
      plane.offset = plane.normal.dot(a.origin);
    } else {
      plane.normal = Vec3d::Unit(bench.settings().plane_axis);
      const double half = mm_per_unit(view, start_);
      const Vec2d seen(plane.normal.dot(view.right()), plane.normal.dot(view.upward()));
      const double length = std::max(seen.norm(), 0.1);
      plane.offset = plane.normal.dot(start_) + half * (to_ - from_).dot(seen) / (length * length);
    }
    step_.emplace();
    step_->shape = plane;
    bench.preview(bench.with_settings(*step_, from_));
  }
  void release(Workbench& bench, const Event&) override {
    if (!step_) return;
    CutStep step = *step_;
    step_.reset();
    bench.commit(std::move(step), from_);
  }
  std::vector<std::vector<Vec2d>> lines(const Workbench& bench) const override {
    if (!step_ || bench.settings().plane_axis != 3) return {};
    return {{from_, to_}};
  }

private:
  Vec2d from_{0, 0}, to_{0, 0};
  Vec3d start_{0, 0, 0};
  std::optional<CutStep> step_;
};

/// A cylinder along the view.
class CorerTool : public Tool {
public:
  void press(Workbench& bench, const Event& event) override { drag(bench, event); }
  void drag(Workbench& bench, const Event& event) override {
    at_ = event.at;
    const View::Ray ray = bench.view().ray(event.at.x(), event.at.y());
    step_.emplace();
    step_->shape = CylinderCut{.from = ray.origin,
                               .to = ray.origin + ray.direction,
                               .radius = bench.settings().core_radius,
                               .endless = true};
    bench.preview(bench.with_settings(*step_, at_));
  }
  void release(Workbench& bench, const Event&) override {
    if (step_) bench.commit(*std::exchange(step_, std::nullopt), at_);
  }

private:
  Vec2d at_{0, 0};
  std::optional<CutStep> step_;
};

/// Drags a depth: to the right is deeper.
class PeelTool : public Tool {
public:
  void press(Workbench& bench, const Event& event) override {
    from_ = event.at;
    const auto there = bench.hit(event.at);
    region_ = there ? bench.root()->model().mesh.region[there->tet] : 0;
    drag(bench, event);
  }
  void drag(Workbench& bench, const Event& event) override {
    step_.emplace();
    step_->depth = DepthCut{.region = region_, .value = std::clamp(0.05 + 0.8 * (event.at - from_).x(), 0.02, 0.98)};
    bench.preview(bench.with_settings(*step_, from_));
    bench.say("depth " + std::to_string(step_->depth->value).substr(0, 4));
  }
  void release(Workbench& bench, const Event&) override {
    if (step_) bench.commit(*std::exchange(step_, std::nullopt), from_);
  }

private:
  Vec2d from_{0, 0};
  std::int32_t region_ = 0;
  std::optional<CutStep> step_;
};

} // namespace

std::vector<ToolEntry> cut_tools() {
  return {{"stroke", "Stroke", "2", "draw a line across: it cuts along the view",
           [] { return std::make_unique<StrokeTool>(); }},
          {"plane", "Plane", "3", "drag a plane and see the section at once",
           [] { return std::make_unique<PlaneTool>(); }},
          {"loop", "Loop", "4", "draw a loop: what it encloses is scooped or punched out",
           [] { return std::make_unique<LoopTool>(); }},
          {"corer", "Corer", "5", "a cylinder along the view", [] { return std::make_unique<CorerTool>(); }},
          {"peel", "Peel", "6", "drag to the right: peels off what is less deep",
           [] { return std::make_unique<PeelTool>(); }}};
}

} // namespace pith
