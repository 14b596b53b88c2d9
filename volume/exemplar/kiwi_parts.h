#pragma once
// The parts of the kiwi exemplar that are things rather than fields: seeds, pale specks, hairs. Internal to the
// exemplar.
#include "volume/exemplar/kiwi.h"
#include "volume/exemplar/periodic_noise.h"

namespace pith::kiwi {

/// The stages of the random numbers' keys.
enum Stage : std::uint64_t { stage_warp = 1, stage_seed, stage_speck, stage_hair, stage_field };

/// How far the locules stray sideways, in locules: the field that both flesh and seeds follow.
PeriodicNoise locule_warp(std::uint64_t seed);
inline constexpr float warp_amplitude = 0.15f;

/// Pale dashes in the flesh: the crystal-bearing cells that sparkle in a cut kiwi. Elongated along S like the seeds.
std::vector<KiwiSeed> specks(std::uint64_t seed);

/// What the things add to one slice of constant z, x fastest, resolution² values each.
struct SliceThings {
  std::vector<float> seed;  ///< how much of a texel is seed
  std::vector<float> shade; ///< how dark a seed behind makes the flesh around it
  std::vector<float> speck; ///< how much is speck
};

/// Draws seeds and specks into the slice at z; reuses the storage. The result depends on nothing but the arguments.
void draw_things(const std::vector<KiwiSeed>& seeds, const std::vector<KiwiSeed>& specks, int resolution, float z,
                 SliceThings& slice);

/// The skin seen from outside: brightness in [0, 1] over (x, z), x fastest: short hairs, mostly along T, over a
/// mottled ground. In parallel.
std::vector<float> hair_brightness(std::uint64_t seed, int resolution);

} // namespace pith::kiwi
