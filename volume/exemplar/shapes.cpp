// Bodies of revolution are given by the square of their radius over the axis: unlike the radius it is smooth at the
// ends.
#include "volume/exemplar/shapes.h"

#include "volume/base/error.h"
#include "volume/exemplar/kiwi_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pith {

namespace {

constexpr double pi = std::numbers::pi;

double square(double x) { return x * x; }

/// Distance to a box around the origin with rounded edges.
double rounded_box(const Vec3d& p, const Vec3d& half, double round) {
  const Vec3d q = p.cwiseAbs() - half + Vec3d::Constant(round);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - round;
}

double carrot(const Vec3d& p) {
  const double u = (p.z() + 78) / 156, v = std::clamp(u, 0.0, 1.0); // 0 at the tip, 1 at the crown
  const double x = p.x() - 3.0 * std::sin(2.6 * v + 0.4) + 2.0, y = p.y() - 2.2 * std::sin(3.4 * v + 1.9);
  const double from_axis = x * x + y * y, around = std::atan2(y, x);
  // Not quite round, with shallow rings.
  const double radius =
      (3.2 + 15.8 * std::pow(v, 0.80)) *
      (1 + 0.010 * std::sin(58 * u + 1.3 * std::sin(around + 2 * u)) +
       (0.016 * std::cos(2 * around + 5 * u) + 0.010 * std::cos(3 * around - 7 * u)) * std::min(1.0, from_axis / 9));
  double squared = radius * radius;
  if (u < 0.07) squared *= 1 - square((0.07 - u) / 0.07);
  if (u > 0.86) squared *= 1 - std::pow((u - 0.86) / 0.14, 2.4);
  const double crown = u > 0.9 ? 60.0 * std::exp(-from_axis / 40.0) * std::min(1.0, (u - 0.9) / 0.05) : 0; // sunk in
  return (from_axis - squared + crown) / 20;
}

double tree(const Vec3d& p) {
  const double u = p.z() / 150; // −1 … 1
  const double around = std::atan2(p.y(), p.x());
  const double from_axis = p.x() * p.x() + p.y() * p.y(), near_axis = std::min(1.0, from_axis / 400);
  const double radius =
      (58 - 4.5 * u + 2.5 * square(std::max(0.0, -u))) *
      (1 + near_axis * (0.022 * std::cos(2 * around + 0.7) + 0.014 * std::cos(3 * around - 1.1 + u) +
                        0.010 * std::cos(5 * around + 2 * u)));
  const double end = std::max(0.0, (std::fabs(u) - 0.85) / 0.15);
  const double trunk = (from_axis - radius * radius * (1 - end * end)) / 116;
  // The branch rises from the trunk at 50 degrees.
  const Vec3d along = Vec3d(std::sin(0.87), 0, std::cos(0.87)), base(10, 0, -20);
  const double t = (p - base).dot(along);
  const double branch_radius = 21 - 0.055 * t;
  const double tip = std::max(0.0, (t - 112) / 16), back = std::max(0.0, -t / 12);
  const double branch =
      ((p - base - t * along).squaredNorm() - square(branch_radius) * (1 - tip * tip - back * back)) / 42;
  return smooth_union(trunk, branch, 16);
}

double watermelon(const Vec3d& p) {
  const Vec3d q = p.cwiseQuotient(Vec3d(125, 125, 150));
  const Vec3d d = p.normalized();
  const double uneven = 0.007 * std::sin(3.3 * d.x() + 1.1 * d.z() + 0.4) * std::cos(2.1 * d.y() - 0.7) +
                        0.005 * std::sin(4.1 * d.y() - 2.7 * d.x() + 1.9);
  const double from_axis = p.x() * p.x() + p.y() * p.y();
  const double dimple = (p.z() > 0 ? 0.024 : 0.014) * std::exp(-from_axis / square(p.z() > 0 ? 13.0 : 10.0));
  return 125 * (std::pow(std::pow(std::hypot(q.x(), q.y()), 2.2) + std::pow(std::fabs(q.z()), 2.2), 1 / 2.2) - 1 -
                uneven + dimple);
}

double tube(const Vec3d& p) {
  // An S-shaped rod: the axis strays along x.
  const double u = p.z() / 62;
  const double x = p.x() - 13 * std::sin(1.9 * u), y = p.y() - 3 * std::cos(1.4 * u) + 2;
  const double slope = 13 * 1.9 / 62 * std::cos(1.9 * u); // of the axis: what is seen in a level section is wider
  const double from_axis = x * x / (1 + slope * slope) + y * y, around = std::atan2(y, x);
  const double radius = 14 * (1 + 0.02 * std::min(1.0, from_axis / 25) * std::cos(2 * around + 3 * u));
  return smooth_intersection((from_axis - radius * radius) / 28, std::fabs(p.z()) - 55, 3.0);
}

double strata(const Vec3d& p) {
  const double uneven = 0.5 * std::sin(0.071 * p.x() + 0.4) * std::sin(0.093 * p.y() - 0.8) +
                        0.35 * std::sin(0.13 * p.z() + 0.05 * p.x() + 1.0);
  return rounded_box(p, {60, 40, 35}, 3.0) - uneven;
}

double cake(const Vec3d& p) {
  // The wedge's tip is at x = −45; the rim, a part of a circle of 90 mm, at x = 45.
  constexpr double half_angle = 26 * pi / 180;
  const double x = p.x() + 45, y = std::fabs(p.y());
  const double side = y * std::cos(half_angle) - x * std::sin(half_angle);
  const double rim = std::hypot(x, y) - 90;
  const double wedge = smooth_intersection(smooth_intersection(side, rim, 3.0), -x + 1.5, 3.0);
  return smooth_intersection(wedge, std::fabs(p.z()) - 31, 4.0);
}

double mineral(const Vec3d& p) {
  // A rounded triangle for a section, as tourmaline's; three planes at the top, a broken base.
  const double around = std::atan2(p.y(), p.x());
  double prism = -1e9;
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * pi * i / 3 + 0.3;
    const double face = p.x() * std::cos(turn) + p.y() * std::sin(turn) - 14.0;
    const double edge = -(p.x() * std::cos(turn) + p.y() * std::sin(turn)) - 18.0; // blunts the three edges
    prism = i == 0 ? smooth_intersection(face, edge, 2.0)
                   : smooth_intersection(prism, smooth_intersection(face, edge, 2.0), 9.0);
  }
  prism += 0.18 * std::cos(36 * around) * std::min(1.0, std::hypot(p.x(), p.y()) / 10); // striations along z
  double top = -1e9;
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * pi * (i + 0.5) / 3 + 0.3;
    const double plane = 0.62 * (p.x() * std::cos(turn) + p.y() * std::sin(turn)) + 0.785 * (p.z() - 48);
    top = i == 0 ? plane : smooth_intersection(top, plane, 1.5);
  }
  const double base = -p.z() - 46 + 1.2 * std::sin(0.31 * p.x() + 0.5) + 0.9 * std::sin(0.37 * p.y() - 0.3 * p.x());
  return smooth_intersection(smooth_intersection(prism, top, 1.5), base, 3.0);
}

