#pragma once
// What must hold of pieces after any cut, checked the slow and sure way.
#include "volume/base/error.h"
#include "volume/cut/arrange.h"
#include "volume/mesh/orientation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace pith {

/// A mesh with its boundary.
struct Solid {
  TetMesh mesh;
  Boundary boundary;
  explicit Solid(TetMesh m) : mesh(std::move(m)), boundary(boundary_of(mesh)) {}
};

/// One tet of a piece, whole or cut, with the tags of its faces.
struct PieceTet {
  std::array<VertexId, 4> corner;
  std::array<FaceTag, 4> face;
  TetId root;
};

inline std::vector<PieceTet> tets_of(const Pieces& pieces, std::uint32_t piece, const TetMesh& root,
                                     const Boundary& boundary) {
  std::vector<PieceTet> tets;
  for (const TetId t : all_ids<TetId>(root.tet_count())) {
    if (pieces.label[t] != piece) continue;
    PieceTet tet{root.corner[t], {}, t};
    for (int i = 0; i < 4; ++i)
      if (boundary.facet_of_tet[t][i].exists()) tet.face[i] = FaceTag::skin(boundary.facet_of_tet[t][i]);
    tets.push_back(tet);
  }
  for (const CutTet& tet : pieces.piece[piece].cut) tets.push_back({tet.corner, tet.face, tet.root});
  return tets;
}

using Triple = std::array<std::uint32_t, 3>;

/// The corners in an even permutation that begins with the smallest, so that a face and its mate have reversed keys.
inline Triple turned(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (b < a && b < c) return {b, c, a};
  if (c < a && c < b) return {c, a, b};
  return {a, b, c};
}

/// Edges that do not have exactly one triangle in each direction.
inline std::size_t bad_edges(const PieceSurface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& triangle : surface.triangle)
    for (int i = 0; i < 3; ++i) ++uses[{triangle.corner[i], triangle.corner[(i + 1) % 3]}];
  std::size_t bad = 0;
  for (const auto& [edge, count] : uses) {
    const auto back = uses.find({edge.second, edge.first});
    bad += count != 1 || back == uses.end() || back->second != 1;
  }
  return bad;
}

/// Vertices of a surface at which it hangs together by the vertex alone: more than one fan of triangles.
inline std::size_t pinched_vertices(const PieceSurface& surface) {
  std::vector<std::uint32_t> parent(3 * surface.triangle.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root_of = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::uint32_t>> side; // its corners
  for (std::uint32_t t = 0; t < surface.triangle.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = 3 * t + k, to = 3 * t + (k + 1) % 3;
      const auto& corner = surface.triangle[t].corner;
      side[{corner[k], corner[(k + 1) % 3]}] = {from, to};
    }
  for (const auto& [edge, corners] : side)
    if (const auto back = side.find({edge.second, edge.first}); back != side.end()) {
      parent[root_of(corners.first)] = root_of(back->second.second);
      parent[root_of(corners.second)] = root_of(back->second.first);
    }
  std::map<std::uint32_t, int> fans;
  for (std::uint32_t i = 0; i < parent.size(); ++i)
    if (root_of(i) == i) ++fans[surface.triangle[i / 3].corner[i % 3]];
  return std::count_if(fans.begin(), fans.end(), [](const auto& fan) { return fan.second > 1; });
}

inline double surface_volume(const PieceSurface& surface) {
  double six = 0;
  for (const auto& t : surface.triangle)
    six += surface.position[t.corner[0]].cross(surface.position[t.corner[1]]).dot(surface.position[t.corner[2]]);
  return six / 6;
}

/// Every tet positive (exactly), inner faces shared by exactly two tets of the piece that look the other way, skin
/// and section faces by one; skin faces lie in their facet's plane; the surface is what the faces say and encloses
/// the piece's volume. Returns the volume.
inline double check_piece(const Pieces& pieces, std::uint32_t piece, const TetMesh& root, const Boundary& boundary) {
  std::map<Triple, int> uses;
  std::size_t not_positive = 0, outer = 0;
  const std::vector<PieceTet> tets = tets_of(pieces, piece, root, boundary);
  double volume = 0;
  for (const PieceTet& tet : tets) {
    std::array<Vec3d, 4> p;
    for (int i = 0; i < 4; ++i) p[i] = pieces.position(root, tet.corner[i]);
    not_positive += orientation(p[0], p[1], p[2], p[3]) <= 0;
    volume += (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) / 6;
    for (int i = 0; i < 4; ++i) {
      const auto& c = facet_corners[i];
      ++uses[turned(tet.corner[c[0]], tet.corner[c[1]], tet.corner[c[2]])];
    }
  }
  EXPECT_EQ(not_positive, 0u) << "tets without volume";
  std::size_t wrong_mates = 0, wrong_places = 0;
  for (const PieceTet& tet : tets)
    for (int i = 0; i < 4; ++i) {
      const auto& c = facet_corners[i];
      const std::uint32_t a = tet.corner[c[0]], b = tet.corner[c[1]], d = tet.corner[c[2]];
      const auto back = uses.find(turned(a, d, b));
      const int mates = back == uses.end() ? 0 : back->second;
      const bool interface = tet.face[i].is_skin() && boundary.behind[tet.face[i].facet()].exists();
      if (uses[turned(a, b, d)] != 1) ++wrong_mates;
      if (!interface && mates != (tet.face[i].is_interior() ? 1 : 0)) ++wrong_mates;
      outer += mates == 0;
      if (tet.face[i].is_skin()) {
        const auto& facet = boundary.corner[tet.face[i].facet()];
        const Vec3d& o = root.position[facet[0]];
        const Vec3d normal = (root.position[facet[1]] - o).cross(root.position[facet[2]] - o).normalized();
        for (const std::uint32_t v : {a, b, d})
          wrong_places += std::abs(normal.dot(pieces.position(root, VertexId(v)) - o)) > 1e-9;
      }
    }
  EXPECT_EQ(wrong_mates, 0u) << "faces that do not fit their tags";
  EXPECT_EQ(wrong_places, 0u) << "skin faces off their facet";
  const PieceSurface surface = surface_of(pieces, piece, root, boundary);
  EXPECT_EQ(surface.triangle.size(), outer);
  EXPECT_NEAR(surface_volume(surface), volume, 1e-12 * (1 + volume));
  EXPECT_NEAR(measure(pieces, piece, root).volume, volume, 1e-12 * (1 + volume));
  return volume;
}

/// check_piece for all; the surfaces' edges; the volumes' sum against the root's, relative 1e-12.
inline void check_pieces(const Pieces& pieces, const TetMesh& root, const Boundary& boundary, bool manifold = true) {
  validate(pieces, root, boundary);
  double sum = 0, whole = 0;
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    SCOPED_TRACE("piece " + std::to_string(p));
    sum += check_piece(pieces, p, root, boundary);
    if (manifold) {
      const PieceSurface surface = surface_of(pieces, p, root, boundary);
      EXPECT_EQ(bad_edges(surface), 0u);
      EXPECT_EQ(pinched_vertices(surface), 0u);
    }
  }
  for (const TetId t : all_ids<TetId>(root.tet_count())) whole += signed_volume(root, t);
  EXPECT_NEAR(sum, whole, 1e-12 * whole);
}

