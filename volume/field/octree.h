#pragma once
// An octree over points in which neighbours differ little in size, with the near and far boxes of each box (private
// to the field module; Carrier, Greengard, Rokhlin 1988).
#include "volume/base/types.h"

#include <span>

namespace pith {

struct OctreeOptions {
  std::size_t leaf_points = 100; ///< a box with more is divided
  int deepest = 16;              ///< levels below the root, at most 20
};

struct OctreeBox {
  static constexpr std::uint32_t none = ~0u;
  std::array<std::int32_t, 3> at{}; ///< place in the grid of its level
  int level = 0;                    ///< the root's is 0
  std::uint32_t parent = none;      ///< before its children
  std::uint32_t child = none;       ///< first of eight in a row: bit 0 of the rest is high x, 1 high y, 2 high z
  std::uint32_t begin = 0, end = 0; ///< points, in the tree's order
  std::uint32_t slot_begin = 0, slot_end = 0; ///< the same in the padded order: every leaf's slots are whole lanes

  bool leaf() const { return child == none; }
  bool holds_points() const { return begin != end; }
};

/// A far box of the same level, and its place less the other's: each −3 … 3.
struct FarBox {
  std::uint32_t box;
  std::uint32_t offset; ///< ((x + 3) · 7 + (y + 3)) · 7 + (z + 3)
};

/// Rows of one list per box.
template <class T>
struct BoxLists {
  std::vector<std::uint32_t> begin = {0};
  std::vector<T> entry;
  std::span<const T> operator[](std::uint32_t box) const {
    return std::span<const T>(entry).subspan(begin[box], begin[box + 1] - begin[box]);
  }
};

/// The root is a cube about the points, twice their extent wide, so that places around them have a leaf too.
/// For every leaf, each point of the tree belongs to a box of near(leaf) or to one of far(leaf) or far(an ancestor);
/// the near boxes are leaves, or have leaves for children. Only boxes with points are listed.
class Octree {
public:
  explicit Octree(std::span<const Vec3d> points, const OctreeOptions& options = {});

  const std::vector<OctreeBox>& boxes() const { return box_; }
  std::span<const std::uint32_t> near(std::uint32_t box) const { return near_[box]; }
  std::span<const FarBox> far(std::uint32_t box) const { return far_[box]; }
  const std::vector<std::uint32_t>& order() const { return order_; } ///< the input's numbers, in the tree's order
  const std::vector<std::uint32_t>& slot() const { return slot_; }   ///< of each point of the input
  std::size_t slots() const { return box_[0].slot_end; }

  double half(const OctreeBox& box) const { return half_[box.level]; }
  Vec3d center(const OctreeBox& box) const;
  bool contains(const Vec3d& x) const;         ///< whether the root does
  std::uint32_t leaf_at(const Vec3d& x) const; ///< x inside the root

private:
  void divide(std::uint32_t box, std::span<const std::uint64_t> code);
  void grade(std::span<const std::uint64_t> code);
  void number_slots();
  void list_boxes();

  Vec3d low_ = Vec3d::Zero();
  std::vector<double> half_; ///< of a box, by level
  std::vector<OctreeBox> box_;
  BoxLists<std::uint32_t> near_;
  BoxLists<FarBox> far_;
  std::vector<std::uint32_t> order_, slot_;
};

} // namespace pith
