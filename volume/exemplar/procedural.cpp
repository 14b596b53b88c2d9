#include "volume/exemplar/procedural.h"

#include "volume/base/error.h"
#include "volume/exemplar/kiwi.h"
#include "volume/exemplar/painters.h"
#include "volume/exemplar/seeds.h"

namespace pith {

namespace {

struct Generator {
  const char* name;
  Exemplar (*make)(const ProceduralOptions& options);
};

constexpr Generator generators[] = {
    {"kiwi", kiwi_exemplar},
    {"kiwi-flesh", kiwi_flesh_exemplar},
    {"carrot", carrot_exemplar},
    {"tree", tree_exemplar},
    {"watermelon", [](const ProceduralOptions& options) { return watermelon_exemplar(options, true); }},
    {"watermelon-flesh", [](const ProceduralOptions& options) { return watermelon_exemplar(options, false); }},
    {"watermelon-striped", watermelon_striped_exemplar},
    {"tube", tube_exemplar},
    {"sandstone", sandstone_exemplar},
    {"shale", shale_exemplar},
    {"limestone", limestone_exemplar},
    {"conglomerate", conglomerate_exemplar},
    {"sponge", sponge_exemplar},
    {"cream", cream_exemplar},
    {"chocolate", chocolate_exemplar},
    {"mineral", mineral_exemplar},
    {"ripening", ripening_exemplar},
    {"brick", brick_exemplar},
    {"pepper", pepper_exemplar},
    {"banana", banana_exemplar},
    {"citrus", citrus_exemplar},
    {"kiwi-seed", kiwi_seed_exemplar},
    {"watermelon-seed", watermelon_seed_exemplar},
    {"almond", almond_exemplar},
};

} // namespace

std::vector<std::string> procedural_names() {
  std::vector<std::string> names;
  for (const Generator& generator : generators) names.push_back(generator.name);
  return names;
}

Exemplar procedural_exemplar(const std::string& name, const ProceduralOptions& options) {
  if (options.resolution < 16 || options.resolution > 512)
    throw InvalidInput("exemplar resolution", std::to_string(options.resolution) + " texels along each axis",
                       "give 16 to 512");
  std::string known;
  for (const Generator& generator : generators) {
    if (name == generator.name) return generator.make(options);
    known += (known.empty() ? "" : ", ") + std::string(generator.name);
  }
  throw InvalidInput("exemplar", "there is no procedural exemplar named '" + name + "'", "choose one of: " + known);
}

} // namespace pith