/// Section faces of a cut: every one must be there twice, once for each half, with the same corners reversed.
inline void check_sections_match(const Pieces& pieces, CutId cut) {
  std::map<Triple, int> uses;
  for (const Piece& piece : pieces.piece)
    for (const CutTet& tet : piece.cut)
      for (int i = 0; i < 4; ++i) {
        const auto& c = facet_corners[i];
        if (tet.face[i] == FaceTag::section(cut))
          ++uses[turned(tet.corner[c[0]], tet.corner[c[1]], tet.corner[c[2]])];
      }
  EXPECT_FALSE(uses.empty());
  for (const auto& [face, count] : uses) {
    const auto back = uses.find(turned(face[0], face[2], face[1]));
    ASSERT_TRUE(count == 1 && back != uses.end() && back->second == 1) << "a section face without its mate";
  }
}

inline bool same_bits(const Pieces& a, const Pieces& b) {
  const auto same_tet = [](const CutTet& x, const CutTet& y) {
    return x.corner == y.corner && x.root == y.root && x.face == y.face;
  };
  if (a.label != b.label || a.piece.size() != b.piece.size() || a.added.size() != b.added.size() ||
      a.added_position != b.added_position || a.added_normal != b.added_normal || a.cut_count != b.cut_count ||
      a.on_section.size() != b.on_section.size())
    return false;
  for (std::size_t i = 0; i < a.added.size(); ++i)
    if (a.added[i].a != b.added[i].a || a.added[i].b != b.added[i].b || a.added[i].cut != b.added[i].cut)
      return false;
  for (std::size_t i = 0; i < a.on_section.size(); ++i)
    if (a.on_section[i].vertex != b.on_section[i].vertex || a.on_section[i].normal != b.on_section[i].normal)
      return false;
  for (std::size_t p = 0; p < a.piece.size(); ++p)
    if (!std::equal(a.piece[p].cut.begin(), a.piece[p].cut.end(), b.piece[p].cut.begin(), b.piece[p].cut.end(),
                    same_tet) ||
        a.piece[p].placement.translation != b.piece[p].placement.translation)
      return false;
  return true;
}

/// The message of the InvalidInput that `body` throws; empty when it throws none.
template <class Body>
std::string refusal(const Body& body) {
  try {
    body();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

} // namespace pith
