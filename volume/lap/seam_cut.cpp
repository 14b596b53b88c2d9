#include "volume/lap/seam_cut.h"

#include "volume/lap/min_cut.h"
#include "volume/layer/composite.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace pith {

namespace {

/// A mask's texels as a grid: index arithmetic and the six neighbours.
struct Grid {
  explicit Grid(const Mask& mask) : size(mask.size), open(mask.open), count(mask.alpha.size()) {}
  std::array<int, 3> size;
  std::array<bool, 3> open;
  std::size_t count;

  std::size_t index(int x, int y, int z) const { return (std::size_t(z) * size[1] + y) * size[0] + x; }
  std::array<int, 3> at(std::size_t i) const {
    const int x = static_cast<int>(i % size[0]), rest = static_cast<int>(i / size[0]);
    return {x, rest % size[1], rest / size[1]};
  }
  static constexpr std::size_t outside = ~std::size_t(0);
  /// Along an axis, one step up or down.
  std::size_t neighbor(std::size_t i, int axis, int step) const {
    std::array<int, 3> p = at(i);
    p[axis] += step;
    return p[axis] < 0 || p[axis] >= size[axis] ? outside : index(p[0], p[1], p[2]);
  }
};

/// Steps from each texel to the nearest that is not opaque by half, or out of the mask where it ends.
std::vector<std::uint16_t> depth_of(const Mask& mask, const Grid& grid) {
  std::vector<std::uint16_t> depth(grid.count, 0xffff);
  std::vector<std::size_t> front, next;
  for (std::size_t i = 0; i < grid.count; ++i) {
    bool at_end = false;
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) at_end |= !grid.open[axis] && grid.neighbor(i, axis, step) == Grid::outside;
    if (mask.alpha[i] >= 128 && !at_end) continue;
    depth[i] = mask.alpha[i] < 128 ? 0 : 1;
    front.push_back(i);
  }
  for (; !front.empty(); front.swap(next)) {
    next.clear();
    for (const std::size_t i : front)
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1})
          if (const std::size_t j = grid.neighbor(i, axis, step); j != Grid::outside && depth[j] > depth[i] + 1) {
            depth[j] = static_cast<std::uint16_t>(depth[i] + 1);
            next.push_back(j);
          }
  }
  return depth;
}

class SeamCutter {
public:
  SeamCutter(const Simplices& mesh, Layer& layer) : mesh_(mesh), layer_(layer), rows_(layer.begin) {
    std::vector<Mask> own;
    for (Patch& p : layer.patch) {
      own.push_back(layer.mask[p.mask]);
      p.mask = static_cast<std::uint32_t>(own.size() - 1);
    }
    layer.mask = std::move(own);
    original_ = layer.mask;
    reader_.emplace(layer, false);
    lookups_.resize(layer.patch.size());
    row_of_.resize(layer.lookup.size());
    for (std::uint32_t s = 0; s < mesh.count; ++s)
      for (std::uint32_t i = rows_[s]; i < rows_[s + 1]; ++i) {
        row_of_[i] = s;
        lookups_[layer.lookup[i].patch].push_back(i);
      }
    int component = 0;
    for (const Channel& c : layer.exemplar.front().channel)
      for (int k = 0; k < c.components; ++k, ++component) {
        const bool compared = c.semantic != Semantic::direction && c.semantic != Semantic::normal;
        const float range = decoded(c, 255) - decoded(c, 0);
        weigh_[component] = compared && range > 0 ? 1 / range : 0;
        low_[component] = decoded(c, 0);
        curved_[component] = c.semantic == Semantic::color;
      }
  }

  /// From the lowest patch up: what lies beneath one is final when its turn comes. Patches that share no simplex go
  /// side by side.
  void cut_all(const Progress& progress) {
    std::vector<std::uint32_t> level(layer_.patch.size(), 0), highest(mesh_.count, 0);
    for (std::uint32_t p = static_cast<std::uint32_t>(layer_.patch.size()); p-- > 0;) { // the first paste lies on top
      for (const std::uint32_t i : lookups_[p]) level[p] = std::max(level[p], highest[row_of_[i]]);
      for (const std::uint32_t i : lookups_[p]) highest[row_of_[i]] = level[p] + 1;
    }
    std::vector<std::vector<std::uint32_t>> batch;
    for (std::uint32_t p = 0; p < level.size(); ++p) {
      if (batch.size() <= level[p]) batch.resize(level[p] + 1);
      batch[level[p]].push_back(p);
    }
    std::size_t done = 0;
    for (const std::vector<std::uint32_t>& patches : batch) {
      report(progress, static_cast<double>(done) / static_cast<double>(level.size()));
      done += patches.size();
      parallel_for(patches.size(), 1, [&](std::size_t i) { cut(patches[i]); });
      for (const std::uint32_t p : patches) reader_->mask[p] = MaskGrid(layer_.mask[p]);
    }
  }

