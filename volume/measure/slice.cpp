#include "volume/measure/slice.h"

#include "volume/base/error.h"
#include "volume/layer/tables.h"
#include "volume/measure/sighting.h"

#include <cmath>

namespace pith {

SliceGrid centered_grid(const Vec3d& center, const Vec3d& right, const Vec3d& down, int width, int height) {
  return {center - 0.5 * (width - 1) * right - 0.5 * (height - 1) * down, right, down, width, height};
}

SliceGrid framed_grid(const Box& box, const Vec3d& normal, double offset, double pitch) {
  const double length = normal.norm();
  if (!(length > 0) || !std::isfinite(length))
    throw InvalidInput("slice", "the plane's normal has no length", "give a direction");
  if (!(pitch > 0)) throw InvalidInput("slice", "the pitch is not positive", "give mm per pixel");
  const Vec3d n = normal / length;
  int most = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(n[k]) > std::abs(n[most])) most = k;
  // Looking along the normal's strongest axis: x right before y, and downwards the other one, reversed.
  const int across = most == 0 ? 1 : 0, along = most == 2 ? 1 : 2;
  Vec3d right = Vec3d::Unit(across);
  right = (right - right.dot(n) * n).normalized();
  Vec3d down = n.cross(right);
  if (down[along] > 0) down = -down;

  const Vec3d middle = box.center(), on_plane = middle + (offset / length - n.dot(middle)) * n;
  double half_width = 0, half_height = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3d corner(i & 1 ? box.high.x() : box.low.x(), i & 2 ? box.high.y() : box.low.y(),
                       i & 4 ? box.high.z() : box.low.z());
    half_width = std::max(half_width, std::abs((corner - on_plane).dot(right)));
    half_height = std::max(half_height, std::abs((corner - on_plane).dot(down)));
  }
  const double width = std::ceil(2 * half_width / pitch), height = std::ceil(2 * half_height / pitch);
  if (!(width * height <= 1e8))
    throw InvalidInput("slice", "would have " + std::to_string(width * height) + " pixels", "give a larger pitch");
  return centered_grid(on_plane, pitch * right, pitch * down, std::max(1, int(width)), std::max(1, int(height)));
}

namespace {

Slice empty_slice(const SliceGrid& grid, bool sources) {
  Slice slice;
  slice.color = Image(grid.width, grid.height, 3);
  const std::size_t pixels = std::size_t(grid.width) * grid.height;
  slice.inside.assign(pixels, 0);
  slice.depth.assign(pixels, 0);
  if (sources) slice.source.resize(pixels);
  return slice;
}

int color_of(const Root& root) {
  int component = 0;
  for (const Channel& c : root.channels()) {
    if (c.semantic == Semantic::color && c.components == 3) return component;
    component += c.components;
  }
  throw InvalidInput("model '" + root.model().name + "'", "has no colour", "give a layer a colour channel");
}

PixelSource source_at(const Root& root, const Location& location, std::int32_t region, Sighting& sighting) {
  PixelSource source;
  source.tet = location.tet;
  for (std::size_t l = root.tables().layers.size(); l-- > 0;) {
    const LayerReader& reader = root.tables().layers[l].reader;
    const Layer& layer = *reader.layer;
    if (layer.domain != Domain::solid || (layer.region >= 0 && layer.region != region)) continue;
    look_at(reader, location.tet, location.barycentric, sighting);
    const SeenLookup* top = sighting.dominant();
    if (!top || sighting.coverage < 0.5f) {
      source.over += (1 - source.over) * sighting.coverage;
      continue;
    }
    source.layer = static_cast<std::uint32_t>(l);
    source.patch = top->lookup->patch;
    source.share = top->share / sighting.coverage;
    for (int k = 0; k < 3; ++k) source.coordinate[k] = top->source[k];
    break;
  }
  return source;
}

void fill_row(const Root& root, const SliceGrid& grid, const SliceOptions& options, int component, int y,
              Slice& slice) {
  const Model& model = root.model();
  Sighting sighting;
  TetId hint;
  for (int x = 0; x < grid.width; ++x) {
    const Vec3d position = grid.at(x, y);
    const Location location = root.locator().locate(position, options.region, hint);
    if (!location.inside) continue;
    hint = location.tet;
    const std::int32_t region = model.mesh.region[location.tet];
    const std::size_t i = slice.index(x, y);
    slice.inside[i] = 1;
    const Material material = material_at(root, {.position = position, .region = region, .facet = {}, .hint = hint},
                                          location, options.footprint);
    for (int c = 0; c < 3; ++c) slice.color.at(x, y)[c] = material.value[component + c];
    if (!model.field.depth.empty())
      for (int k = 0; k < 4; ++k)
        slice.depth[i] +=
            static_cast<float>(location.barycentric[k]) * model.field.depth[model.mesh.corner[location.tet][k]];
    if (options.sources) slice.source[i] = source_at(root, location, region, sighting);
  }
}

} // namespace

Slice model_slice(const Root& root, const SliceGrid& grid, const SliceOptions& options) {
  const int component = color_of(root);
  Slice slice = empty_slice(grid, options.sources);
  parallel_for(grid.height, 4, [&](std::size_t y) { fill_row(root, grid, options, component, int(y), slice); });
  return slice;
}

std::vector<Slice> model_slices(const Root& root, const std::vector<SliceGrid>& grids, const SliceOptions& options,
                                const Progress& progress) {
  const int component = color_of(root);
  std::vector<Slice> slices(grids.size());
  SharedProgress finished(progress, grids.size());
  parallel_for(grids.size(), 1, [&](std::size_t i) {
    slices[i] = empty_slice(grids[i], options.sources);
    for (int y = 0; y < grids[i].height; ++y) fill_row(root, grids[i], options, component, y, slices[i]);
    finished.add();
  });
  return slices;
}

ExemplarSlicer::ExemplarSlicer(const Exemplar& exemplar)
    : exemplar_(exemplar), grid_(texel_grid(exemplar, exemplar.texel, decode_table(exemplar))) {
  if (exemplar.axes != 3)
    throw InvalidInput("exemplar '" + exemplar.name + "'", "is no volume", "slices need one of 3 axes");
  for (const Channel& c : exemplar.channel) {
    if (c.semantic == Semantic::color && c.components == 3) return;
    color_ += c.components;
  }
  throw InvalidInput("exemplar '" + exemplar.name + "'", "has no colour", "give it a colour channel");
}

Vec3f ExemplarSlicer::color(const Vec3d& u) const {
  const Lanes at{float(u.x()), float(u.y()), float(u.z()), 0};
  std::array<float, max_components> value;
  sample(grid_, cell_at(grid_, at), value.data());
  return {value[color_], value[color_ + 1], value[color_ + 2]};
}

Slice ExemplarSlicer::slice(const SliceGrid& grid, int depth_axis) const {
  Slice slice = empty_slice(grid, false);
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const Vec3d u = grid.at(x, y);
      bool inside = true;
      for (int k = 0; k < 3; ++k)
        if (exemplar_.wrap[k] != Wrap::repeat) inside &= u[k] >= 0 && u[k] <= 1;
      if (!inside) continue;
      const std::size_t i = slice.index(x, y);
      slice.inside[i] = 1;
      const Vec3f c = color(u);
      for (int k = 0; k < 3; ++k) slice.color.at(x, y)[k] = c[k];
      if (depth_axis >= 0) slice.depth[i] = static_cast<float>(u[depth_axis]);
    }
  return slice;
}

} // namespace pith
