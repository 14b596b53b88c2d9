// Tools that design a solid (Takayama 2008, §4): depth by fills and strokes, orientation by strokes. What they draw
// waits for Update.
#include "viewer/tools.h"
#include "volume/base/error.h"
#include "volume/exemplar/procedural.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace pith {
namespace {

/// The entry of a region's solid, made where there is none; a plain one becomes lapped.
Solid& lapped_solid(Recipe& recipe, std::int32_t region, const Settings& settings) {
  for (Solid& solid : recipe.solids)
    if (solid.region == region && solid.kind == Solid::Kind::lapped) return solid;
  std::erase_if(recipe.solids, [&](const Solid& solid) { return solid.region == region; });
  Solid& solid = recipe.solids.emplace_back();
  solid.region = region;
  solid.fill.type = settings.type;
  solid.exemplar.procedural = settings.exemplar;
  if (traits_of(settings.type).uses_scale) solid.scale = settings.scale;
  return solid;
}

std::int32_t region_of(Workbench& bench, const SurfaceHit& there) {
  return bench.root()->model().mesh.region[there.tet];
}

SurfaceHit required_hit(Workbench& bench, const Vec2d& at, const char* what) {
  const auto there = bench.hit(at);
  if (!there)
    throw InvalidInput(what, "the gesture does not begin on the solid", "begin it on the skin or on a section");
  return *there;
}

/// A hit on the skin is outside by rounding, as often as not: the same place, certainly in its tet.
Vec3d inner_place(Workbench& bench, const SurfaceHit& there) {
  const TetMesh& mesh = bench.root()->model().mesh;
  std::array<double, 4> b = barycentric(mesh, there.tet, there.rest);
  double sum = 0;
  for (double& one : b) sum += one = std::max(one, 1e-6);
  Vec3d place = Vec3d::Zero();
  for (int i = 0; i < 4; ++i) place += b[i] / sum * mesh.position[mesh.corner[there.tet][i]];
  return place;
}

/// A click: the skin around it, up to creases, has this depth.
class FillTool : public Tool {
public:
  void release(Workbench& bench, const Event& event) override {
    const SurfaceHit there = required_hit(bench, event.at, "fill");
    if (!there.tag.is_skin()) throw InvalidInput("fill", "that is a section", "click on the skin");
    Recipe recipe = bench.document().recipe();
    DepthConstraint constraint;
    constraint.value = bench.settings().depth;
    constraint.fill.emplace();
    constraint.fill->near = there.rest;
    lapped_solid(recipe, region_of(bench, there), bench.settings()).depth.push_back(constraint);
    bench.document().edit(std::move(recipe), "depth", Document::Build::later);
  }
};

/// A click: one triangle of the surface has this depth.
class FaceTool : public Tool {
public:
  void release(Workbench& bench, const Event& event) override {
    const SurfaceHit there = required_hit(bench, event.at, "face");
    const auto& input = bench.root()->model().boundary.input;
    if (!there.tag.is_skin() || input.empty() || !input[there.facet].exists())
      throw InvalidInput("face", "that is no triangle of the surface file", "click on the skin");
    Recipe recipe = bench.document().recipe();
    DepthConstraint constraint;
    constraint.value = bench.settings().depth;
    constraint.triangles = {input[there.facet]};
    lapped_solid(recipe, region_of(bench, there), bench.settings()).depth.push_back(constraint);
    bench.document().edit(std::move(recipe), "depth", Document::Build::later);
  }
};

/// A line on skin or sections, in rest space.
class StrokeOnSolid : public Tool {
public:
  void press(Workbench& bench, const Event& event) override {
    const SurfaceHit there = required_hit(bench, event.at, "stroke");
    region_ = region_of(bench, there);
    point_ = {there.rest};
    seen_ = {event.at};
  }
  void drag(Workbench& bench, const Event& event) override {
    if (point_.empty() || (event.at - seen_.back()).norm() < 0.008) return;
    const auto there = bench.hit(event.at);
    if (!there || region_of(bench, *there) != region_) return; // beside it
    point_.push_back(there->rest);
    seen_.push_back(event.at);
  }
  std::vector<std::vector<Vec2d>> lines(const Workbench&) const override {
    if (seen_.size() < 2) return {};
    return {seen_};
  }

protected:
  std::vector<Vec3d> taken() { return seen_.clear(), std::exchange(point_, {}); }
  std::int32_t region_ = 0;

private:
  std::vector<Vec3d> point_;
  std::vector<Vec2d> seen_;
};

class DepthTool : public StrokeOnSolid {
public:
  void release(Workbench& bench, const Event&) override {
    const std::vector<Vec3d> point = taken();
    if (point.empty()) return;
    Recipe recipe = bench.document().recipe();
    DepthConstraint constraint;
    constraint.value = bench.settings().depth;
    constraint.stroke = point;
    std::vector<DepthConstraint>& all = lapped_solid(recipe, region_, bench.settings()).depth;
    if (all.empty() &&
        constraint.value > 0) { // depth is from somewhere: as long as nothing else is said, from the skin
      all.emplace_back();
      all.back().skin = true;
    }
    all.push_back(constraint);
    bench.document().edit(std::move(recipe), "depth", Document::Build::later);
  }
};

class OrientationTool : public StrokeOnSolid {
public:
  void release(Workbench& bench, const Event&) override {
    const std::vector<Vec3d> point = taken();
    if (point.size() < 2) return;
    Recipe recipe = bench.document().recipe();
    lapped_solid(recipe, region_, bench.settings()).orientation.push_back({point});
    bench.document().edit(std::move(recipe), "orientation", Document::Build::later);
  }
};

/// Something that is placed where the mouse is pressed, and made larger by dragging away from there.
class PlaceTool : public Tool {
public:
  void press(Workbench& bench, const Event& event) override {
    there_ = required_hit(bench, event.at, "place");
    from_ = to_ = event.at;
    steps_ = 0;
  }
  void drag(Workbench&, const Event& event) override { to_ = event.at; }
  void wheel(Workbench&, double notches) override { steps_ += notches; }
  std::vector<std::vector<Vec2d>> lines(const Workbench&) const override {
    if (!there_) return {};
    std::vector<Vec2d> circle;
    const Vec2d out = to_ - from_;
    const double radius = std::max(out.norm(), 0.01), first = turn() + std::atan2(out.y(), out.x());
    for (int i = 0; i <= 40; ++i) {
      const double angle = first + i * 2 * std::numbers::pi / 40;
      circle.push_back(from_ + radius * Vec2d(std::cos(angle), std::sin(angle)));
    }
    circle.push_back(from_); // shows which way it is turned
    return {circle};
  }

protected:
  virtual double turn() const { return 0; } ///< radians, by the wheel
  /// mm from the place to the mouse, at the place's distance.
  double reach(const Workbench& bench) const {
    return mm_per_unit(bench.view(), there_->world) * (to_ - from_).norm();
  }
  std::optional<SurfaceHit> there_;
  Vec2d from_{0, 0}, to_{0, 0};
  double steps_ = 0; ///< of the wheel
};

/// Takayama 2008, §4: manual pasting. The thing's middle lies where the mouse was pressed.
class PasteTool : public PlaceTool {
public:
  void release(Workbench& bench, const Event& event) override {
    if (!there_) return;
    to_ = event.at;
    const double size = 2 * reach(bench);
    const SurfaceHit there = *std::exchange(there_, std::nullopt);
    if (!(size > 0))
      throw InvalidInput("paste", "it has no size", "drag away from the place, as far as it shall reach");
    PasteStep paste;
    paste.thing.exemplar.procedural = bench.settings().thing;
    const Exemplar small = procedural_exemplar(bench.settings().thing, {.resolution = 16});
    const bool says_where = std::any_of(small.channel.begin(), small.channel.end(),
                                        [](const Channel& channel) { return channel.name == alpha_channel; });
    if (!says_where) paste.thing.mask.emplace();
    paste.options.place = inner_place(bench, there);
    paste.options.size = size;
    paste.options.in_frame = false;
    const Rigid& placement = bench.pieces()->piece[there.piece].placement;
    paste.turn.axis = placement.rotation.transpose() * -bench.view().forward();
    paste.turn.angle = turn() + std::atan2((to_ - from_).y(), (to_ - from_).x());
    Recipe recipe = bench.document().recipe();
    const std::int32_t region = region_of(bench, there);
    auto solid = std::find_if(recipe.solids.begin(), recipe.solids.end(),
                              [&](const Solid& one) { return one.region == region; });
    if (solid == recipe.solids.end()) {
      solid = recipe.solids.emplace(solid);
      solid->region = region;
      solid->kind = Solid::Kind::plain;
    }
    solid->pastes.push_back(std::move(paste));
    bench.document().edit(std::move(recipe), "paste");
  }

protected:
  double turn() const override { return steps_ * std::numbers::pi / 12; }
};

/// Takayama 2008, §4: the texture is as large here as the circle says, compared with what it is.
class ScaleTool : public PlaceTool {
public:
  void drag(Workbench& bench, const Event& event) override {
    PlaceTool::drag(bench, event);
    tell(bench);
  }
  void wheel(Workbench& bench, double notches) override {
    PlaceTool::wheel(bench, notches);
    tell(bench);
  }
  void release(Workbench& bench, const Event& event) override {
    if (!there_) return;
    to_ = event.at;
    const ScaleConstraint constraint{{there_->rest}, factor(bench)};
    const SurfaceHit there = *std::exchange(there_, std::nullopt);
    Recipe recipe = bench.document().recipe();
    lapped_solid(recipe, region_of(bench, there), bench.settings()).local_scale.push_back(constraint);
    bench.document().edit(std::move(recipe), "scale", Document::Build::later);
  }

private:
  /// The circle's diameter over the texture's width there; where nothing is dragged, what the wheel says alone.
  double factor(const Workbench& bench) const {
    const double wheel = std::pow(1.1, steps_);
    if ((to_ - from_).norm() < 0.01) return wheel;
    const PerTet<float>& scale = bench.root()->model().field.scale;
    const bool known = there_->tet < scale.size() && scale[there_->tet] > 0;
    return wheel * std::max(2 * reach(bench) / (known ? double(scale[there_->tet]) : bench.settings().scale), 0.01);
  }
  void tell(Workbench& bench) const {
    if (there_) bench.say("scale × " + std::to_string(factor(bench)).substr(0, 5));
  }
};

} // namespace

std::vector<ToolEntry> solid_tools() {
  return {{"fill", "Fill depth", "", "click: the skin up to its creases gets the depth",
           [] { return std::make_unique<FillTool>(); }},
          {"face", "Face depth", "", "click: one triangle of the surface gets the depth",
           [] { return std::make_unique<FaceTool>(); }},
          {"depth", "Depth stroke", "9", "draw on skin or sections: that line gets the depth",
           [] { return std::make_unique<DepthTool>(); }},
          {"orientation", "Orientation", "0", "draw which way the texture runs",
           [] { return std::make_unique<OrientationTool>(); }},
          {"scale", "Scale", "",
           "drag a circle: one width of the texture becomes as large there; the wheel, while held: by steps",
           [] { return std::make_unique<ScaleTool>(); }},
          {"paste", "Paste", "P", "drag a circle: pastes the thing as large; the wheel, while held, turns it",
           [] { return std::make_unique<PasteTool>(); }}};
}

} // namespace pith
