#include "volume/measure/distortion.h"

#include "volume/measure/sighting.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pith {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

double angle_between(const Vec3d& a, const Vec3d& b) { return degrees * std::atan2(a.cross(b).norm(), a.dot(b)); }

/// What one look-up on one tet comes to.
struct Entry {
  double volume = 0; ///< mm³ in which it is seen
  bool regular = true, inverted = false;
  std::array<double, 3> angle{}, scale{};
  double departure = 0, dirichlet = 0, right_angle = 0, size = 0;
};

Entry entry_of(const Mat3d& jacobian, const Mat3d& frame, double scale) {
  Entry e;
  const Mat3d a = scale * jacobian * frame;
  const double determinant = a.determinant();
  e.inverted = !(determinant > 0);
  for (int k = 0; k < 3; ++k) {
    const Vec3d row = a.row(k);
    e.angle[k] = angle_between(row, Vec3d::Unit(k));
    e.scale[k] = std::abs(std::log2(row.norm()));
    e.right_angle = std::max(e.right_angle, std::abs(90 - angle_between(row, Vec3d(a.row((k + 1) % 3)))));
  }
  e.departure = (a - Mat3d::Identity()).norm();
  e.size = std::abs(std::log2(std::abs(determinant)));
  e.dirichlet = (a.squaredNorm() + (determinant != 0 ? a.inverse().squaredNorm() : INFINITY)) / 6;
  return e;
}

/// A quadrature of four points that is exact for quadratic functions on a tet.
constexpr double near_corner = 0.5854101966249685, far_corner = 0.1381966011250105;

} // namespace

std::optional<DistortionMeasure> distortion_measure(const Model& model, const Layer& layer) {
  const TetMesh& mesh = model.mesh;
  if (model.field.axes.empty() || model.field.scale.empty() || layer.domain != Domain::solid || layer.width != 3)
    return std::nullopt;

  const LayerReader reader(layer, false);
  std::vector<Entry> entry(layer.lookup.size());
  std::vector<double> filled(mesh.tet_count()), filled_singular(mesh.tet_count()), inverted_seen(mesh.tet_count());
  std::vector<std::uint8_t> singular(mesh.tet_count()), inverted(mesh.tet_count());
  parallel_for(mesh.tet_count(), 512, [&](std::size_t i) {
    const TetId t(i);
    const std::span<const Lookup> row = lookups_of(layer, t);
    if (row.empty() || (layer.region >= 0 && mesh.region[t] != layer.region)) return;
    const std::size_t first = row.data() - layer.lookup.data();
    SimplexPoint point;
    point.gradient = barycentric_gradients(mesh, t);
    const double volume = signed_volume(mesh, t), scale = model.field.scale[t];
    singular[i] = !model.field.singular.empty() && model.field.singular[t];
    for (std::size_t k = 0; k < row.size(); ++k) {
      const Mat3d jacobian = jacobian_of(layer, row[k], point).topRows<3>();
      entry[first + k] = entry_of(jacobian, model.field.axes[t], scale);
      entry[first + k].regular = !singular[i];
      inverted[i] |= entry[first + k].inverted;
    }
    filled[i] = volume;
    if (singular[i]) filled_singular[i] = volume;
    Sighting sighting;
    for (int corner = 0; corner < 4; ++corner) {
      std::array<double, 4> b;
      b.fill(far_corner);
      b[corner] = near_corner;
      look_at(reader, t, b, sighting);
      for (const SeenLookup& s : sighting.seen) {
        Entry& e = entry[s.lookup - layer.lookup.data()];
        e.volume += 0.25 * volume * s.share;
        if (e.inverted) inverted_seen[i] += 0.25 * volume * s.share;
      }
    }
  });

  DistortionMeasure measure;
  std::array<WeightedQuantiles, 3> angle, scale;
  WeightedQuantiles departure, dirichlet, right_angle, size;
  for (const Entry& e : entry) {
    measure.inverted += e.inverted;
    measure.inverted_regular += e.inverted && e.regular;
    if (!e.regular || !(e.volume > 0)) continue;
    ++measure.lookups;
    for (int k = 0; k < 3; ++k) {
      angle[k].add(e.angle[k], e.volume);
      scale[k].add(e.scale[k], e.volume);
    }
    departure.add(e.departure, e.volume);
    dirichlet.add(e.dirichlet, e.volume);
    right_angle.add(e.right_angle, e.volume);
    size.add(e.size, e.volume);
  }
  for (int k = 0; k < 3; ++k) {
    measure.axis_angle[k] = spread_of(angle[k]);
    measure.axis_scale[k] = spread_of(scale[k]);
  }
  measure.departure = spread_of(departure);
  measure.symmetric_dirichlet = spread_of(dirichlet);
  measure.angle = spread_of(right_angle);
  measure.volume = spread_of(size);
  double all = 0, lost = 0, wrong = 0;
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    all += filled[t], lost += filled_singular[t], wrong += inverted_seen[t];
    measure.singular_tets += singular[t];
  }
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (inverted[t]) {
      measure.first_inverted = barycenter(mesh, t);
      break;
    }
  if (all > 0) measure.inverted_seen_share = wrong / all, measure.singular_share = lost / all;
  return measure;
}

} // namespace pith
