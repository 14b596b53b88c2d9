// The blend rules of all five methods (docs/design.md, idea 1): paste order (Praun 2000, Takayama 2008), weighted
// (Ray 2009, §4.3), selection by effective height (Schuster 2020, §3.4.2) and histogram preservation (Heitz, Neyret
// 2018).
#include "volume/layer/composite.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pith {

namespace {

using Sight = LookupSight;

/// A sight whose alpha is the interpolated corner weight, not yet masked.
template <int Width>
inline Sight weight_at(const LayerReader& reader, const Lookup& lookup, const std::array<float, 4>& b) {
  constexpr int row = Width + 1;
  const float* r = reader.record.data() + (&lookup - reader.layer->lookup.data()) * reader.record_size;
  const bool solid = reader.layer->domain == Domain::solid; // a facet has three rows; its b[3] is 0
  const float* last = r + (solid ? 3 : 2) * row;
  Sight s;
  s.w = (b[0] * lanes_at(r) + b[1] * lanes_at(r + row)) + (b[2] * lanes_at(r + 2 * row) + b[3] * lanes_at(last));
  if constexpr (Width < 4)
    s.alpha = s.w[Width];
  else
    s.alpha = (b[0] * r[4] + b[1] * r[row + 4]) + (b[2] * r[2 * row + 4] + b[3] * last[4]);
  return s;
}

template <int Width>
inline Sight sight_at(const LayerReader& reader, const Lookup& lookup, const std::array<float, 4>& b) {
  Sight s = weight_at<Width>(reader, lookup, b);
  if (s.alpha > 0)
    if (const MaskGrid* mask = reader.patch[lookup.patch].mask) s.alpha *= mask->alpha(s.w);
  return s;
}

} // namespace

LookupSight sight_of(const LayerReader& reader, const Lookup& lookup, const std::array<float, 4>& b) {
  switch (reader.layer->width) {
  case 2:
    return sight_at<2>(reader, lookup, b);
  case 3:
    return sight_at<3>(reader, lookup, b);
  default:
    return sight_at<4>(reader, lookup, b);
  }
}

LookupJacobian jacobian_of(const Layer& layer, const Lookup& lookup, const SimplexPoint& point) {
  const int stride = layer.width + 1, corners = layer.domain == Domain::solid ? 4 : 3;
  LookupJacobian j = LookupJacobian::Zero();
  for (int i = 0; i < corners; ++i) {
    const float* row = layer.corner.data() + std::size_t(lookup.corner[i]) * stride;
    for (int k = 0; k < layer.width; ++k) j.row(k) += row[k] * point.gradient[i].transpose();
  }
  const AxisMap& frame = layer.patch[lookup.patch].frame;
  for (int k = 0; k < layer.width; ++k) j.row(k) *= double(frame.scale[k]) * layer.evaluation.scale[k];
  return j;
}

