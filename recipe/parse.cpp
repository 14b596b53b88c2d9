// Recipe: the document as a whole, its surface and its solids. docs/recipe.md is the manual of the format.
#include "recipe/json_node.h"
#include "recipe/parse_steps.h"
#include "recipe/parse_things.h"
#include "recipe/parse_types.h"
#include "recipe/recipe.h"
#include "volume/base/error.h"
#include "volume/exemplar/procedural.h"
#include "volume/io/atomic_file.h"

#include <algorithm>

namespace pith {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double endless = std::numeric_limits<double>::infinity();
constexpr int format_version = 1;

TetrahedralizeOptions tetrahedralize_from(const JsonNode& node) {
  node.object({"method", "interior_edge", "boundary_edge", "core_edge", "core_growth", "radius_edge", "wrap_alpha",
               "wrap_offset", "time_limit"});
  TetrahedralizeOptions result;
  if (const auto method = node.find("method"))
    result.method = static_cast<TetrahedralizeOptions::Method>(method->choice({"automatic", "tetgen", "wrap"}));
  const NumberRange edge{0, endless, false, "positive (0: the default)", "give millimetres"};
  node.optional_number("interior_edge", result.interior_edge, edge);
  node.optional_number("boundary_edge", result.boundary_edge, edge);
  node.optional_number("core_edge", result.core_edge, edge);
  node.optional_number("core_growth", result.core_growth,
                       {0.01, endless, false, "0.01 or more", "give mm of edge per mm of distance"});
  node.optional_number("radius_edge", result.radius_edge, {1.1, 10, false, "1.1 to 10", "1.4 makes good tets"});
  node.optional_number("wrap_alpha", result.wrap_alpha,
                       {1e-4, 1, false, "0.0001 to 1", "give a fraction of the diagonal"});
  node.optional_number("wrap_offset", result.wrap_offset,
                       {1e-5, 1, false, "0.00001 to 1", "give a fraction of the diagonal"});
  node.optional_number("time_limit", result.time_limit, {0, endless, true, "positive", "give seconds"});
  if (result.wrap_offset > result.wrap_alpha)
    node.fail("has a wrap_offset above its wrap_alpha", "make the offset the smaller one, a tenth of alpha, say");
  return result;
}

DepthConstraint depth_from(const JsonNode& node) {
  node.object({"skin", "outside", "interface", "triangles", "fill", "crease", "stroke", "value"});
  DepthConstraint result;
  result.value = node.at("value").number({0, 1, false, "0 to 1", "0 is the outermost depth, 1 the innermost"});
  const int places = node.has("skin") + node.has("outside") + node.has("interface") + node.has("triangles") +
                     node.has("fill") + node.has("stroke");
  if (places != 1)
    node.fail(places == 0 ? "names no place" : "names more than one place",
              "give exactly one of \"skin\": true, \"outside\": true, \"interface\", \"triangles\", \"fill\" and "
              "\"stroke\"");
  if (const auto skin = node.find("skin")) {
    result.skin = skin->boolean();
    if (!result.skin) skin->fail("is false, which names no place", "write true, or remove the entry");
  }
  if (const auto outside = node.find("outside")) {
    result.outside = outside->boolean();
    if (!result.outside) outside->fail("is false, which names no place", "write true, or remove the entry");
  }
  if (const auto interface = node.find("interface"))
    result.interface =
        static_cast<std::int32_t>(interface->whole(0, 1'000'000, "name the region on the other side, from 0"));
  if (const auto triangles = node.find("triangles"))
    for (const JsonNode& triangle : triangles->items(1, "name input triangles, from 0"))
      result.triangles.emplace_back(triangle.whole(0, 0xfffffffeLL, "give the number of an input triangle, from 0"));
  if (const auto fill = node.find("fill")) {
    result.fill.emplace();
    if (fill->is_array())
      result.fill->near = fill->vector3();
    else
      result.fill->triangle = TriangleId(
          fill->whole(0, 0xfffffffeLL, "give a point [x, y, z] on the surface or the number of an input triangle"));
    node.optional_number("crease", result.fill->crease, {0, pi, false, "0 to pi", "give radians"});
  } else if (node.has("crease")) {
    node.at("crease").fail("belongs to a \"fill\"", "remove it, or give the fill's place");
  }
  if (const auto stroke = node.find("stroke")) result.stroke = stroke->points(1, "give points [x, y, z] in mm");
  return result;
}

/// `noun`: what the values are called.
void refuse_contradictions(const JsonNode& node, const std::vector<DepthConstraint>& depth, const std::string& noun) {
  const DepthConstraint* skin = nullptr;
  double low = 1, high = 0;
  for (const DepthConstraint& one : depth) {
    low = std::min(low, one.value), high = std::max(high, one.value);
    if (!one.skin) continue;
    if (skin && skin->value != one.value)
      node.fail("gives the skin two " + noun + "s", "keep one of the \"skin\" entries");
    skin = &one;
  }
  if (low == high)
    node.fail("gives every place the same " + noun, "add a place of another " + noun + ", the core at 1, say");
  for (std::size_t i = 0; i < depth.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (depth[i].value == depth[j].value) continue;
      if (depth[i].outside && depth[j].outside)
        node.fail("gives the outside two depths", "keep one of the \"outside\" entries");
      if (depth[i].interface && depth[i].interface == depth[j].interface)
        node.fail("gives the interface with region " + std::to_string(*depth[i].interface) + " two depths",
                  "keep one of the entries");
      if ((depth[i].skin && (depth[j].outside || depth[j].interface)) ||
          (depth[j].skin && (depth[i].outside || depth[i].interface)))
        node.fail("gives a part of the skin a depth of its own beside \"skin\"",
                  "name the parts by \"outside\" and \"interface\" instead of \"skin\"");
      for (const TriangleId t : depth[i].triangles)
        if (std::find(depth[j].triangles.begin(), depth[j].triangles.end(), t) != depth[j].triangles.end())
          node.fail("gives input triangle " + std::to_string(t) + " two " + noun + "s (entries " + std::to_string(j) +
                        " and " + std::to_string(i) + ")",
                    "keep it in one of them");
    }
}

std::vector<DepthConstraint> field_from(const JsonNode& node, const std::string& noun) {
  std::vector<DepthConstraint> result;
  for (const JsonNode& entry : node.items(2, "a field needs a place of value 0 and one of value 1"))
    result.push_back(depth_from(entry));
  refuse_contradictions(node, result, noun);
  return result;
}

std::vector<AxisStroke> orientation_from(const JsonNode& node) {
  std::vector<AxisStroke> result;
  for (const JsonNode& entry : node.items(1, "draw a stroke along the texture's T axis")) {
    entry.object({"stroke"});
    AxisStroke stroke{entry.at("stroke").points(2, "a direction needs two points [x, y, z] in mm")};
    const bool moves = std::any_of(stroke.point.begin(), stroke.point.end(),
                                   [&](const Vec3d& p) { return p != stroke.point.front(); });
    if (!moves) entry.at("stroke").fail("stays at one point", "give two different points");
    result.push_back(std::move(stroke));
  }
  return result;
}

TileOptions tile_from(const JsonNode& node) {
  node.object({"along", "border"});
  TileOptions result;
  if (const auto along = node.find("along")) {
    const std::string axes = along->text();
    result.axis = {};
    for (const char letter : axes) {
      const std::size_t axis = std::string("RST").find(letter);
      if (axis == std::string::npos || result.axis[axis])
        along->fail("is \"" + axes + "\"", "name axes once each, as in \"RST\" or \"RT\"");
      result.axis[axis] = true;
    }
  }
  node.optional_number("border", result.border, {0, 0.5, true, "above 0, to 0.5", "give a part of the exemplar"});
  return result;
}

} // namespace

