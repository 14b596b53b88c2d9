// Axes from strokes: Takayama 2008, §5.2.2.
//
// The paper smooths each component of the vectors. Departures: a stroke's sample constrains the tet that contains it,
// not the one with the nearest barycentre; axes without a sign are smoothed as traceless symmetric tensors
// t tᵀ − I/3, for which t and −t are one (as directions are in diffusion tensor fields), and the axis is read back as
// their principal direction.
#include "volume/field/axis_field.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/scale_hint.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace pith {
namespace {

constexpr int samples_per_stroke = 40;

/// Tangents of the strokes at even samples, as constraints of the tets that hold them (Eq. 2).
std::vector<FieldConstraint> tangents_of(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                                         std::span<const AxisStroke> strokes, const std::string& where,
                                         double margin) {
  if (strokes.empty())
    throw InvalidInput(where, "there is no stroke", "draw at least one along the texture's T axis");
  std::vector<FieldConstraint> constraints;
  for (std::size_t s = 0; s < strokes.size(); ++s) {
    const std::vector<Vec3d>& point = strokes[s].point;
    const std::string name = where + "/" + std::to_string(s);
    for (const Vec3d& p : point)
      if (!p.allFinite()) throw InvalidInput(name, "a stroke point is not finite", "give finite coordinates");
    const double length = length_of(point);
    if (!(length > 0))
      throw InvalidInput(name, "a stroke of " + std::to_string(point.size()) + " points has no length",
                         "give at least two distinct points");
    for (const LocatedSample& one :
         located_samples(mesh, locator, region, point, length / samples_per_stroke, margin))
      constraints.push_back({one.location.tet, one.location.barycentric, one.sample.tangent});
  }
  if (constraints.empty())
    throw InvalidInput(
        where, "none of its " + std::to_string(strokes.size()) + " strokes touches region " + std::to_string(region),
        scale_hint(mesh, strokes.front().point, "draw one on or inside the region, in the mesh's millimetres"));
  return constraints;
}

/// Per tet the mean of its corners' unit vectors.
void read_signed(const TetMesh& mesh, std::int32_t region, const std::vector<FieldConstraint>& tangents,
                 std::span<const Vec3d> normal, const AxisFieldOptions& options, AxisField& field) {
  PerVertex<Vec3d> axis = smooth_vectors(mesh, region, tangents, options.smoothing, &field.smoothing);
  for (Vec3d& v : axis) {
    const double length = v.norm();
    v = length > 1e-12 ? Vec3d(v / length) : Vec3d::Zero();
  }
  parallel_for(mesh.tet_count(), 1024, [&](std::size_t i) {
    const TetId t(i);
    if (mesh.region[t] != region) return;
    Vec3d mean = Vec3d::Zero();
    for (const VertexId v : mesh.corner[t]) mean += axis[v];
    mean *= 0.25;
    const double length = mean.norm();
    field.agreement[t] = static_cast<float>(length);
    Vec3d along = length < 1e-6 ? Vec3d(Vec3d::Zero()) : Vec3d(mean / length);
    if (!normal.empty()) {
      along -= along.dot(normal[i]) * normal[i];
      const double sine = along.norm();
      field.sine[t] = static_cast<float>(sine);
      along = sine > 1e-9 ? Vec3d(along / sine) : Vec3d::Zero();
    }
    field.direction[t] = along;
  });
}

/// The principal direction of a symmetric tensor across a unit vector n, and the gap between its two eigenvalues
/// there: for t tᵀ the square of the sine between t and n.
Vec3d principal_across(const Mat3d& tensor, const Vec3d& n, double& gap) {
  const Vec3d u = perpendicular_to(n), v = n.cross(u);
  const double a = u.dot(tensor * u), b = u.dot(tensor * v), c = v.dot(tensor * v);
  gap = std::hypot(a - c, 2 * b);
  const double angle = 0.5 * std::atan2(2 * b, a - c);
  return std::cos(angle) * u + std::sin(angle) * v;
}

/// Per tet the principal direction of the mean of its corners' tensors.
void read_unsigned(const TetMesh& mesh, std::int32_t region, const std::vector<FieldConstraint>& tangents,
                   std::span<const Vec3d> normal, const AxisFieldOptions& options, AxisField& field) {
  std::vector<FieldConstraint> diagonal = tangents, mixed = tangents;
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    const Vec3d& t = tangents[i].value;
    diagonal[i].value = t.cwiseProduct(t) - Vec3d::Constant(1.0 / 3);
    mixed[i].value = {t.x() * t.y(), t.x() * t.z(), t.y() * t.z()};
  }
  SmoothReport second;
  PerVertex<Vec3d> d = smooth_vectors(mesh, region, diagonal, options.smoothing, &field.smoothing);
  PerVertex<Vec3d> m = smooth_vectors(mesh, region, mixed, options.smoothing, &second);
  field.smoothing.iterations += second.iterations;
  field.smoothing.residual = std::max(field.smoothing.residual, second.residual);
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count())) {
    // Of the length that t tᵀ − I/3 has.
    const double length = std::sqrt((d[v].squaredNorm() + 2 * m[v].squaredNorm()) * 1.5);
    const double scale = length > 1e-12 ? 1 / length : 0;
    d[v] *= scale;
    m[v] *= scale;
  }
  parallel_for(mesh.tet_count(), 1024, [&](std::size_t i) {
    const TetId t(i);
    if (mesh.region[t] != region) return;
    Vec3d a = Vec3d::Zero(), b = Vec3d::Zero();
    for (const VertexId v : mesh.corner[t]) {
      a += 0.25 * d[v];
      b += 0.25 * m[v];
    }
    Mat3d tensor;
    tensor << a.x(), b.x(), b.y(), b.x(), a.y(), b.z(), b.y(), b.z(), a.z();
    const Eigen::SelfAdjointEigenSolver<Mat3d> eigen(tensor);
    const Vec3d values = eigen.eigenvalues(); // ascending
    field.agreement[t] = static_cast<float>(values[2] - values[1]);
    Vec3d along = values[2] - values[1] < 1e-6 ? Vec3d(Vec3d::Zero()) : Vec3d(eigen.eigenvectors().col(2));
    if (!normal.empty()) {
      double gap = 0;
      along = principal_across(tensor, normal[i], gap);
      field.sine[t] = static_cast<float>(std::sqrt(std::min(gap, 1.0)));
      if (!(gap > 1e-12)) along.setZero();
      // Across the normal two eigenvalues are left, and their gap says how sure the axis is there.
      field.agreement[t] = static_cast<float>(std::max<double>(field.agreement[t], gap));
    }
    field.direction[t] = along;
  });
}

