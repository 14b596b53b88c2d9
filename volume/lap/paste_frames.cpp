#include "volume/lap/paste_frames.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace pith {

namespace {

/// All rotations equally likely (Shoemake: Uniform random rotations, Graphics Gems III, 1992).
Mat3d random_rotation(Random& random) {
  const double u = random.uniform(), a = 2 * std::numbers::pi * random.uniform(),
               b = 2 * std::numbers::pi * random.uniform();
  const double p = std::sqrt(1 - u), q = std::sqrt(u);
  return Eigen::Quaterniond(q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b)).toRotationMatrix();
}

/// The smallest turn that takes the unit vector a to the unit vector b, applied to a frame.
Mat3d turned(const Mat3d& frame, const Vec3d& a, const Vec3d& b) {
  const double c = a.dot(b);
  if (c < -1 + 1e-9) { // half a turn around any axis across a
    int least = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(a[k]) < std::abs(a[least])) least = k;
    const Vec3d n = a.cross(Vec3d::Unit(least)).normalized();
    return 2 * n * (n.transpose() * frame) - frame;
  }
  const Vec3d v = a.cross(b);
  Mat3d result = c * frame;
  for (int k = 0; k < 3; ++k) result.col(k) += v.cross(frame.col(k)) + v * (v.dot(frame.col(k)) / (1 + c));
  return result;
}

/// R and T turned over: half a turn around S.
Mat3d turned_over(const Mat3d& frame) {
  Mat3d over = frame;
  over.col(0) = -frame.col(0);
  over.col(2) = -frame.col(2);
  return over;
}

} // namespace

Mat3d seed_frame(const FrameSource& source, std::uint32_t seed, Random& random) {
  if (source.fixed_axes == 0) return random_rotation(random);
  const Mat3d& frame = source.axes[seed];
  if (source.fixed_axes != 1) return frame;
  const double angle = 2 * std::numbers::pi * random.uniform();
  return Eigen::AngleAxisd(angle, frame.col(source.fixed_axis)).toRotationMatrix() * frame;
}

Mat3d PasteFrames::at(std::uint32_t simplex) const {
  if (source_.fixed_axes == 0) return seed_;
  const Mat3d& frame = source_.axes[simplex];
  if (source_.fixed_axes == 1) {
    const Vec3d from = seed_.col(source_.fixed_axis), to = frame.col(source_.fixed_axis);
    return turned(seed_, from, source_.unsigned_axis && from.dot(to) < 0 ? Vec3d(-to) : to);
  }
  return source_.unsigned_axis && frame.col(0).dot(seed_.col(0)) + frame.col(2).dot(seed_.col(2)) < 0
             ? turned_over(frame)
             : frame;
}

double PasteFrames::cosine(std::uint32_t simplex) const {
  if (source_.fixed_axes == 0) return 1;
  const Mat3d& frame = source_.axes[simplex];
  if (source_.fixed_axes == 1) {
    const double c = seed_.col(source_.fixed_axis).dot(frame.col(source_.fixed_axis));
    return source_.unsigned_axis ? std::abs(c) : c;
  }
  // The angle between two frames is that of the rotation between them: trace = 1 + 2 cos.
  const double across = frame.col(0).dot(seed_.col(0)) + frame.col(2).dot(seed_.col(2)),
               s = frame.col(1).dot(seed_.col(1));
  return ((source_.unsigned_axis ? std::abs(across) : across) + s - 1) / 2;
}

} // namespace pith
