// An adaptive octree with lists of near and far boxes: Carrier, Greengard, Rokhlin: A fast adaptive multipole
// algorithm for particle simulations, 1988.
//
// Departure: the tree is graded, so that the lists of boxes of unequal size (their W and X) are short and are summed
// directly. Grading: where a box has grandchildren, its 26 neighbours are divided too.
#include "volume/field/octree.h"

#include "volume/base/morton.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace pith {
namespace {

constexpr int finest = 20;
constexpr std::size_t lane_slots = 8;

std::uint64_t place_key(int level, const std::array<std::int32_t, 3>& at) {
  return (std::uint64_t(1) << (3 * level)) | morton_code(at);
}

std::int32_t cell_of(double from_low, double width, std::int32_t cells) {
  return std::clamp(static_cast<std::int32_t>(from_low / width), 0, cells - 1);
}

} // namespace

Octree::Octree(std::span<const Vec3d> points, const OctreeOptions& options) {
  Box bounds;
  for (const Vec3d& p : points) bounds.add(p);
  const double extent = bounds.extent().maxCoeff(), side = extent > 0 ? 2 * extent : 1;
  low_ = bounds.center() - Vec3d::Constant(0.5 * side);
  for (int level = 0; level <= finest; ++level) half_.push_back(std::ldexp(0.5 * side, -level));

  std::vector<std::uint64_t> unordered(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<std::int32_t, 3> at;
    for (int a = 0; a < 3; ++a) at[a] = cell_of(points[i][a] - low_[a], 2 * half_[finest], 1 << finest);
    unordered[i] = morton_code(at);
  }
  order_.resize(points.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return unordered[a] != unordered[b] ? unordered[a] < unordered[b] : a < b;
  });
  std::vector<std::uint64_t> code(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) code[i] = unordered[order_[i]];

  box_.emplace_back();
  box_[0].end = static_cast<std::uint32_t>(points.size());
  const int deepest = std::min(options.deepest, finest);
  for (std::uint32_t b = 0; b < box_.size(); ++b)
    if (box_[b].end - box_[b].begin > options.leaf_points && box_[b].level < deepest) divide(b, code);
  grade(code);
  number_slots();
  list_boxes();
}

void Octree::divide(std::uint32_t parent, std::span<const std::uint64_t> code) {
  const std::uint32_t first = static_cast<std::uint32_t>(box_.size());
  box_[parent].child = first;
  const OctreeBox above = box_[parent];
  const int shift = 3 * (finest - above.level - 1);
  std::uint32_t begin = above.begin;
  for (std::uint32_t k = 0; k < 8; ++k) {
    OctreeBox box{.at = {}, .level = above.level + 1, .parent = parent, .begin = begin};
    for (int a = 0; a < 3; ++a) box.at[a] = 2 * above.at[a] + static_cast<std::int32_t>(k >> a & 1);
    const std::uint64_t last = (morton_code(box.at) + 1) << shift; // codes of the box's points lie below
    box.end = static_cast<std::uint32_t>(std::lower_bound(code.begin() + begin, code.begin() + above.end, last) -
                                         code.begin());
    begin = box.end;
    box_.push_back(box);
  }
}

void Octree::grade(std::span<const std::uint64_t> code) {
  std::unordered_map<std::uint64_t, std::uint32_t> place;
  std::vector<std::vector<std::uint32_t>> by_level(finest + 1);
  const auto enter = [&](std::uint32_t b) {
    place[place_key(box_[b].level, box_[b].at)] = b;
    by_level[box_[b].level].push_back(b);
  };
  for (std::uint32_t b = 0; b < box_.size(); ++b) enter(b);
  const auto divide_and_enter = [&](std::uint32_t b) {
    divide(b, code);
    for (std::uint32_t k = 0; k < 8; ++k) enter(box_[b].child + k);
  };
  for (int level = finest; level-- > 0;)
    for (std::size_t at = 0; at < by_level[level].size(); ++at) {
      const OctreeBox box = box_[by_level[level][at]];
      if (box.leaf()) continue;
      bool grandchildren = false;
      for (std::uint32_t k = 0; k < 8; ++k) grandchildren = grandchildren || !box_[box.child + k].leaf();
      if (!grandchildren) continue;
      for (int n = 0; n < 27; ++n) {
        const std::array<std::int32_t, 3> beside = {box.at[0] + n % 3 - 1, box.at[1] + n / 3 % 3 - 1,
                                                    box.at[2] + n / 9 - 1};
        if (std::any_of(beside.begin(), beside.end(), [&](std::int32_t i) { return i < 0 || i >= 1 << level; }))
          continue;
        int present = level;
        const auto key = [&](int l) {
          const int up = level - l;
          return place_key(l, {beside[0] >> up, beside[1] >> up, beside[2] >> up});
        };
        while (!place.contains(key(present))) --present;
        for (; present < level; ++present) divide_and_enter(place.at(key(present)));
        if (box_[place.at(key(level))].leaf()) divide_and_enter(place.at(key(level)));
      }
    }
}

