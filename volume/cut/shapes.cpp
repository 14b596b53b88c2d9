// Level sets with a closed form: boxes, cylinders, what several share; and smooth surfaces through points with
// normals (Turk, O'Brien: Shape transformation using variational implicit functions, 1999).
#include "volume/base/error.h"
#include "volume/cut/level_set.h"
#include "volume/field/radial_basis.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pith {
namespace {

std::string text_of(double number) { return std::to_string(number); }

/// A level set that is a distance: the sign is certain as far as it reaches.
class Distance : public LevelSet {
public:
  int side_of_ball(const Vec3d& center, double radius) const override {
    const double at = value(center), reach = radius + 1e-9 * (radius + std::abs(at));
    return (at > reach) - (at < -reach);
  }
};

class BoxSides final : public Distance {
public:
  BoxSides(const Vec3d& center, const Vec3d& half, const Mat3d& axes) : center_(center), half_(half), axes_(axes) {}
  double value(const Vec3d& x) const override {
    const Vec3d beyond = (axes_.transpose() * (x - center_)).cwiseAbs() - half_;
    return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
  }
  Vec3d gradient(const Vec3d& x) const override {
    const Vec3d local = axes_.transpose() * (x - center_), beyond = local.cwiseAbs() - half_;
    Vec3d out = beyond.cwiseMax(0);
    if (out.isZero(0)) {
      int side = 0;
      beyond.maxCoeff(&side);
      out = Vec3d::Unit(side);
    }
    for (int i = 0; i < 3; ++i) out[i] = std::copysign(out[i], local[i]);
    return axes_ * out.normalized();
  }

private:
  Vec3d center_, half_;
  Mat3d axes_; ///< columns
};

class CylinderSides final : public Distance {
public:
  CylinderSides(const CylinderCut& cylinder)
      : middle_(0.5 * (cylinder.from + cylinder.to)), axis_((cylinder.to - cylinder.from).normalized()),
        half_(cylinder.endless ? std::numeric_limits<double>::infinity()
                               : 0.5 * (cylinder.to - cylinder.from).norm()),
        radius_(cylinder.radius) {}
  double value(const Vec3d& x) const override {
    const auto [around, along] = beyond(x);
    return std::hypot(std::max(around, 0.0), std::max(along, 0.0)) + std::min(std::max(around, along), 0.0);
  }
  Vec3d gradient(const Vec3d& x) const override {
    const auto [around, along] = beyond(x);
    const double height = (x - middle_).dot(axis_);
    const Vec3d off = x - middle_ - height * axis_;
    const Vec3d outwards = off.isZero(0) ? axis_.unitOrthogonal() : off.normalized();
    const Vec3d upwards = std::copysign(1.0, height) * axis_;
    if (around > 0 && along > 0) return (around * outwards + along * upwards).normalized();
    return around > along ? outwards : upwards;
  }

private:
  std::pair<double, double> beyond(const Vec3d& x) const {
    const double height = (x - middle_).dot(axis_);
    return {(x - middle_ - height * axis_).norm() - radius_, std::abs(height) - half_};
  }
  Vec3d middle_, axis_;
  double half_, radius_;
};

/// Where all are negative.
class Shared final : public LevelSet {
public:
  explicit Shared(std::vector<std::unique_ptr<LevelSet>> parts) : part_(std::move(parts)) {}
  double value(const Vec3d& x) const override { return largest(x).first; }
  Vec3d gradient(const Vec3d& x) const override { return largest(x).second->gradient(x); }
  int side_of_ball(const Vec3d& center, double radius) const override {
    int side = -1;
    for (const auto& part : part_) {
      const int one = part->side_of_ball(center, radius);
      if (one > 0) return 1;
      if (one == 0) side = 0;
    }
    return side;
  }

private:
  std::pair<double, const LevelSet*> largest(const Vec3d& x) const {
    std::pair<double, const LevelSet*> result{-std::numeric_limits<double>::infinity(), nullptr};
    for (const auto& part : part_)
      if (const double value = part->value(x); !result.second || !(value <= result.first))
        result = {value, part.get()};
    return result;
  }
  std::vector<std::unique_ptr<LevelSet>> part_;
};

class Sheet final : public LevelSet {
public:
  explicit Sheet(RadialBasis basis) : basis_(std::move(basis)) {}
  double value(const Vec3d& x) const override { return basis_.value(x); }
  Vec3d gradient(const Vec3d& x) const override { return basis_.gradient(x); }
  void values(std::span<const Vec3d> points, std::span<double> result) const override {
    basis_.values(points, result);
  }

private:
  RadialBasis basis_;
};

} // namespace

