// Planes, flat and wavy, spheres, and values of many points.
#include "volume/cut/level_set.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"

#include <cmath>
#include <numbers>

namespace pith {
namespace {

constexpr std::size_t points_per_block = 4096;

class Plane final : public LevelSet {
public:
  Plane(const Vec3d& normal, double offset) : normal_(normal), offset_(offset) {}
  double value(const Vec3d& x) const override { return normal_.dot(x) - offset_; }
  Vec3d gradient(const Vec3d&) const override { return normal_; }
  bool linear() const override { return true; }
  int side_of_ball(const Vec3d& center, double radius) const override {
    const double at = value(center), reach = radius + 1e-9 * (radius + std::abs(at));
    return (at > reach) - (at < -reach);
  }

private:
  Vec3d normal_;
  double offset_;
};

/// A plane with waves on it: φ(x) = n·x − offset − h(x), where h depends on the place along the plane only, so that
/// |∇φ| ≥ 1 everywhere. h = amplitude · tanh(g); g is a sum of plane waves of random directions and phases, with
/// lengths spread around the one asked for, and has about unit variance.
class WavyPlane final : public LevelSet {
public:
  WavyPlane(const Vec3d& normal, double offset, const Waves& waves)
      : normal_(normal), offset_(offset), amplitude_(waves.amplitude) {
    int least = 0; // the axis least aligned with the normal
    normal.cwiseAbs().minCoeff(&least);
    const Vec3d across = normal.cross(Vec3d::Unit(least)).normalized(), along = normal.cross(across);
    Random random(waves.seed, wave_stage);
    for (int i = 0; i < wave_count; ++i) {
      // Directions are stratified, so that no seed leaves a direction out.
      const double angle = std::numbers::pi * (i + random.uniform()) / wave_count;
      const double length = waves.length * std::exp2(random.uniform(-0.6, 1.0));
      wave_[i] = 2 * std::numbers::pi / length * (std::cos(angle) * across + std::sin(angle) * along);
      phase_[i] = 2 * std::numbers::pi * random.uniform();
    }
  }

  double value(const Vec3d& x) const override {
    double g = 0;
    for (int i = 0; i < wave_count; ++i) g += std::cos(wave_[i].dot(x) + phase_[i]);
    return normal_.dot(x) - offset_ - amplitude_ * std::tanh(height * g);
  }
  Vec3d gradient(const Vec3d& x) const override {
    double g = 0;
    Vec3d slope = Vec3d::Zero();
    for (int i = 0; i < wave_count; ++i) {
      const double at = wave_[i].dot(x) + phase_[i];
      g += std::cos(at);
      slope -= std::sin(at) * wave_[i];
    }
    const double t = std::tanh(height * g);
    return normal_ - amplitude_ * height * (1 - t * t) * slope;
  }

  int side_of_ball(const Vec3d& center, double radius) const override {
    const double at = normal_.dot(center) - offset_;
    const double reach = (radius + amplitude_) * (1 + 1e-9) + 1e-9 * std::abs(at);
    return (at > reach) - (at < -reach);
  }

private:
  static constexpr int wave_count = 16;
  static constexpr double height = 0.35355339059327373; ///< √(2 / wave_count)
  static constexpr std::uint64_t wave_stage = 0x7761766573;

  Vec3d normal_;
  double offset_, amplitude_;
  std::array<Vec3d, wave_count> wave_;
  std::array<double, wave_count> phase_;
};

class Sphere final : public LevelSet {
public:
  Sphere(const Vec3d& center, double radius) : center_(center), radius_(radius) {}
  double value(const Vec3d& x) const override { return (x - center_).norm() - radius_; }
  Vec3d gradient(const Vec3d& x) const override {
    const Vec3d from = x - center_;
    const double distance = from.norm();
    return distance > 0 ? Vec3d(from / distance) : Vec3d::UnitZ();
  }
  int side_of_ball(const Vec3d& center, double radius) const override {
    const double at = value(center), reach = radius + 1e-9 * (radius + std::abs(at));
    return (at > reach) - (at < -reach);
  }

private:
  Vec3d center_;
  double radius_;
};

} // namespace

void LevelSet::values(std::span<const Vec3d> points, std::span<double> result) const {
  parallel_for(points.size(), points_per_block, [&](std::size_t i) { result[i] = value(points[i]); });
}

std::unique_ptr<LevelSet> level_set_of(const PlaneCut& plane, const std::string& where) {
  const double length = plane.normal.norm();
  if (!std::isfinite(length) || !std::isfinite(plane.offset))
    throw InvalidInput(where, "the normal or the offset is not a finite number", "give finite numbers");
  if (!(length > 0)) throw InvalidInput(where, "the normal is zero", "give a normal of some length");
  const Waves& waves = plane.waves;
  if (!(waves.amplitude >= 0) || !std::isfinite(waves.amplitude))
    throw InvalidInput(where, "the waves' amplitude is " + std::to_string(waves.amplitude) + " mm", "give 0 or more");
  if (waves.amplitude == 0) return std::make_unique<Plane>(plane.normal / length, plane.offset / length);
  if (!(waves.length > 0) || !std::isfinite(waves.length))
    throw InvalidInput(where, "the waves' length is " + std::to_string(waves.length) + " mm",
                       "give a positive length");
  return std::make_unique<WavyPlane>(plane.normal / length, plane.offset / length, waves);
}

std::unique_ptr<LevelSet> level_set_of(const SphereCut& sphere, const std::string& where) {
  if (!sphere.center.allFinite() || !std::isfinite(sphere.radius))
    throw InvalidInput(where, "the center or the radius is not a finite number", "give finite numbers");
  if (!(sphere.radius > 0))
    throw InvalidInput(where, "the radius is " + std::to_string(sphere.radius) + " mm", "give a positive radius");
  return std::make_unique<Sphere>(sphere.center, sphere.radius);
}

} // namespace pith