namespace {

/// Carries directions and normals from texture space to rest space; leaves other channels alone.
void carry_directions(const LayerReader& reader, const LookupJacobian& j, const SimplexPoint& point, float* value) {
  Mat3d map = j.topRows<3>();
  if (reader.layer->domain == Domain::skin)
    map.row(2) = 0.5 * (j.row(0).norm() + j.row(1).norm()) * point.normal.transpose();
  int component = 0;
  for (const Channel& c : reader.layer->exemplar.front().channel) {
    if (c.semantic == Semantic::direction || c.semantic == Semantic::normal) {
      const Vec3d texture(value[component], value[component + 1], value[component + 2]);
      Vec3d rest = Vec3d::Zero();
      if (c.semantic == Semantic::normal) {
        rest = map.transpose() * texture;
      } else if (std::abs(map.determinant()) > 1e-300) {
        rest = map.inverse() * texture;
      }
      const double length = rest.norm();
      if (length > 0) rest /= length;
      for (int i = 0; i < 3; ++i) value[component + i] = static_cast<float>(rest[i]);
    }
    component += c.components;
  }
}

/// The exemplar's values at a sight: mip level, and directions in rest space.
void read_exemplar(const LayerReader& reader, const Lookup& lookup, const Sight& sight, const SimplexPoint& point,
                   bool gaussian, float* value) {
  const Layer& layer = *reader.layer;
  const LayerReader::PatchReader& patch = reader.patch[lookup.patch];
  const Lanes u = patch.scale * sight.w + patch.offset;
  const std::vector<TexelGrid>& levels = gaussian ? patch.source->gaussian : patch.source->level;
  const bool carry = reader.has_directions && !gaussian;
  if (point.footprint <= 0 && !carry) return sample(levels[0], cell_at(levels[0], u), value);

  const LookupJacobian j = jacobian_of(layer, lookup, point);
  double level = 0;
  if (point.footprint > 0) {
    double texels = 1;
    for (int k = 0; k < layer.width; ++k)
      texels = std::max(texels, j.row(k).norm() * levels[0].texels[k] * point.footprint);
    level = std::min(std::log2(texels), static_cast<double>(levels.size() - 1));
  }
  const std::size_t fine = static_cast<std::size_t>(level);
  sample(levels[fine], cell_at(levels[fine], u), value);
  if (const float blend = static_cast<float>(level - fine); blend > 0) {
    std::array<float, max_components> coarse;
    sample(levels[fine + 1], cell_at(levels[fine + 1], u), coarse.data());
    for (int c = 0; c < reader.components; ++c) value[c] += blend * (coarse[c] - value[c]);
  }
  if (carry) carry_directions(reader, j, point, value);
}

/// Blend::mean_over. `result` is a sum of shown values; `squares`: Σ of the squares of their shares; `lookup`: any of
/// them, since along the axes over which the mean varies all that are seen at a point have the same coordinates.
void preserve_variance(const LayerReader& reader, const Lookup& lookup, Lanes w, float squares, LayerValue& result) {
  const float whole = result.coverage * result.coverage;
  if (squares >= 0.99f * whole) return; // one look-up as good as alone: no 8-bit value would change by a step
  const LayerReader::PatchReader& patch = reader.patch[lookup.patch];
  const TexelGrid& grid = patch.source->mean;
  std::array<float, max_components> mean;
  sample(grid, cell_at(grid, patch.scale * w + patch.offset), mean.data());
  const float gain = result.coverage / std::sqrt(squares + reader.layer->blend.correlation * (whole - squares));
  for (int c = 0; c < reader.components; ++c) {
    if (!reader.preserved[c]) continue;
    const float least = grid.low[c / 4][c % 4], most = least + 65535 * grid.step[c / 4][c % 4];
    const float middle = result.coverage * mean[c];
    result.value[c] =
        std::clamp(middle + gain * (result.value[c] - middle), result.coverage * least, result.coverage * most);
  }
}

constexpr float opaque = 0.996f; ///< what lies below would change no 8-bit value by more than one step

/// From the newest paste down until nothing shines through. Reading a mask, then an exemplar, then the next mask
/// would wait for the memory each time: so a few look-ups at once are prepared, and what they will read is asked for.
/// Components 0: any number.
template <int Width, int Components>
LayerValue composite_over(const LayerReader& reader, std::span<const Lookup> lookups, const SimplexPoint& point) {
  constexpr int ahead = 2;
  const int components = Components ? Components : reader.components;
  const bool plain = !needs_gradient(reader, point.footprint), preserves = reader.layer->blend.preserves_variance();
  struct Candidate {
    Sight sight;
    TexelCell cell;
    const Lookup* lookup;
    const LayerReader::PatchReader* patch;
  };
  LayerValue result;
  std::array<float, max_components> value;
  float squares = 0;
  const Lookup* last = nullptr; // of those read, and where
  Lanes last_at{};
  const auto finished = [&]() -> const LayerValue& {
    if (result.coverage >= opaque) { // nothing shines through: what is seen stands for the whole
      for (int k = 0; k < components; ++k) result.value[k] /= result.coverage;
      squares /= result.coverage * result.coverage;
      result.coverage = 1;
    }
    if (preserves && result.lookups_read > 1) preserve_variance(reader, *last, last_at, squares, result);
    return result;
  };
  for (std::size_t next = lookups.size(); next > 0 && result.coverage < opaque;) {
    std::array<Candidate, ahead> candidate;
    int count = 0;
    for (; next > 0 && count < ahead; --next) {
      Candidate& c = candidate[count];
      c.lookup = &lookups[next - 1];
      c.sight = weight_at<Width>(reader, *c.lookup, point.barycentric);
      c.patch = &reader.patch[reader.patch_of[c.lookup - reader.layer->lookup.data()]];
      if (!(c.sight.alpha > 0)) continue;
      if (c.patch->mask) {
        if (!c.patch->mask->reaches(c.sight.w)) continue;
      }
      if (plain) {
        const TexelGrid& grid = c.patch->source->level[0];
        c.cell = cell_at(grid, c.patch->scale * c.sight.w + c.patch->offset);
        prefetch(grid, c.cell);
      }
      ++count;
    }
    for (int i = 0; i < count; ++i) {
      Candidate& c = candidate[i];
      if (c.patch->mask) c.sight.alpha *= c.patch->mask->alpha(c.sight.w);
      if (!(c.sight.alpha > 0)) continue;
      if (plain)
        sample(c.patch->source->level[0], c.cell, value.data());
      else
        read_exemplar(reader, *c.lookup, c.sight, point, false, value.data());
      ++result.lookups_read;
      const float shown = (1 - result.coverage) * std::min(c.sight.alpha, 1.0f);
      for (int k = 0; k < components; ++k) result.value[k] += shown * value[k];
      result.coverage += shown;
      if (preserves) squares += shown * shown, last = c.lookup, last_at = c.sight.w;
      if (result.coverage >= opaque) return finished();
    }
  }
  return finished();
}

/// The look-ups with positive weight: the largest `max_weighted_lookups`, in paste order.
struct Weighted {
  std::array<Sight, max_weighted_lookups> sight;
  std::array<const Lookup*, max_weighted_lookups> lookup;
  std::array<float, max_weighted_lookups> weight;
  int count = 0;
};

Weighted weighted_lookups(const LayerReader& reader, std::span<const Lookup> lookups, const SimplexPoint& point) {
  Weighted kept;
  float total = 0;
  for (const Lookup& lookup : lookups) {
    const Sight sight = sight_of(reader, lookup, point.barycentric);
    if (!(sight.alpha > 0)) continue;
    total += sight.alpha;
    int slot = kept.count;
    if (kept.count == max_weighted_lookups) {
      slot = static_cast<int>(std::min_element(kept.weight.begin(), kept.weight.end()) - kept.weight.begin());
      if (kept.weight[slot] >= sight.alpha) continue;
      for (int i = slot; i + 1 < kept.count; ++i) { // keep paste order
        kept.sight[i] = kept.sight[i + 1];
        kept.lookup[i] = kept.lookup[i + 1];
        kept.weight[i] = kept.weight[i + 1];
      }
      slot = kept.count - 1;
    } else {
      ++kept.count;
    }
    kept.sight[slot] = sight;
    kept.lookup[slot] = &lookup;
    kept.weight[slot] = sight.alpha;
  }
  float sum = 0;
  for (int i = 0; i < kept.count; ++i) sum += kept.weight[i];
  if (sum > 0 && sum < total) // some were dropped: the rest stand for the whole
    for (int i = 0; i < kept.count; ++i) kept.weight[i] *= total / sum;
  return kept;
}

/// Schuster 2020, §3.4.2 and §3.5: effective heights w·h or w·(1 − h); those within the grace of the largest stay,
/// with weight (h_e − max(0, h_e,max − Δh)) / Δh.
void select_by_height(const LayerReader& reader, const Blend& blend, Weighted& kept,
                      const std::array<std::array<float, max_components>, max_weighted_lookups>& value) {
  float largest = 0;
  std::array<float, max_weighted_lookups> effective{};
  for (int i = 0; i < kept.count; ++i) {
    const float height = value[i][reader.height_component];
    effective[i] = kept.weight[i] * (blend.select == Blend::Select::max ? height : 1 - height);
    largest = std::max(largest, effective[i]);
  }
  if (!(largest > 0)) return; // no height anywhere: plain weights decide
  const float floor = std::max(0.0f, largest - blend.grace);
  for (int i = 0; i < kept.count; ++i) kept.weight[i] = std::max(0.0f, effective[i] - floor) / blend.grace;
}

LayerValue composite_weights(const LayerReader& reader, std::span<const Lookup> lookups, const SimplexPoint& point) {
  const Blend& blend = reader.layer->blend;
  Weighted kept = weighted_lookups(reader, lookups, point);
  LayerValue result;
  if (kept.count == 0) return result;

  const bool histogram = blend.mix == Blend::Mix::histogram;
  std::array<std::array<float, max_components>, max_weighted_lookups> value;
  if (!histogram || blend.select != Blend::Select::none || reader.has_directions)
    for (int i = 0; i < kept.count; ++i)
      read_exemplar(reader, *kept.lookup[i], kept.sight[i], point, false, value[i].data());
  float sum = 0;
  for (int i = 0; i < kept.count; ++i) sum += kept.weight[i];
  const float coverage = blend.mix == Blend::Mix::weighted ? std::min(1.0f, sum) : 1.0f;
  if (blend.select != Blend::Select::none) {
    select_by_height(reader, blend, kept, value);
    sum = 0;
    for (int i = 0; i < kept.count; ++i) sum += kept.weight[i];
  }
  std::array<float, max_components> mean{};
  if (!histogram || reader.has_directions)
    for (int i = 0; i < kept.count; ++i)
      for (int c = 0; c < reader.components; ++c) mean[c] += kept.weight[i] / sum * value[i][c];
  if (histogram) {
    float squares = 0;
    for (int i = 0; i < kept.count; ++i) squares += kept.weight[i] / sum * (kept.weight[i] / sum);
    const float gain = 1 / std::sqrt(squares);
    std::array<float, max_components> gaussian{}, one;
    for (int i = 0; i < kept.count; ++i) {
      read_exemplar(reader, *kept.lookup[i], kept.sight[i], point, true, one.data());
      for (int c = 0; c < reader.components; ++c) gaussian[c] += gain * kept.weight[i] / sum * one[c];
    }
    // Back through the first exemplar's inverse table, linearly between its entries; directions keep their mean.
    const Exemplar& exemplar = reader.layer->exemplar[reader.layer->patch[kept.lookup[0]->patch].exemplar];
    int component = 0;
    for (const Channel& channel : exemplar.channel)
      for (int k = 0; k < channel.components; ++k, ++component) {
        if (channel.semantic == Semantic::direction || channel.semantic == Semantic::normal) continue;
        const float byte = std::clamp((gaussian[component] / 6 + 0.5f) * 255, 0.0f, 255.0f);
        const int low = std::min(254, static_cast<int>(byte));
        const float* table = exemplar.inverse.data() + component * 256;
        mean[component] = table[low] + (byte - low) * (table[low + 1] - table[low]);
      }
  }
  for (int c = 0; c < reader.components; ++c) result.value[c] = coverage * mean[c];
  result.coverage = coverage;
  result.lookups_read = kept.count;
  if (blend.preserves_variance() && kept.count > 1) {
    float squares = 0;
    for (int i = 0; i < kept.count; ++i) squares += kept.weight[i] * kept.weight[i];
    preserve_variance(reader, *kept.lookup[0], kept.sight[0].w, squares * (coverage / sum) * (coverage / sum),
                      result);
  }
  return result;
}

} // namespace

