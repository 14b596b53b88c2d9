#pragma once
// How an opaque surface reflects: a diffuse body under a rough dielectric coat that together lose no light.
#include "raytrace/sampling.h"

namespace pith {

/// The share of light that the coat alone reflects, for any index: reflectance is F0 · (facing − grazing) + grazing,
/// with Schlick's Fresnel term of normal reflectance F0. Tables over cos θ and roughness. About 10 ms to make.
class CoatTable {
public:
  CoatTable();
  /// Reflected share of light arriving at `cosine`, and its cosine-weighted mean over the hemisphere.
  double directional(double cosine, double roughness, double normal_reflectance) const;
  double average(double roughness, double normal_reflectance) const;

private:
  struct Entry {
    double facing = 0, grazing = 0;
  };
  Entry directional_entry(double cosine, double roughness) const;
  std::vector<Entry> directional_, average_;
};

/// One surface point's reflection. All directions are local (z: the shading normal), unit, and point away from the
/// surface. Values are for directions above the surface; 0 below.
///
/// Coat: GGX with height-correlated Smith shadowing (Walter et al. 2007; Heitz 2014). Body: Lambert, scaled so that
/// coat and body reflect everything together when the albedo is 1, and reciprocal (Kelemen, Szirmay-Kalos 2001,
/// §2.2).
class Reflection {
public:
  /// `index` ≤ 1: no coat. `roughness`: GGX α = roughness².
  Reflection(const Vec3d& albedo, double roughness, double index, const CoatTable& table, double outgoing_cosine);

  /// BRDF · cos θ of `in`.
  Vec3d value(const Vec3d& out, const Vec3d& in) const;
  /// Density of sample() per solid angle.
  double density(const Vec3d& out, const Vec3d& in) const;
  struct Sample {
    Vec3d direction;
    Vec3d weight;   ///< value / density
    double density; ///< 0: the sample is void
  };
  Sample sample(const Vec3d& out, const std::array<double, 2>& u, double choice) const;

private:
  double coat_value(const Vec3d& out, const Vec3d& in) const;
  double coat_density(const Vec3d& out, const Vec3d& in) const;

  Vec3d albedo_;
  double roughness_, alpha_, normal_reflectance_;
  const CoatTable& table_;
  double body_ = 1;        ///< (1 − E(out)) / (1 − E average)
  double coat_chance_ = 0; ///< of sampling the coat
};

} // namespace pith