void Octree::number_slots() {
  slot_.resize(order_.size());
  std::uint32_t slot = 0;
  std::vector<std::uint32_t> stack = {0};
  while (!stack.empty()) { // depth first: leaves in the tree's order
    const std::uint32_t b = stack.back();
    stack.pop_back();
    OctreeBox& box = box_[b];
    if (!box.leaf()) {
      for (std::uint32_t k = 8; k-- > 0;) stack.push_back(box.child + k);
      continue;
    }
    box.slot_begin = slot;
    for (std::uint32_t i = box.begin; i < box.end; ++i) slot_[order_[i]] = slot++;
    slot = static_cast<std::uint32_t>((slot + lane_slots - 1) / lane_slots * lane_slots);
    box.slot_end = slot;
  }
  for (std::uint32_t b = static_cast<std::uint32_t>(box_.size()); b-- > 0;)
    if (!box_[b].leaf()) {
      box_[b].slot_begin = box_[box_[b].child].slot_begin;
      box_[b].slot_end = box_[box_[b].child + 7].slot_end;
    }
}

void Octree::list_boxes() {
  // Boxes were appended: parents stand before their children, so one pass downwards will do.
  std::vector<std::vector<std::uint32_t>> near(box_.size());
  std::vector<std::vector<FarBox>> far(box_.size());
  if (box_[0].holds_points()) near[0] = {0};
  for (std::uint32_t t = 1; t < box_.size(); ++t) {
    const OctreeBox& box = box_[t];
    for (const std::uint32_t b : near[box.parent]) {
      if (box_[b].leaf()) {
        near[t].push_back(b);
        continue;
      }
      for (std::uint32_t c = box_[b].child; c < box_[b].child + 8; ++c) {
        const OctreeBox& other = box_[c];
        if (!other.holds_points()) continue;
        int apart = 0;
        std::uint32_t offset = 0;
        for (int a = 0; a < 3; ++a) {
          const std::int32_t difference = other.at[a] - box.at[a];
          apart = std::max(apart, std::abs(difference));
          offset = offset * 7 + static_cast<std::uint32_t>(difference + 3);
        }
        if (apart <= 1)
          near[t].push_back(c);
        else
          far[t].push_back({c, offset});
      }
    }
  }
  for (std::uint32_t b = 0; b < box_.size(); ++b) {
    near_.entry.insert(near_.entry.end(), near[b].begin(), near[b].end());
    near_.begin.push_back(static_cast<std::uint32_t>(near_.entry.size()));
    far_.entry.insert(far_.entry.end(), far[b].begin(), far[b].end());
    far_.begin.push_back(static_cast<std::uint32_t>(far_.entry.size()));
  }
}

Vec3d Octree::center(const OctreeBox& box) const {
  const double h = half(box);
  return low_ + Vec3d((2 * box.at[0] + 1) * h, (2 * box.at[1] + 1) * h, (2 * box.at[2] + 1) * h);
}

bool Octree::contains(const Vec3d& x) const {
  const double side = 2 * half_[0];
  for (int a = 0; a < 3; ++a)
    if (!(x[a] >= low_[a] && x[a] <= low_[a] + side)) return false;
  return true;
}

std::uint32_t Octree::leaf_at(const Vec3d& x) const {
  std::array<std::int32_t, 3> at;
  for (int a = 0; a < 3; ++a) at[a] = cell_of(x[a] - low_[a], 2 * half_[finest], 1 << finest);
  std::uint32_t b = 0;
  while (!box_[b].leaf()) {
    const int shift = finest - box_[b].level - 1;
    b = box_[b].child + ((at[0] >> shift & 1) | (at[1] >> shift & 1) << 1 | (at[2] >> shift & 1) << 2);
  }
  return b;
}

} // namespace pith
