#include "volume/cut/section_directions.h"

#include "volume/base/parallel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pith {
namespace {

using Corners = std::array<VertexId, 4>;
constexpr std::size_t tets_per_block = 1024, vertices_per_block = 512;

/// Six times the volume times the gradient of the values' linear interpolation over a tet.
Vec3d weighted_gradient(const Pieces& pieces, const TetMesh& root, const Corners& corner,
                        std::span<const double> value) {
  Vec3d gradient = Vec3d::Zero();
  for (int i = 0; i < 4; ++i) {
    const auto& c = facet_corners[i];
    const Vec3d &p = pieces.position(root, corner[c[0]]), &q = pieces.position(root, corner[c[1]]),
                &r = pieces.position(root, corner[c[2]]);
    gradient -= value[corner[i]] * (q - p).cross(r - p);
  }
  return gradient;
}

Vec3f unit(const Vec3d& direction, const Vec3d& otherwise) {
  const double length = direction.norm();
  if (length > 0 && std::isfinite(length)) return (direction / length).cast<float>();
  const double other = otherwise.norm();
  return other > 0 ? Vec3f((otherwise / other).cast<float>()) : Vec3f::UnitZ();
}

} // namespace

SectionDirections section_directions(const Pieces& pieces, const TetMesh& root, const PieceGroup& group,
                                     const Sides& sides, const GroupField& field, const SectionVertices& vertices,
                                     std::span<const std::array<VertexId, 4>> made,
                                     std::span<const SectionTet> section, VertexId first_added) {
  const std::size_t count = vertices.added.size();
  const std::vector<VertexId>& old = vertices.old;
  SectionDirections result{std::vector<Vec3f>(count), std::vector<Vec3f>(old.size())};
  const auto across_edge = [&](std::size_t i) {
    const auto& [a, b, cut] = vertices.added[i];
    const Vec3d along = pieces.position(root, b) - pieces.position(root, a);
    return Vec3d(sides.state[a] == state_below ? along : Vec3d(-along));
  };
  if (field.level_set) {
    const auto direction = [&](const Vec3d& x) {
      return Vec3d(group.placement.rotation.transpose() * field.level_set->gradient(group.placement(x)));
    };
    parallel_for(count, vertices_per_block,
                 [&](std::size_t i) { result.added[i] = unit(direction(vertices.position[i]), across_edge(i)); });
    parallel_for(old.size(), vertices_per_block, [&](std::size_t i) {
      result.old[i] = unit(direction(pieces.position(root, old[i])), Vec3d::UnitZ());
    });
    return result;
  }

  const std::vector<TetReference>& crossed = sides.crossed;
  std::vector<Vec3d> of_tet(crossed.size()), of_edge(count, Vec3d::Zero()), of_old(old.size(), Vec3d::Zero());
  parallel_for(crossed.size(), tets_per_block, [&](std::size_t i) {
    of_tet[i] = weighted_gradient(pieces, root, crossed[i].corner(pieces, root), field.value);
  });
  const auto add_to_old = [&](const Corners& corner, const Vec3d& gradient) {
    for (const VertexId v : corner)
      if (sides.state[v] == state_on)
        if (const auto at = std::lower_bound(old.begin(), old.end(), v); at != old.end() && *at == v)
          of_old[at - old.begin()] += gradient;
  };
  for (std::size_t i = 0; i < crossed.size(); ++i) {
    const Corners& corner = crossed[i].corner(pieces, root);
    const Pattern& pattern = patterns[sides.pattern_code(corner)];
    for (int e = 0; e < split_edges[static_cast<int>(pattern.split)].count; ++e)
      of_edge[made[i][e] - first_added] += of_tet[i];
    if (pattern.on > 0) add_to_old(corner, of_tet[i]);
  }
  for (const SectionTet& tet : section) {
    const Corners& corner = tet.tet.corner(pieces, root);
    add_to_old(corner, weighted_gradient(pieces, root, corner, field.value));
  }
  for (std::size_t i = 0; i < count; ++i) result.added[i] = unit(of_edge[i], across_edge(i));
  for (std::size_t i = 0; i < old.size(); ++i) result.old[i] = unit(of_old[i], Vec3d::UnitZ());
  return result;
}

} // namespace pith
