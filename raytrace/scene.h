#pragma once
// What rays hit: the surfaces of all pieces where they stand, and a ground plane. Colour comes from material_at.
#include "volume/cut/displace.h"
#include "volume/layer/model.h"

#include <cmath>
#include <memory>

namespace pith {

/// How a surface answers light: a diffuse body of the material's colour under a rough dielectric coat.
struct SurfaceLook {
  double roughness = 0.5; ///< 0 … 1 (GGX α = roughness²); a `roughness` channel of the material takes its place
  double index = 1.4;     ///< refractive index of the coat, > 1; 1: no coat, purely diffuse
};

struct GroundOptions {
  bool on = true;
  double height = std::nan("");        ///< mm along `up`; not a number: just under the lowest point of the pieces
  Vec3d albedo{0.80, 0.79, 0.77};      ///< matte, linear
  double fade_begin = 3, fade_end = 9; ///< where it melts into the background, in radii of the pieces
};

struct SceneOptions {
  Vec3d up{0, 1, 0}; ///< away from the ground
  SurfaceLook skin{.roughness = 0.7};
  SurfaceLook section{.roughness = 0.28};
  double crease = 0.8;            ///< radians: skin facets that meet at a larger angle keep a sharp edge
  Vec3d uncovered{0.5, 0.5, 0.5}; ///< colour where the material's coverage is below 1
  GroundOptions ground;
  DisplaceOptions displacement{}; ///< of the skin by the relief of its material (relief.h), where that has one
};

/// A half line, world space, mm. `direction` has unit length.
struct SceneRay {
  Vec3d origin, direction;
  double to = std::numeric_limits<double>::infinity(); ///< its end
};

/// What a ray met first.
struct Hit {
  static constexpr std::uint32_t ground = 0xfffffffeu; ///< `piece` of the ground plane
  static constexpr std::uint32_t nothing = 0xffffffffu;

  std::uint32_t piece = nothing;
  std::uint32_t triangle = 0; ///< of the piece's surface
  double distance = std::numeric_limits<double>::infinity();
  Vec3d position = Vec3d::Zero(); ///< world
  Vec3d rest = Vec3d::Zero();     ///< the same point in rest space
  Vec3d normal = Vec3d::UnitY();  ///< geometric, unit, outwards; world
  Vec3d smooth = Vec3d::UnitY();  ///< interpolated, unit, outwards; world
  Vec3d lifted = Vec3d::Zero();   ///< where secondary rays start, free of the facets' shadow terminator; world
  FaceTag tag;                    ///< skin facet or section
  TetId root;                     ///< the root tet behind it

  bool exists() const { return piece != nothing; }
  bool is_ground() const { return piece == ground; }
};

/// What material_at gave, in the terms of the reflection model.
struct SurfaceMaterial {
  Vec3d albedo = Vec3d::Constant(0.5);
  double roughness = 0.5;
  double index = 1; ///< 1: no coat
};

/// The pieces, placed, in a tree for rays. Facets where two unmoved pieces touch are left out: they are no interface
/// to light. Immutable; safe to share between threads; answers do not depend on the tree or on the number of threads
/// (near-ties go to the lowest piece, then the lowest triangle, and hits are recomputed in double in rest space).
class Scene {
public:
  /// `root` must outlive the scene; `pieces` is not kept. Throws InvalidInput when nothing is there to see, or when
  /// an option is out of range. Cost: about 0.5 s per million triangles.
  Scene(const Root& root, const Pieces& pieces, const SceneOptions& options = {});
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// The nearest hit, ground included; Hit::exists() is false when the ray leaves.
  Hit nearest(const SceneRay& ray) const;
  /// True when anything, ground included, stands between the ray's origin and its end.
  bool occluded(const SceneRay& ray) const;

  /// The surface's material at a hit, filtered over `footprint` mm.
  SurfaceMaterial material(const Hit& hit, double footprint) const;

  const Root& root() const;
  const SceneOptions& options() const;
  const Box& bounds() const;          ///< of the placed pieces, world
  double ground_height() const;       ///< along options().up
  std::size_t triangle_count() const; ///< triangles that rays can meet
  /// Corners of every triangle that rays can meet, placed: to frame a view. World.
  const std::vector<Vec3d>& points() const;
  /// Area of all sections that can be met, mm².
  double section_area() const;
  /// Places on the sections, at most about a thousand, each standing for `area` (mm², along its outward normal);
  /// world.
  struct SectionSample {
    Vec3d position, area;
  };
  const std::vector<SectionSample>& section_samples() const;

private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

} // namespace pith
