// Recipe: cuts, moves and views.
#include "recipe/parse_steps.h"

#include "volume/exemplar/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace pith {
namespace {

PlaneCut plane_from(const JsonNode& node) {
  node.object({"normal", "offset", "waves"});
  PlaneCut result;
  result.normal = node.at("normal").vector3();
  if (!(result.normal.norm() > 0)) node.at("normal").fail("has no length", "give a direction such as [0, 0, 1]");
  node.optional_number("offset", result.offset, range::any);
  if (const auto waves = node.find("waves")) {
    waves->object({"amplitude", "length", "seed"});
    result.waves.amplitude = waves->at("amplitude").number(range::mm);
    result.waves.length = waves->at("length").number(range::positive_mm);
    waves->optional_seed("seed", result.waves.seed);
  }
  return result;
}

SphereCut sphere_from(const JsonNode& node) {
  node.object({"center", "radius"});
  SphereCut result;
  result.center = node.at("center").vector3();
  result.radius = node.at("radius").number(range::positive_mm);
  return result;
}

PiecePlacement placement_from(const JsonNode& node) {
  node.object({"piece", "rotation", "translation"});
  PiecePlacement result;
  result.piece = node.at("piece").vector3();
  if (const auto rotation = node.find("rotation")) {
    const auto rows = rotation->points(3, "give three rows of three numbers");
    if (rows.size() != 3)
      rotation->fail("has " + std::to_string(rows.size()) + " rows, must have 3", "give a 3×3 matrix");
    for (int row = 0; row < 3; ++row) result.placement.rotation.row(row) = rows[row].transpose();
    const Mat3d& r = result.placement.rotation;
    if (!((r * r.transpose() - Mat3d::Identity()).norm() < 1e-6) || r.determinant() < 0)
      rotation->fail("is not a rotation", "its rows must be of unit length, at right angles, and right-handed");
  }
  if (const auto translation = node.find("translation")) result.placement.translation = translation->vector3();
  return result;
}

BoxCut box_from(const JsonNode& node) {
  node.object({"center", "size", "rotate"});
  BoxCut result;
  result.center = node.at("center").vector3();
  result.size = node.at("size").vector3();
  if (!(result.size.minCoeff() > 0)) node.at("size").fail("is not positive", "give three lengths in mm");
  if (const auto rotate = node.find("rotate")) {
    rotate->object({"axis", "angle"});
    read_turn(*rotate, result.axis, result.angle);
  }
  return result;
}

CylinderCut cylinder_from(const JsonNode& node) {
  node.object({"from", "to", "radius", "endless"});
  CylinderCut result;
  result.from = node.at("from").vector3();
  result.to = node.at("to").vector3();
  if (result.from == result.to) node.fail("has both ends at one place", "move one of them");
  result.radius = node.at("radius").number(range::positive_mm);
  if (const auto endless = node.find("endless")) result.endless = endless->boolean();
  return result;
}

SheetCut sheet_from(const JsonNode& node) {
  node.object({"points", "normals"});
  SheetCut result;
  result.point = node.at("points").points(1, "give points that the cut passes through");
  result.normal = node.at("normals").points(1, "give a normal for each point");
  if (result.normal.size() != result.point.size())
    node.at("normals").fail("has " + std::to_string(result.normal.size()) + " entries for " +
                                std::to_string(result.point.size()) + " points",
                            "give one normal for each point");
  return result;
}

/// Those of LevelSetShape; "surface", and in cuts "depth" and "join", may stand in their place.
constexpr std::array shape_keys = {"plane", "sphere", "stroke", "box", "cylinder", "sheet"};

LevelSetShape shape_from(const JsonNode& node) {
  if (const auto plane = node.find("plane")) return plane_from(*plane);
  if (const auto sphere = node.find("sphere")) return sphere_from(*sphere);
  if (const auto box = node.find("box")) return box_from(*box);
  if (const auto cylinder = node.find("cylinder")) return cylinder_from(*cylinder);
  if (const auto sheet = node.find("sheet")) return sheet_from(*sheet);
  return stroke_from(node.at("stroke"));
}

/// Fails unless exactly one of the shapes is there.
void check_one_shape(const JsonNode& node, const std::vector<std::string>& others) {
  std::string all;
  int shapes = 0;
  std::vector<std::string> keys(shape_keys.begin(), shape_keys.end());
  keys.insert(keys.end(), others.begin(), others.end());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    shapes += node.has(keys[i].c_str());
    all += (i == 0 ? "" : i + 1 < keys.size() ? ", " : " and ") + ("\"" + keys[i] + "\"");
  }
  if (shapes != 1) node.fail(shapes == 0 ? "has no shape" : "has more than one shape", "give exactly one of " + all);
}

} // namespace

