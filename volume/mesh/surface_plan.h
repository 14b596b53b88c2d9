#pragma once
// What becomes of a surface on its way to tets, before any tet is made.
#include "volume/mesh/tri_mesh.h"

#include <string>

namespace pith {

/// What `tetrahedralize` would do with a surface before it hands it to TetGen.
struct SurfacePlan {
  enum class Way {
    as_it_is, ///< the surface is clean
    mend,     ///< mended in place
    wrap,     ///< wrapped as a whole: the surface moves everywhere
    refuse    ///< tetrahedralize would throw InvalidInput
  };
  Way way = Way::as_it_is;
  double moved = 0; ///< mend: how far the surface moves, mm; 0 unless faults are cut out
  std::string note; ///< what would be mended, or why not
};

/// The same steps without TetGen, for method `automatic`; throws nothing but std::bad_alloc. (TetGen fails on a few
/// surfaces that this finds clean; they are wrapped then.) Cost: about that of surface_defects, several times over
/// where there are faults.
SurfacePlan surface_plan(const TriMesh& surface, const std::string& name);

} // namespace pith
