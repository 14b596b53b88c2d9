// Takayama et al. 2008, §3 (Fig. 3) and §5.2.2: what each type needs.
#include "volume/lap/texture_type.h"

namespace pith {

namespace {

constexpr TextureTraits all_traits[texture_type_count] = {
    {"0", 0, -1, {false, false, false}, false, false, true}, {"1-a", 1, 2, {false, false, false}, false, true, true},
    {"1-b", 1, 1, {false, true, false}, true, false, false}, {"2-a", 3, -1, {false, false, false}, true, true, true},
    {"2-b", 3, -1, {false, true, false}, true, true, false}, {"2-c", 3, -1, {false, true, true}, true, false, false},
    {"2-d", 3, -1, {true, true, true}, true, false, false},
};

} // namespace

const TextureTraits& traits_of(TextureType type) { return all_traits[static_cast<int>(type)]; }

std::optional<TextureType> texture_type_of(const std::string& name) {
  for (int type = 0; type < texture_type_count; ++type)
    if (name == all_traits[type].name) return static_cast<TextureType>(type);
  return std::nullopt;
}

char axis_letter(int axis) { return "RST"[axis]; }

} // namespace pith
