#include "volume/exemplar/procedural.h"

#include "volume/base/error.h"
#include "volume/exemplar/kiwi.h"
#include "volume/exemplar/seeds.h"

namespace pith {

std::vector<std::string> procedural_names() { return {"kiwi", "kiwi-flesh", "kiwi-seed", "watermelon-seed"}; }

Exemplar procedural_exemplar(const std::string& name, const ProceduralOptions& options) {
  if (options.resolution < 16 || options.resolution > 512)
    throw InvalidInput("exemplar resolution", std::to_string(options.resolution) + " texels along each axis",
                       "give 16 to 512");
  if (name == "kiwi") return kiwi_exemplar(options);
  if (name == "kiwi-flesh") return kiwi_flesh_exemplar(options);
  if (name == "kiwi-seed") return kiwi_seed_exemplar(options);
  if (name == "watermelon-seed") return watermelon_seed_exemplar(options);
  std::string known;
  for (const std::string& each : procedural_names()) known += (known.empty() ? "" : ", ") + each;
  throw InvalidInput("exemplar", "there is no procedural exemplar named '" + name + "'", "choose one of: " + known);
}

} // namespace pith
