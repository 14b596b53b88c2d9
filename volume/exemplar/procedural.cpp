#include "volume/exemplar/procedural.h"

#include "volume/base/error.h"
#include "volume/exemplar/kiwi.h"

namespace pith {

std::vector<std::string> procedural_names() { return {"kiwi"}; }

Exemplar procedural_exemplar(const std::string& name, const ProceduralOptions& options) {
  if (options.resolution < 16 || options.resolution > 512)
    throw InvalidInput("exemplar resolution", std::to_string(options.resolution) + " texels along each axis",
                       "give 16 to 512");
  if (name == "kiwi") return kiwi_exemplar(options);
  std::string known;
  for (const std::string& each : procedural_names()) known += (known.empty() ? "" : ", ") + each;
  throw InvalidInput("exemplar", "there is no procedural exemplar named '" + name + "'", "choose one of: " + known);
}

} // namespace pith
