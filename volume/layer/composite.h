#pragma once
// The one compositor: the look-ups of one layer on one simplex become one value, by the layer's blend rule.
#include "volume/layer/layer_reader.h"
#include "volume/mesh/tet_mesh.h"

#include <span>

namespace pith {

/// The look-ups of one simplex (a tet or a boundary facet, by the layer's domain), in paste order; none where the
/// layer has nothing there.
std::span<const Lookup> lookups_of(const Layer& layer, std::uint32_t simplex);

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