  /// Where the cut masks leave a sample uncovered that the old ones covered, these get their old alpha back.
  void restore_coverage(const Coverage& coverage) {
    std::vector<std::uint8_t> touched(layer_.patch.size(), 0);
    for (std::uint32_t s = 0; s < mesh_.count; ++s) {
      if (!coverage.open(s)) continue;
      const std::span<const Lookup> row(layer_.lookup.data() + rows_[s], rows_[s + 1] - rows_[s]);
      for (const std::array<float, 4>& b : coverage.samples(s)) {
        SimplexPoint point;
        point.barycentric = b;
        if (coverage_of(*reader_, row, point).coverage >= 1 - 1 / 255.0f) continue;
        for (const Lookup& lookup : row) {
          const LookupSight sight = sight_of(*reader_, lookup, b);
          touched[lookup.patch] = 1;
          for_texels_around(lookup.patch, sight.w, [&](std::size_t texel) {
            layer_.mask[lookup.patch].alpha[texel] = original_[lookup.patch].alpha[texel];
          });
        }
      }
    }
    for (std::uint32_t p = 0; p < touched.size(); ++p)
      if (touched[p]) reader_->mask[p] = MaskGrid(layer_.mask[p]);
  }

  /// Keeps only look-ups that can be seen at a sample, from the uppermost down.
  void drop_hidden(Coverage& coverage) {
    LargeArray<Lookup> kept;
    LargeArray<std::uint32_t> begin(1, 0);
    std::vector<Lookup> row;
    std::vector<float> let_through;
    for (std::uint32_t s = 0; s < mesh_.count; ++s) {
      row.clear();
      for (std::uint32_t i = rows_[s + 1]; i-- > rows_[s] && coverage.open(s);) {
        const auto samples = coverage.samples(s);
        const auto shining = coverage.shining(s);
        let_through.clear();
        bool seen = false;
        for (std::size_t k = 0; k < samples.size(); ++k) {
          const float alpha = std::max(0.0f, sight_of(*reader_, layer_.lookup[i], samples[k]).alpha);
          seen |= alpha > 0 && shining[k] > 1 / 512.0f;
          let_through.push_back(1 - std::min(alpha, 1.0f));
        }
        if (!seen) continue;
        coverage.cover(s, let_through);
        row.push_back(layer_.lookup[i]);
      }
      kept.insert(kept.end(), row.rbegin(), row.rend());
      begin.push_back(static_cast<std::uint32_t>(kept.size()));
    }
    reader_.reset();
    layer_.lookup = std::move(kept);
    layer_.begin = std::move(begin);
    compact();
  }

private:
  /// Takes away patches, masks and corner rows that no look-up needs any more.
  void compact() {
    constexpr std::uint32_t none = 0xffffffffu;
    std::vector<std::uint32_t> patch(layer_.patch.size(), none), row(layer_.corner_count(), none);
    for (const Lookup& lookup : layer_.lookup) patch[lookup.patch] = 0;
    std::vector<Patch> patches;
    std::vector<Mask> masks;
    for (std::uint32_t p = 0; p < patch.size(); ++p) {
      if (patch[p] == none) continue;
      patch[p] = static_cast<std::uint32_t>(patches.size());
      masks.push_back(std::move(layer_.mask[p]));
      patches.push_back(layer_.patch[p]);
      patches.back().mask = patch[p];
    }
    LargeArray<float> corner;
    std::uint32_t rows = 0;
    for (Lookup& lookup : layer_.lookup) {
      lookup.patch = patch[lookup.patch];
      for (std::uint32_t& c : lookup.corner) {
        if (row[c] == none) {
          row[c] = rows++;
          corner.insert(corner.end(), layer_.corner.begin() + 4 * std::size_t(c),
                        layer_.corner.begin() + 4 * std::size_t(c) + 4);
        }
        c = row[c];
      }
    }
    layer_.patch = std::move(patches);
    layer_.mask = std::move(masks);
    layer_.corner = std::move(corner);
  }

  template <class Visit>
  void for_texels_around(std::uint32_t patch, Lanes w, const Visit& visit) const {
    const Mask& mask = layer_.mask[patch];
    std::array<std::array<int, 2>, 3> at;
    for (int a = 0; a < 3; ++a) {
      const int low = static_cast<int>(std::floor(std::clamp(w[a], -1.0f, 2.0f) * mask.size[a] - 0.5f));
      at[a] = {std::clamp(low, 0, mask.size[a] - 1), std::clamp(low + 1, 0, mask.size[a] - 1)};
    }
    const Grid grid(mask);
    for (const int z : at[2])
      for (const int y : at[1])
        for (const int x : at[0]) visit(grid.index(x, y, z));
  }

