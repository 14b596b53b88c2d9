#pragma once
// The scene file of `pith render`: where to look from, light, ground, background, how surfaces answer light.
// docs/recipe.md describes it.
#include "raytrace/render.h"
#include "raytrace/tone.h"

#include <filesystem>
#include <optional>
#include <string>

namespace pith::cli {

struct SceneFile {
  std::optional<View> view;             ///< none: framed
  Vec3d direction = Vec3d::Zero();      ///< for framing; zero: chosen
  std::optional<double> vertical_angle; ///< for framing
  SceneOptions scene;
  std::optional<Environment> environment; ///< with its image read; none: the built-in sky
  std::vector<AreaLight> lights;
  bool default_lights = true; ///< neither "environment" nor "lights" was given
  Background background;
  ToneOptions tone;
};

/// Reads JSON text. Images are relative to `folder`. Errors: InvalidInput, naming the place, as for recipes.
SceneFile parse_scene(const std::string& text, const std::string& file, const std::filesystem::path& folder);

} // namespace pith::cli