ExemplarSource exemplar_from(const JsonNode& node) {
  node.object({"file", "tile", "procedural", "resolution", "seed"});
  ExemplarSource result;
  if (node.has("file") == node.has("procedural"))
    node.fail(node.has("file") ? "has both \"file\" and \"procedural\"" : "has neither \"file\" nor \"procedural\"",
              "give exactly one of them");
  if (const auto file = node.find("file")) {
    result.file = file->text();
    for (const char* key : {"resolution", "seed"})
      if (node.has(key))
        node.at(key).fail("is for procedural exemplars only", "remove it: the file has its own size");
    if (const auto tile = node.find("tile")) result.tile = tile_from(*tile);
  } else if (node.has("tile")) {
    node.at("tile").fail("is for files only", "remove it: procedural exemplars repeat where their type asks for it");
  }
  if (const auto name = node.find("procedural")) {
    result.procedural = name->text();
    const std::vector<std::string> known = procedural_names();
    if (std::find(known.begin(), known.end(), result.procedural) == known.end()) {
      std::string all;
      for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
      name->fail("is \"" + result.procedural + "\", which no generator makes", "known names: " + all);
    }
  }
  node.optional_whole("resolution", result.resolution, 16, 512, "give texels along each axis");
  node.optional_seed("seed", result.seed);
  return result;
}

