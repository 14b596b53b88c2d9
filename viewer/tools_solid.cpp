// Tools that design a solid (Takayama 2008, §4): depth by fills and strokes, orientation by strokes. What they draw
// waits for Update.
#include "viewer/tools.h"
#include "volume/base/error.h"

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

} // namespace

std::vector<ToolEntry> solid_tools() {
  return {{"fill", "Fill depth", "", "click: the skin up to its creases gets the depth",
           [] { return std::make_unique<FillTool>(); }},
          {"face", "Face depth", "", "click: one triangle of the surface gets the depth",
           [] { return std::make_unique<FaceTool>(); }},
          {"depth", "Depth stroke", "9", "draw on skin or sections: that line gets the depth",
           [] { return std::make_unique<DepthTool>(); }},
          {"orientation", "Orientation", "0", "draw which way the texture runs",
           [] { return std::make_unique<OrientationTool>(); }}};
}

} // namespace pith