LayerValue composite(const LayerReader& reader, std::span<const Lookup> lookups, const SimplexPoint& point) {
  if (reader.layer->blend.mix != Blend::Mix::over) return composite_weights(reader, lookups, point);
  switch (reader.layer->width) {
  case 2:
    return composite_over<2, 0>(reader, lookups, point);
  case 3:
    return reader.components == 3 ? composite_over<3, 3>(reader, lookups, point)
                                  : composite_over<3, 0>(reader, lookups, point);
  default:
    return composite_over<4, 0>(reader, lookups, point);
  }
}

LayerCoverage coverage_of(const LayerReader& reader, std::span<const Lookup> lookups, const SimplexPoint& point) {
  LayerCoverage result;
  float sum = 0, shown_through = 1;
  for (const Lookup& lookup : lookups) {
    const float alpha = sight_of(reader, lookup, point.barycentric).alpha;
    if (!(alpha > 0)) continue;
    ++result.visible;
    sum += alpha;
    shown_through *= 1 - std::min(alpha, 1.0f);
  }
  switch (reader.layer->blend.mix) {
  case Blend::Mix::over:
    result.coverage = 1 - shown_through;
    break;
  case Blend::Mix::weighted:
    result.coverage = std::min(1.0f, sum);
    break;
  default:
    result.coverage = sum > 0 ? 1.0f : 0.0f;
  }
  return result;
}

} // namespace pith
