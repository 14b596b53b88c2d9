// Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; Heitz, "Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014; Heitz, "Sampling the GGX Distribution of
// Visible Normals", JCGT 7(4), 2018; Kelemen, Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model",
// Eurographics 2001.
#include "raytrace/reflection.h"

namespace pith {

namespace {
constexpr double pi = std::numbers::pi;
constexpr int cosines = 64, roughnesses = 32;
constexpr double least_alpha = 1e-3;

double alpha_of(double roughness) { return std::max(least_alpha, roughness * roughness); }

/// Smith's Λ for GGX (Heitz 2014, Eq. 72).
double smith_lambda(double cosine, double alpha) {
  const double c2 = cosine * cosine;
  if (c2 >= 1) return 0;
  return 0.5 * (std::sqrt(1 + alpha * alpha * (1 - c2) / c2) - 1);
}

double facet_distribution(double cosine, double alpha) {
  const double a2 = alpha * alpha, d = cosine * cosine * (a2 - 1) + 1;
  return a2 / (pi * d * d);
}

/// A normal of the facets visible from `out` (Heitz 2018, appendix A).
Vec3d visible_normal(const Vec3d& out, double alpha, const std::array<double, 2>& u) {
  const Vec3d v = Vec3d(alpha * out.x(), alpha * out.y(), out.z()).normalized();
  const double across = v.x() * v.x() + v.y() * v.y();
  const Vec3d t1 = across > 0 ? Vec3d(Vec3d(-v.y(), v.x(), 0) / std::sqrt(across)) : Vec3d::UnitX();
  const Vec3d t2 = v.cross(t1);
  const double radius = std::sqrt(u[0]), angle = 2 * pi * u[1];
  const double a = radius * std::cos(angle);
  const double s = 0.5 * (1 + v.z());
  const double b = (1 - s) * std::sqrt(std::max(0.0, 1 - a * a)) + s * radius * std::sin(angle);
  const Vec3d n = a * t1 + b * t2 + std::sqrt(std::max(0.0, 1 - a * a - b * b)) * v;
  return Vec3d(alpha * n.x(), alpha * n.y(), std::max(1e-9, n.z())).normalized();
}

double schlick(double cosine, double normal_reflectance) {
  const double m = 1 - std::clamp(cosine, 0.0, 1.0), m2 = m * m;
  return normal_reflectance + (1 - normal_reflectance) * m2 * m2 * m;
}

double luminance(const Vec3d& c) { return 0.2126 * c.x() + 0.7152 * c.y() + 0.0722 * c.z(); }

/// Cosines are spaced by their square roots: the tables change fastest at grazing angles.
double cosine_at(int i) {
  const double t = std::max(1e-3, double(i) / (cosines - 1));
  return t * t;
}
} // namespace

CoatTable::CoatTable() : directional_(cosines * roughnesses), average_(roughnesses) {
  constexpr int across = 24, around = 12;
  for (int r = 0; r < roughnesses; ++r) {
    const double alpha = alpha_of(double(r) / (roughnesses - 1));
    for (int c = 0; c < cosines; ++c) {
      const double cosine = cosine_at(c);
      const Vec3d out(std::sqrt(1 - cosine * cosine), 0, cosine);
      const double out_lambda = smith_lambda(cosine, alpha);
      Entry sum;
      for (int i = 0; i < across; ++i)
        for (int j = 0; j < around; ++j) { // half the circle: the lobe is symmetric
          const Vec3d normal = visible_normal(out, alpha, {(i + 0.5) / across, 0.25 + 0.5 * (j + 0.5) / around});
          const double half = out.dot(normal);
          const double in_cosine = 2 * half * normal.z() - out.z();
          if (in_cosine <= 0) continue;
          const double weight = (1 + out_lambda) / (1 + out_lambda + smith_lambda(in_cosine, alpha));
          sum.facing += weight;
          sum.grazing += weight * schlick(half, 0);
        }
      directional_[r * cosines + c] = {sum.facing / (across * around), sum.grazing / (across * around)};
    }
    constexpr int steps = 256;
    Entry mean;
    for (int i = 0; i < steps; ++i) {
      const double cosine = (i + 0.5) / steps;
      const Entry e = directional_entry(cosine, double(r) / (roughnesses - 1));
      mean.facing += 2 * cosine * e.facing / steps;
      mean.grazing += 2 * cosine * e.grazing / steps;
    }
    average_[r] = mean;
  }
}

CoatTable::Entry CoatTable::directional_entry(double cosine, double roughness) const {
  const double x = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * (cosines - 1);
  const double y = std::clamp(roughness, 0.0, 1.0) * (roughnesses - 1);
  const int i = std::min(cosines - 2, int(x)), j = std::min(roughnesses - 2, int(y));
  const double a = x - i, b = y - j;
  const auto mixed = [&](double Entry::*part) {
    const Entry* row = directional_.data() + j * cosines + i;
    return (1 - b) * ((1 - a) * row[0].*part + a * row[1].*part) +
           b * ((1 - a) * row[cosines].*part + a * row[cosines + 1].*part);
  };
  return {mixed(&Entry::facing), mixed(&Entry::grazing)};
}

double CoatTable::directional(double cosine, double roughness, double f0) const {
  const Entry e = directional_entry(cosine, roughness);
  return f0 * (e.facing - e.grazing) + e.grazing;
}

double CoatTable::average(double roughness, double f0) const {
  const double y = std::clamp(roughness, 0.0, 1.0) * (roughnesses - 1);
  const int j = std::min(roughnesses - 2, int(y));
  const double b = y - j;
  const double facing = (1 - b) * average_[j].facing + b * average_[j + 1].facing;
  const double grazing = (1 - b) * average_[j].grazing + b * average_[j + 1].grazing;
  return f0 * (facing - grazing) + grazing;
}

Reflection::Reflection(const Vec3d& albedo, double roughness, double index, const CoatTable& table,
                       double outgoing_cosine)
    : albedo_(albedo), roughness_(roughness), alpha_(alpha_of(roughness)),
      normal_reflectance_(index > 1 ? std::pow((index - 1) / (index + 1), 2) : 0), table_(table) {
  if (normal_reflectance_ <= 0) return;
  const double coat = table.directional(outgoing_cosine, roughness, normal_reflectance_);
  body_ = (1 - coat) / (1 - table.average(roughness, normal_reflectance_));
  const double body = (1 - coat) * luminance(albedo);
  coat_chance_ = std::clamp(coat / (coat + body), 0.1, 0.9);
}

double Reflection::coat_value(const Vec3d& out, const Vec3d& in) const {
  const Vec3d half = (out + in).normalized();
  const double shadowing = 1 / (1 + smith_lambda(out.z(), alpha_) + smith_lambda(in.z(), alpha_));
  return facet_distribution(half.z(), alpha_) * shadowing * schlick(out.dot(half), normal_reflectance_) /
         (4 * out.z()); // · cos θ of `in` cancels
}

double Reflection::coat_density(const Vec3d& out, const Vec3d& in) const {
  const Vec3d half = (out + in).normalized();
  return facet_distribution(half.z(), alpha_) / (4 * out.z() * (1 + smith_lambda(out.z(), alpha_)));
}

Vec3d Reflection::value(const Vec3d& out, const Vec3d& in) const {
  if (out.z() <= 0 || in.z() <= 0) return Vec3d::Zero();
  if (normal_reflectance_ <= 0) return albedo_ * (in.z() / pi);
  const double through = body_ * (1 - table_.directional(in.z(), roughness_, normal_reflectance_));
  return albedo_ * (through * in.z() / pi) + Vec3d::Constant(coat_value(out, in));
}

double Reflection::density(const Vec3d& out, const Vec3d& in) const {
  if (out.z() <= 0 || in.z() <= 0) return 0;
  const double body = (1 - coat_chance_) * in.z() / pi;
  return coat_chance_ > 0 ? body + coat_chance_ * coat_density(out, in) : body;
}

Reflection::Sample Reflection::sample(const Vec3d& out, const std::array<double, 2>& u, double choice) const {
  Sample result{Vec3d::UnitZ(), Vec3d::Zero(), 0};
  if (out.z() <= 0) return result;
  if (choice < coat_chance_) {
    const Vec3d half = visible_normal(out, alpha_, u);
    result.direction = 2 * out.dot(half) * half - out;
  } else {
    result.direction = cosine_direction(u);
  }
  const double density = this->density(out, result.direction);
  if (!(density > 0)) return result;
  result.density = density;
  result.weight = value(out, result.direction) / density;
  return result;
}

} // namespace pith
