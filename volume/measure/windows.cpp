#include "volume/measure/windows.h"

#include "volume/measure/sighting.h"

#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cmath>

namespace pith {

namespace {

constexpr std::uint64_t stage = 0x77696e; // of random numbers

struct TextureFrame {
  Mat3d axes = Mat3d::Identity();
  double scale = 1;
};

/// The field's frame at a tet, or that of what is seen at the point.
std::optional<TextureFrame> frame_at(const Model& model, const LayerReader& reader, const VolumePoint& point) {
  if (!model.field.axes.empty() && !model.field.scale.empty())
    return TextureFrame{model.field.axes[point.tet], model.field.scale[point.tet]};
  Sighting sighting;
  look_at(reader, point.tet, point.barycentric, sighting);
  const SeenLookup* top = sighting.dominant();
  if (!top) return std::nullopt;
  SimplexPoint at;
  at.gradient = barycentric_gradients(model.mesh, point.tet);
  const Mat3d jacobian = jacobian_of(*reader.layer, *top->lookup, at).topRows<3>();
  const double determinant = jacobian.determinant();
  if (!(std::abs(determinant) > 1e-12)) return std::nullopt;
  const Mat3d inverse = jacobian.inverse(); // columns: mm per texture width along each axis
  TextureFrame frame;
  frame.scale = std::cbrt(1 / std::abs(determinant));
  const Vec3d s = inverse.col(1).normalized(), t = (inverse.col(2) - inverse.col(2).dot(s) * s).normalized();
  frame.axes << s.cross(t), s, t;
  if (determinant < 0) frame.axes.col(0) *= -1;
  return frame;
}

/// The window's right and down in texture space.
std::pair<Vec3d, Vec3d> directions_of(SliceClass slice_class, Random& random) {
  switch (slice_class) {
  case SliceClass::across_r:
    return {Vec3d::UnitZ(), Vec3d::UnitY()};
  case SliceClass::across_s:
    return {Vec3d::UnitX(), Vec3d::UnitZ()};
  case SliceClass::across_t:
    return {Vec3d::UnitX(), Vec3d::UnitY()};
  case SliceClass::oblique:
    break;
  }
  const auto direction = [&] {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Vec3d(x, y, z);
  };
  const Vec3d a = direction().normalized(), b = direction();
  return {a, (b - b.dot(a) * a).normalized()};
}

/// How far two frames are turned against each other, radians.
double turn_between(const Mat3d& a, const Mat3d& b) {
  return std::acos(std::clamp(0.5 * ((a.transpose() * b).trace() - 1), -1.0, 1.0));
}

} // namespace

bool varies_with_depth(const Model& model, const Layer& layer) {
  if (model.field.depth.empty() || layer.width < 2 || layer.lookup.empty()) return false;
  std::size_t asked = 0, agree = 0;
  for (const TetId t : all_ids<TetId>(model.mesh.tet_count())) {
    const auto row = lookups_of(layer, t);
    if (row.empty()) continue;
    const AxisMap& frame = layer.patch[row.front().patch].frame;
    for (int k = 0; k < 4; ++k) {
      const float w = layer.corner[std::size_t(row.front().corner[k]) * (layer.width + 1) + 1];
      const float u = layer.evaluation.scale[1] * (frame.scale[1] * w + frame.offset[1]) + layer.evaluation.offset[1];
      ++asked;
      agree += std::abs(u - model.field.depth[model.mesh.corner[t][k]]) < 1e-3f;
    }
  }
  return asked > 0 && 10 * agree >= 9 * asked;
}

WindowSets windows_of(const Root& root, const Layer& layer, SliceClass slice_class, const WindowOptions& options,
                      const Progress& progress) {
  const Model& model = root.model();
  const Exemplar& exemplar = layer.exemplar.front();
  const ExemplarSlicer slicer(exemplar);
  const LayerReader reader(layer, false);
  WindowSets sets;
  sets.depth_varying = varies_with_depth(model, layer);
  for (int k = 2; k >= 0; --k)
    if (exemplar.wrap[k] == Wrap::repeat && !(k == 1 && sets.depth_varying)) sets.split_axis = k;

  const VolumePoints source(model.mesh, layer.region, options.takes);
  if (!(source.volume() > 0)) return sets;
  struct Window {
    bool valid = false;
    SliceGrid model, exemplar, first, second;
    TextureFrame frame;
  };
  std::vector<Window> window(options.windows);
  parallel_for(window.size(), 4, [&](std::size_t i) {
    const std::uint64_t key = hash_of(options.seed, stage, static_cast<int>(slice_class));
    Random random(key, i);
    const VolumePoint point = source.point(key, i);
    const std::optional<TextureFrame> frame = frame_at(model, reader, point);
    if (!frame || !(frame->scale > 0)) return;
    const auto [right, down] = directions_of(slice_class, random);
    double extent = options.extent;
    if (options.largest_mm > 0) extent = std::min(extent, options.largest_mm / frame->scale);
    const double step = extent / options.pixels;

    Sighting sighting;
    look_at(reader, point.tet, point.barycentric, sighting);
    const SeenLookup* top = sighting.dominant();
    Vec3d center[3]; // whole, first half, second half
    for (int k = 0; k < 3; ++k) {
      const bool depth = k == 1 && sets.depth_varying;
      double fixed = 0;
      if (depth)
        for (int c = 0; c < 4; ++c)
          fixed += point.barycentric[c] * model.field.depth[model.mesh.corner[point.tet][c]];
      else if (exemplar.wrap[k] != Wrap::repeat)
        fixed = top ? std::clamp(double(top->source[k]), 0.0, 1.0) : random.uniform();
      const bool free = !depth && exemplar.wrap[k] == Wrap::repeat;
      const double reach =
          std::min(0.25, 0.5 * (options.pixels - 1) * step * (std::abs(right[k]) + std::abs(down[k])));
      for (int set = 0; set < 3; ++set) {
        const double u = random.uniform();
        if (!free) {
          center[set][k] = fixed;
        } else if (set > 0 && k == sets.split_axis) {
          center[set][k] = 0.5 * (set - 1) + reach + u * (0.5 - 2 * reach);
        } else {
          center[set][k] = u;
        }
      }
    }
    Window& w = window[i];
    w.valid = true;
    w.frame = *frame;
    const int n = options.pixels;
    w.model = centered_grid(point.position, step * frame->scale * (frame->axes * right),
                            step * frame->scale * (frame->axes * down), n, n);
    w.exemplar = centered_grid(center[0], step * right, step * down, n, n);
    w.first = centered_grid(center[1], step * right, step * down, n, n);
    w.second = centered_grid(center[2], step * right, step * down, n, n);
  });
  std::erase_if(window, [](const Window& w) { return !w.valid; });

  std::vector<SliceGrid> grids;
  for (const Window& w : window) grids.push_back(w.model);
  sets.model = model_slices(root, grids, {.region = layer.region, .footprint = 0, .sources = true}, progress);
  const std::size_t count = window.size();
  sets.exemplar.resize(count);
  if (sets.split_axis >= 0) sets.first_half.resize(count), sets.second_half.resize(count);
  const auto own = static_cast<std::uint32_t>(&layer - model.layer.data());
  std::vector<std::size_t> left(count);
  parallel_for(count, 4, [&](std::size_t i) {
    const int depth_axis = sets.depth_varying ? 1 : -1;
    Slice& shown = sets.model[i];
    sets.exemplar[i] = slicer.slice(window[i].exemplar, depth_axis);
    if (sets.split_axis >= 0) {
      sets.first_half[i] = slicer.slice(window[i].first, depth_axis);
      sets.second_half[i] = slicer.slice(window[i].second, depth_axis);
    }
    const bool turns =
        std::isfinite(options.turn_tolerance) && !model.field.axes.empty() && !model.field.scale.empty();
    for (std::size_t p = 0; p < shown.inside.size(); ++p) {
      bool keep = shown.inside[p] && sets.exemplar[i].inside[p];
      const PixelSource& source = shown.source[p];
      keep &= (source.layer == own && source.over <= 1 / 255.0f) || source.layer == PixelSource::none;
      if (keep && sets.depth_varying)
        keep = std::abs(shown.depth[p] - sets.exemplar[i].depth[p]) <= options.depth_tolerance;
      if (keep && turns) {
        const TetId t = shown.source[p].tet;
        const double ratio = model.field.scale[t] / window[i].frame.scale;
        keep = turn_between(model.field.axes[t], window[i].frame.axes) <= options.turn_tolerance &&
               ratio <= options.scale_tolerance && ratio * options.scale_tolerance >= 1;
      }
      for (auto* set : {&sets.model, &sets.exemplar, &sets.first_half, &sets.second_half})
        if (!set->empty()) (*set)[i].inside[p] = keep;
      left[i] += keep;
      if (!sets.depth_varying) shown.depth[p] = 0; // one band
    }
  });
  for (std::size_t i = 0; i < count; ++i) {
    sets.pixels += sets.model[i].inside.size();
    sets.pixels_left += left[i];
  }
  return sets;
}

} // namespace pith
