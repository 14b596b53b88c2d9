#pragma once
// What pith-vdb.so offers: plain C, so that nothing of OpenVDB shows. Used by vdb_io.cpp alone.
#include <cstdint>

namespace pith::vdb_module {

/// 8 × 8 × 8 voxels; voxel (x, y, z) of a leaf is number 64 x + 8 y + z.
struct Leaf {
  std::int32_t origin[3];  ///< multiples of 8
  std::uint64_t active[8]; ///< bit n of the 512
  float color[512][3];
};

struct Volume {
  double voxel; ///< edge, in units of the file
  float density;
  const char* color_name;
};

struct Grids; ///< grids under construction

/// Null when out of memory.
using BeginFunction = Grids*(const Volume*);
/// 0 when done. Each origin at most once.
using AddFunction = int(Grids*, const Leaf* leaf, std::uint64_t count);
/// The whole file in memory, which belongs to the grids; 0 when done, else `message` (512 bytes) holds one line. To
/// be called once, at the end.
using EncodeFunction = int(Grids*, char** bytes, std::uint64_t* count, char* message);
using EndFunction = void(Grids*);

} // namespace pith::vdb_module
