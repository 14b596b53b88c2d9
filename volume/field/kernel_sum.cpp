// The fast multipole method with interpolated far fields: Fong, Darve 2009, §2.2, on the graded tree of octree.h.
#include "volume/field/kernel_sum.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace pith {
namespace {

/// Large leaves: summing near boxes directly is cheap, and errors of the far field are smoother.
constexpr std::size_t leaf_points = 300;
/// Targets whose far boxes are translated together: one matrix product per offset up to symmetry.
constexpr std::size_t target_block = 24;

double power(Kernel kernel, double h) { return kernel == Kernel::biharmonic ? h : h * h * h; }

using Matrix = Eigen::MatrixXd;

std::vector<std::vector<std::uint32_t>> boxes_by_level(const Octree& tree) {
  std::vector<std::vector<std::uint32_t>> levels;
  for (std::uint32_t b = 0; b < tree.boxes().size(); ++b) {
    const std::size_t level = static_cast<std::size_t>(tree.boxes()[b].level);
    if (levels.size() <= level) levels.resize(level + 1);
    levels[level].push_back(b);
  }
  return levels;
}

int child_number(const Octree& tree, std::uint32_t box) {
  return static_cast<int>(box - tree.boxes()[tree.boxes()[box].parent].child);
}

} // namespace

KernelSum::KernelSum(Kernel kernel, std::span<const Vec3d> centers)
    : kernel_(kernel), tree_(centers, {.leaf_points = leaf_points}), far_(far_operators(kernel)) {
  for (auto* array : {&x_, &y_, &z_}) array->assign(tree_.slots(), 0.0);
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const std::uint32_t slot = tree_.slot()[i];
    x_[slot] = centers[i].x();
    y_[slot] = centers[i].y();
    z_[slot] = centers[i].z();
  }
}

Vec3d KernelSum::local(const OctreeBox& box, const Vec3d& x) const {
  return (x - tree_.center(box)) / tree_.half(box);
}

std::vector<double> KernelSum::in_slots(std::span<const double> weight) const {
  std::vector<double> slots(tree_.slots(), 0.0);
  for (std::size_t i = 0; i < weight.size(); ++i) slots[tree_.slot()[i]] = weight[i];
  return slots;
}

KernelSum::Moments KernelSum::moments_of(const std::vector<double>& slot_weight) const {
  const auto& boxes = tree_.boxes();
  Moments moments(boxes.size());
  parallel_for(boxes.size(), 8, [&](std::size_t b) {
    moments[b].fill(0);
    if (!boxes[b].leaf()) return;
    const std::uint32_t count = boxes[b].end - boxes[b].begin;
    for (std::uint32_t s = boxes[b].slot_begin; s < boxes[b].slot_begin + count; ++s)
      add_moments(moments[b], local(boxes[b], {x_[s], y_[s], z_[s]}), slot_weight[s]);
  });
  const auto levels = boxes_by_level(tree_);
  for (std::size_t level = levels.size(); level-- > 0;)
    parallel_for(levels[level].size(), 8, [&](std::size_t i) {
      const std::uint32_t b = levels[level][i];
      if (boxes[b].leaf() || !boxes[b].holds_points()) return;
      for (int k = 0; k < 8; ++k)
        if (boxes[boxes[b].child + k].holds_points()) add_child_moments(moments[b], moments[boxes[b].child + k], k);
    });
  return moments;
}