/// Turns directions over so that neighbours agree: breadth first from the lowest tet of each connected part.
void make_signs_agree(const TetMesh& mesh, std::int32_t region, const std::vector<FieldConstraint>& tangents,
                      PerTet<Vec3d>& direction) {
  PerTet<std::uint8_t> done(mesh.tet_count(), 0);
  std::vector<TetId> queue;
  for (const TetId start : all_ids<TetId>(mesh.tet_count())) {
    if (mesh.region[start] != region || done[start]) continue;
    queue.assign(1, start);
    done[start] = 1;
    for (std::size_t at = 0; at < queue.size(); ++at)
      for (const TetId next : mesh.neighbor[queue[at]]) {
        if (!next.exists() || mesh.region[next] != region || done[next]) continue;
        if (direction[next].dot(direction[queue[at]]) < 0) direction[next] = -direction[next];
        done[next] = 1;
        queue.push_back(next);
      }
  }
  double with = 0;
  for (const FieldConstraint& c : tangents) with += direction[c.tet].dot(c.value);
  if (with < 0)
    for (Vec3d& d : direction) d = -d;
}

} // namespace

Vec3d perpendicular_to(const Vec3d& s) {
  int least = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(s[k]) < std::abs(s[least])) least = k;
  return (Vec3d::Unit(least) - s[least] * s).normalized();
}

std::vector<LocatedSample> located_samples(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                                           std::span<const Vec3d> polyline, double spacing, double margin) {
  std::vector<LocatedSample> result;
  TetId hint;
  for (const PolylineSample& sample : evenly_sampled(polyline, spacing)) {
    const Location location = locator.locate(sample.point, region, hint);
    if (!location.tet.exists()) continue;
    Vec3d held = Vec3d::Zero();
    for (int k = 0; k < 4; ++k) held += location.barycentric[k] * mesh.position[mesh.corner[location.tet][k]];
    if (!location.inside && (held - sample.point).norm() > margin) continue;
    hint = location.tet;
    result.push_back({location, sample});
  }
  return result;
}

AxisField axis_field(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                     std::span<const AxisStroke> strokes, std::span<const Vec3d> normal, const std::string& where,
                     const AxisFieldOptions& options) {
  const std::vector<FieldConstraint> tangents = tangents_of(mesh, locator, region, strokes, where, options.margin);
  AxisField field;
  field.direction.assign(mesh.tet_count(), Vec3d::Zero());
  field.sine.assign(mesh.tet_count(), 1.0f);
  field.agreement.assign(mesh.tet_count(), 0.0f);
  if (options.unsigned_axis) {
    read_unsigned(mesh, region, tangents, normal, options, field);
    make_signs_agree(mesh, region, tangents, field.direction);
  } else {
    read_signed(mesh, region, tangents, normal, options, field);
  }
  return field;
}

} // namespace pith
