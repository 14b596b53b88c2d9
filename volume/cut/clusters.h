#pragma once
// Root tets in clusters that lie together: a cut passes over those that its level set cannot reach. Not part of the
// public face of this module.
#include "volume/cut/level_set.h"
#include "volume/mesh/tet_mesh.h"

namespace pith {

/// 128 root tets each, along a space-filling curve; and which tets are around each vertex.
struct TetClusters {
  PerTet<std::uint32_t> cluster; ///< of each tet
  VertexTets around;             ///< the root's
  struct Ball {
    Vec3d center;
    double radius;
  };
  std::vector<Ball> ball; ///< rest space; holds the cluster's tets and every tet that shares a vertex with one

  std::size_t count() const { return ball.size(); }
};

/// O(n log n): 0.13 s for a million tets, once per root.
TetClusters clusters_of(const TetMesh& root);

/// For each cluster the sign of the level set all through its ball, where the pieces stand; 0 where it may change.
/// As the balls hold the neighbours too, no value in or beside a cluster of one sign is snapped to zero.
std::vector<std::int8_t> sides_of_clusters(const TetClusters& clusters, const LevelSet& level_set,
                                           const Rigid& placement);

} // namespace pith
