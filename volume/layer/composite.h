#pragma once
// The one compositor: the look-ups of one layer on one simplex become one value, by the layer's blend rule.
#include "volume/layer/layer.h"
#include "volume/layer/sample.h"
#include "volume/mesh/tet_mesh.h"

#include <span>

namespace pith {

/// The look-ups of one simplex (a tet or a boundary facet, by the layer's domain), in paste order; none where the
/// layer has nothing there.
std::span<const Lookup> lookups_of(const Layer& layer, std::uint32_t simplex);

/// Gradients (1/mm) of a tet's barycentric coordinates.
std::array<Vec3d, 4> barycentric_gradients(const TetMesh& mesh, TetId tet);

/// A layer with what is needed to read it fast: grids for every mip level, decoding tables, and the corner rows of
/// every look-up side by side (with 3 coordinates in a tet one line of the cache instead of four). Refers to the
/// layer. Memory: 68 bytes per look-up, and per texel 2.3 for each component.
struct LayerReader {
  explicit LayerReader(const Layer& layer, bool mips);

  struct Source {
    std::vector<TexelGrid> level;    ///< finest first
    std::vector<TexelGrid> gaussian; ///< the twins in standard deviations, same levels; empty without
    TexelGrid mean;                  ///< over the axes that Blend::mean_over names, of the finest; unset without
  };
  /// A patch: exemplar coordinates are scale · w + offset (its frame, then the layer's evaluation).
  struct PatchReader {
    Lanes scale{}, offset{};
    const MaskGrid* mask; ///< null: none
    const Source* source;
  };
  const Layer* layer;
  std::vector<Source> source; ///< per exemplar
  std::vector<MaskGrid> mask;
  std::vector<PatchReader> patch;
  std::size_t record_size = 0;        ///< (width + 1) · corners
  LargeArray<float> record;           ///< per look-up, its corner rows
  LargeArray<std::uint32_t> patch_of; ///< per look-up
  int components = 0;
  int height_component = -1; ///< of the first height channel
  bool has_directions = false;
  std::array<bool, max_components> preserved{}; ///< components whose mean and variance mixing preserves

  LayerReader(LayerReader&&) = default; ///< `patch` points into vectors whose memory moves along
  LayerReader(const LayerReader&) = delete;
};

/// A place on one simplex: a tet (4 corners) or a boundary facet (3).
struct SimplexPoint {
  std::array<float, 4> barycentric{}; ///< the fourth is 0 on a facet
  /// Gradients (1/mm) of the barycentric coordinates; on a facet tangent to it. Needed only for directions and
  /// footprints, and not set otherwise.
  std::array<Vec3d, 4> gradient;
  Vec3d normal;         ///< unit, of a facet; not set on a tet
  double footprint = 0; ///< mm
};

/// One look-up at a point: its coordinates in the patch's unit cube and its masked weight.
struct LookupSight {
  Lanes w; ///< lanes beyond the layer's width mean nothing
  float alpha;
};
/// `lookup` is one of the reader's layer.
LookupSight sight_of(const LayerReader& reader, const Lookup& lookup, const std::array<float, 4>& barycentric);

/// Rows: gradients (1/mm) of a look-up's exemplar coordinates over rest space. Needs the point's gradients.
using LookupJacobian = Eigen::Matrix<double, 4, 3>;
LookupJacobian jacobian_of(const Layer& layer, const Lookup& lookup, const SimplexPoint& point);

struct LayerValue {
  std::array<float, max_components> value{}; ///< multiplied by coverage
  float coverage = 0;
  int lookups_read = 0;
};

/// True when compositing this layer needs SimplexPoint's gradients.
inline bool needs_gradient(const LayerReader& reader, double footprint) {
  return reader.has_directions || footprint > 0;
}

/// The value of a row of look-ups (a simplex's, in paste order). `lookups` is a part of the layer's own list.
LayerValue composite(const LayerReader& reader, std::span<const Lookup> lookups, const SimplexPoint& point);

/// Coverage alone, and how many look-ups have a positive masked weight: for the measures of a fill.
struct LayerCoverage {
  float coverage = 0;
  int visible = 0;
};
LayerCoverage coverage_of(const LayerReader& reader, std::span<const Lookup> lookups, const SimplexPoint& point);

} // namespace pith