double fruit(const Vec3d& p) {
  const Vec3d d = p.norm() > 0 ? Vec3d(p.normalized()) : Vec3d(0, 0, 1);
  const double from_axis = p.x() * p.x() + p.y() * p.y();
  double radius = 37.5 * (1 - 0.045 * d.z() * d.z() + 0.02 * d.z());
  radius += 0.5 * std::sin(3.1 * d.x() + 1.2) * std::cos(2.7 * d.y()) + 0.3 * std::sin(4.0 * d.z() - 2.0 * d.y());
  // The seam runs from the stem down the +x side; the stem's hollow is deep, the other end has a small point.
  const double seam = std::exp(-square(d.y() / 0.11)) * std::max(0.0, d.x() + 0.25);
  radius -= 1.5 * std::min(1.0, seam);
  radius -= p.z() > 0 ? 8.5 * std::exp(-from_axis / square(8.5)) : -1.2 * std::exp(-from_axis / square(4.0));
  return p.norm() - radius;
}

double wall(const Vec3d& p) {
  constexpr double half_angle = 50 * pi / 180;
  const double x = p.x() + 80, radius = std::hypot(x, p.y());
  const double ends = std::fabs(p.y()) * std::cos(half_angle) - x * std::sin(half_angle);
  return smooth_intersection(smooth_intersection(std::fabs(radius - 95) - 18, std::fabs(p.z()) - 50, 2.5), ends, 2.5);
}

double citrus(const Vec3d& p) {
  const double u = p.z() / 36;
  const double from_axis = p.x() * p.x() + p.y() * p.y();
  const double body =
      (std::sqrt(from_axis + p.z() * p.z()) - 36 + 0.4 * std::sin(0.09 * p.x() + 0.7) * std::cos(0.08 * p.y()));
  const double knob = (from_axis + square((p.z() + 34) / 1.35)) / 14 - 7.0;
  const double dimple = u > 0 ? 1.6 * std::exp(-from_axis / 30) : 0;
  return smooth_union(body + dimple, knob, 9);
}

struct Named {
  const char* name;
  double (*value)(const Vec3d&);
  Vec3d low, high;
};

std::vector<Named> shapes() {
  return {
      {"carrot", carrot, {-26, -26, -81}, {26, 26, 81}},
      {"tree", tree, {-72, -72, -156}, {128, 72, 156}},
      {"watermelon", watermelon, {-130, -130, -156}, {130, 130, 156}},
      {"tube", tube, {-32, -20, -58}, {32, 20, 58}},
      {"strata", strata, {-64, -44, -39}, {64, 44, 39}},
      {"cake", cake, {-48, -44, -34}, {49, 44, 34}},
      {"mineral", mineral, {-26, -26, -52}, {26, 26, 62}},
      {"fruit", fruit, {-42, -42, -42}, {42, 42, 42}},
      {"wall", wall, {-36, -92, -54}, {37, 92, 54}},
      {"citrus", citrus, {-40, -40, -50}, {40, 40, 42}},
  };
}

} // namespace

std::vector<std::string> shape_names() {
  std::vector<std::string> names{"kiwi"};
  for (const Named& shape : shapes()) names.push_back(shape.name);
  return names;
}

ImplicitShape implicit_shape(const std::string& name) {
  for (const Named& shape : shapes())
    if (name == shape.name) return {shape.value, shape.low, shape.high};
  std::string known;
  for (const std::string& each : shape_names()) known += (known.empty() ? "" : ", ") + each;
  throw InvalidInput("shape \"" + name + "\"", "no generator makes it", "known names: " + known);
}

TriMesh named_shape(const std::string& name, int triangles) {
  if (name == "kiwi") return kiwi_surface(triangles);
  return implicit_surface(implicit_shape(name), triangles, "shape \"" + name + "\"");
}

} // namespace pith
