// Measures of pieces, and the piece at a point.
#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/cut/piece.h"
#include "volume/mesh/orientation.h"
#include "volume/mesh/region_measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

namespace pith {
namespace {

using Corners = std::array<Vec3d, 4>;

double signed_volume(const Corners& p) { return (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) / 6; }

/// The smallest of the four barycentric coordinates of x.
double smallest_barycentric(const Corners& p, const Vec3d& x) {
  const double whole = signed_volume(p);
  double smallest = 1;
  for (int i = 0; i < 4; ++i) {
    Corners part = p;
    part[i] = x;
    smallest = std::min(smallest, signed_volume(part) / whole);
  }
  return smallest;
}

PieceMeasure measure_of(const Pieces& pieces, const TetMesh& root, std::span<const TetId> whole,
                        std::span<const CutTet> cut) {
  PieceMeasure result;
  result.whole_tets = whole.size();
  result.cut_tets = cut.size();
  const std::size_t tets = whole.size() + cut.size();
  const auto corners_of = [&](std::size_t i) {
    const auto& corner = i < whole.size() ? root.corner[whole[i]] : cut[i - whole.size()].corner;
    return Corners{pieces.position(root, corner[0]), pieces.position(root, corner[1]),
                   pieces.position(root, corner[2]), pieces.position(root, corner[3])};
  };
  std::vector<double> volume(tets);
  parallel_for(tets, 4096, [&](std::size_t i) { volume[i] = signed_volume(corners_of(i)); });
  result.volume = ordered_sum(tets, [&](std::size_t i) { return volume[i]; });
  for (std::size_t i = 0; i < tets; ++i)
    for (const Vec3d& p : corners_of(i)) result.bounds.add(p);
  if (result.volume > 0)
    for (int axis = 0; axis < 3; ++axis)
      result.centroid[axis] =
          ordered_sum(tets,
                      [&](std::size_t i) {
                        const Corners p = corners_of(i);
                        return volume[i] * (p[0][axis] + p[1][axis] + p[2][axis] + p[3][axis]) / 4;
                      }) /
          result.volume;
  std::vector<double> dihedral(cut.size());
  parallel_for(cut.size(), 1024,
               [&](std::size_t i) { dihedral[i] = smallest_dihedral(corners_of(whole.size() + i)); });
  result.minimum_dihedral = std::numbers::pi;
  for (const double angle : dihedral) result.minimum_dihedral = std::min(result.minimum_dihedral, angle);
  return result;
}

} // namespace

PieceMeasure measure(const Pieces& pieces, std::uint32_t piece, const TetMesh& root) {
  if (piece >= pieces.piece.size())
    throw InvalidInput("piece",
                       "there is no piece " + std::to_string(piece) + " among " + std::to_string(pieces.piece.size()),
                       "name one that exists");
  std::vector<TetId> whole;
  for (const TetId t : all_ids<TetId>(root.tet_count()))
    if (pieces.label[t] == piece) whole.push_back(t);
  return measure_of(pieces, root, whole, pieces.piece[piece].cut);
}

std::vector<PieceMeasure> measures_of(const Pieces& pieces, const TetMesh& root) {
  std::vector<std::vector<TetId>> whole(pieces.piece.size());
  for (const TetId t : all_ids<TetId>(root.tet_count()))
    if (pieces.label[t] != Pieces::was_cut) whole[pieces.label[t]].push_back(t);
  std::vector<PieceMeasure> result;
  result.reserve(whole.size());
  for (std::size_t p = 0; p < whole.size(); ++p)
    result.push_back(measure_of(pieces, root, whole[p], pieces.piece[p].cut));
  return result;
}

std::uint32_t piece_at(const Pieces& pieces, const TetMesh& root, TetId owner, const Vec3d& x) {
  if (!owner.exists() || owner.value >= pieces.label.size()) return no_piece;
  if (pieces.label[owner] != Pieces::was_cut) return pieces.label[owner];

  // New vertices are rounded, so that a point on an inner face may miss the tets on both its sides by a hair: then
  // the nearest one, within a relative 1e-9.
  double nearest = -1e-9;
  std::uint32_t found = no_piece;
  for (std::size_t p = 0; p < pieces.piece.size(); ++p)
    for (const CutTet& tet : pieces.piece[p].cut) {
      if (tet.root != owner) continue;
      Corners corner;
      for (int i = 0; i < 4; ++i) corner[i] = pieces.position(root, tet.corner[i]);
      bool inside = true;
      for (int i = 0; i < 4 && inside; ++i) {
        Corners part = corner;
        part[i] = x;
        inside = orientation(part[0], part[1], part[2], part[3]) >= 0;
      }
      if (inside) return static_cast<std::uint32_t>(p);
      if (const double miss = smallest_barycentric(corner, x); miss > nearest) {
        nearest = miss;
        found = static_cast<std::uint32_t>(p);
      }
    }
  return found;
}

} // namespace pith
