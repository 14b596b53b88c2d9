#pragma once
// What a user can set: one table for panels, sessions and help.
#include "recipe/recipe.h"

#include <functional>

namespace pith {

struct Settings {
  // cutting
  Keep keep = Keep::both;
  double spread = 0;       ///< mm; set afresh when a document is opened
  bool one_piece = false;  ///< cut the piece alone on which the gesture begins
  int plane_axis = 3;      ///< x, y, z, or as drawn
  double core_radius = 5;  ///< mm
  double scoop_depth = 10; ///< mm below the surface; 0: through and through
  double drop_height = 0;  ///< mm
  double explode = 0.3;
  // solids
  double depth = 0; ///< what depth tools draw
  TextureType type = TextureType::tensor_2b;
  std::string exemplar = "kiwi";
  std::string thing = "almond"; ///< what is pasted by hand
  double scale = 10;            ///< mm per texture width
  // display
  bool lit = true, occlusion = true, filtered = true, strokes = true;
  double relief = 1; ///< displacement's scale
};

struct Setting {
  std::string name, label, tip;
  enum class Kind { toggle, number, choice } kind = Kind::toggle;
  double low = 0, high = 1;                    ///< of a number
  std::vector<std::string> choices;            ///< of a choice
  std::function<std::string()> text;           ///< its value
  std::function<void(const std::string&)> set; ///< InvalidInput when it is none of its values
};

/// All settings, by panel order; they refer to `settings`.
std::vector<Setting> setting_table(Settings& settings);

} // namespace pith
