// Importance sampling of latitude-longitude pictures (Pharr, Jakob, Humphreys, Physically Based Rendering, 4th ed.,
// §12.5) and uniform sampling of rectangles.
#include "raytrace/light_sampler.h"

#include <algorithm>

namespace pith {

namespace {
constexpr double pi = std::numbers::pi;
constexpr int most_columns = 512;

double brightness(const Vec3d& c) { return (c.x() + c.y() + c.z()) / 3; }

/// Index of the interval of a running sum that `u` · last falls in; `left` becomes the position inside it, in [0, 1).
std::size_t drawn(const double* running, std::size_t count, double u, double& left) {
  const double wanted = u * running[count];
  std::size_t i = std::upper_bound(running + 1, running + count + 1, wanted) - (running + 1);
  i = std::min(i, count - 1);
  while (i > 0 && running[i + 1] <= running[i]) --i;
  const double width = running[i + 1] - running[i];
  left = width > 0 ? std::clamp((wanted - running[i]) / width, 0.0, 0x1.fffffffffffffp-1) : 0.5;
  return i;
}
} // namespace

SkyFrame::SkyFrame(const Vec3d& up_direction, double turn) : up(up_direction.normalized()) {
  const Vec3d axis = std::abs(up.x()) < 0.9 ? Vec3d::UnitX() : Vec3d::UnitY();
  const Vec3d start = up.cross(axis).normalized(), aside = up.cross(start);
  forward = std::cos(turn) * start + std::sin(turn) * aside;
  right = forward.cross(up);
}

EnvironmentSampler::EnvironmentSampler(const Environment& environment, const Vec3d& up, bool upper_only)
    : environment_(environment), frame_(up, environment.turn) {
  const Image& image = environment.image;
  if (!image.pixel.empty()) {
    columns_ = std::clamp(image.width, 1, most_columns);
    rows_ = 2 * ((std::clamp(image.height, 2, most_columns / 2) + 1) / 2); // even: the horizon is a border of rows
  }
  row_cosine_.resize(rows_ + 1);
  for (int r = 0; r <= rows_; ++r) row_cosine_[r] = 2 * r == rows_ ? 0 : std::cos(pi * r / rows_);
  // Mean brightness of each cell on a small grid, and a floor so that no lit direction is missed.
  const int fine = image.pixel.empty() ? 4 : std::clamp((image.width + columns_ - 1) / columns_, 2, 8);
  std::vector<double> power(std::size_t(columns_) * rows_);
  double sum = 0, solid_angle = 0;
  for (int r = 0; r < rows_; ++r) {
    const double cell = (row_cosine_[r] - row_cosine_[r + 1]) * 2 * pi / columns_;
    if (upper_only && 2 * r >= rows_) continue;
    for (int c = 0; c < columns_; ++c) {
      double mean = 0;
      for (int i = 0; i < fine; ++i)
        for (int j = 0; j < fine; ++j)
          mean += brightness(radiance_at((c + (i + 0.5) / fine) / columns_,
                                         row_cosine_[r] + (row_cosine_[r + 1] - row_cosine_[r]) * (j + 0.5) / fine));
      mean /= fine * fine;
      power[std::size_t(r) * columns_ + c] = mean;
      sum += mean * cell;
      solid_angle += cell;
    }
  }
  const double floor = 0.05 * sum / solid_angle;
  row_.assign(rows_ + 1, 0);
  column_.assign(std::size_t(columns_ + 1) * rows_, 0);
  density_.assign(power.size(), 0);
  for (int r = 0; r < rows_; ++r) {
    const double cell = (row_cosine_[r] - row_cosine_[r + 1]) * 2 * pi / columns_;
    double* running = column_.data() + std::size_t(r) * (columns_ + 1);
    for (int c = 0; c < columns_; ++c) {
      const bool hidden = upper_only && 2 * r >= rows_;
      const double p = hidden ? 0 : power[std::size_t(r) * columns_ + c] + floor;
      density_[std::size_t(r) * columns_ + c] = p;
      running[c + 1] = running[c] + p * cell;
    }
    row_[r + 1] = row_[r] + running[columns_];
  }
  total_ = row_[rows_];
  if (total_ > 0)
    for (double& d : density_) d /= total_;
}

Vec3d EnvironmentSampler::radiance_at(double column, double cosine) const {
  const Image& image = environment_.image;
  if (image.pixel.empty()) {
    // Smooth in the sine of the elevation: most of the change is near the horizon.
    const double t = std::min(1.0, std::abs(cosine)), s = 1 - (1 - t) * (1 - t);
    const Vec3d& pole = cosine >= 0 ? environment_.zenith : environment_.nadir;
    return environment_.scale * (environment_.horizon + s * (pole - environment_.horizon));
  }
  const double x = column * image.width - 0.5;
  const double y = std::acos(std::clamp(cosine, -1.0, 1.0)) / pi * image.height - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y);
  const auto texel = [&](double c, double r) {
    int i = static_cast<int>(c) % image.width;
    if (i < 0) i += image.width;
    const float* p = image.at(i, std::clamp(static_cast<int>(r), 0, image.height - 1));
    return Vec3d(std::max(0.0f, p[0]), std::max(0.0f, p[1]), std::max(0.0f, p[2]));
  };
  const Vec3d above = texel(x0, y0) + (x - x0) * (texel(x0 + 1, y0) - texel(x0, y0));
  const Vec3d below = texel(x0, y0 + 1) + (x - x0) * (texel(x0 + 1, y0 + 1) - texel(x0, y0 + 1));
  return environment_.scale * (above + (y - y0) * (below - above));
}

