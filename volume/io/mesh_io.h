#pragma once
// Triangle meshes from and to files: OBJ, OFF, PLY (ASCII and binary, both byte orders), STL (ASCII and binary).
#include "volume/mesh/tri_mesh.h"

#include <filesystem>

namespace pith {

/// Reads by extension; `scale` multiplies the coordinates (1000 for a file in metres). Polygons become fans; OBJ
/// groups and materials become parts. STL vertices are welded. Numbers read alike in every locale. Errors: IoFailure
/// when the file cannot be opened; InvalidInput, with the line or byte, when it is empty, truncated, not of that
/// format, has an index out of range, a coordinate that is not finite, or no usable size (surface_size.h).
TriMesh read_tri_mesh(const std::filesystem::path& path, double scale = 1);

/// Writes by extension. The file appears whole or not at all.
void write_tri_mesh(const std::filesystem::path& path, const TriMesh& mesh);

} // namespace pith
