#include "volume/mesh/facet_tree.h"

#include <algorithm>
#include <numeric>

namespace pith {

NearestFacet closest_point(const std::array<Vec3d, 3>& triangle, const Vec3d& x) {
  const Vec3d &a = triangle[0], &b = triangle[1], &c = triangle[2];
  const auto result = [&](double u, double v, double w) {
    NearestFacet nearest;
    nearest.barycentric = {u, v, w};
    nearest.point = u * a + v * b + w * c;
    nearest.squared_distance = (nearest.point - x).squaredNorm();
    return nearest;
  };
  const Vec3d ab = b - a, ac = c - a, ax = x - a;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax);
  if (d1 <= 0 && d2 <= 0) return result(1, 0, 0);
  const Vec3d bx = x - b;
  const double d3 = ab.dot(bx), d4 = ac.dot(bx);
  if (d3 >= 0 && d4 <= d3) return result(0, 1, 0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 - d3 > 0) {
    const double v = d1 / (d1 - d3);
    return result(1 - v, v, 0);
  }
  const Vec3d cx = x - c;
  const double d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d6 >= 0 && d5 <= d6) return result(0, 0, 1);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 - d6 > 0) {
    const double w = d2 / (d2 - d6);
    return result(1 - w, 0, w);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && (d4 - d3) + (d5 - d6) > 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return result(0, 1 - w, w);
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return result(1, 0, 0);
  return result(1 - vb / sum - vc / sum, vb / sum, vc / sum);
}

FacetTree::FacetTree(std::vector<std::array<Vec3d, 3>> triangles) : triangle_(std::move(triangles)) {
  order_.resize(triangle_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vec3d> center(triangle_.size());
  for (std::size_t i = 0; i < triangle_.size(); ++i)
    center[i] = (triangle_[i][0] + triangle_[i][1] + triangle_[i][2]) / 3;
  if (!triangle_.empty()) build(0, static_cast<std::uint32_t>(triangle_.size()), center);
}

std::uint32_t FacetTree::build(std::uint32_t begin, std::uint32_t end, const std::vector<Vec3d>& center) {
  const std::uint32_t index = static_cast<std::uint32_t>(node_.size());
  node_.emplace_back();
  Box box, centers;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const Vec3d& corner : triangle_[order_[i]]) box.add(corner);
    centers.add(center[order_[i]]);
  }
  if (end - begin <= 4) {
    node_[index] = {box, begin, end, true};
    return index;
  }
  int axis = 0;
  centers.extent().maxCoeff(&axis);
  const std::uint32_t middle = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair(center[a][axis], a) < std::pair(center[b][axis], b);
                   });
  const std::uint32_t left = build(begin, middle, center);
  const std::uint32_t right = build(middle, end, center);
  node_[index] = {box, left, right, false};
  return index;
}

namespace {

double squared_distance(const Box& box, const Vec3d& x) {
  return (box.low - x).cwiseMax(x - box.high).cwiseMax(0).squaredNorm();
}

} // namespace

NearestFacet FacetTree::nearest(const Vec3d& x, std::span<const std::int32_t> group, std::int32_t wanted) const {
  NearestFacet best;
  if (node_.empty()) return best;
  std::array<std::pair<double, std::uint32_t>, 128> stack;
  std::size_t top = 0;
  stack[top++] = {squared_distance(node_[0].box, x), 0};
  while (top > 0) {
    const auto [distance, index] = stack[--top];
    if (distance > best.squared_distance) continue;
    const Node& node = node_[index];
    if (node.leaf) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const std::uint32_t facet = order_[i];
        if (!group.empty() && group[facet] != wanted) continue;
        NearestFacet candidate = closest_point(triangle_[facet], x);
        candidate.facet = facet;
        if (candidate.squared_distance < best.squared_distance ||
            (candidate.squared_distance == best.squared_distance && facet < best.facet))
          best = candidate;
      }
    } else {
      std::pair<double, std::uint32_t> near{squared_distance(node_[node.begin].box, x), node.begin};
      std::pair<double, std::uint32_t> far{squared_distance(node_[node.end].box, x), node.end};
      if (far.first < near.first) std::swap(near, far);
      stack[top++] = far;
      stack[top++] = near;
    }
  }
  return best;
}

} // namespace pith
