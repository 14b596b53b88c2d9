#pragma once
// Pieces: what cuts leave of a root mesh. A piece is labels on whole root tets plus its own cut tets; no coordinates,
// no colours are copied (docs/design.md, idea 4).
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
  Rigid placement; ///< from rest space to where the piece stands
};

/// A vertex that a cut added, on the edge between two older vertices. Both halves and all later cuts share its bits.
struct AddedVertex {
  VertexId a, b; ///< a < b
  CutId cut;
};

/// The field's direction at a vertex that existed before a cut and happens to lie on its section.
struct SectionNormal {
  VertexId vertex;
  CutId cut;
  Vec3f normal; ///< unit, rest space, from negative to positive
};

/// All pieces of a model. Vertex ids below root vertex count are root vertices, the rest are `added` in order.
struct Pieces {
  std::uint32_t root_vertex_count = 0;
  PerTet<std::uint32_t> label; ///< for each root tet, the piece that keeps it whole; `was_cut` where none does
  std::vector<Piece> piece;
  std::vector<AddedVertex> added;
  std::vector<Vec3d> added_position; ///< rest space
  std::vector<Vec3f> added_normal;   ///< unit gradient of the cut's field there (rest space, negative to positive)
  std::vector<SectionNormal> on_section; ///< older vertices on sections, ascending by (cut, vertex)
  std::uint32_t cut_count = 0;

  static constexpr std::uint32_t was_cut = 0xffffffffu;

  const Vec3d& position(const TetMesh& root, VertexId v) const {
    return v < root_vertex_count ? root.position[v] : added_position[v - root_vertex_count];
  }
};

/// One piece: the whole root.
Pieces whole_piece(const TetMesh& root);

/// Throws InvalidInput, naming the first offender, when arrays do not fit one another, labels, corners, tags or roots
/// are out of range, positions are not finite, or a placement is not a rigid motion.
void validate(const Pieces& pieces, const TetMesh& root, const Boundary& boundary);

/// The unit normal of the section of `cut` at vertex v (rest space, from the left half to the right half), smooth
/// over the section: the gradient of the cut's field at vertices of that cut; interpolated at vertices that later
/// cuts added to the section. Zero where v does not lie on that section. O(log section + later cuts).
Vec3f section_normal(const Pieces& pieces, const TetMesh& root, VertexId v, CutId cut);

/// The closed surface of one piece in rest space, ready to draw, trace or export. An interface between two regions is
/// part of it only where the piece has one of its sides. O(boundary facets + vertices + the piece's cut tets).
struct PieceSurface {
  std::vector<VertexId> vertex; ///< ids in Pieces, ascending
  std::vector<Vec3d> position;  ///< rest space, parallel to `vertex`
  struct Triangle {
    std::array<std::uint32_t, 3> corner; ///< rows of `position`, counter-clockwise from outside
    TetId root;                          ///< the root tet behind it: a hint for material_at, and its region
    FaceTag tag;                         ///< skin facet or section
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
/// Of all pieces, bit for bit the same: one pass over the root's labels.
std::vector<PieceMeasure> measures_of(const Pieces& pieces, const TetMesh& root);

/// The piece that contains a rest point (named that way in recipes); `owner` is the root tet that contains x. On a
/// section the lowest-numbered piece. `no_piece` where `owner` does not exist or x lies in a part that was not kept.
inline constexpr std::uint32_t no_piece = 0xffffffffu;
std::uint32_t piece_at(const Pieces& pieces, const TetMesh& root, TetId owner, const Vec3d& x);

} // namespace pith
