#pragma once
// Inside volume/mesh: TetGen, run in the helper program pith-tetgen.
#include "volume/base/parallel.h"
#include "volume/mesh/tri_mesh.h"

#include <filesystem>
#include <functional>
#include <string>

namespace pith::tetgen {

struct Settings {
  double max_volume = 0;                  ///< of a tet, mm³; 0: no bound
  std::vector<std::array<Vec3d, 2>> core; ///< segments along which tets shall be finer; only under max_volume
  double core_edge = 0, core_growth = 0;  ///< mm; mm per mm of distance
  double radius_edge = 0;                 ///< 0: no refinement beyond what the surface needs
  double time_limit = 600;
  std::filesystem::path helper; ///< empty: `pith-tetgen` beside the running program
};

/// Tets of everything that the surface encloses, cavities too; or why there are none.
struct Outcome {
  PerVertex<Vec3d> position; ///< the surface's vertices first, unchanged
  PerTet<std::array<VertexId, 4>> corner;
  std::string failure;  ///< empty: it worked
  bool stopped = false; ///< the caller's `meanwhile` said so
};

/// Runs the helper and waits. The helper leaves no file behind, whatever becomes of it. The surface must be clean; if
/// it is not, the outcome is a failure in words. The tets are as TetGen made them: the caller checks them. Throws
/// IoFailure when the helper cannot be started, Cancelled on request.
Outcome run(const TriMesh& surface, const Settings& settings, const Progress& progress,
            const std::function<bool()>& meanwhile = {});

} // namespace pith::tetgen
