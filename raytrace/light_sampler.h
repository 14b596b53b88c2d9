#pragma once
// Draws directions towards the lights in proportion to what they send.
#include "raytrace/light.h"
#include "raytrace/sampling.h"

#include <span>

namespace pith {

/// The axes of the surroundings: `forward` is what the middle column of a latitude-longitude picture shows (up × x;
/// up × y where up runs along x), turned by `turn`; columns go right.
struct SkyFrame {
  Vec3d right, up, forward;
  SkyFrame(const Vec3d& up, double turn);
};

/// The environment with a table of what comes from where. The table's cells have exact solid angles, so a constant
/// sky is sampled uniformly.
class EnvironmentSampler {
public:
  /// `upper_only`: directions below the horizon are never drawn (a ground plane hides them). `environment` must
  /// outlive the sampler.
  EnvironmentSampler(const Environment& environment, const Vec3d& up, bool upper_only);

  Vec3d radiance(const Vec3d& direction) const;
  /// False: there is no light to draw.
  bool lit() const { return total_ > 0; }
  Vec3d sample(const std::array<double, 2>& u, double& density) const;
  /// Per solid angle.
  double density(const Vec3d& direction) const;
  /// Irradiance of a plane that faces up, by the table's cells.
  Vec3d upward_irradiance() const;

private:
  double column_of(const Vec3d& direction) const; ///< 0 … 1
  std::size_t cell_of(const Vec3d& direction) const;
  Vec3d radiance_at(double column, double row_cosine) const;

  const Environment& environment_;
  SkyFrame frame_;
  int columns_ = 1, rows_ = 64;
  std::vector<double> row_cosine_;   ///< borders of rows, 1 … −1
  std::vector<double> row_, column_; ///< running sums: of rows, and of cells within each row
  std::vector<double> density_;      ///< per cell
  double total_ = 0;
};

/// The rectangles, one chosen with chances proportional to power over squared distance to the subject.
class AreaSampler {
public:
  /// `lights` must outlive the sampler.
  AreaSampler(std::span<const AreaLight> lights, const Vec3d& subject);

  bool lit() const { return !chance_.empty(); }
  struct Sample {
    Vec3d direction, radiance;
    double distance = 0, density = 0; ///< per solid angle; 0: the light faces away
  };
  Sample sample(const Vec3d& from, const std::array<double, 2>& u) const;

  /// Radiance along a ray up to `to`, each light weighted by `weight(density of sample() for it)`. Lights do not hide
  /// one another.
  template <class Weight>
  Vec3d radiance(const Vec3d& origin, const Vec3d& direction, double to, bool camera, const Weight& weight) const {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < chance_.size(); ++i) {
      if (camera && !lights_[i].visible) continue;
      const double density = density_towards(i, origin, direction, to);
      if (density > 0) sum += weight(density) * lights_[i].radiance;
    }
    return sum;
  }
  /// Irradiance without shadows at a point whose normal is `normal`, by a fixed grid of 16 × 16 points on each light.
  Vec3d irradiance(const Vec3d& at, const Vec3d& normal) const;

private:
  double density_towards(std::size_t i, const Vec3d& origin, const Vec3d& direction, double to) const;

  std::span<const AreaLight> lights_;
  std::vector<double> chance_, running_;
};

} // namespace pith
