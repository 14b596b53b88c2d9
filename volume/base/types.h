#pragma once
// Vectors, strong ids and the arrays that they index. Lengths are millimetres, angles radians.
#include "volume/base/large_array.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace pith {

using Vec2d = Eigen::Vector2d;
using Vec3d = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Mat3d = Eigen::Matrix3d;

/// An index that cannot be mistaken for another kind of index. It reads as a plain number and is made from one only
/// explicitly. `none` stands for "no such element".
template <class Tag>
struct Id {
  std::uint32_t value = std::numeric_limits<std::uint32_t>::max();

  constexpr Id() = default;
  template <class Integer>
    requires std::is_integral_v<Integer>
  explicit constexpr Id(Integer index) : value(static_cast<std::uint32_t>(index)) {}
  constexpr operator std::uint32_t() const { return value; }
  constexpr bool exists() const { return value != std::numeric_limits<std::uint32_t>::max(); }
};

using VertexId = Id<struct VertexTag>;
using TriangleId = Id<struct TriangleTag>; ///< a triangle of an input surface
using TetId = Id<struct TetTag>;
using FacetId = Id<struct FacetTag>; ///< a boundary facet of a tet mesh
using CutId = Id<struct CutTag>;     ///< a cut, in the order in which the cuts were made

/// A vector that is indexed by one kind of id only.
template <class Index, class T>
class Indexed : public LargeArray<T> {
public:
  using LargeArray<T>::vector;
  using reference = typename LargeArray<T>::reference;
  using const_reference = typename LargeArray<T>::const_reference;
  reference operator[](Index i) { return LargeArray<T>::operator[](i.value); }
  const_reference operator[](Index i) const { return LargeArray<T>::operator[](i.value); }
};

template <class T> using PerVertex = Indexed<VertexId, T>;
template <class T> using PerTriangle = Indexed<TriangleId, T>;
template <class T> using PerTet = Indexed<TetId, T>;
template <class T> using PerFacet = Indexed<FacetId, T>;

/// All ids 0 .. count − 1, to loop over: `for (TetId t : all_ids<TetId>(mesh.tet_count()))`.
template <class Index>
struct IdRange {
  struct Iterator {
    std::uint32_t at;
    Index operator*() const { return Index(at); }
    Iterator& operator++() { return ++at, *this; }
    bool operator!=(const Iterator& other) const { return at != other.at; }
  };
  std::uint32_t count;
  Iterator begin() const { return {0}; }
  Iterator end() const { return {count}; }
};
template <class Index>
IdRange<Index> all_ids(std::size_t count) {
  return {static_cast<std::uint32_t>(count)};
}

/// An axis-aligned box; empty until something is added.
struct Box {
  Vec3d low = Vec3d::Constant(std::numeric_limits<double>::infinity());
  Vec3d high = Vec3d::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void add(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  bool empty() const { return !(low.x() <= high.x()); }
  Vec3d extent() const { return empty() ? Vec3d::Zero() : Vec3d(high - low); }
  Vec3d center() const { return 0.5 * (low + high); }
  double diagonal() const { return extent().norm(); }
  bool contains(const Vec3d& p) const { return (p.array() >= low.array()).all() && (p.array() <= high.array()).all(); }
};

/// A rigid motion: rest point x → rotation · x + translation.
struct Rigid {
  Mat3d rotation = Mat3d::Identity();
  Vec3d translation = Vec3d::Zero();

  Vec3d operator()(const Vec3d& x) const { return rotation * x + translation; }
  Vec3d inverse(const Vec3d& y) const { return rotation.transpose() * (y - translation); }
  bool identity() const { return rotation == Mat3d::Identity() && translation == Vec3d::Zero(); }
};

} // namespace pith