  /// How differently two materials look: the Euclidean distance of their components, each from 0 to 1.
  float difference(const LayerValue& a, const LayerValue& b) const {
    float sum = 0;
    for (int c = 0; c < reader_->components; ++c) {
      const auto number = [&](const LayerValue& v) {
        const float x = std::max(0.0f, (v.value[c] / v.coverage - low_[c]) * weigh_[c]);
        return curved_[c] ? std::sqrt(x) : x; // about as the eye sees it
      };
      const float d = number(a) - number(b);
      sum += d * d;
    }
    return sum;
  }

  /// What a patch's texels show against what lies beneath: where look-ups reach them.
  struct Overlap {
    std::vector<float> difference;  ///< −1 where no look-up reaches or the mask is transparent
    std::vector<std::uint8_t> bare; ///< nothing beneath covers it
  };

  Overlap overlap_of(std::uint32_t p) const {
    const Mask& mask = original_[p];
    const Grid grid(mask);
    Overlap overlap{std::vector<float>(grid.count, -1), std::vector<std::uint8_t>(grid.count, 0)};
    for (const std::uint32_t i : lookups_[p]) {
      const Lookup& lookup = layer_.lookup[i];
      const std::span<const Lookup> beneath(layer_.lookup.data() + rows_[row_of_[i]], i - rows_[row_of_[i]]);
      Eigen::Matrix<double, 3, 4> corner;
      for (int k = 0; k < 4; ++k)
        for (int a = 0; a < 3; ++a) corner(a, k) = layer_.corner[std::size_t(lookup.corner[k]) * 4 + a];
      Mat3d edges;
      for (int k = 0; k < 3; ++k) edges.col(k) = corner.col(k + 1) - corner.col(0);
      if (!(std::abs(edges.determinant()) > 1e-18)) continue;
      const Mat3d inverse = edges.inverse();
      std::array<int, 3> low, high;
      for (int a = 0; a < 3; ++a) {
        low[a] = std::max(0, static_cast<int>(std::ceil(corner.row(a).minCoeff() * grid.size[a] - 0.5)));
        high[a] =
            std::min(grid.size[a] - 1, static_cast<int>(std::floor(corner.row(a).maxCoeff() * grid.size[a] - 0.5)));
      }
      for (int z = low[2]; z <= high[2]; ++z)
        for (int y = low[1]; y <= high[1]; ++y)
          for (int x = low[0]; x <= high[0]; ++x) {
            const std::size_t texel = grid.index(x, y, z);
            if (mask.alpha[texel] == 0 || overlap.bare[texel]) continue;
            const Vec3d w((x + 0.5) / grid.size[0], (y + 0.5) / grid.size[1], (z + 0.5) / grid.size[2]);
            const Vec3d b = inverse * (w - corner.col(0));
            if (b.minCoeff() < -1e-6 || b.sum() > 1 + 1e-6) continue;
            SimplexPoint point;
            point.barycentric = {float(1 - b.sum()), float(b[0]), float(b[1]), float(b[2])};
            const LayerValue under = composite(*reader_, beneath, point);
            if (under.coverage < 0.999f) {
              overlap.bare[texel] = 1;
              continue;
            }
            const LayerValue over = composite(*reader_, {&lookup, 1}, point);
            if (over.coverage > 0)
              overlap.difference[texel] = std::max(overlap.difference[texel], difference(over, under));
          }
      mark_bare(overlap, lookup, beneath);
    }
    return overlap;
  }

  /// Tets may lie between texel centres: those around the tet's middle and corners count as well.
  void mark_bare(Overlap& overlap, const Lookup& lookup, std::span<const Lookup> beneath) const {
    constexpr float near = 0.97f, rest = 0.01f;
    constexpr std::array<std::array<float, 4>, 5> places{{{near, rest, rest, rest},
                                                          {rest, near, rest, rest},
                                                          {rest, rest, near, rest},
                                                          {rest, rest, rest, near},
                                                          {0.25f, 0.25f, 0.25f, 0.25f}}};
    for (const std::array<float, 4>& b : places) {
      SimplexPoint point;
      point.barycentric = b;
      if (coverage_of(*reader_, beneath, point).coverage >= 0.999f) continue;
      for_texels_around(lookup.patch, sight_of(*reader_, lookup, b).w,
                        [&](std::size_t texel) { overlap.bare[texel] = 1; });
    }
  }