double EnvironmentSampler::column_of(const Vec3d& direction) const {
  if (columns_ == 1) return 0.5;
  return 0.5 + std::atan2(direction.dot(frame_.right), direction.dot(frame_.forward)) / (2 * pi);
}

Vec3d EnvironmentSampler::radiance(const Vec3d& direction) const {
  return radiance_at(column_of(direction), direction.dot(frame_.up));
}

Vec3d EnvironmentSampler::sample(const std::array<double, 2>& u, double& density) const {
  double down, across;
  const std::size_t r = drawn(row_.data(), rows_, u[1], down);
  const std::size_t c = drawn(column_.data() + r * (columns_ + 1), columns_, u[0], across);
  const double cosine = row_cosine_[r] + down * (row_cosine_[r + 1] - row_cosine_[r]);
  const double angle = ((c + across) / columns_ - 0.5) * 2 * pi;
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  density = density_[r * columns_ + c];
  return cosine * frame_.up + sine * (std::sin(angle) * frame_.right + std::cos(angle) * frame_.forward);
}

std::size_t EnvironmentSampler::cell_of(const Vec3d& direction) const {
  const double column = column_of(direction);
  const double cosine = direction.dot(frame_.up);
  const auto below = std::lower_bound(row_cosine_.begin() + 1, row_cosine_.end(), cosine, std::greater<double>());
  const int r = std::clamp(static_cast<int>(below - row_cosine_.begin()) - 1, 0, rows_ - 1);
  const int c = std::clamp(static_cast<int>(column * columns_), 0, columns_ - 1);
  return std::size_t(r) * columns_ + c;
}

double EnvironmentSampler::density(const Vec3d& direction) const { return density_[cell_of(direction)]; }

Vec3d EnvironmentSampler::upward_irradiance() const {
  Vec3d sum = Vec3d::Zero();
  const int columns = environment_.image.pixel.empty() ? 1 : columns_;
  for (int r = 0; 2 * r < rows_; ++r) {
    const double high = row_cosine_[r], low = row_cosine_[r + 1];
    for (int c = 0; c < columns; ++c)
      sum +=
          radiance_at((c + 0.5) / columns, 0.5 * (high + low)) * (0.5 * (high * high - low * low) * 2 * pi / columns);
  }
  return sum;
}

AreaSampler::AreaSampler(std::span<const AreaLight> lights, const Vec3d& subject) : lights_(lights) {
  double sum = 0;
  for (const AreaLight& light : lights) {
    const double power = brightness(light.radiance) * light.edge_u.cross(light.edge_v).norm() /
                         std::max(1e-12, (light.center - subject).squaredNorm());
    chance_.push_back(power);
    sum += power;
  }
  if (!(sum > 0)) chance_.clear();
  double running = 0;
  for (double& c : chance_) {
    c /= sum;
    running_.push_back(running += c);
  }
}

AreaSampler::Sample AreaSampler::sample(const Vec3d& from, const std::array<double, 2>& u) const {
  std::size_t i = 0;
  while (i + 1 < chance_.size() && (u[0] >= running_[i] || chance_[i] <= 0)) ++i;
  const double below = i > 0 ? running_[i - 1] : 0;
  const double a = std::clamp((u[0] - below) / chance_[i], 0.0, 1.0) - 0.5;
  const AreaLight& light = lights_[i];
  const Vec3d to = light.center + a * light.edge_u + (u[1] - 0.5) * light.edge_v - from;
  Sample result;
  result.distance = to.norm();
  result.direction = to / result.distance;
  result.radiance = light.radiance;
  const Vec3d area = light.edge_u.cross(light.edge_v);
  const double facing = -area.dot(result.direction); // area · cos θ
  if (facing > 0) result.density = chance_[i] * result.distance * result.distance / facing;
  return result;
}

double AreaSampler::density_towards(std::size_t i, const Vec3d& origin, const Vec3d& direction, double to) const {
  const AreaLight& light = lights_[i];
  const Vec3d area = light.edge_u.cross(light.edge_v);
  const double facing = -area.dot(direction);
  if (!(facing > 0)) return 0;
  const double distance = area.dot(origin - light.center) / facing;
  if (!(distance > 0) || distance >= to) return 0;
  const Vec3d at = origin + distance * direction - light.center;
  if (std::abs(at.dot(light.edge_u)) > 0.5 * light.edge_u.squaredNorm()) return 0;
  if (std::abs(at.dot(light.edge_v)) > 0.5 * light.edge_v.squaredNorm()) return 0;
  return chance_[i] * distance * distance / facing;
}

Vec3d AreaSampler::irradiance(const Vec3d& at, const Vec3d& normal) const {
  constexpr int n = 16;
  Vec3d sum = Vec3d::Zero();
  for (const AreaLight& light : lights_) {
    const Vec3d area = light.edge_u.cross(light.edge_v) / (n * n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Vec3d to =
            light.center + ((i + 0.5) / n - 0.5) * light.edge_u + ((j + 0.5) / n - 0.5) * light.edge_v - at;
        const double squared = to.squaredNorm();
        sum += light.radiance * (std::max(0.0, -area.dot(to)) * std::max(0.0, normal.dot(to)) / (squared * squared));
      }
  }
  return sum;
}

double neutral_exposure(const Lights& lights, const Vec3d& subject, const Vec3d& up) {
  const Vec3d normal = up.normalized();
  const Vec3d irradiance = EnvironmentSampler(lights.environment, normal, true).upward_irradiance() +
                           AreaSampler(lights.area, subject).irradiance(subject, normal);
  const double shown = brightness(irradiance) / pi;
  return shown > 0 ? std::log2(0.8 / shown) : 0;
}

} // namespace pith
