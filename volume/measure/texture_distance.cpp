#include "volume/measure/texture_distance.h"

#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/measure/patch_search.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace pith {

namespace {

constexpr std::uint64_t stage = 0x74657874; // of random numbers

/// Mean of the distances of those that found somebody.
double mean_found(const std::vector<float>& distance) {
  const double found = ordered_sum(distance.size(), [&](std::size_t i) { return distance[i] >= 0 ? 1.0 : 0.0; });
  if (!(found > 0)) return 0;
  return ordered_sum(distance.size(), [&](std::size_t i) { return std::max(0.0f, distance[i]); }) / found;
}

int band_count(const PatchTable& a, const PatchTable& b) {
  std::int32_t last = -1;
  for (const PatchTable* t : {&a, &b})
    for (const std::int32_t band : t->band) last = std::max(last, band);
  return last + 1;
}

using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Columns: random directions of unit length.
Eigen::MatrixXf directions_of(int dimension, int directions, std::uint64_t seed) {
  Eigen::MatrixXf direction(dimension, directions);
  for (int d = 0; d < directions; ++d) {
    Random random(seed, stage, static_cast<std::uint64_t>(d));
    for (int k = 0; k < dimension; ++k) direction(k, d) = static_cast<float>(random.normal());
    direction.col(d).normalize();
  }
  return direction;
}

/// Rows: a patch on each of the directions. All directions at once, for they are what adds up in lanes.
RowMajor projected(const PatchTable& table, const Eigen::MatrixXf& direction) {
  const RowMajor by_number = direction;
  RowMajor result(static_cast<Eigen::Index>(table.count()), direction.cols());
  parallel_for(table.count(), 128, [&](std::size_t i) {
    const auto row = table.row(i);
    Eigen::RowVectorXf sum = Eigen::RowVectorXf::Zero(direction.cols());
    for (int k = 0; k < table.dimension; ++k) sum += row[k] * by_number.row(k);
    result.row(static_cast<Eigen::Index>(i)) = sum;
  });
  return result;
}

/// Mean over directions and bands, bands weighted by the first set's patches.
double sliced_wasserstein(const PatchTable& a, const PatchTable& b, int directions, std::uint64_t seed) {
  const int n = a.dimension, bands = band_count(a, b);
  std::vector<std::vector<std::uint32_t>> rows_a(bands), rows_b(bands);
  for (std::uint32_t i = 0; i < a.count(); ++i) rows_a[a.band[i]].push_back(i);
  for (std::uint32_t i = 0; i < b.count(); ++i) rows_b[b.band[i]].push_back(i);
  const Eigen::MatrixXf direction = directions_of(n, directions, seed);
  const RowMajor of_a = projected(a, direction), of_b = projected(b, direction);
  const auto column = [](const RowMajor& table, const std::vector<std::uint32_t>& rows, std::size_t d) {
    std::vector<float> result;
    result.reserve(rows.size());
    for (const std::uint32_t r : rows) result.push_back(table(r, static_cast<Eigen::Index>(d)));
    return result;
  };
  double weight = 0;
  for (int k = 0; k < bands; ++k)
    if (!rows_a[k].empty() && !rows_b[k].empty()) weight += static_cast<double>(rows_a[k].size());
  if (!(weight > 0)) return 0;
  std::vector<double> sum(directions);
  parallel_for(directions, 1, [&](std::size_t d) {
    for (int k = 0; k < bands; ++k) {
      if (rows_a[k].empty() || rows_b[k].empty()) continue;
      sum[d] += static_cast<double>(rows_a[k].size()) *
                wasserstein_distance(column(of_a, rows_a[k], d), column(of_b, rows_b[k], d));
    }
  });
  double total = 0;
  for (const double s : sum) total += s;
  return total / directions / weight;
}

int band_at(const Slice& slice, std::size_t i, int bands) {
  return std::clamp(static_cast<int>(slice.depth[i] * bands), 0, bands - 1);
}

/// Encoded values of the pixels inside, per channel and band.
std::vector<std::array<std::vector<float>, 3>> pixel_values(std::span<const Slice> slices, int bands) {
  std::vector<std::array<std::vector<float>, 3>> values(bands);
  for (const Slice& s : slices)
    for (std::size_t i = 0; i < s.inside.size(); ++i)
      if (s.inside[i])
        for (int c = 0; c < 3; ++c)
          values[band_at(s, i, bands)][c].push_back(
              srgb_from_linear(std::clamp(s.color.pixel[3 * i + c], 0.0f, 1.0f)));
  return values;
}

double color_distance(std::span<const Slice> shown, std::span<const Slice> exemplar, int bands) {
  const auto a = pixel_values(shown, bands), b = pixel_values(exemplar, bands);
  double sum = 0, weight = 0;
  for (int k = 0; k < bands; ++k) {
    if (a[k][0].empty() || b[k][0].empty()) continue;
    for (int c = 0; c < 3; ++c) sum += static_cast<double>(a[k][c].size()) * wasserstein_distance(a[k][c], b[k][c]);
    weight += 3.0 * static_cast<double>(a[k][0].size());
  }
  return weight > 0 ? sum / weight : 0;
}

/// Normalised autocorrelation of the encoded colours less their band's mean, for shifts (0 … lag, −lag … lag); 1 at
/// no shift. Empty where nothing varies.
std::vector<double> autocorrelation(std::span<const Slice> slices, int lag, int bands) {
  std::vector<Vec3d> mean(bands, Vec3d::Zero());
  std::vector<double> count(bands);
  const auto value = [](const Slice& s, std::size_t i) {
    Vec3d v;
    for (int c = 0; c < 3; ++c) v[c] = srgb_from_linear(std::clamp(s.color.pixel[3 * i + c], 0.0f, 1.0f));
    return v;
  };
  for (const Slice& s : slices)
    for (std::size_t i = 0; i < s.inside.size(); ++i)
      if (s.inside[i]) {
        mean[band_at(s, i, bands)] += value(s, i);
        count[band_at(s, i, bands)] += 1;
      }
  for (int k = 0; k < bands; ++k)
    if (count[k] > 0) mean[k] /= count[k];

  const int rows = 2 * lag + 1, shifts = rows * (lag + 1);
  struct Sums {
    std::vector<double> product;
    std::vector<double> pairs;
  };
  std::vector<Sums> part(slices.size());
  parallel_for(slices.size(), 1, [&](std::size_t n) {
    const Slice& s = slices[n];
    // What is not inside is 0 and adds nothing, so that whole rows can be multiplied.
    Eigen::VectorXd v = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(s.inside.size()));
    Eigen::VectorXf inside = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(s.inside.size()));
    for (std::size_t i = 0; i < s.inside.size(); ++i)
      if (s.inside[i]) {
        v.segment<3>(3 * static_cast<Eigen::Index>(i)) = value(s, i) - mean[band_at(s, i, bands)];
        inside[static_cast<Eigen::Index>(i)] = 1;
      }
    part[n] = {std::vector<double>(shifts), std::vector<double>(shifts)};
    for (int dy = -lag; dy <= lag; ++dy)
      for (int dx = 0; dx <= std::min(lag, s.width() - 1); ++dx) {
        const int shift = (dy + lag) * (lag + 1) + dx, length = s.width() - dx;
        for (int y = std::max(0, -dy); y < std::min(s.height(), s.height() - dy); ++y) {
          const auto i = static_cast<Eigen::Index>(s.index(0, y)), j = static_cast<Eigen::Index>(s.index(dx, y + dy));
          part[n].product[shift] += v.segment(3 * i, 3 * length).dot(v.segment(3 * j, 3 * length));
          part[n].pairs[shift] += inside.segment(i, length).dot(inside.segment(j, length));
        }
      }
  });
  std::vector<double> product(shifts), pairs(shifts);
  for (const Sums& p : part)
    for (int k = 0; k < shifts; ++k) product[k] += p.product[k], pairs[k] += p.pairs[k];
  const int none = lag * (lag + 1);
  if (!(product[none] > 0)) return {};
  const double variance = product[none] / pairs[none];
  for (int k = 0; k < shifts; ++k) product[k] = pairs[k] > 0 ? product[k] / pairs[k] / variance : 0;
  return product;
}

