// Recipe: canonical JSON. Keys stand in the order of docs/recipe.md; options that equal the library's defaults are
// left out, so that a recipe says what its author decided.
#include "recipe/recipe.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace pith {
namespace {

using json = nlohmann::ordered_json;

json json_from(const Vec3d& v) { return json::array({v.x(), v.y(), v.z()}); }
json json_from(const Vec2d& v) { return json::array({v.x(), v.y()}); }
template <class Point>
json json_from(const std::vector<Point>& points) {
  json result = json::array();
  for (const Point& point : points) result.push_back(json_from(point));
  return result;
}

/// Writes a value that differs from the default.
template <class T>
void put(json& into, const char* key, const T& value, const T& usual) {
  if (!(value == usual)) into[key] = value;
}
void put_object(json& into, const char* key, json value) {
  if (!value.empty()) into[key] = std::move(value);
}

json json_from(const TetrahedralizeOptions& options) {
  const TetrahedralizeOptions usual;
  json result = json::object();
  const char* methods[] = {"automatic", "tetgen", "wrap"};
  if (options.method != usual.method) result["method"] = methods[static_cast<int>(options.method)];
  put(result, "interior_edge", options.interior_edge, usual.interior_edge);
  put(result, "core_edge", options.core_edge, usual.core_edge);
  put(result, "core_growth", options.core_growth, usual.core_growth);
  put(result, "boundary_edge", options.boundary_edge, usual.boundary_edge);
  put(result, "radius_edge", options.radius_edge, usual.radius_edge);
  put(result, "wrap_alpha", options.wrap_alpha, usual.wrap_alpha);
  put(result, "wrap_offset", options.wrap_offset, usual.wrap_offset);
  put(result, "time_limit", options.time_limit, usual.time_limit);
  return result;
}

json json_from(const DepthConstraint& constraint) {
  json result = json::object();
  if (constraint.skin) result["skin"] = true;
  if (constraint.outside) result["outside"] = true;
  if (constraint.interface) result["interface"] = *constraint.interface;
  if (!constraint.triangles.empty()) {
    json triangles = json::array();
    for (const TriangleId t : constraint.triangles) triangles.push_back(t.value);
    result["triangles"] = std::move(triangles);
  }
  if (constraint.fill) {
    if (constraint.fill->triangle.exists())
      result["fill"] = constraint.fill->triangle.value;
    else
      result["fill"] = json_from(constraint.fill->near);
    put(result, "crease", constraint.fill->crease, FaceFill().crease);
  }
  if (!constraint.stroke.empty()) result["stroke"] = json_from(constraint.stroke);
  result["value"] = constraint.value;
  return result;
}

json json_from(const ExemplarSource& source) {
  if (!source.file.empty()) {
    json result = {{"file", source.file}};
    if (source.tile) {
      std::string along;
      for (int axis = 0; axis < 3; ++axis)
        if (source.tile->axis[axis]) along += "RST"[axis];
      result["tile"] = {{"along", along}, {"border", source.tile->border}};
    }
    return result;
  }
  return {{"procedural", source.procedural}, {"resolution", source.resolution}, {"seed", source.seed}};
}

json json_from(const SplotchOptions& mask) {
  const SplotchOptions usual;
  json result = json::object();
  put(result, "resolution", mask.resolution, usual.resolution);
  put(result, "radius", mask.radius, usual.radius);
  put(result, "radius_outer", mask.radius_outer, usual.radius_outer);
  put(result, "radius_along", mask.radius_along, usual.radius_along);
  put(result, "reach_outer", mask.reach_outer, usual.reach_outer);
  put(result, "reach_inner", mask.reach_inner, usual.reach_inner);
  put(result, "drop_off", mask.drop_off, usual.drop_off);
  put(result, "irregularity", mask.irregularity, usual.irregularity);
  put(result, "seed", mask.seed, usual.seed);
  return result;
}

json json_from(const FrameOptions& frame) {
  const FrameOptions usual;
  json result = json::object();
  put(result, "layer_width", frame.layer_width, usual.layer_width);
  put(result, "singular_sine", frame.singular_sine, usual.singular_sine);
  put(result, "vanishing_rise", frame.vanishing_rise, usual.vanishing_rise);
  put(result, "smallest_scale", frame.smallest_scale, usual.smallest_scale);
  put(result, "largest_scale", frame.largest_scale, usual.largest_scale);
  if (frame.unsigned_axis) result["axis"] = "unsigned";
  return result;
}

json json_from(const AxisStroke& stroke) { return {{"stroke", json_from(stroke.point)}}; }

json json_from(const ScaleConstraint& local) {
  json result = json::object();
  if (local.stroke.size() == 1)
    result["point"] = json_from(local.stroke.front());
  else
    result["stroke"] = json_from(local.stroke);
  result["factor"] = local.factor;
  return result;
}

/// What pastes and scatter share, after the thing itself.
template <class Step>
void put_common(json& into, const Step& step) {
  const std::remove_cvref_t<decltype(step.options)> usual;
  into["size"] = step.options.size;
  if (!step.options.in_frame) into["axes"] = "rest";
  if (step.turn.angle != 0) into["rotate"] = {{"axis", json_from(step.turn.axis)}, {"angle", step.turn.angle}};
  if (step.options.follow == Follow::warped) into["follow"] = "warped";
  put(into, "clip", step.options.clip, usual.clip);
}

json thing_json(const ThingSource& thing) {
  json result = {{"exemplar", json_from(thing.exemplar)}};
  if (thing.mask) result["mask"] = json_from(*thing.mask); // an empty one says that there is a mask
  return result;
}

json json_from(const PasteStep& step) {
  json result = thing_json(step.thing);
  result["place"] = json_from(step.options.place);
  put_common(result, step);
  return result;
}

json json_from(const ScatterStep& step) {
  const ScatterOptions& o = step.options;
  const ScatterOptions usual;
  json result = thing_json(step.thing);
  put(result, "count", o.count, usual.count);
  put(result, "spacing", o.spacing, usual.spacing);
  put(result, "gap", o.gap, usual.gap);
  put_common(result, step);
  put(result, "size_variation", o.size_variation, usual.size_variation);
  if (o.depth != usual.depth) result["depth"] = {o.depth[0], o.depth[1]};
  if (o.axis != usual.axis || o.along != usual.along || o.groups != usual.groups)
    result["axis"] = {json_from(o.axis[0]), json_from(o.axis[1])};
  if (o.along != usual.along) result["along"] = {o.along[0], o.along[1]};
  put(result, "groups", o.groups, usual.groups);
  put(result, "group_width", o.group_width, usual.group_width);
  put(result, "jitter", o.jitter, usual.jitter);
  put(result, "spin", o.spin, usual.spin);
  result["seed"] = o.seed;
  return result;
}

json json_from(const Solid& solid);
json json_from(const DivideStep& divide);
json json_from(const CutStep& cut);
json json_from(const MoveStep& move);
template <class T>
void put_list(json& into, const char* key, const std::vector<T>& entries) {
  if (entries.empty()) return;
  json list = json::array();
  for (const T& entry : entries) list.push_back(json_from(entry));
  into[key] = std::move(list);
}

json json_from(const Solid& solid) {
  json result = {{"region", solid.region}};
  if (solid.kind == Solid::Kind::plain) {
    result["type"] = "plain";
    result["color"] = json_from(solid.color);
    put_list(result, "scatter", solid.scatter);
    put_list(result, "pastes", solid.pastes);
    return result;
  }
  result["type"] = traits_of(solid.fill.type).name;
  put_list(result, "depth", solid.depth);
  put_list(result, "along", solid.along);
  put_list(result, "around", solid.around);
  json depth_options = json::object();
  put(depth_options, "max_centers", solid.depth_options.max_centers, DepthOptions().max_centers);
  put(depth_options, "stroke_spacing", solid.depth_options.stroke_spacing, DepthOptions().stroke_spacing);
  if (!solid.depth_options.remove_extrema) depth_options["extrema"] = "keep";
  if (solid.depth_options.guard_overshoot) depth_options["overshoot"] = "guard";
  put(depth_options, "persistence", solid.depth_options.persistence, DepthOptions().persistence);
  put_object(result, "depth_options", std::move(depth_options));
  put_list(result, "orientation", solid.orientation);
  put(result, "scale", solid.scale, 0.0);
  put_list(result, "local_scale", solid.local_scale);
  put_object(result, "frame", json_from(solid.frame));
  result["exemplar"] = json_from(solid.exemplar);
  put_object(result, "mask", json_from(solid.fill.splotch));
  const LapOptions usual;
  json fill = json::object();
  put(fill, "frame_tolerance", solid.fill.frame_tolerance, usual.frame_tolerance);
  put(fill, "length_weight", solid.fill.length_weight, usual.length_weight);
  put(fill, "scale_tolerance", solid.fill.scale_tolerance, usual.scale_tolerance);
  put(fill, "sample_spacing", solid.fill.sample_spacing, usual.sample_spacing);
  put(fill, "coverage_order", solid.fill.coverage_order, usual.coverage_order);
  put(fill, "mask_variants", solid.fill.mask_variants, usual.mask_variants);
  put(fill, "align", solid.fill.align, usual.align);
  put(fill, "structured", solid.fill.structured, usual.structured);
  put(fill, "preserve_variance", solid.fill.preserve_variance, usual.preserve_variance);
  put(fill, "max_attempts", solid.fill.max_attempts, usual.max_attempts);
  put_object(result, "fill", std::move(fill));
  result["seed"] = solid.fill.seed;
  put_list(result, "scatter", solid.scatter);
  put_list(result, "pastes", solid.pastes);
  return result;
}

json json_from(const View& view) {
  json result = {{"eye", json_from(view.eye)}, {"target", json_from(view.target)}, {"up", json_from(view.up)}};
  result["vertical_angle"] = view.vertical_angle;
  put(result, "height", view.height, View().height);
  return result;
}

void put_shape(json& into, const LevelSetShape& shape) {
  if (const auto* plane = std::get_if<PlaneCut>(&shape)) {
    into["plane"] = {{"normal", json_from(plane->normal)}, {"offset", plane->offset}};
    if (const Waves& waves = plane->waves; waves.amplitude > 0)
      into["plane"]["waves"] = {{"amplitude", waves.amplitude}, {"length", waves.length}, {"seed", waves.seed}};
  }
  if (const auto* sphere = std::get_if<SphereCut>(&shape))
    into["sphere"] = {{"center", json_from(sphere->center)}, {"radius", sphere->radius}};
  if (const auto* stroke = std::get_if<StrokeCut>(&shape)) {
    json& entry = into["stroke"] = {{"points", json_from(stroke->point)}, {"view", json_from(stroke->view)}};
    put(entry, "closed", stroke->closed, false);
    put(entry, "from", stroke->from, StrokeCut().from);
    put(entry, "to", stroke->to, StrokeCut().to);
  }
  if (const auto* box = std::get_if<BoxCut>(&shape)) {
    into["box"] = {{"center", json_from(box->center)}, {"size", json_from(box->size)}};
    if (box->angle != 0) into["box"]["rotate"] = {{"axis", json_from(box->axis)}, {"angle", box->angle}};
  }
  if (const auto* cylinder = std::get_if<CylinderCut>(&shape)) {
    into["cylinder"] = {
        {"from", json_from(cylinder->from)}, {"to", json_from(cylinder->to)}, {"radius", cylinder->radius}};
    put(into["cylinder"], "endless", cylinder->endless, false);
  }
  if (const auto* sheet = std::get_if<SheetCut>(&shape))
    into["sheet"] = {{"points", json_from(sheet->point)}, {"normals", json_from(sheet->normal)}};
}

json json_of_file(const SurfaceSource& surface) {
  json result = {{"file", surface.file}};
  if (!surface.shape.empty()) result = {{"shape", surface.shape}, {"triangles", surface.triangles}};
  put(result, "scale", surface.scale, 1.0);
  return result;
}

json json_from(const DivideStep& divide) {
  json result = json::object();
  if (divide.surface) {
    result["surface"] = json_of_file(*divide.surface);
  } else {
    put_shape(result, divide.shape);
  }
  if (!divide.only.empty()) result["only"] = divide.only;
  put(result, "snap", divide.snap, DivideStep().snap);
  return result;
}

json json_from(const CutStep& cut) {
  json result = json::object();
  if (!cut.join.empty())
    result["join"] = json_from(cut.join);
  else if (cut.surface)
    result["surface"] = json_of_file(*cut.surface);
  else if (cut.depth)
    result["depth"] = {{"region", cut.depth->region}, {"value", cut.depth->value}};
  else
    put_shape(result, cut.shape);
  if (cut.keep != Keep::both) result["keep"] = cut.keep == Keep::left ? "left" : "right";
  put(result, "spread", cut.spread, 0.0);
  put(result, "snap", cut.snap, CutStep().snap);
  if (!cut.only.empty()) result["only"] = json_from(cut.only);
  if (!cut.placements.empty()) {
    json placements = json::array();
    for (const PiecePlacement& one : cut.placements) {
      const Mat3d& r = one.placement.rotation;
      json entry = {{"piece", json_from(one.piece)}};
      if (r != Mat3d::Identity())
        entry["rotation"] = {json_from(Vec3d(r.row(0))), json_from(Vec3d(r.row(1))), json_from(Vec3d(r.row(2)))};
      entry["translation"] = json_from(one.placement.translation);
      placements.push_back(std::move(entry));
    }
    result["placements"] = std::move(placements);
  }
  return result;
}

json json_from(const MoveStep& move) {
  if (move.explode) return {{"explode", *move.explode}};
  if (move.drop) return {{"drop", *move.drop}};
  json result = {{"piece", json_from(move.piece)}, {"translate", json_from(move.translate)}};
  if (move.angle != 0) {
    result["rotate"] = {{"axis", json_from(move.axis)}, {"angle", move.angle}};
    if (move.about) result["about"] = json_from(*move.about);
  }
  return result;
}

/// Shortest text that reads back alike; whole numbers without a point.
std::string scalar(const json& value) {
  if (value.is_number_float()) {
    const double x = value.get<double>();
    if (x == std::trunc(x) && std::abs(x) < 1e15 && !(x == 0 && std::signbit(x)))
      return std::to_string(static_cast<std::int64_t>(x));
  }
  return value.dump();
}

bool flat(const json& value) {
  for (const json& entry : value)
    if (entry.is_structured()) return false;
  return true;
}

/// Lists of numbers on one line, everything else indented by two.
void print(const json& value, int indent, std::string& text) {
  if (!value.is_structured() || value.empty() || (value.is_array() && flat(value))) {
    if (!value.is_array() || value.empty()) {
      text += scalar(value);
      return;
    }
    text += '[';
    for (std::size_t i = 0; i < value.size(); ++i) text += (i ? ", " : "") + scalar(value[i]);
    text += ']';
    return;
  }
  const std::string margin(indent + 2, ' ');
  const bool object = value.is_object();
  text += object ? "{\n" : "[\n";
  bool first = true;
  for (const auto& entry : value.items()) {
    if (!first) text += ",\n";
    first = false;
    text += margin;
    if (object) text += json(entry.key()).dump() + ": ";
    print(entry.value(), indent + 2, text);
  }
  text += '\n' + std::string(indent, ' ') + (object ? '}' : ']');
}

} // namespace

std::string recipe_text(const Recipe& recipe) {
  json document = {{"pith", 1}};
  if (!recipe.name.empty()) document["name"] = recipe.name;
  if (recipe.surface.shape.empty())
    document["surface"] = {{"file", recipe.surface.file}};
  else
    document["surface"] = {{"shape", recipe.surface.shape}, {"triangles", recipe.surface.triangles}};
  put(document["surface"], "scale", recipe.surface.scale, 1.0);
  put_object(document, "tetrahedralize", json_from(recipe.tetrahedralize));
  put_list(document, "divide", recipe.divides);
  put_list(document, "solids", recipe.solids);
  put_list(document, "cuts", recipe.cuts);
  put_list(document, "moves", recipe.moves);
  if (recipe.view) document["view"] = json_from(*recipe.view);
  if (!recipe.scene.empty()) document["scene"] = recipe.scene;
  std::string text;
  print(document, 0, text);
  return text + "\n";
}

} // namespace pith
