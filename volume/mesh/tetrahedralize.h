#pragma once
// From a closed surface to tets that fill it: TetGen on what is clean or can be mended, CGAL's alpha wrap on the
// rest.
#include "volume/base/parallel.h"
#include "volume/mesh/tet_mesh.h"
#include "volume/mesh/tri_mesh.h"

#include <filesystem>
#include <string>

namespace pith {

struct TetrahedralizeOptions {
  enum class Method { automatic, tetgen, wrap };
  /// `automatic`: TetGen where the surface is clean or its faults can be mended in place, else `wrap`: TetGen on an
  /// alpha wrap. `tetgen`: as `automatic`, but a surface that would have to change is refused.
  Method method = Method::automatic;
  /// Target edge length inside, mm; 0: twelve times the mean edge of the surface, at most diagonal / 12.
  double interior_edge = 0;
  /// Along these polylines, of two points or more each, tets shall have edges of about `core_edge` (mm; 0: as
  /// elsewhere), and `core_growth` mm longer ones for each mm away from them, up to `interior_edge`. For axes around
  /// which a texture turns.
  std::vector<std::vector<Vec3d>> core{};
  double core_edge = 0, core_growth = 0.4;
  /// Target edge length on the boundary, mm; 0: the surface as it is. Longer edges are split at their middle before
  /// meshing, so that the boundary comes out finer than the inside; no point of it moves.
  double boundary_edge = 0;
  /// Radius-edge ratio bound of TetGen (-q); at least 1.1.
  double radius_edge = 1.4;
  /// Alpha and offset of the wrap, as fractions of the bounding box diagonal.
  double wrap_alpha = 0.01, wrap_offset = 0.001;
  /// Seconds before TetGen's process is given up. A wrap that would take longer than this (by an estimate; ten
  /// minutes are always granted) is refused.
  double time_limit = 600;
  /// The helper program that runs TetGen; empty: `pith-tetgen` beside the running program.
  std::filesystem::path helper{};
};

struct TetrahedralizeResult {
  TetMesh mesh; ///< connected and valid; vertices of the surface first, bit for bit
  /// The surface that was meshed, facing away from its material. "tetgen": the input with its triangle numbers kept;
  /// triangles that were dropped stay without facets, and those that close holes follow the input's. "wrap": the
  /// wrap.
  TriMesh surface;
  Indexed<FacetId, TriangleId> input; ///< for each facet of boundary_of(mesh): the triangle of `surface` it lies in
  std::string method;                 ///< "tetgen" or "wrap"
  double surface_moved =
      0;            ///< largest distance from the input's vertices and triangle centres to the surface meshed, mm
  std::string note; ///< what was wrong with the input and what was done about it; empty where nothing was
};

/// Fills a surface with tets. `name` stands in messages for the surface (a file name).
///
/// What is wrong with the surface is mended in this order, and `note` says so: vertices of equal position are merged,
/// collapsed and duplicate triangles dropped, triangles of no area replaced, closed shells oriented (none of this
/// moves the surface); holes are closed by least area; a few triangles at fault (crossing, non-manifold) are cut out
/// and the gap closed; and where that does not do, the whole surface is wrapped.
///
/// Regions: a shell that lies in no other bounds material. Inside material, a shell that faces the same way as the
/// one around it is a region of its own (a stone in flesh); one that faces the other way is a cavity. Regions are
/// numbered by nesting depth, then in the order of the file: with one outermost shell that is region 0.
///
/// Errors: InvalidInput when the surface is empty, has NaN, is smaller than 1e-9 mm or reaches beyond 1e12 mm, has
/// only degenerate triangles or encloses no volume, or an option makes no sense; SolverFailure when TetGen fails on
/// the surface and on its wrap; IoFailure when the helper program is missing; Cancelled. A crash of TetGen never ends
/// the process, and no file is left behind. Deterministic. Cost: about TetGen's (70,000 tets/s); a wrap of 20,000
/// triangles 2 s and more.
TetrahedralizeResult tetrahedralize(const TriMesh& surface, const std::string& name,
                                    const TetrahedralizeOptions& options = {}, const Progress& progress = {});

} // namespace pith
