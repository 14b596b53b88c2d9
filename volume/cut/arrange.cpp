// Keeping and moving pieces.
#include "volume/cut/arrange.h"

#include "volume/base/error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

namespace pith {
namespace {

std::string text_of(std::size_t number) { return std::to_string(number); }

} // namespace

void keep_pieces(Pieces& pieces, const TetMesh& root, std::span<const std::uint32_t> keep) {
  std::vector<std::uint32_t> number(pieces.piece.size(), Pieces::was_cut);
  if (keep.empty()) throw InvalidInput("keep", "no piece is kept", "name at least one piece");
  for (std::size_t k = 0; k < keep.size(); ++k) {
    if (keep[k] >= pieces.piece.size())
      throw InvalidInput("keep", "there is no piece " + text_of(keep[k]) + " among " + text_of(pieces.piece.size()),
                         "name pieces from 0 to " + text_of(pieces.piece.size() - 1));
    if (number[keep[k]] != Pieces::was_cut)
      throw InvalidInput("keep", "piece " + text_of(keep[k]) + " is named twice", "name each piece once");
    number[keep[k]] = static_cast<std::uint32_t>(k);
  }

  // Added vertices that a kept tet uses, and those between which they lie.
  const std::uint32_t first = static_cast<std::uint32_t>(root.vertex_count());
  std::vector<bool> used(pieces.added.size(), false);
  for (const std::uint32_t p : keep)
    for (const CutTet& tet : pieces.piece[p].cut)
      for (const VertexId v : tet.corner)
        if (v >= first) used[v - first] = true;
  for (std::size_t i = used.size(); i-- > 0;)
    if (used[i])
      for (const VertexId end : {pieces.added[i].a, pieces.added[i].b})
        if (end >= first) used[end - first] = true;

  Pieces kept;
  kept.root_vertex_count = pieces.root_vertex_count;
  kept.cut_count = pieces.cut_count;
  std::vector<VertexId> renumbered(used.size());
  const auto now = [&](VertexId v) { return v < first ? v : renumbered[v - first]; };
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    renumbered[i] = VertexId(first + kept.added.size());
    kept.added.push_back({now(pieces.added[i].a), now(pieces.added[i].b), pieces.added[i].cut});
    kept.added_position.push_back(pieces.added_position[i]);
    kept.added_normal.push_back(pieces.added_normal[i]);
  }
  for (const SectionNormal& known : pieces.on_section)
    if (const VertexId v = now(known.vertex); v.exists()) kept.on_section.push_back({v, known.cut, known.normal});
  kept.label = pieces.label;
  for (std::uint32_t& label : kept.label)
    if (label != Pieces::was_cut) label = number[label];
  kept.piece.reserve(keep.size());
  for (const std::uint32_t p : keep) {
    kept.piece.push_back(pieces.piece[p]);
    for (CutTet& tet : kept.piece.back().cut)
      for (VertexId& v : tet.corner) v = now(v);
  }
  pieces = std::move(kept);
}

void spread(Pieces& pieces, const CutResult& result, const TetMesh& root, double distance) {
  if (!std::isfinite(distance)) throw InvalidInput("spread", "the distance is not finite", "give millimetres");
  if (result.origin.size() != pieces.piece.size())
    throw InvalidInput("spread",
                       "the cut's result has " + std::to_string(result.origin.size()) + " pieces of " +
                           std::to_string(pieces.piece.size()),
                       "spread right after the cut");
  // The sections of right halves look to the left.
  Vec3d normal = Vec3d::Zero();
  double area = 0;
  const FaceTag tag = FaceTag::section(CutId(pieces.cut_count - 1));
  for (std::size_t p = 0; p < pieces.piece.size(); ++p) {
    if (result.origin[p].side <= 0) continue;
    for (const CutTet& tet : pieces.piece[p].cut)
      for (int i = 0; i < 4; ++i) {
        if (tet.face[i] != tag) continue;
        const auto& c = facet_corners[i];
        const Vec3d& at = pieces.position(root, tet.corner[c[0]]);
        const Vec3d facet =
            (pieces.position(root, tet.corner[c[1]]) - at).cross(pieces.position(root, tet.corner[c[2]]) - at);
        normal -= pieces.piece[p].placement.rotation * facet;
        area += facet.norm();
      }
  }
  if (!(normal.norm() > 1e-6 * area))
    throw InvalidInput("spread", "the section has no mean normal: it is closed, or nothing was cut",
                       "move the pieces one by one");
  const Vec3d step = 0.5 * distance * normal.normalized();
  for (std::size_t p = 0; p < pieces.piece.size(); ++p)
    pieces.piece[p].placement.translation += result.origin[p].side * step;
}

void explode(Pieces& pieces, const TetMesh& root, double part) {
  if (!std::isfinite(part)) throw InvalidInput("explode", "the part is not finite", "give a number such as 0.5");
  std::vector<Vec3d> middle;
  Vec3d sum = Vec3d::Zero();
  double volume = 0;
  for (const PieceMeasure& measured : measures_of(pieces, root)) {
    middle.push_back(pieces.piece[middle.size()].placement(measured.centroid));
    sum += measured.volume * middle.back();
    volume += measured.volume;
  }
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p)
    pieces.piece[p].placement.translation += part * (middle[p] - sum / volume);
}

void drop(Pieces& pieces, const TetMesh& root, double height) {
  if (!std::isfinite(height)) throw InvalidInput("drop", "the height is not finite", "give millimetres");
  std::vector<double> lowest(pieces.piece.size(), std::numeric_limits<double>::infinity());
  const auto look = [&](std::uint32_t p, const std::array<VertexId, 4>& corner) {
    for (const VertexId v : corner)
      lowest[p] = std::min(lowest[p], pieces.piece[p].placement(pieces.position(root, v)).z());
  };
  for (const TetId t : all_ids<TetId>(root.tet_count()))
    if (const std::uint32_t p = pieces.label[t]; p != Pieces::was_cut) look(p, root.corner[t]);
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    for (const CutTet& tet : pieces.piece[p].cut) look(p, tet.corner);
    if (std::isfinite(lowest[p])) pieces.piece[p].placement.translation.z() += height - lowest[p];
  }
}

} // namespace pith
