// The closed surface of one piece: skin facets of its whole tets, skin and section faces of its cut tets.
#include "volume/base/error.h"
#include "volume/cut/piece.h"

#include <algorithm>
#include <string>

namespace pith {
namespace {

using Triple = std::array<std::uint32_t, 3>;

struct Face {
  std::array<VertexId, 3> corner;
  TetId root;
  FaceTag tag;
};

Triple sorted_corners(const std::array<VertexId, 3>& corner) {
  Triple key = {corner[0], corner[1], corner[2]};
  std::sort(key.begin(), key.end());
  return key;
}

/// Drops the faces of which the piece has both sides.
void drop_pairs(std::vector<Face>& faces) {
  std::vector<std::pair<Triple, std::uint32_t>> order;
  order.reserve(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    order.emplace_back(sorted_corners(faces[i].corner), static_cast<std::uint32_t>(i));
  std::sort(order.begin(), order.end());
  std::vector<bool> paired(faces.size(), false);
  for (std::size_t i = 0; i + 1 < order.size(); ++i)
    if (order[i].first == order[i + 1].first) paired[order[i].second] = paired[order[i + 1].second] = true;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (!paired[i]) faces[kept++] = faces[i];
  faces.resize(kept);
}

} // namespace

PieceSurface surface_of(const Pieces& pieces, std::uint32_t piece, const TetMesh& root, const Boundary& boundary) {
  if (piece >= pieces.piece.size())
    throw InvalidInput("piece",
                       "there is no piece " + std::to_string(piece) + " among " + std::to_string(pieces.piece.size()),
                       "name one that exists");

  // An interface between regions is no surface where the piece has both its sides.
  std::vector<Face> faces, interfaces;
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    const TetId t = boundary.tet[f];
    if (pieces.label[t] != piece) continue;
    const TetId behind = boundary.behind[f];
    if (behind.exists() && pieces.label[behind] == piece) continue;
    (behind.exists() ? interfaces : faces).push_back({boundary.corner[f], t, FaceTag::skin(f)});
  }
  for (const CutTet& tet : pieces.piece[piece].cut)
    for (int i = 0; i < 4; ++i) {
      if (tet.face[i].is_interior()) continue;
      const auto& c = facet_corners[i];
      const bool interface = tet.face[i].is_skin() && boundary.behind[tet.face[i].facet()].exists();
      (interface ? interfaces : faces)
          .push_back({{tet.corner[c[0]], tet.corner[c[1]], tet.corner[c[2]]}, tet.root, tet.face[i]});
    }
  drop_pairs(interfaces);
  faces.insert(faces.end(), interfaces.begin(), interfaces.end());

  PieceSurface surface;
  constexpr std::uint32_t unused = 0xffffffffu;
  std::vector<std::uint32_t> row(pieces.root_vertex_count + pieces.added.size(), unused);
  for (const Face& face : faces)
    for (const VertexId v : face.corner) row[v] = 0;
  for (std::size_t v = 0; v < row.size(); ++v) {
    if (row[v] == unused) continue;
    row[v] = static_cast<std::uint32_t>(surface.vertex.size());
    surface.vertex.push_back(VertexId(v));
    surface.position.push_back(pieces.position(root, VertexId(v)));
  }
  surface.triangle.reserve(faces.size());
  for (const Face& face : faces)
    surface.triangle.push_back(
        {{row[face.corner[0]], row[face.corner[1]], row[face.corner[2]]}, face.root, face.tag});
  return surface;
}

} // namespace pith
