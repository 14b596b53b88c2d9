#include "volume/layer/composite.h"
#include "volume/layer/tables.h"

#include <algorithm>
#include <cmath>

namespace pith {

std::span<const Lookup> lookups_of(const Layer& layer, std::uint32_t simplex) {
  std::size_t row = simplex;
  if (!layer.simplex.empty()) {
    const auto at = std::lower_bound(layer.simplex.begin(), layer.simplex.end(), simplex);
    if (at == layer.simplex.end() || *at != simplex) return {};
    row = at - layer.simplex.begin();
  }
  return {layer.lookup.data() + layer.begin[row], layer.lookup.data() + layer.begin[row + 1]};
}

namespace {

/// The point of a facet nearest to x, with tangent gradients where they are needed.
SimplexPoint point_on_facet(const Model& model, FacetId facet, const Vec3d& x) {
  std::array<Vec3d, 3> p;
  for (int i = 0; i < 3; ++i) p[i] = model.mesh.position[model.boundary.corner[facet][i]];
  const NearestFacet nearest = closest_point(p, x);
  SimplexPoint point;
  for (int i = 0; i < 3; ++i) point.barycentric[i] = static_cast<float>(nearest.barycentric[i]);
  const Vec3d area = (p[1] - p[0]).cross(p[2] - p[0]);
  const double squared = area.squaredNorm();
  point.normal = area / std::sqrt(squared);
  for (int i = 0; i < 3; ++i) point.gradient[i] = area.cross(p[(i + 2) % 3] - p[(i + 1) % 3]) / squared;
  return point;
}

/// Asks the memory for where a simplex' row is; then for the uppermost look-ups of the row.
void prefetch_begin(const Root::Tables::LayerEntry& entry, std::uint32_t simplex) {
  __builtin_prefetch(entry.begin() + simplex);
}
void prefetch_row(const LayerReader& reader, std::span<const Lookup> row) {
  if (row.empty()) return;
  const std::size_t last = &row.back() - reader.layer->lookup.data();
  __builtin_prefetch(reader.patch_of.data() + last);
  for (std::size_t i = 0; i < std::min<std::size_t>(2, row.size()); ++i)
    __builtin_prefetch(reader.record.data() + (last - i) * reader.record_size);
}

Material& with_unit_directions(const Root::Tables& tables, Material& material) {
  for (int first : tables.directions) {
    float* d = material.value.data() + first;
    const float length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (length > 0)
      for (int k = 0; k < 3; ++k) d[k] /= length;
  }
  return material;
}

} // namespace

void materials_at(const Root& root, std::span<const MaterialPoint> points, std::span<Material> result,
                  double footprint) {
  const Root::Tables& tables = root.tables();
  const TetMesh& mesh = tables.model.mesh;
  const auto each_solid_layer = [&](const auto& visit) {
    for (const auto& entry : tables.layers)
      if (entry.reader.layer->domain == Domain::solid) visit(entry);
  };
  // Two steps ahead of the evaluation: where a tet's corners and look-ups are, then what they are.
  constexpr std::size_t far = 12, near = 6;
  for (std::size_t step = 0; step < points.size() + far; ++step) {
    const auto hint_of = [&](std::size_t delay) {
      const bool due = step >= delay && step - delay < points.size();
      return due && points[step - delay].hint < mesh.tet_count() ? points[step - delay].hint : TetId();
    };
    if (const TetId tet = hint_of(0); tet.exists()) {
      __builtin_prefetch(&mesh.corner[tet]);
      __builtin_prefetch(&mesh.region[tet]);
      each_solid_layer([&](const Root::Tables::LayerEntry& entry) { prefetch_begin(entry, tet); });
    }
    if (const TetId tet = hint_of(far - near); tet.exists()) {
      for (const VertexId v : mesh.corner[tet]) __builtin_prefetch(&mesh.position[v]);
      each_solid_layer([&](const Root::Tables::LayerEntry& entry) { prefetch_row(entry.reader, entry.row(tet)); });
    }
    if (step >= far) result[step - far] = material_at(root, points[step - far], footprint);
  }
}

Material material_at(const Root& root, const MaterialPoint& point, double footprint) {
  TetId hint = point.hint;
  if (!hint.exists() && point.facet.exists()) hint = root.model().boundary.tet[point.facet];
  return material_at(root, point, root.locator().locate(point.position, point.region, hint), footprint);
}

Material material_at(const Root& root, const MaterialPoint& point, const Location& location, double footprint) {
  const Root::Tables& tables = root.tables();
  const Model& model = tables.model;
  Material material;
  material.tet = location.tet;
  if (!location.tet.exists()) return material;
  const std::int32_t region = model.mesh.region[location.tet];

  std::array<float, max_components> covered{}; // per component: a layer need not have every channel
  float shown_through = 1;
  for (std::size_t i = tables.layers.size(); i-- > 0;) {
    const Root::Tables::LayerEntry& entry = tables.layers[i];
    const LayerReader& reader = entry.reader;
    const std::vector<int>& component = entry.component;
    const Layer& layer = *reader.layer;
    if (layer.region >= 0 && layer.region != region) continue;
    SimplexPoint at;
    std::span<const Lookup> lookups;
    if (layer.domain == Domain::solid) {
      lookups = entry.row(location.tet);
      if (lookups.empty()) continue;
      for (int k = 0; k < 4; ++k) at.barycentric[k] = static_cast<float>(location.barycentric[k]);
      if (needs_gradient(reader, footprint)) at.gradient = barycentric_gradients(model.mesh, location.tet);
    } else {
      if (!point.facet.exists()) continue;
      lookups = entry.row(point.facet);
      if (!lookups.empty()) at = point_on_facet(model, point.facet, point.position);
    }
    if (lookups.empty()) continue;
    at.footprint = footprint;
    const LayerValue value = composite(reader, lookups, at);
    material.lookups_read += static_cast<std::uint16_t>(value.lookups_read);
    if (value.coverage == 1 && shown_through == 1 && reader.components == tables.components) { // as is most often
      for (int c = 0; c < reader.components; ++c) material.value[component[c]] = value.value[c];
      material.coverage = 1;
      return with_unit_directions(tables, material);
    }
    for (int c = 0; c < reader.components; ++c) {
      float& below = covered[component[c]];
      material.value[component[c]] += (1 - below) * value.value[c];
      below += (1 - below) * value.coverage;
    }
    shown_through *= 1 - value.coverage;
    if (std::all_of(covered.begin(), covered.begin() + tables.components, [](float c) { return c >= 0.999f; })) break;
  }
  material.coverage = 1 - shown_through;
  for (int c = 0; c < tables.components; ++c)
    if (covered[c] > 0 && covered[c] != 1) material.value[c] /= covered[c];
  return with_unit_directions(tables, material);
}

} // namespace pith
