#pragma once
// From a closed surface to tets that fill it: TetGen on clean input, CGAL on the rest.
#include "volume/base/parallel.h"
#include "volume/mesh/tet_mesh.h"
#include "volume/mesh/tri_mesh.h"

#include <filesystem>
#include <string>

namespace pith {

struct TetrahedralizeOptions {
  enum class Method { automatic, tetgen, wrap };
  /// `automatic`: TetGen where the surface is clean, else `wrap` (alpha wrapping, then Mesh_3).
  Method method = Method::automatic;
  /// Target edge length inside, mm; 0: twelve times the mean edge of the surface, at most diagonal / 12.
  double interior_edge = 0;
  /// Target edge length on the boundary, mm; 0: the surface as it is. Longer edges are split before meshing.
  double boundary_edge = 0;
  /// Radius-edge ratio bound of TetGen (-q); at least 1.1.
  double radius_edge = 1.4;
  /// Alpha and offset of the wrap, as fractions of the bounding box diagonal.
  double wrap_alpha = 0.01, wrap_offset = 0.001;
  /// Seconds before TetGen's process is given up.
  double time_limit = 600;
  /// The helper program that runs TetGen; empty: `pith-tetgen` beside the running program.
  std::filesystem::path helper;
};

struct TetrahedralizeResult {
  TetMesh mesh;                       ///< connected and valid; one region per closed shell
  TriMesh surface;                    ///< the surface that was meshed: the input, or its wrap
  Indexed<FacetId, TriangleId> input; ///< for each facet of boundary_of(mesh): the triangle of `surface` it came from
  std::string method;                 ///< "tetgen" or "wrap"
  double surface_moved = 0;           ///< largest distance from the input surface to the one meshed, mm
  std::string note;                   ///< why the fall-back was taken; empty otherwise
};

/// Preconditions: none beyond a mesh in memory. `name` stands in messages for the surface (a file name).
/// Errors: InvalidInput when the surface is empty, has NaN, or has no volume even after wrapping; SolverFailure when
/// both ways fail. A crash of TetGen or CGAL's refusal becomes the fall-back, then an error; it never ends the
/// process. Nested shells (a stone in flesh) become regions: shells are oriented by their nesting depth before
/// meshing.
TetrahedralizeResult tetrahedralize(const TriMesh& surface, const std::string& name,
                                    const TetrahedralizeOptions& options = {}, const Progress& progress = {});

} // namespace pith