std::unique_ptr<LevelSet> level_set_of(const BoxCut& box, const std::string& where) {
  if (!box.center.allFinite() || !box.size.allFinite() || !box.axis.allFinite() || !std::isfinite(box.angle))
    throw InvalidInput(where, "a number is not finite", "give finite numbers");
  if (!(box.size.minCoeff() > 0))
    throw InvalidInput(where, "an edge of the box is " + text_of(box.size.minCoeff()) + " mm", "give positive edges");
  Mat3d axes = Mat3d::Identity();
  if (box.angle != 0) {
    if (!(box.axis.norm() > 0)) throw InvalidInput(where, "the axis of the turn is zero", "give a direction");
    axes = Eigen::AngleAxisd(box.angle, box.axis.normalized()).toRotationMatrix();
  }
  return std::make_unique<BoxSides>(box.center, 0.5 * box.size, axes);
}

std::unique_ptr<LevelSet> level_set_of(const CylinderCut& cylinder, const std::string& where) {
  if (!cylinder.from.allFinite() || !cylinder.to.allFinite() || !std::isfinite(cylinder.radius))
    throw InvalidInput(where, "a number is not finite", "give finite numbers");
  if (!((cylinder.to - cylinder.from).norm() > 0))
    throw InvalidInput(where, "both ends of the cylinder are at one place", "move one of them");
  if (!(cylinder.radius > 0))
    throw InvalidInput(where, "the radius is " + text_of(cylinder.radius) + " mm", "give a positive radius");
  return std::make_unique<CylinderSides>(cylinder);
}

std::unique_ptr<LevelSet> level_set_of(const SheetCut& sheet, const std::string& where) {
  constexpr std::size_t most = 2000;
  const std::size_t count = sheet.point.size();
  if (count == 0) throw InvalidInput(where, "has no points", "give points that the cut passes through");
  if (count > most)
    throw InvalidInput(where, std::to_string(count) + " points, at most " + std::to_string(most), "leave some out");
  if (sheet.normal.size() != count)
    throw InvalidInput(where,
                       std::to_string(sheet.normal.size()) + " normals for " + std::to_string(count) + " points",
                       "give one normal for each point");
  Box box;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "point " + std::to_string(i);
    if (!sheet.point[i].allFinite() || !sheet.normal[i].allFinite())
      throw InvalidInput(where, name + " or its normal is not finite", "give finite numbers");
    if (!(sheet.normal[i].norm() > 0))
      throw InvalidInput(where, "the normal of " + name + " is zero", "give a direction");
    box.add(sheet.point[i]);
  }
  if (count == 1) // a plane
    return level_set_of(PlaneCut{sheet.normal[0], sheet.normal[0].dot(sheet.point[0])}, where);
  std::vector<Vec3d> center;
  std::vector<double> value;
  for (std::size_t i = 0; i < count; ++i) {
    double nearest = box.diagonal();
    for (std::size_t j = 0; j < count; ++j)
      if (j != i) nearest = std::min(nearest, (sheet.point[j] - sheet.point[i]).norm());
    if (!(nearest > 1e-9 * box.diagonal()))
      throw InvalidInput(where, "point " + std::to_string(i) + " is given twice", "leave it out");
    const double beside = 0.4 * nearest; // other points are farther from it than from this one
    for (const double side : {0.0, -1.0, 1.0}) {
      center.push_back(sheet.point[i] + side * beside * sheet.normal[i].normalized());
      value.push_back(side * beside);
    }
  }
  return std::make_unique<Sheet>(RadialBasis::fit(center, value, {.kernel = Kernel::triharmonic}));
}

std::unique_ptr<LevelSet> shared_by(std::vector<std::unique_ptr<LevelSet>> parts) {
  return std::make_unique<Shared>(std::move(parts));
}

std::unique_ptr<LevelSet> level_set_of(const LevelSetShape& shape, const std::string& where) {
  static constexpr std::array<const char*, std::variant_size_v<LevelSetShape>> name = {"plane", "sphere",   "stroke",
                                                                                       "box",   "cylinder", "sheet"};
  return std::visit([&](const auto& one) { return level_set_of(one, where + "/" + name[shape.index()]); }, shape);
}

} // namespace pith