SurfaceSource surface_from(const JsonNode& node) {
  SurfaceSource result;
  if (const auto shape = node.find("shape")) {
    node.object({"shape", "triangles", "scale"});
    result.shape = shape->text();
    std::string all;
    bool known = false;
    for (const std::string& name : shape_names()) {
      known |= name == result.shape;
      all += (all.empty() ? "" : ", ") + name;
    }
    if (!known) shape->fail("is \"" + result.shape + "\", which is no shape", "known names: " + all);
    node.optional_whole("triangles", result.triangles, 100, 1'000'000,
                        "give about how many triangles it should have");
  } else {
    node.object({"file", "scale"});
    result.file = node.at("file").text();
  }
  node.optional_number("scale", result.scale, range::positive);
  return result;
}

void read_turn(const JsonNode& node, Vec3d& axis, double& angle) {
  axis = node.at("axis").vector3();
  if (!(axis.norm() > 0)) node.at("axis").fail("has no length", "give a direction such as [0, 0, 1]");
  angle = node.at("angle").number({-1e6, 1e6, false, "an angle", "give radians"});
}

StrokeCut stroke_from(const JsonNode& node) {
  node.object({"points", "view", "closed", "from", "to"});
  StrokeCut result;
  const JsonNode points = node.at("points");
  for (const JsonNode& point : points.items(2, "a stroke needs two points [u, v] or more"))
    result.point.push_back(point.vector2());
  const bool moves = std::any_of(result.point.begin(), result.point.end(),
                                 [&](const Vec2d& p) { return p != result.point.front(); });
  if (!moves) points.fail("stay at one place", "give two different points");
  result.view = view_from(node.at("view"));
  if (const auto closed = node.find("closed")) result.closed = closed->boolean();
  for (const char* key : {"from", "to"})
    if (node.has(key) && !result.closed)
      node.fail(std::string("has a \"") + key + "\", which only closed strokes have", "close it, or remove the key");
  node.optional_number("from", result.from, range::any);
  node.optional_number("to", result.to, range::any);
  if (!(result.from < result.to))
    node.fail("is scooped from where it ends", "give a \"from\" that is less than \"to\"");
  return result;
}

View view_from(const JsonNode& node) {
  node.object({"eye", "target", "up", "vertical_angle", "height"});
  View result;
  result.eye = node.at("eye").vector3();
  if (const auto target = node.find("target")) result.target = target->vector3();
  if (const auto up = node.find("up")) result.up = up->vector3();
  node.optional_number("vertical_angle", result.vertical_angle,
                       {0, 3.1, false, "0 to 3.1", "give the full opening angle in radians; 0 is orthographic"});
  node.optional_number("height", result.height, range::positive_mm);
  const Vec3d along = result.target - result.eye;
  if (!(along.norm() > 0)) node.fail("has its eye at its target", "move one of them");
  if (!(along.normalized().cross(result.up.normalized()).norm() > 1e-9))
    node.fail("has an up that is parallel to the line of sight, or no up", "give another up");
  return result;
}

