// Tools that arrange pieces: move, join.
#include "viewer/tools.h"
#include "volume/base/error.h"

#include <utility>

namespace pith {
namespace {

/// Drags a piece across the view; with Ctrl it turns about the direction of sight.
class MoveTool : public Tool {
public:
  void press(Workbench& bench, const Event& event) override {
    grip_.reset();
    if (bench.document().stale()) return;
    if (const auto there = bench.hit(event.at)) {
      const Pieces& pieces = *bench.pieces();
      grip_ = Grip{there->piece, there->world, pieces.piece[there->piece].placement, event.at, event.control, {}};
      grip_->step.piece = rest_point_in(pieces, there->piece, bench.root()->model().mesh);
    }
  }
  void drag(Workbench& bench, const Event& event) override {
    if (!grip_) return;
    const View& view = bench.view();
    const Vec2d by = event.at - grip_->from;
    Rigid placement = grip_->placement;
    if (grip_->turning) {
      grip_->step.axis = -view.forward();
      grip_->step.angle = 2 * by.x();
      grip_->step.about = grip_->point;
      const Mat3d turn = Eigen::AngleAxisd(grip_->step.angle, grip_->step.axis).toRotationMatrix();
      placement.rotation = turn * placement.rotation;
      placement.translation = turn * (placement.translation - grip_->point) + grip_->point;
    } else {
      const double half = mm_per_unit(view, grip_->point);
      grip_->step.translate = half * (by.x() * view.right() + by.y() * view.upward());
      placement.translation += grip_->step.translate;
    }
    bench.show_placement(grip_->piece, placement);
  }
  void release(Workbench& bench, const Event&) override {
    if (!grip_) return;
    const MoveStep step = std::exchange(grip_, std::nullopt)->step;
    if (step.angle != 0 || step.translate.norm() > 0) bench.document().move(step);
  }

private:
  struct Grip {
    std::uint32_t piece;
    Vec3d point;
    Rigid placement;
    Vec2d from;
    bool turning;
    MoveStep step;
  };
  std::optional<Grip> grip_;
};

/// From one piece to another: they become one.
class JoinTool : public Tool {
public:
  void press(Workbench& bench, const Event& event) override {
    first_ = bench.hit(event.at);
    from_ = to_ = event.at;
  }
  void drag(Workbench&, const Event& event) override { to_ = event.at; }
  void release(Workbench& bench, const Event& event) override {
    const auto first = std::exchange(first_, std::nullopt);
    const auto second = bench.hit(event.at);
    if (!first || !second || first->piece == second->piece)
      throw InvalidInput("join", "the drag does not lead from one piece to another",
                         "press on one piece and release on the other");
    CutStep step;
    for (const std::uint32_t piece : {first->piece, second->piece})
      step.join.push_back(rest_point_in(*bench.pieces(), piece, bench.root()->model().mesh));
    bench.document().cut(std::move(step));
  }
  std::vector<std::vector<Vec2d>> lines(const Workbench&) const override {
    return first_ ? std::vector<std::vector<Vec2d>>{{from_, to_}} : std::vector<std::vector<Vec2d>>{};
  }

private:
  std::optional<SurfaceHit> first_;
  Vec2d from_{0, 0}, to_{0, 0};
};

} // namespace

std::vector<ToolEntry> piece_tools() {
  return {{"move", "Move", "7", "drag a piece; with Ctrl it turns", [] { return std::make_unique<MoveTool>(); }},
          {"join", "Join", "8", "drag from one piece to its neighbour: they become one",
           [] { return std::make_unique<JoinTool>(); }}};
}

} // namespace pith
