#pragma once
// One camera sample: the light that comes along a ray.
#include "raytrace/light_sampler.h"
#include "raytrace/reflection.h"
#include "raytrace/render.h"

namespace pith {

/// What one sample of a pixel gives.
struct CameraSample {
  Vec3d radiance = Vec3d::Zero();
  double alpha = 1;
  Vec3d albedo = Vec3d::Zero();
  Hit first;
  double seen = 1; ///< share of the first hit in the colour: less than 1 where the ground fades
};

/// Path tracing with direct light by multiple importance sampling (Veach 1997; Pharr, Jakob, Humphreys, §13.4).
/// Shared by all threads.
class PathTracer {
public:
  PathTracer(const Scene& scene, const View& view, const Lights& lights, const RenderOptions& options);

  CameraSample sample(std::uint64_t pixel, int x, int y, std::uint32_t sample) const;

private:
  Vec3d path(const SceneRay& start, const Hit& first, const SurfaceMaterial& material, PixelSampler& sampler) const;
  Vec3d direct(const Hit& hit, const Reflection& reflection, const LocalFrame& frame, const Vec3d& out,
               PixelSampler& sampler) const;
  /// Light that a ray without a hit up to `distance` brings, weighted against the samplers of lights; a `density` of
  /// 0 stands for a camera ray.
  Vec3d lights_along(const SceneRay& ray, double distance, bool leaves, double density) const;
  Vec3d background(const Vec3d& direction) const;
  double pixel_width(double distance) const;

  const Scene& scene_;
  const View& view_;
  const RenderOptions& options_;
  EnvironmentSampler environment_;
  AreaSampler area_;
  CoatTable coat_;
  PixelFilter filter_;
  Vec3d backdrop_ = Vec3d::Zero();
  double radius_ = 1;
};

} // namespace pith
