#include "recipe/plain_layer.h"

namespace pith {

Layer plain_layer(const TetMesh& mesh, std::int32_t region, const Vec3d& color, const std::string& name) {
  Exemplar exemplar;
  exemplar.name = name;
  exemplar.channel = {Channel{}};
  for (int c = 0; c < 3; ++c) exemplar.texel.push_back(encoded(exemplar.channel[0], static_cast<float>(color[c])));

  Layer layer;
  layer.name = name;
  layer.region = region;
  layer.exemplar.push_back(std::move(exemplar));
  layer.patch.push_back(Patch{});
  layer.corner = {0.5f, 0.5f, 0.5f, 1.0f}; // one row serves every corner: the middle of the texel, full weight
  layer.begin.push_back(0);
  for (const TetId tet : all_ids<TetId>(mesh.tet_count())) {
    if (region >= 0 && mesh.region[tet] != region) continue;
    if (region >= 0) layer.simplex.push_back(tet);
    layer.lookup.push_back(Lookup{});
    layer.begin.push_back(static_cast<std::uint32_t>(layer.lookup.size()));
  }
  if (layer.simplex.size() == mesh.tet_count()) layer.simplex.clear();
  return layer;
}

} // namespace pith
