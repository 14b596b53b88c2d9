#pragma once
// Which tet owns a point. The answer is a function of the point and the region alone: hints buy speed, never change
// it.
#include "volume/mesh/boundary.h"
#include "volume/mesh/facet_tree.h"
#include "volume/mesh/tet_mesh.h"

namespace pith {

/// Where a point is: the owner, and its barycentric coordinates there (sum 1, clamped to [0, 1] when the point lay
/// outside).
struct Location {
  TetId tet;
  std::array<double, 4> barycentric{};
  bool inside = false; ///< in the closed tet; false: the nearest tet of the region was taken
};

/// The owner of x in a region: the lowest-numbered closed tet that contains x (exact orientation tests). A point in
/// no tet of the region goes to the tet behind the nearest boundary facet of that region (lowest id among equals),
/// with the point projected onto that facet. Needs the mesh and boundary to outlive it.
class Locator {
public:
  Locator(const TetMesh& mesh, const Boundary& boundary);

  /// `region` −1: any region. `hint`: a tet near x, or none. Cost: ~0.3 µs with a good hint, ~1 µs without.
  Location locate(const Vec3d& x, std::int32_t region = -1, TetId hint = {}) const;

  /// True when x lies in some closed tet of the region.
  bool contains(const Vec3d& x, std::int32_t region = -1) const;

  /// The owner of x, or none when x lies in no closed tet of the region.
  TetId owner(const Vec3d& x, std::int32_t region = -1, TetId hint = {}) const;

  /// The nearest boundary facet (of a region, −1: any); its closest point and barycentrics.
  NearestFacet nearest_facet(const Vec3d& x, std::int32_t region = -1) const {
    return region < 0 ? facets_.nearest(x) : facets_.nearest(x, facet_region_, region);
  }

private:
  TetId lowest_owner(const Vec3d& x, std::int32_t region, TetId found, const std::array<int, 4>& sign) const;
  TetId walk(const Vec3d& x, TetId from, std::array<int, 4>& sign) const;
  TetId search_cell(const Vec3d& x, std::int32_t region) const;
  std::uint32_t coordinate(const Vec3d& x, int axis) const;
  std::uint32_t cell_of(const Vec3d& x) const;

  const TetMesh& mesh_;
  const Boundary& boundary_;
  FacetTree facets_;
  std::vector<std::int32_t> facet_region_;
  bool several_regions_ = false;
  VertexTets around_;
  Box bounds_;
  Vec3d cells_per_mm_;
  std::array<std::uint32_t, 3> cells_{};
  std::vector<std::uint32_t> cell_begin_;
  std::vector<TetId> cell_tet_;
};

/// Barycentric coordinates of x in a tet, by one fixed expression (four determinants, divided by their sum).
std::array<double, 4> barycentric(const TetMesh& mesh, TetId tet, const Vec3d& x);

} // namespace pith
