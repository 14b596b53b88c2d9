// Planes, spheres, and values of many points.
#include "volume/cut/level_set.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"

#include <cmath>

namespace pith {
namespace {

constexpr std::size_t points_per_block = 4096;

class Plane final : public LevelSet {
public:
  Plane(const Vec3d& normal, double offset) : normal_(normal), offset_(offset) {}
  double value(const Vec3d& x) const override { return normal_.dot(x) - offset_; }
  Vec3d gradient(const Vec3d&) const override { return normal_; }
  bool linear() const override { return true; }

private:
  Vec3d normal_;
  double offset_;
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
  return std::make_unique<Plane>(plane.normal / length, plane.offset / length);
}

std::unique_ptr<LevelSet> level_set_of(const SphereCut& sphere, const std::string& where) {
  if (!sphere.center.allFinite() || !std::isfinite(sphere.radius))
    throw InvalidInput(where, "the center or the radius is not a finite number", "give finite numbers");
  if (!(sphere.radius > 0))
    throw InvalidInput(where, "the radius is " + std::to_string(sphere.radius) + " mm", "give a positive radius");
  return std::make_unique<Sphere>(sphere.center, sphere.radius);
}

} // namespace pith
