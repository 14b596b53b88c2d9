#pragma once
// The field's direction at the vertices of a section. Not part of the public face of this module.
#include "volume/cut/classify.h"

namespace pith {

/// What lies on a new section.
struct SectionVertices {
  std::vector<AddedVertex> added;
  std::vector<Vec3d> position; ///< of the added ones, rest space
  std::vector<VertexId> old;   ///< vertices that were there, ascending
};

/// A tet with faces on the section that is not subdivided.
struct SectionTet {
  TetReference tet;
  std::uint8_t faces; ///< bit i: the face opposite corner i
  bool above;
};

struct SectionDirections {
  std::vector<Vec3f> added, old; ///< unit, rest space, from negative to positive
};

/// The level set's gradient where there is one; else that of the values' interpolation in the tets around, weighted
/// by their volumes. `made[i]`: the new vertices of crossed tet i; the first has the id `first_added`.
SectionDirections section_directions(const Pieces& pieces, const TetMesh& root, const PieceGroup& group,
                                     const Sides& sides, const GroupField& field, const SectionVertices& vertices,
                                     std::span<const std::array<VertexId, 4>> made,
                                     std::span<const SectionTet> section, VertexId first_added);

} // namespace pith