void read_mask(const JsonNode& node, SplotchOptions& mask) {
  node.object({"resolution", "radius", "radius_outer", "radius_along", "reach_outer", "reach_inner", "drop_off",
               "irregularity", "seed"});
  node.optional_whole("resolution", mask.resolution, 4, 256, "give texels along each axis");
  for (auto [key, width] : {std::pair("radius", &mask.radius), std::pair("radius_outer", &mask.radius_outer)})
    node.optional_number(key, *width, {0, 4, true, "above 0, to 4", "give texture widths"});
  for (auto [key, width] : {std::pair("radius_along", &mask.radius_along),
                            std::pair("reach_outer", &mask.reach_outer), std::pair("reach_inner", &mask.reach_inner)})
    node.optional_number(key, *width, {0, 1, true, "above 0, to 1", "give parts of the depth"});
  node.optional_number("drop_off", mask.drop_off, {0, 0.5, true, "above 0, to 0.5", "give texture widths"});
  node.optional_number("irregularity", mask.irregularity, {0, 0.25, false, "0 to 0.25", "give texture widths"});
  node.optional_seed("seed", mask.seed);
  if (mask.drop_off > mask.radius) node.fail("has a drop_off wider than its radius", "make drop_off the smaller one");
}

namespace {

void read_frame(const JsonNode& node, FrameOptions& frame) {
  node.object({"layer_width", "singular_sine", "vanishing_rise", "smallest_scale", "largest_scale", "axis"});
  node.optional_number("layer_width", frame.layer_width, range::positive);
  node.optional_number("singular_sine", frame.singular_sine, range::fraction);
  node.optional_number("vanishing_rise", frame.vanishing_rise, range::fraction);
  node.optional_number("smallest_scale", frame.smallest_scale, range::positive_mm);
  node.optional_number("largest_scale", frame.largest_scale, range::positive_mm);
  if (frame.largest_scale > 0 && frame.smallest_scale > frame.largest_scale)
    node.fail("has a smallest_scale above its largest_scale", "swap them");
  if (const auto axis = node.find("axis")) frame.unsigned_axis = axis->choice({"signed", "unsigned"}) == 1;
}

void read_fill(const JsonNode& node, LapOptions& fill) {
  node.object({"frame_tolerance", "length_weight", "scale_tolerance", "sample_spacing", "coverage_order",
               "mask_variants", "align", "preserve_variance", "structured", "max_attempts"});
  node.optional_number("length_weight", fill.length_weight, {0, 1, true, "above 0, to 1", "1 is as in the paper"});
  node.optional_number("frame_tolerance", fill.frame_tolerance, {0, pi, true, "above 0, to pi", "give radians"});
  node.optional_number("scale_tolerance", fill.scale_tolerance,
                       {1, endless, true, "above 1", "give a ratio of two scales"});
  node.optional_number("sample_spacing", fill.sample_spacing, {1e-3, 1, false, "0.001 to 1", "give texture widths"});
  node.optional_whole("coverage_order", fill.coverage_order, 1, 16, "8 samples each tet edge eight times");
  node.optional_whole("mask_variants", fill.mask_variants, 1, 64, "give a number of outlines");
  if (const auto align = node.find("align")) fill.align = align->boolean();
  if (const auto structured = node.find("structured")) fill.structured = structured->boolean();
  if (const auto preserve = node.find("preserve_variance")) fill.preserve_variance = preserve->boolean();
  node.optional_whole("max_attempts", fill.max_attempts, 1, 1000, "give a number of pastes");
}

Solid solid_from(const JsonNode& node) {
  Solid result;
  if (!node.is_object()) node.object({});
  const std::size_t type = node.at("type").choice({"plain", "0", "1-a", "1-b", "2-a", "2-b", "2-c", "2-d"});
  if (const auto region = node.find("region"))
    result.region = static_cast<std::int32_t>(
        region->whole(0, 1'000'000, "regions count from 0, one per closed shell, then those made by \"divide\""));
  if (type == 0) {
    node.object({"type", "region", "color", "scatter", "pastes"});
    result.kind = Solid::Kind::plain;
    const JsonNode color = node.at("color");
    result.color = color.vector3();
    if ((result.color.array() < 0).any() || (result.color.array() > 1).any())
      color.fail("has a component outside 0 to 1", "give linear red, green, blue");
    read_things(node, result);
    return result;
  }
  node.object({"type", "region", "depth", "along", "around", "depth_options", "orientation", "scale", "local_scale",
               "frame", "exemplar", "mask", "fill", "seed", "scatter", "pastes"});
  result.fill.type = static_cast<TextureType>(type - 1);
  check_keys_of_type(node, result.fill.type);
  if (const auto depth = node.find("depth")) result.depth = field_from(*depth, "depth");
  if (const auto along = node.find("along")) result.along = field_from(*along, "value");
  if (const auto around = node.find("around")) result.around = field_from(*around, "value");
  if (const auto options = node.find("depth_options")) {
    options->object({"max_centers", "stroke_spacing", "extrema", "overshoot", "persistence"});
    options->optional_whole("max_centers", result.depth_options.max_centers, 10, 1'000'000,
                            "leave it out for as many as are worth while");
    if (const auto extrema = options->find("extrema"))
      result.depth_options.remove_extrema = extrema->choice({"keep", "remove"}) == 1;
    if (const auto overshoot = options->find("overshoot"))
      result.depth_options.guard_overshoot = overshoot->choice({"clamp", "guard"}) == 1;
    options->optional_number("persistence", result.depth_options.persistence, range::fraction);
    options->optional_number("stroke_spacing", result.depth_options.stroke_spacing, range::positive_mm);
  }
  if (const auto orientation = node.find("orientation")) result.orientation = orientation_from(*orientation);
  node.optional_number("scale", result.scale, range::positive_mm);
  if (const auto local = node.find("local_scale")) result.local_scale = local_scale_from(*local);
  if (const auto frame = node.find("frame")) {
    read_frame(*frame, result.frame);
    if (result.frame.unsigned_axis && !traits_of(result.fill.type).uses_stroke)
      frame->at("axis").fail("is unsigned in a type without strokes", "remove it: 1-a, 2-a and 2-b have an axis");
  }
  result.exemplar = exemplar_from(node.at("exemplar"));
  if (const auto mask = node.find("mask")) read_mask(*mask, result.fill.splotch);
  if (const auto fill = node.find("fill")) read_fill(*fill, result.fill);
  node.optional_seed("seed", result.fill.seed);
  read_things(node, result);
  return result;
}

} // namespace

