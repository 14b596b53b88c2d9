// Pieces as data: the first one, checks, and section normals.
#include "volume/cut/piece.h"
#include "volume/base/error.h"

#include <algorithm>
#include <string>

namespace pith {
namespace {

std::string text_of(std::size_t number) { return std::to_string(number); }

[[noreturn]] void refuse(const std::string& what) {
  throw InvalidInput("pieces", what, "make the pieces again by the cuts of their recipe");
}

void check_tet(const CutTet& tet, const std::string& where, const Pieces& pieces, std::size_t vertices,
               std::size_t facets) {
  for (const VertexId v : tet.corner)
    if (v.value >= vertices) refuse(where + " names vertex " + text_of(v) + " of " + text_of(vertices));
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      if (tet.corner[i] == tet.corner[j]) refuse(where + " has vertex " + text_of(tet.corner[i]) + " twice");
  if (tet.root.value >= pieces.label.size())
    refuse(where + " names root tet " + text_of(tet.root) + " of " + text_of(pieces.label.size()));
  if (pieces.label[tet.root] != Pieces::was_cut)
    refuse(where + " lies in root tet " + text_of(tet.root) + ", which piece " + text_of(pieces.label[tet.root]) +
           " keeps whole");
  for (const FaceTag tag : tet.face) {
    if (tag.is_skin() && tag.facet().value >= facets)
      refuse(where + " names boundary facet " + text_of(tag.facet()) + " of " + text_of(facets));
    if (tag.is_section() && tag.cut().value >= pieces.cut_count)
      refuse(where + " names cut " + text_of(tag.cut()) + " of " + text_of(pieces.cut_count));
  }
}

} // namespace

Pieces whole_piece(const TetMesh& root) {
  Pieces pieces;
  pieces.root_vertex_count = static_cast<std::uint32_t>(root.vertex_count());
  pieces.label.assign(root.tet_count(), 0);
  pieces.piece.resize(1);
  return pieces;
}

void validate(const Pieces& pieces, const TetMesh& root, const Boundary& boundary) {
  if (pieces.root_vertex_count != root.vertex_count())
    refuse(text_of(pieces.root_vertex_count) + " root vertices, but the model has " + text_of(root.vertex_count()));
  if (pieces.label.size() != root.tet_count())
    refuse(text_of(pieces.label.size()) + " labels for " + text_of(root.tet_count()) + " root tets");
  const std::size_t added = pieces.added.size();
  if (pieces.added_position.size() != added || pieces.added_normal.size() != added)
    refuse(text_of(added) + " added vertices with " + text_of(pieces.added_position.size()) + " positions and " +
           text_of(pieces.added_normal.size()) + " normals");
  for (std::size_t t = 0; t < pieces.label.size(); ++t)
    if (const std::uint32_t label = pieces.label[TetId(t)]; label != Pieces::was_cut && label >= pieces.piece.size())
      refuse("root tet " + text_of(t) + " belongs to piece " + text_of(label) + " of " +
             text_of(pieces.piece.size()));
  for (std::size_t i = 0; i < added; ++i) {
    const AddedVertex& vertex = pieces.added[i];
    const std::string where = "added vertex " + text_of(i);
    if (vertex.a >= vertex.b || vertex.b >= pieces.root_vertex_count + i)
      refuse(where + " lies between vertices " + text_of(vertex.a) + " and " + text_of(vertex.b));
    if (vertex.cut.value >= pieces.cut_count)
      refuse(where + " names cut " + text_of(vertex.cut) + " of " + text_of(pieces.cut_count));
    if (!pieces.added_position[i].allFinite() || !pieces.added_normal[i].allFinite())
      refuse(where + " is not finite");
  }
  const std::size_t vertices = pieces.root_vertex_count + added;
  for (const SectionNormal& known : pieces.on_section)
    if (known.vertex.value >= vertices || known.cut.value >= pieces.cut_count || !known.normal.allFinite())
      refuse("a section normal of vertex " + text_of(known.vertex) + ", cut " + text_of(known.cut) +
             " is not usable");
  for (std::size_t p = 0; p < pieces.piece.size(); ++p) {
    const Piece& piece = pieces.piece[p];
    const Mat3d& r = piece.placement.rotation;
    if (!r.allFinite() || !piece.placement.translation.allFinite() ||
        (r * r.transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff() > 1e-6)
      refuse("the placement of piece " + text_of(p) + " is not a rigid motion");
    for (std::size_t j = 0; j < piece.cut.size(); ++j)
      check_tet(piece.cut[j], "cut tet " + text_of(j) + " of piece " + text_of(p), pieces, vertices,
                boundary.facet_count());
  }
}

Vec3f section_normal(const Pieces& pieces, const TetMesh& root, VertexId v, CutId cut) {
  if (v >= pieces.root_vertex_count) {
    const AddedVertex& vertex = pieces.added[v - pieces.root_vertex_count];
    if (vertex.cut == cut) return pieces.added_normal[v - pieces.root_vertex_count];
    if (vertex.cut > cut) { // a later cut put it on an edge of the section, or somewhere else
      const Vec3f a = section_normal(pieces, root, vertex.a, cut), b = section_normal(pieces, root, vertex.b, cut);
      if (a.isZero(0) || b.isZero(0)) return Vec3f::Zero();
      const Vec3d &from = pieces.position(root, vertex.a), &to = pieces.position(root, vertex.b);
      const Vec3d along = to - from;
      const double t = (pieces.position(root, v) - from).dot(along) / along.squaredNorm();
      const Vec3f between = a + static_cast<float>(t) * (b - a);
      const float length = between.norm();
      return length > 0 ? Vec3f(between / length) : Vec3f::Zero();
    }
  }
  const auto before = [](const SectionNormal& known, const std::pair<CutId, VertexId>& wanted) {
    return known.cut != wanted.first ? known.cut < wanted.first : known.vertex < wanted.second;
  };
  const auto at = std::lower_bound(pieces.on_section.begin(), pieces.on_section.end(), std::pair(cut, v), before);
  const bool found = at != pieces.on_section.end() && at->cut == cut && at->vertex == v;
  return found ? at->normal : Vec3f::Zero();
}

} // namespace pith
