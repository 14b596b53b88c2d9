#pragma once
// Pieces: what cuts leave of a root mesh. A piece is labels on whole root tets plus its own cut tets; no coordinates, no
// colours are copied (docs/design.md, idea 4).
#include "volume/mesh/boundary.h"
#include "volume/mesh/tet_mesh.h"

#include <map>

namespace pith {

/// What a face of a cut tet is: inside the piece, part of a root boundary facet, or part of the section of a cut.
struct FaceTag {
  std::int32_t code = -1; ///< −1 interior; f ≥ 0 root facet f; −2 − c section of cut c

  static FaceTag interior() { return {}; }
  static FaceTag skin(FacetId facet) { return {static_cast<std::int32_t>(facet.value)}; }
  static FaceTag section(CutId cut) { return {-2 - static_cast<std::int32_t>(cut.value)}; }
  bool is_interior() const { return code == -1; }
  bool is_skin() const { return code >= 0; }
  bool is_section() const { return code <= -2; }
  FacetId facet() const { return is_skin() ? FacetId(code) : FacetId(); }
  CutId cut() const { return is_section() ? CutId(-2 - code) : CutId(); }
  bool operator==(const FaceTag&) const = default;
};

/// A tet that a cut made, inside one root tet. Corners are root vertices or added vertices.
struct CutTet {
  std::array<VertexId, 4> corner;
  TetId root;
  std::array<FaceTag, 4> face; ///< opposite each corner
};

/// A part of the root.
struct Piece {
  std::vector<CutTet> cut;
  Rigid placement;      ///< from rest space to where the piece stands
};

/// A vertex that a cut added, on the edge between two older vertices. Both halves and all later cuts share its bits.
struct AddedVertex {
  VertexId a, b; ///< a < b
  CutId cut;
};

/// All pieces of a model. Vertex ids below root vertex count are root vertices, the rest are `added` in order.
struct Pieces {
  std::uint32_t root_vertex_count = 0;
  PerTet<std::uint32_t> label;            ///< for each root tet, the piece that keeps it whole; `was_cut` where none does
  std::vector<Piece> piece;
  std::vector<AddedVertex> added;
  std::vector<Vec3d> added_position;      ///< rest space
  std::vector<Vec3f> added_normal;        ///< unit gradient of the cut's field there, in rest space
  std::uint32_t cut_count = 0;

  static constexpr std::uint32_t was_cut = 0xffffffffu;

  const Vec3d& position(const TetMesh& root, VertexId v) const {
    return v < root_vertex_count ? root.position[v] : added_position[v - root_vertex_count];
  }
};

/// One piece: the whole root.
Pieces whole_piece(const TetMesh& root);

/// Throws InvalidInput when labels, corners, tags or roots are out of range.
void validate(const Pieces& pieces, const TetMesh& root, const Boundary& boundary);

/// The closed surface of one piece in rest space, ready to draw, trace or export.
struct PieceSurface {
  std::vector<VertexId> vertex;                   ///< ids in Pieces, ascending
  std::vector<Vec3d> position;                    ///< rest space, parallel to `vertex`
  struct Triangle {
    std::array<std::uint32_t, 3> corner;          ///< rows of `position`, counter-clockwise from outside
    TetId root;                                   ///< the root tet behind it: a hint for material_at, and its region
    FaceTag tag;                                  ///< skin facet or section
  };
  std::vector<Triangle> triangle;
};
PieceSurface surface_of(const Pieces& pieces, std::uint32_t piece, const TetMesh& root, const Boundary& boundary);

/// Volume (mm³) and centroid (rest space) of a piece; O(its tets).
struct PieceMeasure {
  double volume = 0;
  Vec3d centroid = Vec3d::Zero();
  Box bounds;
  std::size_t whole_tets = 0, cut_tets = 0;
  double minimum_dihedral = 0; ///< radians, over cut tets; π where there are none
};
PieceMeasure measure(const Pieces& pieces, std::uint32_t piece, const TetMesh& root);

/// The piece that contains a rest point (named that way in recipes); none (an id that does not exist) outside.
std::uint32_t piece_at(const Pieces& pieces, const TetMesh& root, TetId owner, const Vec3d& x);

} // namespace pith