void KernelSum::far_fields(const Moments& moments, std::span<const std::uint32_t> target, Moments& series) const {
  struct Pair {
    FarOperators::Turn turn;
    std::uint32_t column, source;
  };
  const auto& boxes = tree_.boxes();
  std::vector<NodeVector> weights(boxes.size());
  parallel_for(boxes.size(), 16, [&](std::size_t b) {
    if (boxes[b].holds_points()) weights[b] = node_weights(moments[b]);
  });
  parallel_blocks(target.size(), target_block, [&](std::size_t begin, std::size_t end) {
    std::vector<Pair> pairs;
    for (std::size_t i = begin; i < end; ++i)
      for (const FarBox& far : tree_.far(target[i]))
        pairs.push_back({far_.turn[far.offset], static_cast<std::uint32_t>(i - begin), far.box});
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.turn.matrix < b.turn.matrix; });
    std::vector<NodeVector> field(end - begin);
    for (NodeVector& f : field) f.fill(0);
    Matrix turned, moved;
    for (std::size_t first = 0; first < pairs.size();) {
      std::size_t last = first;
      while (last < pairs.size() && pairs[last].turn.matrix == pairs[first].turn.matrix) ++last;
      const std::size_t count = last - first;
      turned.resize(cheb_nodes, count);
      for (std::size_t c = 0; c < count; ++c) {
        const auto& to = far_.permutation[pairs[first + c].turn.permutation];
        const NodeVector& from = weights[pairs[first + c].source];
        double* const column = turned.data() + c * cheb_nodes;
        for (int n = 0; n < cheb_nodes; ++n) column[to[n]] = from[n];
      }
      moved.noalias() = far_.matrix[pairs[first].turn.matrix] * turned;
      for (std::size_t c = 0; c < count; ++c) {
        const auto& to = far_.permutation[pairs[first + c].turn.permutation];
        const double* const column = moved.data() + c * cheb_nodes;
        NodeVector& f = field[pairs[first + c].column];
        for (int n = 0; n < cheb_nodes; ++n) f[n] += column[to[n]];
      }
      first = last;
    }
    for (std::size_t i = begin; i < end; ++i) {
      series[target[i]] = series_through(field[i - begin].data());
      const double scale = power(kernel_, tree_.half(boxes[target[i]]));
      for (double& s : series[target[i]]) s *= scale;
    }
  });
}

KernelSum::Moments KernelSum::series_of(const Moments& moments, const std::vector<std::uint8_t>& target) const {
  const auto& boxes = tree_.boxes();
  std::vector<std::uint8_t> needed = target;
  for (std::uint32_t b = static_cast<std::uint32_t>(boxes.size()); b-- > 1;)
    if (needed[b]) needed[boxes[b].parent] = 1;
  Moments series(boxes.size());
  parallel_for(boxes.size(), 64, [&](std::size_t b) { series[b].fill(0); });
  const auto levels = boxes_by_level(tree_);
  std::vector<std::uint32_t> with_far;
  for (const auto& level : levels)
    for (const std::uint32_t b : level)
      if (needed[b] && !tree_.far(b).empty()) with_far.push_back(b);
  far_fields(moments, with_far, series);
  for (std::size_t level = 1; level < levels.size(); ++level)
    parallel_for(levels[level].size(), 8, [&](std::size_t i) {
      const std::uint32_t b = levels[level][i];
      if (needed[b]) add_parent_series(series[b], series[boxes[b].parent], child_number(tree_, b));
    });
  return series;
}

void KernelSum::at_centers(std::span<const double> weight, std::span<double> result,
                           std::span<const std::uint8_t> wanted) const {
  const auto& boxes = tree_.boxes();
  const std::vector<double> slots = in_slots(weight);
  std::vector<std::uint8_t> target(boxes.size(), 0);
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t b = 0; b < boxes.size(); ++b) {
    if (!boxes[b].leaf()) continue;
    for (std::uint32_t i = boxes[b].begin; i < boxes[b].end && !target[b]; ++i)
      target[b] = wanted.empty() || wanted[tree_.order()[i]];
    if (target[b]) leaves.push_back(b);
  }
  const Moments series = series_of(moments_of(slots), target);
  with_kernel(kernel_, [&]<Kernel kernel>() {
    parallel_for(leaves.size(), 2, [&](std::size_t l) {
      const std::uint32_t b = leaves[l];
      for (std::uint32_t i = boxes[b].begin; i < boxes[b].end; ++i) {
        const std::uint32_t point = tree_.order()[i], slot = tree_.slot()[point];
        if (!wanted.empty() && !wanted[point]) continue;
        const Vec3d x(x_[slot], y_[slot], z_[slot]);
        Lane sum = Lane::Zero();
        for (const std::uint32_t n : tree_.near(b))
          add_kernels<kernel>(centers(), slots.data(), boxes[n].slot_begin, boxes[n].slot_end, x, sum);
        result[point] = sum_of(sum) + series_value(series[b], local(boxes[b], x));
      }
    });
  });
}

