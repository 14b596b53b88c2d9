#include "volume/lap/affine_layer.h"

#include "volume/base/random.h"

namespace pith {

Layer affine_layer(const LapInput& input) {
  const TetMesh& mesh = input.mesh;
  Layer layer;
  layer.width = 3;
  layer.region = input.region;
  layer.patch.push_back({.exemplar = 0, .mask = Patch::no_mask, .frame = {}, .key = hash_of(0x2d, input.region)});
  constexpr std::uint32_t none = 0xffffffffu;
  std::vector<std::uint32_t> row(mesh.vertex_count(), none);
  layer.begin.reserve(mesh.tet_count() + 1);
  layer.begin.push_back(0);
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    if (mesh.region[t] == input.region) {
      Lookup lookup;
      for (int k = 0; k < 4; ++k) {
        const VertexId v = mesh.corner[t][k];
        if (row[v] == none) {
          row[v] = static_cast<std::uint32_t>(layer.corner_count());
          for (const std::span<const float>& coordinate : input.coordinate) layer.corner.push_back(coordinate[v]);
          layer.corner.push_back(1);
        }
        lookup.corner[k] = row[v];
      }
      layer.lookup.push_back(lookup);
    }
    layer.begin.push_back(static_cast<std::uint32_t>(layer.lookup.size()));
  }
  return layer;
}

} // namespace pith
