#include "volume/measure/slice_metric.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pith {

SliceMetric slice_metric(const WindowSets& sets, const SliceMetricOptions& options) {
  SliceMetric metric;
  metric.windows = sets.model.size();
  if (sets.pixels > 0) metric.pixels_left = static_cast<double>(sets.pixels_left) / static_cast<double>(sets.pixels);
  TextureDistanceOptions distance = options.distance;
  if (!sets.depth_varying) distance.bands = 1;
  metric.distance = texture_distance(sets.model, sets.exemplar, distance);
  if (sets.split_axis < 0) return metric;
  metric.self = texture_distance(sets.first_half, sets.second_half, distance);
  metric.relative = relative_to(metric.distance, metric.self);
  return metric;
}

SliceMetric slice_metric(const Root& root, const Layer& layer, SliceClass slice_class,
                         const SliceMetricOptions& options, const Progress& progress) {
  return slice_metric(windows_of(root, layer, slice_class, options.window, progress), options);
}

namespace {

double distance_to(const std::vector<Vec3d>& line, const Vec3d& x) {
  double least = (x - line.front()).squaredNorm();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec3d along = line[i + 1] - line[i];
    const double squared = along.squaredNorm();
    const double t = squared > 0 ? std::clamp((x - line[i]).dot(along) / squared, 0.0, 1.0) : 0;
    least = std::min(least, (x - line[i] - t * along).squaredNorm());
  }
  return std::sqrt(least);
}

void append(std::vector<Slice>& to, std::vector<Slice>&& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// All classes in one.
WindowSets all_windows(const Root& root, const Layer& layer, const WindowOptions& options) {
  WindowSets all;
  for (const SliceClass c : slice_classes) {
    WindowSets sets = windows_of(root, layer, c, options);
    append(all.model, std::move(sets.model));
    append(all.exemplar, std::move(sets.exemplar));
    append(all.first_half, std::move(sets.first_half));
    append(all.second_half, std::move(sets.second_half));
    all.split_axis = sets.split_axis;
    all.depth_varying = sets.depth_varying;
    all.pixels += sets.pixels;
    all.pixels_left += sets.pixels_left;
  }
  return all;
}

} // namespace

std::optional<NearAxisMeasure> near_axis_measure(const Root& root, const Layer& layer, const std::vector<Vec3d>& axis,
                                                 const SliceMetricOptions& options, double part) {
  if (axis.empty()) return std::nullopt;
  const TetMesh& mesh = root.model().mesh;
  Box box;
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (layer.region < 0 || mesh.region[t] == layer.region)
      for (const VertexId v : mesh.corner[t]) box.add(mesh.position[v]);
  if (box.empty()) return std::nullopt;
  NearAxisMeasure measure;
  measure.reach = part * box.extent().maxCoeff();
  const auto is_near = [&](TetId t) { return distance_to(axis, barycenter(mesh, t)) <= measure.reach; };

  WindowOptions window = options.window;
  window.windows = std::max(1, window.windows / 2); // of each class, near and elsewhere: as much work as two classes
  window.largest_mm = 2 * measure.reach;
  window.turn_tolerance = window.scale_tolerance = std::numeric_limits<double>::infinity();
  window.takes = is_near;
  const WindowSets near = all_windows(root, layer, window);
  window.takes = [&](TetId t) { return !is_near(t); };
  const WindowSets elsewhere = all_windows(root, layer, window);
  measure.near = slice_metric(near, options);
  measure.elsewhere = slice_metric(elsewhere, options);
  if (measure.near.distance.patches == 0 || measure.elsewhere.distance.patches == 0 || near.split_axis < 0)
    return std::nullopt;
  measure.ratio = relative_to(measure.near.relative, measure.elsewhere.relative);
  return measure;
}

} // namespace pith
