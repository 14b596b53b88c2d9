#pragma once
// Random points inside a solid, and weighted quantiles of what is found there: what the measures share.
#include "volume/mesh/tet_mesh.h"

#include <functional>
#include <vector>

namespace pith {

/// A point and where it lies.
struct VolumePoint {
  TetId tet;
  std::array<double, 4> barycentric{};
  Vec3d position = Vec3d::Zero(); ///< rest space, mm
};

/// Points uniform over the volume of the tets of a region (−1: all) that `takes` accepts (none: every one). Each
/// point is a function of (seed, number) alone. Refers to the mesh.
class VolumePoints {
public:
  explicit VolumePoints(const TetMesh& mesh, std::int32_t region = -1, const std::function<bool(TetId)>& takes = {});

  double volume() const { return total_; } ///< mm³; 0: there is nothing, and no point may be asked for
  VolumePoint point(std::uint64_t seed, std::uint64_t number) const;

private:
  const TetMesh& mesh_;
  std::vector<TetId> tet_;
  std::vector<double> volume_up_to_;
  double total_ = 0;
};

/// Collects values with weights and answers quantiles: the smallest value below or at which lies at least the asked
/// part of the weight. The order of adding does not matter to the answer beyond rounding.
class WeightedQuantiles {
public:
  void add(double value, double weight) {
    if (weight > 0) entry_.push_back({value, weight});
  }
  std::size_t count() const { return entry_.size(); }
  /// 0 ≤ part ≤ 1; NaN when nothing was added. The first call after an addition sorts: O(n log n).
  double at(double part);

private:
  struct Entry {
    double value, weight;
  };
  std::vector<Entry> entry_;
  std::size_t sorted_ = 0;
  double total_ = 0;
};

/// The two quantiles that the measures tell.
struct Spread {
  double median = 0, p95 = 0;
};
Spread spread_of(WeightedQuantiles& quantiles);

} // namespace pith
