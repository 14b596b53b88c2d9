#include "volume/measure/patch_search.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pith {

Slice half_size(const Slice& fine) {
  Slice coarse;
  const int width = fine.width() / 2, height = fine.height() / 2;
  coarse.color = Image(width, height, 3);
  coarse.inside.assign(std::size_t(width) * height, 0);
  coarse.depth.assign(std::size_t(width) * height, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = coarse.index(x, y);
      coarse.inside[i] = 1;
      for (int k = 0; k < 4; ++k) {
        const int fx = 2 * x + (k & 1), fy = 2 * y + (k >> 1);
        coarse.inside[i] &= fine.inside[fine.index(fx, fy)];
        coarse.depth[i] += 0.25f * fine.depth[fine.index(fx, fy)];
        for (int c = 0; c < 3; ++c) coarse.color.at(x, y)[c] += 0.25f * fine.color.at(fx, fy)[c];
      }
    }
  return coarse;
}

PatchTable patches_of(std::span<const Slice> slices, int side, int bands, std::size_t most) {
  struct Place {
    std::uint32_t slice;
    int x, y;
  };
  std::vector<Place> place;
  for (std::uint32_t s = 0; s < slices.size(); ++s) {
    const Slice& slice = slices[s];
    for (int y = 0; y + side <= slice.height(); ++y)
      for (int x = 0; x + side <= slice.width(); ++x) {
        bool whole = true;
        for (int j = 0; j < side && whole; ++j)
          for (int i = 0; i < side && whole; ++i) whole = slice.inside[slice.index(x + i, y + j)] != 0;
        if (whole) place.push_back({s, x, y});
      }
  }
  PatchTable table;
  table.dimension = side * side * 3;
  const std::size_t count = std::min(place.size(), most);
  table.value.resize(count * table.dimension);
  table.band.resize(count);
  parallel_for(count, 256, [&](std::size_t i) {
    const Place& p = place[i * place.size() / count];
    const Slice& slice = slices[p.slice];
    float* out = table.value.data() + i * table.dimension;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        for (int c = 0; c < 3; ++c)
          *out++ = srgb_from_linear(std::clamp(slice.color.at(p.x + x, p.y + y)[c], 0.0f, 1.0f));
    const float depth = slice.depth[slice.index(p.x + side / 2, p.y + side / 2)];
    table.band[i] = std::clamp(static_cast<int>(depth * bands), 0, bands - 1);
  });
  return table;
}

namespace {

constexpr int lanes = 16;

/// Rows turned by a rotation, the most telling numbers first.
std::vector<float> turned(const PatchTable& table, const Eigen::MatrixXf& rotation) {
  const int n = table.dimension;
  std::vector<float> result(table.value.size());
  parallel_blocks(table.count(), 128, [&](std::size_t begin, std::size_t end) {
    Eigen::VectorXf row(n), out(n);
    for (std::size_t i = begin; i < end; ++i) {
      std::copy_n(table.value.data() + i * n, n, row.data());
      out.setZero();
      for (int k = 0; k < n; ++k) out += row[k] * rotation.col(k);
      std::copy_n(out.data(), n, result.data() + i * n);
    }
  });
  return result;
}

/// Rows: the principal components of (at most 2048 evenly chosen) rows, largest first.
Eigen::MatrixXf principal_components(const PatchTable& table) {
  const int n = table.dimension;
  const std::size_t used = std::min<std::size_t>(table.count(), 2048);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < used; ++i) {
    const auto row = table.row(i * table.count() / used);
    for (int k = 0; k < n; ++k) mean[k] += row[k];
  }
  mean /= static_cast<double>(used);
  parallel_for(n, 8, [&](std::size_t column) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < used; ++i) {
      const auto row = table.row(i * table.count() / used);
      const double factor = row[column] - mean[column];
      for (int k = static_cast<int>(column); k < n; ++k) sum[k] += factor * (row[k] - mean[k]);
    }
    covariance.col(column) = sum;
  });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance); // reads the lower triangle
  return solver.eigenvectors().rowwise().reverse().transpose().cast<float>();
}