Recipe parse_recipe(const std::string& text, const std::string& file) {
  const nlohmann::json document = json_of(text, file);
  const JsonNode root(document, file);
  root.object({"pith", "name", "surface", "tetrahedralize", "divide", "solids", "cuts", "moves", "view", "scene"});
  Recipe result;
  result.file = file;
  root.at("pith").whole(format_version, format_version, "this program reads version 1 of the format");
  if (const auto name = root.find("name"))
    result.name = name->text();
  else
    result.name = plain_text(std::filesystem::path(file).stem().string());
  result.surface = surface_from(root.at("surface"));
  if (const auto options = root.find("tetrahedralize")) result.tetrahedralize = tetrahedralize_from(*options);
  if (const auto divides = root.find("divide"))
    for (const JsonNode& entry : divides->items(0, "")) result.divides.push_back(divide_from(entry));
  if (const auto solids = root.find("solids"))
    for (const JsonNode& entry : solids->items(0, "")) {
      Solid solid = solid_from(entry);
      for (std::size_t i = 0; i < result.solids.size(); ++i)
        if (result.solids[i].region == solid.region)
          entry.fail("fills region " + std::to_string(solid.region) + ", which /solids/" + std::to_string(i) +
                         " fills already",
                     "give each solid a region of its own");
      result.solids.push_back(std::move(solid));
    }
  const auto marks_core = [](const DepthConstraint& one) { return one.value == 1 && one.stroke.size() > 1; };
  if (result.tetrahedralize.core_edge > 0 &&
      std::none_of(result.solids.begin(), result.solids.end(), [&](const Solid& solid) {
        return std::any_of(solid.depth.begin(), solid.depth.end(), marks_core);
      }))
    root.at("tetrahedralize")
        .fail("has a core_edge, but no solid has a stroke of depth 1",
              "draw one along the core, or leave core_edge out");
  if (const auto cuts = root.find("cuts"))
    for (const JsonNode& entry : cuts->items(0, "")) result.cuts.push_back(cut_from(entry));
  if (const auto moves = root.find("moves"))
    for (const JsonNode& entry : moves->items(0, "")) result.moves.push_back(move_from(entry));
  if (const auto view = root.find("view")) result.view = view_from(*view);
  if (const auto scene = root.find("scene")) result.scene = scene->text();
  return result;
}

Recipe read_recipe(const std::filesystem::path& path) {
  return parse_recipe(file_content(path), path.filename().string());
}

CutStep parse_cut(const std::string& text, const std::string& file) {
  const nlohmann::json document = json_of(text, file);
  const JsonNode root(document, file);
  CutStep step;
  if (root.is_object() && root.has("points"))
    step.shape = stroke_from(root);
  else
    step = cut_from(root);
  return step;
}

View parse_view(const std::string& text, const std::string& file) {
  const nlohmann::json document = json_of(text, file);
  return view_from(JsonNode(document, file));
}

} // namespace pith
