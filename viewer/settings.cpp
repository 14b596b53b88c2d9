#include "viewer/settings.h"

#include "volume/base/error.h"
#include "volume/exemplar/procedural.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

namespace pith {
namespace {

Setting toggle(std::string name, std::string label, std::string tip, bool& value) {
  Setting s{name, std::move(label), std::move(tip), Setting::Kind::toggle, 0, 1, {}, {}, {}};
  s.text = [&value] { return value ? "on" : "off"; };
  s.set = [&value, name](const std::string& text) {
    if (text != "on" && text != "off")
      throw InvalidInput(name, "'" + text + "' is neither on nor off", "say on or off");
    value = text == "on";
  };
  return s;
}

Setting number(std::string name, std::string label, std::string tip, double low, double high, double& value) {
  Setting s{name, std::move(label), std::move(tip), Setting::Kind::number, low, high, {}, {}, {}};
  s.text = [&value] { return fmt::format("{}", value); };
  s.set = [&value, low, high, name](const std::string& text) {
    double read = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (error != std::errc() || end != text.data() + text.size() || !(read >= low && read <= high))
      throw InvalidInput(name, "'" + text + "' is no number in range", fmt::format("give {} to {}", low, high));
    value = read;
  };
  return s;
}

Setting choice(std::string name, std::string label, std::string tip, std::vector<std::string> choices,
               std::function<int()> at, std::function<void(int)> choose) {
  Setting s{name, std::move(label), std::move(tip), Setting::Kind::choice, 0, 1, choices, {}, {}};
  s.text = [choices, at] { return choices[at()]; };
  s.set = [choices, choose, name](const std::string& text) {
    const auto found = std::find(choices.begin(), choices.end(), text);
    if (found == choices.end()) {
      std::string all;
      for (const std::string& one : choices) all += (all.empty() ? "" : ", ") + one;
      throw InvalidInput(name, "there is no '" + text + "'", "choose one of " + all);
    }
    choose(static_cast<int>(found - choices.begin()));
  };
  return s;
}

} // namespace

std::vector<Setting> setting_table(Settings& s) {
  std::vector<std::string> types, exemplars;
  for (int t = 0; t < texture_type_count; ++t) types.push_back(traits_of(static_cast<TextureType>(t)).name);
  for (const auto& name : procedural_names()) exemplars.emplace_back(name);
  const auto exemplar = [&exemplars](std::string name, std::string label, std::string tip, std::string& value) {
    const auto at = [&value, exemplars] {
      const auto found = std::find(exemplars.begin(), exemplars.end(), value);
      return found == exemplars.end() ? 0 : static_cast<int>(found - exemplars.begin());
    };
    return choice(std::move(name), std::move(label), std::move(tip), exemplars, at,
                  [&value, exemplars](int i) { value = exemplars[i]; });
  };
  return {choice(
              "keep", "Keep", "which side of a cut stays", {"both", "left", "right"}, [&s] { return int(s.keep); },
              [&s](int i) { s.keep = Keep(i); }),
          number("spread", "Spread (mm)", "how far halves move apart after a cut", 0, 1000, s.spread),
          toggle("one_piece", "One piece", "cut the piece alone on which the gesture begins", s.one_piece),
          choice(
              "plane", "Plane", "which way the plane faces", {"x", "y", "z", "drawn"}, [&s] { return s.plane_axis; },
              [&s](int i) { s.plane_axis = i; }),
          number("core_radius", "Core radius (mm)", "of the corer", 0.01, 1000, s.core_radius),
          number("scoop_depth", "Scoop depth (mm)", "how deep a loop scoops; 0: it punches through", 0, 1000,
                 s.scoop_depth),
          number("drop_height", "Ground (mm)", "height of the plane that Drop puts pieces on", -10000, 10000,
                 s.drop_height),
          number("explode", "Explode by", "part of its distance from the middle by which each piece moves away", -0.9,
                 10, s.explode),
          number("depth", "Depth", "what the depth tools draw: 0 outside, 1 innermost", 0, 1, s.depth),
          choice(
              "type", "Type", "how the texture looks from different sides, and along how many axes it changes", types,
              [&s] { return int(s.type); }, [&s](int i) { s.type = TextureType(i); }),
          exemplar("exemplar", "Exemplar", "the material", s.exemplar),
          exemplar("thing", "Thing", "what the paste tool pastes", s.thing),
          number("scale", "Scale (mm)", "millimetres per texture width, for types that do not follow depth", 0.01,
                 10000, s.scale),
          toggle("lit", "Light", "off: the material's colours alone", s.lit),
          toggle("occlusion", "Shade crevices", "less light where less of the sky is seen", s.occlusion),
          toggle("filtered", "Filter", "coarser texels where they are smaller than a pixel", s.filtered),
          toggle("strokes", "Strokes", "show what was drawn", s.strokes),
          number("relief", "Relief", "how far the skin's relief stands out", 0, 10, s.relief)};
}

} // namespace pith