DivideStep divide_from(const JsonNode& node) {
  node.object({"plane", "sphere", "stroke", "box", "cylinder", "sheet", "surface", "only", "snap"});
  check_one_shape(node, {"surface"});
  DivideStep result;
  if (const auto surface = node.find("surface"))
    result.surface = surface_from(*surface);
  else
    result.shape = shape_from(node);
  if (const auto only = node.find("only")) {
    const auto region_from = [](const JsonNode& entry) {
      return static_cast<std::int32_t>(entry.whole(0, 1'000'000, "name a region, from 0"));
    };
    if (!only->is_array()) {
      result.only = {region_from(*only)};
    } else {
      for (const JsonNode& entry : only->items(1, "name regions, or leave it out to divide all"))
        result.only.push_back(region_from(entry));
      std::sort(result.only.begin(), result.only.end());
      result.only.erase(std::unique(result.only.begin(), result.only.end()), result.only.end());
    }
  }
  node.optional_number("snap", result.snap, {0, 0.4, false, "0 to 0.4", "give a fraction of an edge"});
  return result;
}

CutStep cut_from(const JsonNode& node) {
  node.object({"plane", "sphere", "stroke", "box", "cylinder", "sheet", "surface", "depth", "join", "keep", "spread",
               "snap", "only", "placements"});
  check_one_shape(node, {"surface", "depth", "join"});
  CutStep result;
  if (const auto join = node.find("join")) {
    for (const char* key : {"keep", "spread", "snap", "only"})
      if (node.has(key)) node.fail(std::string("joins pieces, for which \"") + key + "\" means nothing", "remove it");
    result.join = join->points(2, "name the pieces to join by rest points in them");
  } else if (const auto surface = node.find("surface")) {
    result.surface = surface_from(*surface);
  } else if (const auto depth = node.find("depth")) {
    depth->object({"region", "value"});
    result.depth.emplace();
    int region = 0;
    depth->optional_whole("region", region, 0, 1'000'000, "name a region, from 0");
    result.depth->region = region;
    result.depth->value = depth->at("value").number({0, 1, true, "between 0 and 1", "give a depth below the skin"});
  } else {
    result.shape = shape_from(node);
  }
  if (const auto keep = node.find("keep")) result.keep = static_cast<Keep>(keep->choice({"both", "left", "right"}));
  node.optional_number("spread", result.spread, range::mm);
  node.optional_number("snap", result.snap, {0, 0.4, false, "0 to 0.4", "give a fraction of an edge"});
  if (result.spread > 0 && result.keep != Keep::both)
    node.fail("spreads halves but keeps only one of them", "remove \"spread\", or keep both");
  if (const auto only = node.find("only")) {
    // One point, or a list of points.
    if (only->is_array() && !only->items(1, "name pieces by rest points").front().is_array())
      result.only = {only->vector3()};
    else
      result.only = only->points(1, "name pieces by rest points");
  }
  if (const auto placements = node.find("placements"))
    for (const JsonNode& entry : placements->items(0, "")) result.placements.push_back(placement_from(entry));
  return result;
}

MoveStep move_from(const JsonNode& node) {
  node.object({"piece", "translate", "rotate", "about", "explode", "drop"});
  MoveStep result;
  if (node.has("explode") || node.has("drop")) {
    if (node.has("explode") + node.has("drop") + node.has("piece") > 1 || node.has("translate") || node.has("rotate"))
      node.fail("does more than one thing", "give \"explode\", \"drop\" or \"piece\", each in an entry of its own");
    double value = 0;
    node.optional_number("explode", value, range::any);
    node.optional_number("drop", value, range::any);
    (node.has("explode") ? result.explode : result.drop) = value;
    return result;
  }
  result.piece = node.at("piece").vector3();
  if (!node.has("translate") && !node.has("rotate")) node.fail("moves nothing", "add \"translate\" or \"rotate\"");
  if (const auto translate = node.find("translate")) result.translate = translate->vector3();
  if (const auto rotate = node.find("rotate")) {
    rotate->object({"axis", "angle"});
    read_turn(*rotate, result.axis, result.angle);
  }
  if (const auto about = node.find("about")) {
    if (!node.has("rotate")) about->fail("is given without \"rotate\"", "remove it, or add \"rotate\"");
    result.about = about->vector3();
  }
  return result;
}

} // namespace pith
