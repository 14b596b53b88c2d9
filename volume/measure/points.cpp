#include "volume/measure/points.h"

#include "volume/base/random.h"

#include <algorithm>
#include <limits>

namespace pith {

namespace {
constexpr std::uint64_t stage = 0x706f696e74; // of random numbers
}

VolumePoints::VolumePoints(const TetMesh& mesh, std::int32_t region, const std::function<bool(TetId)>& takes)
    : mesh_(mesh) {
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    if ((region >= 0 && mesh.region[t] != region) || (takes && !takes(t))) continue;
    tet_.push_back(t);
    volume_up_to_.push_back(total_ += signed_volume(mesh, t));
  }
}

VolumePoint VolumePoints::point(std::uint64_t seed, std::uint64_t number) const {
  Random random(seed, stage, number);
  const auto found = std::upper_bound(volume_up_to_.begin(), volume_up_to_.end(), random.uniform() * total_);
  VolumePoint point;
  point.tet = tet_[std::min<std::size_t>(found - volume_up_to_.begin(), tet_.size() - 1)];
  // Uniform in a tet: the gaps between three sorted uniform numbers.
  std::array<double, 3> cut{random.uniform(), random.uniform(), random.uniform()};
  std::sort(cut.begin(), cut.end());
  point.barycentric = {cut[0], cut[1] - cut[0], cut[2] - cut[1], 1 - cut[2]};
  for (int k = 0; k < 4; ++k) point.position += point.barycentric[k] * mesh_.position[mesh_.corner[point.tet][k]];
  return point;
}

double WeightedQuantiles::at(double part) {
  if (entry_.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (sorted_ != entry_.size()) {
    std::sort(entry_.begin(), entry_.end(), [](const Entry& a, const Entry& b) {
      return a.value < b.value || (a.value == b.value && a.weight < b.weight);
    });
    sorted_ = entry_.size();
    total_ = 0;
    for (const Entry& e : entry_) total_ += e.weight;
  }
  double sum = 0;
  for (const Entry& e : entry_)
    if ((sum += e.weight) >= part * total_) return e.value;
  return entry_.back().value;
}

Spread spread_of(WeightedQuantiles& quantiles) { return {quantiles.at(0.5), quantiles.at(0.95)}; }

} // namespace pith
