#include "cli/scene_file.h"

#include "recipe/json_node.h"
#include "recipe/parse_steps.h"
#include "volume/io/image_io.h"

namespace pith::cli {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr NumberRange not_negative{0, endless, false, "0 or more", "give a number from 0 up"};

Vec3d light_from(const JsonNode& node) {
  const Vec3d color = node.vector3();
  if ((color.array() < 0).any()) node.fail("has a negative component", "give linear red, green, blue from 0 up");
  return color;
}

Environment environment_from(const JsonNode& node, const std::filesystem::path& folder) {
  node.object({"file", "zenith", "horizon", "nadir", "scale", "turn"});
  Environment result;
  if (const auto file = node.find("file")) {
    for (const char* key : {"zenith", "horizon", "nadir"})
      if (node.has(key)) node.at(key).fail("is given beside a file", "keep one of them");
    const std::filesystem::path given = file->text(), path = given.is_absolute() ? given : folder / given;
    std::error_code error;
    if (!std::filesystem::exists(path, error))
      file->fail("names a file that does not exist", "paths count from the scene's folder");
    result.image = read_image(path);
  }
  if (const auto zenith = node.find("zenith")) result.zenith = light_from(*zenith);
  if (const auto horizon = node.find("horizon")) result.horizon = light_from(*horizon);
  if (const auto nadir = node.find("nadir")) result.nadir = light_from(*nadir);
  node.optional_number("scale", result.scale, not_negative);
  node.optional_number("turn", result.turn, range::any);
  return result;
}

AreaLight area_from(const JsonNode& node) {
  node.object({"center", "edge_u", "edge_v", "radiance", "visible"});
  AreaLight result;
  result.center = node.at("center").vector3();
  result.edge_u = node.at("edge_u").vector3();
  result.edge_v = node.at("edge_v").vector3();
  result.radiance = light_from(node.at("radiance"));
  if (const auto visible = node.find("visible")) result.visible = visible->boolean();
  if (!(result.edge_u.cross(result.edge_v).norm() > 0)) node.fail("has no area", "give two edges at right angles");
  return result;
}

void read_look(const JsonNode& node, SurfaceLook& look) {
  node.object({"roughness", "index"});
  node.optional_number("roughness", look.roughness, range::fraction);
  node.optional_number("index", look.index, {1, 4, false, "1 to 4", "1.4 suits fruit; 1 is matte"});
}

void read_ground(const JsonNode& node, GroundOptions& ground) {
  if (!node.is_object()) {
    ground.on = node.boolean();
    return;
  }
  node.object({"height", "albedo", "fade_begin", "fade_end"});
  node.optional_number("height", ground.height, range::any);
  if (const auto albedo = node.find("albedo")) ground.albedo = light_from(*albedo);
  node.optional_number("fade_begin", ground.fade_begin, not_negative);
  node.optional_number("fade_end", ground.fade_end, not_negative);
  if (ground.fade_end < ground.fade_begin) node.fail("fades out before it begins to", "swap fade_begin and fade_end");
}

Background background_from(const JsonNode& node) {
  Background result;
  if (node.is_array()) {
    result.kind = Background::Kind::color;
    result.color = light_from(node);
    return result;
  }
  static constexpr Background::Kind kinds[] = {Background::Kind::backdrop, Background::Kind::sky,
                                               Background::Kind::transparent};
  result.kind = kinds[node.choice({"backdrop", "sky", "transparent"})];
  return result;
}

} // namespace

SceneFile parse_scene(const std::string& text, const std::string& file, const std::filesystem::path& folder) {
  const nlohmann::json document = json_of(text, file);
  const JsonNode root(document, file);
  root.object({"view", "direction", "vertical_angle", "up", "environment", "lights", "ground", "background", "skin",
               "section", "uncovered", "tone"});
  SceneFile result;
  if (const auto view = root.find("view")) {
    for (const char* key : {"direction", "vertical_angle"})
      if (root.has(key)) root.at(key).fail("is given beside a view", "keep one of them");
    result.view = view_from(*view);
  }
  if (const auto direction = root.find("direction")) {
    result.direction = direction->vector3();
    if (!(result.direction.norm() > 0)) direction->fail("has no length", "give a direction such as [0, 1, 2]");
  }
  if (const auto angle = root.find("vertical_angle"))
    result.vertical_angle = angle->number({0, 3.1, false, "0 to 3.1", "give radians; 0 is orthographic"});
  if (const auto up = root.find("up")) {
    result.scene.up = up->vector3();
    if (!(result.scene.up.norm() > 0)) up->fail("has no length", "give a direction such as [0, 0, 1]");
    result.scene.up.normalize();
  }
  if (const auto environment = root.find("environment")) result.environment = environment_from(*environment, folder);
  if (const auto lights = root.find("lights"))
    for (const JsonNode& light : lights->items(0, "")) result.lights.push_back(area_from(light));
  result.default_lights = !root.has("environment") && !root.has("lights");
  if (const auto ground = root.find("ground")) read_ground(*ground, result.scene.ground);
  if (const auto background = root.find("background")) result.background = background_from(*background);
  if (const auto skin = root.find("skin")) read_look(*skin, result.scene.skin);
  if (const auto section = root.find("section")) read_look(*section, result.scene.section);
  if (const auto uncovered = root.find("uncovered")) result.scene.uncovered = light_from(*uncovered);
  if (const auto tone = root.find("tone")) {
    tone->object({"curve", "exposure"});
    if (const auto curve = tone->find("curve"))
      result.tone.curve = static_cast<ToneOptions::Curve>(curve->choice({"neutral", "clip"}));
    tone->optional_number("exposure", result.tone.exposure, {-30, 30, false, "-30 to 30", "give stops"});
  }
  return result;
}

} // namespace pith::cli