void KernelSum::hold(std::span<const double> weight) {
  const auto& boxes = tree_.boxes();
  weight_ = in_slots(weight);
  moments_ = moments_of(weight_);
  std::vector<std::uint8_t> target(boxes.size(), 0);
  for (std::uint32_t b = 0; b < boxes.size(); ++b) target[b] = boxes[b].leaf();
  series_ = series_of(moments_, target);
}

/// Calls near(box) for boxes to sum directly, and far(box) for those that act through their nodes.
template <class NearBox, class FarNode>
void KernelSum::outside(std::uint32_t b, const Vec3d& x, const NearBox& near, const FarNode& far) const {
  const OctreeBox& box = tree_.boxes()[b];
  if (!box.holds_points()) return;
  if ((x - tree_.center(box)).cwiseAbs().maxCoeff() >= 3 * tree_.half(box)) return far(b);
  if (box.leaf()) return near(b);
  for (std::uint32_t k = 0; k < 8; ++k) outside(box.child + k, x, near, far);
}

double KernelSum::value(const Vec3d& x) const {
  const auto& boxes = tree_.boxes();
  return with_kernel(kernel_, [&]<Kernel kernel>() {
    Lane sum = Lane::Zero();
    const auto add_near = [&](std::uint32_t n) {
      add_kernels<kernel>(centers(), weight_.data(), boxes[n].slot_begin, boxes[n].slot_end, x, sum);
    };
    if (tree_.contains(x)) {
      const std::uint32_t leaf = tree_.leaf_at(x);
      for (const std::uint32_t n : tree_.near(leaf)) add_near(n);
      return sum_of(sum) + series_value(series_[leaf], local(boxes[leaf], x));
    }
    double far = 0;
    outside(0, x, add_near, [&](std::uint32_t b) {
      const auto weights = node_weights(moments_[b]);
      for (int n = 0; n < cheb_nodes; ++n) {
        const double square = (x - tree_.center(boxes[b]) - tree_.half(boxes[b]) * cheb_node(n)).squaredNorm();
        far += weights[n] * kernel_of<kernel>(Lane::Constant(square))[0];
      }
    });
    return sum_of(sum) + far;
  });
}

Vec3d KernelSum::gradient(const Vec3d& x) const {
  const auto& boxes = tree_.boxes();
  return with_kernel(kernel_, [&]<Kernel kernel>() -> Vec3d {
    LaneGradient sum;
    const auto add_near = [&](std::uint32_t n) {
      add_gradients<kernel>(centers(), weight_.data(), boxes[n].slot_begin, boxes[n].slot_end, x, sum);
    };
    if (tree_.contains(x)) {
      const std::uint32_t leaf = tree_.leaf_at(x);
      for (const std::uint32_t n : tree_.near(leaf)) add_near(n);
      return sum.sum() + series_gradient(series_[leaf], local(boxes[leaf], x)) / tree_.half(boxes[leaf]);
    }
    Vec3d far = Vec3d::Zero();
    outside(0, x, add_near, [&](std::uint32_t b) {
      const auto weights = node_weights(moments_[b]);
      for (int n = 0; n < cheb_nodes; ++n) {
        const Vec3d d = x - tree_.center(boxes[b]) - tree_.half(boxes[b]) * cheb_node(n);
        far += weights[n] * slope_of<kernel>(Lane::Constant(d.squaredNorm()))[0] * d;
      }
    });
    return sum.sum() + far;
  });
}

} // namespace pith
