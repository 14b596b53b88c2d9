#pragma once
// Cutting pieces by a level set: marching tetrahedra on below/on/above signs, both halves at once.
#include "volume/cut/level_set.h"
#include "volume/cut/piece.h"

namespace pith {

struct CutOptions {
  /// Which pieces to cut; empty: all.
  std::vector<std::uint32_t> only;
  /// Values within this fraction of an edge from a vertex are taken as exactly on it, and new vertices keep this far
  /// from the ends of their edges: better tets for a section that is off by at most that fraction. From 0 to 0.4;
  /// below 1e-6 counts as 1e-6, so that no tet degenerates. Up to 0.01, planes stay flat: they are off by at most a
  /// millionth of the solid's diagonal.
  double snap = 0.01;
  /// Both halves are manifold (if the piece was), also where the field vanishes at vertices, edges and faces in any
  /// pattern: a vertex at which a half would hang together by a vertex or an edge alone counts as beside the zero
  /// set, not on it. false: every vertex of value 0 is on the section, and halves may be pinched.
  bool manifold = true;
};

struct CutResult {
  /// For each piece after the cut: the piece it came from and its side (−1 left, +1 right, 0 not touched).
  struct Origin {
    std::uint32_t piece;
    int side;
  };
  std::vector<Origin> origin;
  std::size_t tets_cut = 0; ///< tets that the level set passed through and that were subdivided
};

/// Cuts the pieces of one root. It knows where the root's tets lie, so that a field is evaluated, and tets are looked
/// at, only where the level set may pass (LevelSet::side_of_ball): keep one for as long as a root is being cut. A cut
/// at a time; the results are those of the functions below, bit for bit.
class Cutter {
public:
  /// Keeps references to both. O(n log n): 0.13 s for a million tets.
  Cutter(const TetMesh& root, const Boundary& boundary);
  ~Cutter();
  Cutter(Cutter&&) noexcept;

  /// Cuts every piece p by φ(placement_p · x). A piece that lies on one side stays as it is and keeps its number; one
  /// that is cut becomes its left half (φ < 0; same number) and its right half (appended, in the order of the
  /// pieces). New vertices are computed once per (edge, cut, placement), so both halves, pieces that stand together
  /// and all later cuts share their bits; the root's colours need no copy. Tets that lie on the section altogether go
  /// to the left. A face that lies on the section between two halves is tagged as section of this cut; the skin,
  /// interfaces between regions included, keeps its tags. All tets have a positive volume, by the exact predicate.
  /// Errors: InvalidInput when φ is not finite at some vertex, an option is out of range, or nothing is cut at all;
  /// SolverFailure when tets that earlier cuts left are too thin for the precision of numbers. The pieces are
  /// unchanged then. Cost: φ at the vertices near its zero set, one label per root tet, and work in proportion to the
  /// tets cut and to the cut tets of the pieces that fall in two.
  CutResult cut(Pieces& pieces, const LevelSet& level_set, const CutOptions& options = {});

  /// The same where the values are known already: `value[v]` for every vertex id of `pieces` (root, then added). With
  /// a level set, new vertices are placed at its true zeros; without one, where the linear interpolation of the
  /// values is zero. Cost: one pass over the tets.
  CutResult cut_by_values(Pieces& pieces, std::span<const double> value, const LevelSet* level_set = nullptr,
                          const CutOptions& options = {});

  /// One that knows nothing beforehand and passes over all tets: made at once, for a root that is not cut again soon.
  static Cutter for_one_cut(const TetMesh& root, const Boundary& boundary);

private:
  struct Parts;
  explicit Cutter(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// One cut by Cutter::for_one_cut.
CutResult cut(Pieces& pieces, const TetMesh& root, const Boundary& boundary, const LevelSet& level_set,
              const CutOptions& options = {});
CutResult cut_by_values(Pieces& pieces, const TetMesh& root, const Boundary& boundary, std::span<const double> value,
                        const LevelSet* level_set = nullptr, const CutOptions& options = {});

} // namespace pith