  void cut(std::uint32_t p) {
    constexpr double unit = 4096, shortest = 0.004; // cost of a difference of 1; of one texel's side without any
    const Mask& mask = original_[p];
    const Grid grid(mask);
    const Overlap overlap = overlap_of(p);
    const std::vector<std::uint16_t> depth = depth_of(mask, grid);
    const std::uint16_t core = static_cast<std::uint16_t>((*std::max_element(depth.begin(), depth.end()) + 1) / 2);

    const std::vector<std::uint8_t> bare = grown(grid, overlap.bare); // seams keep a texel away from it
    constexpr std::uint32_t none = 0xffffffffu;
    std::vector<std::uint32_t> node(grid.count, none);
    std::vector<std::int64_t> source, sink;
    for (std::size_t i = 0; i < grid.count; ++i) {
      if (mask.alpha[i] == 0 || (overlap.difference[i] < 0 && !overlap.bare[i])) continue;
      node[i] = static_cast<std::uint32_t>(source.size());
      source.push_back(bare[i] || depth[i] >= core ? never : 0);
      sink.push_back(0);
    }
    const auto price = [&](std::size_t i, std::size_t j) {
      const float a = overlap.difference[i], b = overlap.difference[j]; // below 0: bare, so the other stands for it
      const float seen = a < 0 ? 2 * b : b < 0 ? 2 * a : a + b;
      return static_cast<std::int64_t>(unit * (shortest + std::max(0.0f, seen)));
    };
    std::vector<CutEdge> edges;
    for (std::size_t i = 0; i < grid.count; ++i) {
      if (node[i] == none) continue;
      for (int axis = 0; axis < 3; ++axis)
        for (int step : {-1, 1}) {
          const std::size_t j = grid.neighbor(i, axis, step);
          if (j == Grid::outside) {
            if (!grid.open[axis]) sink[node[i]] += price(i, i);
          } else if (mask.alpha[j] == 0) {
            sink[node[i]] += price(i, i); // the old border is one way to cut, at its price
          } else if (step > 0 && node[j] != none) {
            edges.push_back({node[i], node[j], price(i, j)});
          }
        }
    }
    const std::vector<std::uint8_t> kept = min_cut(source, sink, edges);
    std::vector<std::uint8_t> keep(grid.count, 0), reached(grid.count, 0);
    for (std::size_t i = 0; i < grid.count; ++i) {
      reached[i] = node[i] != none;
      keep[i] = reached[i] && kept[node[i]];
    }
    soften(layer_.mask[p], grid, keep, reached);
  }

  /// With the 26 around each.
  static std::vector<std::uint8_t> grown(const Grid& grid, std::vector<std::uint8_t> set) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<std::uint8_t> before = set;
      for (std::size_t i = 0; i < grid.count; ++i)
        for (const int step : {-1, 1})
          if (const std::size_t j = grid.neighbor(i, axis, step); j != Grid::outside) set[i] |= before[j];
    }
    return set;
  }

  /// As it was where kept, and next to that where no look-up reaches; else half of it across a texel's side, less
  /// across an edge or corner, and nothing further away.
  static void soften(Mask& mask, const Grid& grid, const std::vector<std::uint8_t>& keep,
                     const std::vector<std::uint8_t>& reached) {
    for (std::size_t i = 0; i < grid.count; ++i) {
      if (keep[i] || mask.alpha[i] == 0) continue;
      const std::array<float, 4> fall =
          reached[i] ? std::array<float, 4>{1, 0.5f, 0.3f, 0.2f} : std::array<float, 4>{1, 1, 1, 1};
      const std::array<int, 3> at = grid.at(i);
      float alpha = 0;
      for (int z = std::max(0, at[2] - 1); z <= std::min(grid.size[2] - 1, at[2] + 1); ++z)
        for (int y = std::max(0, at[1] - 1); y <= std::min(grid.size[1] - 1, at[1] + 1); ++y)
          for (int x = std::max(0, at[0] - 1); x <= std::min(grid.size[0] - 1, at[0] + 1); ++x)
            if (keep[grid.index(x, y, z)]) alpha = std::max(alpha, fall[(x != at[0]) + (y != at[1]) + (z != at[2])]);
      mask.alpha[i] = static_cast<std::uint8_t>(std::lrint(alpha * mask.alpha[i]));
    }
  }

  const Simplices& mesh_;
  Layer& layer_;
  const LargeArray<std::uint32_t>& rows_;
  std::vector<Mask> original_;
  std::optional<LayerReader> reader_;
  std::vector<std::vector<std::uint32_t>> lookups_; ///< of each patch
  std::vector<std::uint32_t> row_of_;               ///< of each look-up, its simplex
  std::array<float, max_components> weigh_{}, low_{};
  std::array<bool, max_components> curved_{};
};

} // namespace

void cut_seams(const Simplices& mesh, Coverage coverage, Layer& layer, const Progress& progress) {
  SeamCutter cutter(mesh, layer);
  cutter.cut_all(progress);
  cutter.restore_coverage(coverage);
  cutter.drop_hidden(coverage);
}

} // namespace pith
