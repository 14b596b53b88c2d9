#pragma once
// Pieces as OpenVDB fog volumes: `density` (float) and `color` (Vec3s, linear), the two grids that Blender's and
// other renderers' default shaders look for. OpenVDB sits in a module of its own (pith-vdb.so, beside the program).
#include "volume/base/parallel.h"
#include "volume/cut/piece.h"
#include "volume/layer/model.h"

#include <filesystem>
#include <string>

namespace pith {

struct VdbOptions {
  double voxel = 0;                 ///< edge of a voxel, mm; 0: longest extent / 256
  double scale = 0.001;             ///< file units per mm: 0.001 for metres (Blender), 1 for millimetres
  float density = 1;                ///< value of `density` inside, per file unit
  std::string color_name = "color"; ///< "Cd" for Houdini
};

struct VdbResult {
  double voxel = 0;            ///< mm
  std::array<int, 3> extent{}; ///< voxels of the bounding box
  std::size_t active = 0;      ///< voxels inside
};

/// Voxel (i, j, k) has its centre at voxel · (i, j, k) in world space and is active when the centre lies in a piece
/// where it stands; its colour is material_at the rest position. Where pieces overlap, the lowest piece counts. The
/// file appears whole or not at all and has the same bytes each time. Errors: InvalidInput for options out of range
/// or more than 2·10⁹ voxels in the bounding box; IoFailure. Cost: about 0.5 µs per active voxel and core.
VdbResult write_vdb(const std::filesystem::path& path, const Root& root, const Pieces& pieces,
                    const VdbOptions& options = {}, const Progress& progress = {});

} // namespace pith