double autocorrelation_distance(std::span<const Slice> a, std::span<const Slice> b, int lag, int bands) {
  std::vector<double> x = autocorrelation(a, lag, bands), y = autocorrelation(b, lag, bands);
  if (x.empty() && y.empty()) return 0;
  x.resize(std::max(x.size(), y.size())); // a flat picture correlates with nothing
  y.resize(x.size());
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
  return std::sqrt(sum / static_cast<double>(x.size()));
}

} // namespace

double wasserstein_distance(std::vector<float> a, std::vector<float> b) {
  if (a.empty() || b.empty()) return 0;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  // Both quantile functions are steps; walk through their joint steps.
  double sum = 0, at = 0;
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const double end_a = static_cast<double>(i + 1) / static_cast<double>(a.size()),
                 end_b = static_cast<double>(j + 1) / static_cast<double>(b.size());
    const double end = std::min(end_a, end_b);
    sum += (end - at) * std::abs(double(a[i]) - b[j]);
    at = end;
    if (end_a <= end) ++i;
    if (end_b <= end) ++j;
  }
  return sum;
}

TextureDistance texture_distance(std::span<const Slice> shown, std::span<const Slice> exemplar,
                                 const TextureDistanceOptions& options) {
  if (options.patch < 1 || options.patch > 31 || options.levels < 1 || options.directions < 1 || options.bands < 1 ||
      options.patches < 1 || options.lag < 0)
    throw InvalidInput("texture distance", "an option is out of range",
                       "give a patch of 1 to 31 pixels and at least one level, direction, band and patch");
  TextureDistance distance;
  std::vector<Slice> a(shown.begin(), shown.end()), b(exemplar.begin(), exemplar.end());
  int levels = 0;
  for (int level = 0; level < options.levels; ++level) {
    if (level > 0) {
      for (auto* set : {&a, &b})
        parallel_for(set->size(), 8, [&](std::size_t i) { (*set)[i] = half_size((*set)[i]); });
    }
    const PatchTable of_shown = patches_of(a, options.patch, options.bands, options.patches),
                     of_exemplar = patches_of(b, options.patch, options.bands, options.patches);
    if (level == 0) distance.patches = of_shown.count();
    if (of_shown.count() == 0 || of_exemplar.count() == 0) break;
    ++levels;
    distance.coherence += mean_found(nearest_distances(of_shown, of_exemplar));
    distance.completeness += mean_found(nearest_distances(of_exemplar, of_shown));
    distance.wasserstein += sliced_wasserstein(of_shown, of_exemplar, options.directions, options.seed);
  }
  if (levels > 0) {
    distance.coherence /= levels;
    distance.completeness /= levels;
    distance.wasserstein /= levels;
  }
  distance.color = color_distance(shown, exemplar, options.bands);
  distance.autocorrelation = autocorrelation_distance(shown, exemplar, options.lag, options.bands);
  return distance;
}

TextureDistance relative_to(const TextureDistance& distance, const TextureDistance& self) {
  const auto ratio = [](double a, double b) { return b > 0 ? a / b : (a > 0 ? INFINITY : 1.0); };
  TextureDistance r;
  r.coherence = ratio(distance.coherence, self.coherence);
  r.completeness = ratio(distance.completeness, self.completeness);
  r.wasserstein = ratio(distance.wasserstein, self.wasserstein);
  r.color = ratio(distance.color, self.color);
  r.autocorrelation = ratio(distance.autocorrelation, self.autocorrelation);
  r.patches = distance.patches;
  return r;
}

} // namespace pith
