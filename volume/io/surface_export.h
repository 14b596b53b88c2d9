#pragma once
// The coloured surface of pieces, skin and sections, and the files that carry it: PLY, OBJ, STL, GLB. And the tets
// themselves with their colours: VTU.
#include "volume/base/parallel.h"
#include "volume/cut/displace.h"
#include "volume/layer/model.h"

#include <filesystem>

namespace pith {

struct SurfaceOptions {
  /// Triangles are subdivided until no edge is longer (mm), so that colours at vertices show the texture; 0: as they
  /// are.
  double max_edge = 0;
  /// Guard: InvalidInput when subdivision would make more triangles than this.
  std::size_t max_triangles = 50'000'000;
  /// Of the skin by the relief of its material (relief.h), where that has one; its own guard counts per piece.
  DisplaceOptions displacement{};
};

/// Vertices are split where a smooth surface ends: between skin and section, between sections of different cuts,
/// between regions. Vertices of one `point` stand at the same place; over points each piece is closed.
struct ColoredSurface {
  std::vector<Vec3d> position; ///< of each point, world space (where the piece stands), mm
  struct Vertex {
    std::uint32_t point;
    Vec3f normal; ///< unit, world space
    Vec3f color;  ///< linear Rec.709
  };
  std::vector<Vertex> vertex;
  std::vector<std::array<std::uint32_t, 3>> triangle; ///< of vertices, counter-clockwise from outside

  /// Triangles and vertices stand in runs: piece by piece; in a piece the skin first, then the sections by cut.
  struct Part {
    std::uint32_t piece;
    CutId cut; ///< none: the skin
    std::uint32_t triangle_begin, triangle_end;
    std::uint32_t vertex_begin, vertex_end;
  };
  std::vector<Part> part;
  std::size_t turned = 0; ///< triangles that displacement turned inwards (DisplacedSurface::turned)
};

/// Colours are material_at the rest position, from before displacement, of each vertex, on the side of the root tet behind it; skin triangles
/// see the skin layers. Normals: the root's smooth skin, the cut's field on sections. Cost: one material_at per
/// vertex, in parallel.
ColoredSurface colored_surface(const Root& root, const Pieces& pieces, const SurfaceOptions& options = {},
                               const Progress& progress = {});

/// What stands in a file.
struct SurfaceCounts {
  std::size_t triangles = 0;
  std::size_t vertices = 0; ///< 0 in STL, which has none: each triangle names its corners by place
};

/// All of them return what they wrote. The files appear whole or not at all. Errors: IoFailure; InvalidInput for an
/// extension that is none of the four.

/// By extension: .ply, .obj, .stl or .glb.
SurfaceCounts write_surface(const std::filesystem::path& path, const ColoredSurface& surface,
                            const std::string& name = "pith");

/// Binary little-endian; x y z float32, nx ny nz, red green blue (8 bit, sRGB). Points are shared where their colours
/// agree, so that a model without skin layers is watertight by index. (Readers in wide use stumble over properties of
/// faces, so there are none.)
SurfaceCounts write_ply(const std::filesystem::path& path, const ColoredSurface& surface);
/// `v x y z r g b` (sRGB in [0, 1]), `vn`, points shared as in PLY; one object per piece with groups skin, section_0
/// ... Edges between skin and section are shaded softly in both; GLB keeps them sharp.
SurfaceCounts write_obj(const std::filesystem::path& path, const ColoredSurface& surface,
                        const std::string& name = "pith");
/// Binary; no colour.
SurfaceCounts write_stl(const std::filesystem::path& path, const ColoredSurface& surface);
/// Metres, axes as they are (y is up in pith and in glTF); one mesh per piece, COLOR_0 linear 16 bit.
SurfaceCounts write_glb(const std::filesystem::path& path, const ColoredSurface& surface,
                        const std::string& name = "pith");

/// The tets of all pieces where they stand, for ParaView: points with `color` (linear); cells with `region`,
/// `root` (root tet), `piece` and `color` (at the barycentre). Appended raw binary.
struct TetCounts {
  std::size_t tets = 0, vertices = 0;
};
TetCounts write_vtu(const std::filesystem::path& path, const Root& root, const Pieces& pieces);

} // namespace pith
