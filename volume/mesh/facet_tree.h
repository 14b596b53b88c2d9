#pragma once
// The nearest triangle to a point: a tree of bounding boxes.
#include "volume/base/types.h"

#include <span>

namespace pith {

struct NearestFacet {
  std::uint32_t facet = std::numeric_limits<std::uint32_t>::max();
  Vec3d point = Vec3d::Zero();         ///< the closest point on it
  std::array<double, 3> barycentric{}; ///< of that point
  double squared_distance = std::numeric_limits<double>::infinity();
};

/// Closest point of one triangle to x (Ericson, Real-Time Collision Detection, 5.1.5).
NearestFacet closest_point(const std::array<Vec3d, 3>& triangle, const Vec3d& x);

/// Triangles are copied in; ties in distance go to the lowest number, so the answer does not depend on the tree.
class FacetTree {
public:
  FacetTree() = default;
  explicit FacetTree(std::vector<std::array<Vec3d, 3>> triangles);

  std::size_t facet_count() const { return triangle_.size(); }
  /// O(log n) in practice. With `group` (one number per triangle) and `wanted`, only triangles of that group count.
  NearestFacet nearest(const Vec3d& x, std::span<const std::int32_t> group = {}, std::int32_t wanted = 0) const;

private:
  struct Node {
    Box box;
    std::uint32_t begin = 0, end = 0; ///< triangles of a leaf; children otherwise
    bool leaf = true;
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end, const std::vector<Vec3d>& center);

  std::vector<std::array<Vec3d, 3>> triangle_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> node_;
};

} // namespace pith
