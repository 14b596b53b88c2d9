#include "volume/measure/seams.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>

namespace pith {

namespace {

/// What is gathered of one band of depth.
struct Band {
  std::vector<float> border, interior, seam; ///< gradients across borders, inside one patch, inside seam bands
  std::vector<Vec3d> seam_color, interior_color;
};

double p99(std::vector<float> values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double variance(const std::vector<Vec3d>& colors) {
  Vec3d middle = Vec3d::Zero();
  for (const Vec3d& c : colors) middle += c;
  middle /= static_cast<double>(colors.size());
  double sum = 0;
  for (const Vec3d& c : colors) sum += (c - middle).squaredNorm();
  return sum / static_cast<double>(colors.size());
}

/// A weighted mean of ratios; 1 where there is none.
struct MeanRatio {
  double sum = 0, weight = 0;
  void add(double above, double below, double w) {
    if (below > 0) sum += w * above / below, weight += w;
  }
  double value() const { return weight > 0 ? sum / weight : 1; }
};

} // namespace

SeamMeasure seam_measure(std::span<const Slice> slices, const SeamOptions& options) {
  std::vector<Band> band(options.bands);
  SeamMeasure measure;
  std::size_t inside = 0, mixed = 0;
  for (const Slice& s : slices) {
    if (s.source.size() != s.inside.size())
      throw InvalidInput("seams", "a slice does not tell its sources", "ask for them (SliceOptions::sources)");
    std::vector<Vec3d> color(s.inside.size(), Vec3d::Zero());
    for (std::size_t i = 0; i < color.size(); ++i)
      for (int c = 0; c < 3; ++c) color[i][c] = srgb_from_linear(std::clamp(s.color.pixel[3 * i + c], 0.0f, 1.0f));
    const auto shows = [&](std::size_t i) { return s.inside[i] && s.source[i].patch != PixelSource::none; };
    const auto pure = [&](std::size_t i) { return s.source[i].share >= options.pure; };
    for (int y = 0; y < s.height(); ++y)
      for (int x = 0; x < s.width(); ++x) {
        const std::size_t i = s.index(x, y);
        if (!shows(i)) continue;
        Band& b = band[std::clamp(static_cast<int>(s.depth[i] * options.bands), 0, options.bands - 1)];
        ++inside;
        mixed += !pure(i);
        (pure(i) ? b.interior_color : b.seam_color).push_back(color[i]);
        for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)}) {
          if (x + dx >= s.width() || y + dy >= s.height()) continue;
          const std::size_t j = s.index(x + dx, y + dy);
          if (!shows(j)) continue;
          const float gradient = static_cast<float>((color[i] - color[j]).norm());
          const bool same = s.source[i].patch == s.source[j].patch && s.source[i].layer == s.source[j].layer;
          if (!same) b.border.push_back(gradient);
          if (same && pure(i) && pure(j)) b.interior.push_back(gradient);
          if (!pure(i) && !pure(j)) b.seam.push_back(gradient);
        }
      }
  }
  MeanRatio edge, gradient, contrast;
  for (const Band& b : band) {
    measure.border_pairs += b.border.size();
    measure.interior_pairs += b.interior.size();
    if (b.interior.size() >= options.least_pairs) {
      if (b.border.size() >= options.least_pairs)
        edge.add(p99(b.border), p99(b.interior), static_cast<double>(b.border.size()));
      if (b.seam.size() >= options.least_pairs)
        gradient.add(mean(b.seam), mean(b.interior), static_cast<double>(b.seam.size()));
    }
    if (b.seam_color.size() >= options.least_pairs && b.interior_color.size() >= options.least_pairs)
      contrast.add(variance(b.seam_color), variance(b.interior_color), static_cast<double>(b.seam_color.size()));
  }
  measure.border_gradient_p99 = edge.value();
  measure.band_gradient = gradient.value();
  measure.band_variance = contrast.value();
  if (inside > 0) measure.border_share = static_cast<double>(mixed) / static_cast<double>(inside);
  return measure;
}

} // namespace pith
