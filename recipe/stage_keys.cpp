#include "recipe/stage_keys.h"

#include "recipe/build.h"

namespace pith {
namespace {

void add_view(KeyMaker& maker, const View& view) {
  maker.add(view.eye).add(view.target).add(view.up).add(view.vertical_angle).add(view.height);
}

KeyMaker& add(KeyMaker& maker, const LevelSetShape& shape) {
  maker.add(static_cast<std::uint64_t>(shape.index()));
  if (const auto* plane = std::get_if<PlaneCut>(&shape)) {
    maker.add(plane->normal).add(plane->offset);
    maker.add(plane->waves.amplitude).add(plane->waves.length).add(plane->waves.seed);
  }
  if (const auto* sphere = std::get_if<SphereCut>(&shape)) maker.add(sphere->center).add(sphere->radius);
  if (const auto* stroke = std::get_if<StrokeCut>(&shape)) {
    maker.add(stroke->point).add(stroke->closed).add(stroke->from).add(stroke->to);
    add_view(maker, stroke->view);
  }
  if (const auto* box = std::get_if<BoxCut>(&shape))
    maker.add(box->center).add(box->size).add(box->axis).add(box->angle);
  if (const auto* cylinder = std::get_if<CylinderCut>(&shape))
    maker.add(cylinder->from).add(cylinder->to).add(cylinder->radius).add(cylinder->endless);
  if (const auto* sheet = std::get_if<SheetCut>(&shape)) maker.add(sheet->point).add(sheet->normal);
  return maker;
}

} // namespace

KeyMaker& add(KeyMaker& maker, const TetrahedralizeOptions& options) {
  if (options.core_edge > 0)
    for (const std::vector<Vec3d>& line : options.core) maker.add(line);
  return maker.add(static_cast<int>(options.method))
      .add(options.interior_edge)
      .add(options.core_edge)
      .add(options.core_growth)
      .add(options.boundary_edge)
      .add(options.radius_edge)
      .add(options.wrap_alpha)
      .add(options.wrap_offset)
      .add(options.time_limit);
}

KeyMaker& add(KeyMaker& maker, const std::vector<DepthConstraint>& constraints) {
  maker.add(static_cast<std::uint64_t>(constraints.size()));
  for (const DepthConstraint& one : constraints) {
    maker.add(one.value)
        .add(one.skin)
        .add(one.outside)
        .add(one.interface.value_or(-1))
        .add(one.stroke)
        .add(static_cast<std::uint64_t>(one.triangles.size()));
    for (const TriangleId triangle : one.triangles) maker.add(static_cast<std::uint64_t>(triangle.value));
    maker.add(one.fill.has_value());
    if (one.fill)
      maker.add(one.fill->near).add(static_cast<std::uint64_t>(one.fill->triangle.value)).add(one.fill->crease);
  }
  return maker;
}

KeyMaker& add(KeyMaker& maker, const DepthOptions& options) {
  return maker.add(options.max_centers)
      .add(options.stroke_spacing)
      .add(options.remove_extrema)
      .add(options.guard_overshoot)
      .add(options.persistence);
}

KeyMaker& add(KeyMaker& maker, const std::vector<AxisStroke>& strokes) {
  maker.add(static_cast<std::uint64_t>(strokes.size()));
  for (const AxisStroke& stroke : strokes) maker.add(stroke.point);
  return maker;
}

KeyMaker& add(KeyMaker& maker, const std::vector<ScaleConstraint>& constraints) {
  maker.add(static_cast<std::uint64_t>(constraints.size()));
  for (const ScaleConstraint& one : constraints) maker.add(one.stroke).add(one.factor);
  return maker;
}

KeyMaker& add(KeyMaker& maker, const FrameOptions& options) {
  return maker.add(options.layer_width)
      .add(options.singular_sine)
      .add(options.vanishing_rise)
      .add(options.smallest_scale)
      .add(options.largest_scale)
      .add(options.unsigned_axis);
}

KeyMaker& add(KeyMaker& maker, const LapOptions& options) {
  maker.add(static_cast<int>(options.type))
      .add(options.seed)
      .add(options.frame_tolerance)
      .add(options.length_weight)
      .add(options.scale_tolerance)
      .add(options.coverage_order)
      .add(options.sample_spacing)
      .add(options.mask_variants)
      .add(options.align)
      .add(options.preserve_variance)
      .add(options.structured)
      .add(options.max_attempts);
  return add(maker, options.splotch);
}

KeyMaker& add(KeyMaker& maker, const SplotchOptions& mask) {
  return maker.add(mask.axes)
      .add(mask.resolution)
      .add(mask.radius)
      .add(mask.radius_outer)
      .add(mask.radius_along)
      .add(mask.reach_outer)
      .add(mask.reach_inner)
      .add(mask.drop_off)
      .add(mask.irregularity)
      .add(mask.variation_axis)
      .add(mask.endless_axis)
      .add(mask.seed);
}

KeyMaker& add(KeyMaker& maker, const DivideStep& step) {
  add(maker, step.shape).add(static_cast<std::uint64_t>(step.only.size()));
  for (const std::int32_t region : step.only) maker.add(static_cast<int>(region));
  return maker.add(step.surface.has_value()).add(step.snap);
}

KeyMaker& add(KeyMaker& maker, const PasteStep& step) {
  const PasteOptions& o = step.options;
  return maker.add(o.place)
      .add(o.size)
      .add(step.turn.axis)
      .add(step.turn.angle)
      .add(o.in_frame)
      .add(static_cast<int>(o.follow))
      .add(o.clip);
}

KeyMaker& add(KeyMaker& maker, const ScatterStep& step) {
  const ScatterOptions& o = step.options;
  return maker.add(o.count)
      .add(o.spacing)
      .add(o.gap)
      .add(o.size)
      .add(o.size_variation)
      .add(o.depth[0])
      .add(o.depth[1])
      .add(o.axis[0])
      .add(o.axis[1])
      .add(o.along[0])
      .add(o.along[1])
      .add(o.groups)
      .add(o.group_width)
      .add(step.turn.axis)
      .add(step.turn.angle)
      .add(o.in_frame)
      .add(o.jitter)
      .add(o.spin)
      .add(static_cast<int>(o.follow))
      .add(o.clip)
      .add(o.seed);
}

KeyMaker& add(KeyMaker& maker, const CutStep& step) {
  add(maker, step.shape);
  maker.add(step.join).add(step.surface.has_value()).add(step.depth.has_value());
  if (step.depth) maker.add(static_cast<int>(step.depth->region)).add(step.depth->value);
  maker.add(static_cast<int>(step.keep)).add(step.spread).add(step.snap).add(step.only);
  maker.add(static_cast<std::uint64_t>(step.placements.size()));
  for (const PiecePlacement& stood : step.placements) {
    maker.add(stood.piece).add(stood.placement.translation);
    for (int column = 0; column < 3; ++column) maker.add(Vec3d(stood.placement.rotation.col(column)));
  }
  return maker;
}

KeyMaker& add(KeyMaker& maker, const MoveStep& step) {
  maker.add(step.explode.has_value()).add(step.explode.value_or(0));
  maker.add(step.drop.has_value()).add(step.drop.value_or(0));
  maker.add(step.piece).add(step.translate).add(step.axis).add(step.angle).add(step.about.has_value());
  if (step.about) maker.add(*step.about);
  return maker;
}

std::map<std::string, std::string> BuildResult::keys() const {
  std::map<std::string, std::string> result;
  for (const StageReport& stage : stages) result[stage.name] = stage.key;
  return result;
}

void add_last_cut(std::map<std::string, std::string>& keys, const Recipe& recipe) {
  std::erase_if(keys, [](const auto& entry) { return entry.first.starts_with("move "); });
  const std::size_t last = recipe.cuts.size() - 1;
  if (recipe.cuts[last].surface || recipe.cuts[last].depth) return; // its key is only known to a build
  const std::string before = last == 0 ? "refine" : "cut " + std::to_string(last - 1);
  const auto found = keys.find(before);
  if (found == keys.end()) return; // a model that was not built from a recipe
  KeyMaker cut(code_version());
  cut.add("cut").add(key_from(found->second));
  keys["cut " + std::to_string(last)] = add(cut, recipe.cuts[last]).key().text();
}

void add_last_move(std::map<std::string, std::string>& keys, const Recipe& recipe) {
  const std::size_t last = recipe.moves.size() - 1, cuts = recipe.cuts.size();
  const std::string before = last > 0   ? "move " + std::to_string(last - 1)
                             : cuts > 0 ? "cut " + std::to_string(cuts - 1)
                                        : "refine";
  const auto found = keys.find(before);
  if (found == keys.end()) return; // a model that was not built from a recipe
  KeyMaker move(code_version());
  move.add("move").add(key_from(found->second));
  keys["move " + std::to_string(last)] = add(move, recipe.moves[last]).key().text();
}

} // namespace pith