/// Turned rows of one band in blocks of `lanes`, number by number, ascending in the first number.
struct Band {
  std::size_t blocks = 0;
  std::vector<float> value; ///< blocks · dimension · lanes
  std::vector<float> low, high;
};

Band band_of(const std::vector<float>& turned, int n, std::vector<std::uint32_t> rows) {
  std::sort(rows.begin(), rows.end(), [&](auto a, auto b) {
    return std::pair(turned[std::size_t(a) * n], a) < std::pair(turned[std::size_t(b) * n], b);
  });
  Band band;
  band.blocks = (rows.size() + lanes - 1) / lanes;
  band.value.resize(band.blocks * n * lanes);
  for (std::size_t b = 0; b < band.blocks; ++b) {
    for (int lane = 0; lane < lanes; ++lane) {
      const std::size_t row =
          rows[std::min(b * lanes + lane, rows.size() - 1)]; // the last block repeats the last row
      for (int k = 0; k < n; ++k) band.value[(b * n + k) * lanes + lane] = turned[row * n + k];
    }
    band.low.push_back(band.value[b * n * lanes]);
    band.high.push_back(band.value[b * n * lanes + lanes - 1]);
  }
  return band;
}

/// The least squared distance of q to a block's rows, if below `best`; else something not below it.
float nearest_in_block(const float* block, const float* q, int n, float best) {
  float sum[lanes] = {};
  for (int k = 0; k < n;) {
    const int end = std::min(n, k + 8);
    for (; k < end; ++k) {
      const float* value = block + k * lanes;
      for (int lane = 0; lane < lanes; ++lane) {
        const float d = value[lane] - q[k];
        sum[lane] += d * d;
      }
    }
    float least = sum[0];
    for (int lane = 1; lane < lanes; ++lane) least = std::min(least, sum[lane]);
    if (least >= best) return best;
    if (k == n) return least;
  }
  return best;
}

float nearest_squared(const Band& band, const float* q, int n) {
  float best = std::numeric_limits<float>::infinity();
  std::size_t up = std::lower_bound(band.high.begin(), band.high.end(), q[0]) - band.high.begin(), down = up;
  const auto look = [&](std::size_t b) { best = nearest_in_block(band.value.data() + b * n * lanes, q, n, best); };
  while (up < band.blocks || down > 0) {
    if (up < band.blocks) {
      const float gap = std::max(0.0f, band.low[up] - q[0]);
      if (gap * gap < best) {
        look(up++);
      } else {
        up = band.blocks;
      }
    }
    if (down > 0) {
      const float gap = std::max(0.0f, q[0] - band.high[down - 1]);
      if (gap * gap < best) {
        look(--down);
      } else {
        down = 0;
      }
    }
  }
  return best;
}

} // namespace

std::vector<float> nearest_distances(const PatchTable& query, const PatchTable& table) {
  std::vector<float> distance(query.count(), -1.0f);
  if (query.count() == 0 || table.count() == 0 || query.dimension != table.dimension) return distance;
  const int n = table.dimension;
  const Eigen::MatrixXf rotation = principal_components(table);
  const std::vector<float> q = turned(query, rotation), t = turned(table, rotation);
  std::vector<std::vector<std::uint32_t>> rows(1 + *std::max_element(table.band.begin(), table.band.end()));
  for (std::uint32_t i = 0; i < table.count(); ++i) rows[table.band[i]].push_back(i);
  std::vector<Band> band;
  for (auto& r : rows) band.push_back(r.empty() ? Band{} : band_of(t, n, std::move(r)));
  parallel_for(query.count(), 64, [&](std::size_t i) {
    const std::size_t b = query.band[i];
    if (b >= band.size() || band[b].blocks == 0) return;
    distance[i] = std::sqrt(nearest_squared(band[b], q.data() + i * n, n) / n);
  });
  return distance;
}

} // namespace pith
