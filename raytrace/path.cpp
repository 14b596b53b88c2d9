// Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, §9.2 (multiple importance sampling);
// Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., §13.4 (path tracing with direct light).
#include "raytrace/path.h"

#include <algorithm>

namespace pith {

namespace {
/// Samples of a pixel lie closer together than pixels do; the pixel filter does the rest.
constexpr double footprint_in_pixels = 0.5;
constexpr std::uint32_t first_bounce_pair = 4, pairs_per_bounce = 5;

/// The shading normal, bent so that the eye is above it: smooth normals may turn away from rays that graze the facet.
Vec3d facing_normal(const Hit& hit, const Vec3d& out) {
  constexpr double least = 0.02;
  const double cosine = hit.smooth.dot(out);
  if (cosine >= least) return hit.smooth;
  const Vec3d across = hit.smooth - cosine * out;
  const double length = across.norm();
  if (!(length > 1e-9)) return out;
  return std::sqrt(1 - least * least) * (across / length) + least * out;
}

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
} // namespace

PathTracer::PathTracer(const Scene& scene, const View& view, const Lights& lights, const RenderOptions& options)
    : scene_(scene), view_(view), options_(options),
      environment_(lights.environment, scene.options().up, scene.options().ground.on),
      area_(lights.area, scene.bounds().center()) {
  radius_ = std::max(1e-9, 0.5 * scene.bounds().diagonal());
  const GroundOptions& ground = scene.options().ground;
  if (ground.on) {
    // The empty ground far away: sky, and what the rectangles still give where it has faded.
    const Vec3d& up = scene.options().up;
    const Vec3d center = scene.bounds().center();
    const Vec3d below = center + (scene.ground_height() - center.dot(up)) * up;
    const LocalFrame frame(up);
    Vec3d irradiance = environment_.upward_irradiance();
    constexpr int ring = 16;
    const double distance = 0.5 * (ground.fade_begin + ground.fade_end) * radius_;
    for (int i = 0; i < ring; ++i) {
      const double angle = 2 * std::numbers::pi * i / ring;
      const Vec3d at = below + distance * (std::cos(angle) * frame.tangent + std::sin(angle) * frame.bitangent);
      irradiance += area_.irradiance(at, up) / ring;
    }
    backdrop_ = ground.albedo.cwiseProduct(irradiance) / std::numbers::pi;
  }
}

double PathTracer::pixel_width(double distance) const {
  if (view_.orthographic()) return view_.height / options_.height;
  return 2 * distance * std::tan(0.5 * view_.vertical_angle) / options_.height;
}

Vec3d PathTracer::background(const Vec3d& direction) const {
  switch (options_.background.kind) {
  case Background::Kind::backdrop:
    return scene_.options().ground.on ? backdrop_ : environment_.radiance(direction);
  case Background::Kind::sky:
    return environment_.radiance(direction);
  case Background::Kind::color:
    return options_.background.color;
  case Background::Kind::transparent:
    break;
  }
  return Vec3d::Zero();
}

CameraSample PathTracer::sample(std::uint64_t pixel, int x, int y, std::uint32_t number) const {
  PixelSampler sampler(options_.seed, pixel, number);
  const auto [a, b] = sampler.next();
  const double px = x + 0.5 + filter_.offset(a), py = y + 0.5 + filter_.offset(b);
  const double half = 0.5 * options_.height;
  const View::Ray eye = view_.ray((px - 0.5 * options_.width) / half, (half - py) / half);
  const SceneRay ray{eye.origin, eye.direction};

  CameraSample result;
  result.first = scene_.nearest(ray);
  Hit& first = result.first;
  const bool transparent = options_.background.kind == Background::Kind::transparent;
  if (first.is_ground()) {
    const GroundOptions& ground = scene_.options().ground;
    const Vec3d& up = scene_.options().up;
    Vec3d away = first.position - scene_.bounds().center();
    away -= away.dot(up) * up;
    result.seen = 1 - smooth_step(ground.fade_begin, ground.fade_end, away.norm() / radius_);
  } else if (!first.exists()) {
    result.seen = 0;
  }
  if (result.seen > 0) {
    const double cosine = std::max(0.25, std::abs(first.normal.dot(ray.direction)));
    const double footprint = footprint_in_pixels * pixel_width(first.distance) / std::sqrt(cosine);
    const SurfaceMaterial material = scene_.material(first, footprint);
    result.radiance = result.seen * path(ray, first, material, sampler);
    result.albedo = result.seen * material.albedo;
  }
  if (result.seen < 1) {
    const Vec3d behind = (1 - result.seen) * background(ray.direction);
    result.radiance += behind;
    result.albedo += behind.cwiseMin(1.0);
    if (transparent) result.alpha = result.seen;
  }
  const Vec3d glow = lights_along(ray, first.distance, false, 0);
  result.radiance += glow;
  if (transparent && glow.maxCoeff() > 0) result.alpha = 1;
  return result;
}

Vec3d PathTracer::lights_along(const SceneRay& ray, double distance, bool leaves, double density) const {
  const bool camera = density <= 0;
  Vec3d sum = area_.radiance(ray.origin, ray.direction, distance, camera,
                             [&](double other) { return camera ? 1.0 : power_heuristic(density, other); });
  if (leaves && !camera)
    sum += power_heuristic(density, environment_.lit() ? environment_.density(ray.direction) : 0) *
           environment_.radiance(ray.direction);
  return sum;
}

Vec3d PathTracer::direct(const Hit& hit, const Reflection& reflection, const LocalFrame& frame, const Vec3d& out,
                         PixelSampler& sampler) const {
  Vec3d sum = Vec3d::Zero();
  const auto u = sampler.next(), v = sampler.next();
  if (environment_.lit()) {
    double density;
    const Vec3d direction = environment_.sample(u, density);
    const Vec3d in = frame.local(direction);
    const Vec3d value = reflection.value(out, in);
    if (density > 0 && value.maxCoeff() > 0 && !scene_.occluded({hit.lifted, direction}))
      sum += value.cwiseProduct(environment_.radiance(direction)) *
             (power_heuristic(density, reflection.density(out, in)) / density);
  }
  if (area_.lit()) {
    const AreaSampler::Sample light = area_.sample(hit.lifted, v);
    const Vec3d in = frame.local(light.direction);
    const Vec3d value = reflection.value(out, in);
    if (light.density > 0 && value.maxCoeff() > 0 && !scene_.occluded({hit.lifted, light.direction, light.distance}))
      sum += value.cwiseProduct(light.radiance) *
             (power_heuristic(light.density, reflection.density(out, in)) / light.density);
  }
  return sum;
}

Vec3d PathTracer::path(const SceneRay& start, const Hit& first, const SurfaceMaterial& first_material,
                       PixelSampler& sampler) const {
  Vec3d sum = Vec3d::Zero(), throughput = Vec3d::Ones();
  SceneRay ray = start;
  Hit hit = first;
  SurfaceMaterial material = first_material;
  double travelled = first.distance;
  for (int depth = 1;; ++depth) {
    if (hit.normal.dot(ray.direction) >= 0) break; // inside, through a crack no wider than rounding: dark
    const Vec3d away = -ray.direction;
    const LocalFrame frame(facing_normal(hit, away));
    const Vec3d out = frame.local(away);
    const Reflection reflection(material.albedo, material.roughness, material.index, coat_, out.z());
    sampler.go_to(first_bounce_pair + pairs_per_bounce * depth);
    sum += throughput.cwiseProduct(direct(hit, reflection, frame, out, sampler));
    const auto u = sampler.next(), choice = sampler.next();
    const Reflection::Sample next = reflection.sample(out, u, choice[0]);
    if (!(next.density > 0)) break;
    throughput = throughput.cwiseProduct(next.weight);
    ray = SceneRay{hit.lifted, frame.world(next.direction)};
    hit = scene_.nearest(ray);
    sum += throughput.cwiseProduct(lights_along(ray, hit.distance, !hit.exists(), next.density));
    if (!hit.exists() || depth >= options_.max_depth) break;
    travelled += hit.distance;
    // Light that has bounced needs no detail: about a twentieth of the way it came.
    material = scene_.material(hit, std::max(pixel_width(travelled), 0.05 * hit.distance));
  }
  return sum;
}

} // namespace pith
