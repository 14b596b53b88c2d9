#include "volume/lap/pastes.h"

#include <Eigen/LU>
#include <algorithm>
#include <numeric>

namespace pith {

Pastes::Pastes(const Simplices& mesh, Coverage coverage, std::vector<Mask> masks, bool keep_hidden)
    : mesh_(mesh), coverage_(std::move(coverage)), masks_(std::move(masks)), grids_(masks_.begin(), masks_.end()),
      axes_(masks_.front().axes), keep_hidden_(keep_hidden), newest_(mesh.count, none) {
  for (const Mask& mask : masks_)
    mask_volume_.push_back(std::accumulate(mask.alpha.begin(), mask.alpha.end(), 0.0) / 255 / mask.alpha.size());
}

void Pastes::look(Paste& paste) const {
  const Clump& clump = paste.growth.clump;
  const MaskGrid& mask = grids_[paste.patch.mask];
  const int n = mesh_.corners;
  paste.shown.clear();
  paste.let_through.clear();
  paste.inverted = 0;
  double used = 0;
  std::array<Lanes, 4> row{};
  const auto alpha_at = [&](const std::array<float, 4>& b) {
    const Lanes w = (b[0] * row[0] + b[1] * row[1]) + (b[2] * row[2] + b[3] * row[3]);
    return w[axes_] > 0 ? w[axes_] * mask.alpha(w) : 0.0f;
  };
  for (std::uint32_t s = 0; s < clump.simplex.size(); ++s) {
    for (int i = 0; i < n; ++i) {
      const std::uint32_t v = clump.corner[s * n + i];
      for (int k = 0; k < axes_; ++k) row[i][k] = static_cast<float>(clump.coordinate[v * axes_ + k]);
      row[i][axes_] = paste.growth.weight[v];
    }
    // The used share: alpha at its middle times the size of its image in the texture.
    double image = 0; // six times its volume in the mask's cube, below 0 in mirror image
    if (n == 4) {
      Mat3d edges;
      for (int k = 0; k < 3; ++k)
        for (int a = 0; a < 3; ++a) edges(a, k) = row[k + 1][a] - row[0][a];
      image = edges.determinant();
      used += std::abs(image) / 6 * alpha_at({0.25f, 0.25f, 0.25f, 0.25f});
    }
    const std::uint32_t simplex = clump.simplex[s];
    if (!coverage_.open(simplex) && !keep_hidden_) continue;
    const auto samples = coverage_.samples(simplex);
    const auto shining = coverage_.shining(simplex);
    const std::size_t start = paste.let_through.size();
    bool seen = false;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const float alpha = alpha_at(samples[i]);
      seen |= alpha > 0 && (shining[i] > 1 / 512.0f || keep_hidden_);
      paste.let_through.push_back(1 - alpha);
    }
    if (seen) {
      paste.shown.push_back(s);
      paste.inverted += image < 0;
    } else {
      paste.let_through.resize(start);
    }
  }
  paste.share_used = static_cast<float>(used / mask_volume_[paste.patch.mask]);
}

void Pastes::commit(const Paste& paste) {
  const Clump& clump = paste.growth.clump;
  const int n = mesh_.corners;
  const std::uint32_t patch = static_cast<std::uint32_t>(patch_.size());
  std::vector<std::uint32_t> row_of(clump.vertex.size(), none);
  std::size_t at = 0;
  bool used = false;
  for (std::uint32_t s : paste.shown) {
    const std::uint32_t simplex = clump.simplex[s];
    const std::size_t samples = coverage_.samples(simplex).size();
    const std::span<const float> let_through(paste.let_through.data() + at, samples);
    at += samples;
    if (!coverage_.open(simplex) && !keep_hidden_) continue; // closed by a paste of the same round
    Lookup lookup;
    lookup.patch = patch;
    for (int i = 0; i < n; ++i) {
      const std::uint32_t v = clump.corner[s * n + i];
      if (row_of[v] == none) {
        row_of[v] = static_cast<std::uint32_t>(corner_.size() / (axes_ + 1));
        for (int k = 0; k < axes_; ++k) corner_.push_back(static_cast<float>(clump.coordinate[v * axes_ + k]));
        corner_.push_back(paste.growth.weight[v]);
      }
      lookup.corner[i] = row_of[v];
    }
    for (int i = n; i < 4; ++i) lookup.corner[i] = lookup.corner[n - 1];
    older_.push_back(newest_[simplex]);
    newest_[simplex] = static_cast<std::uint32_t>(lookup_.size());
    lookup_.push_back(lookup);
    coverage_.cover(simplex, let_through);
    used = true;
  }
  if (used) patch_.push_back(paste.patch);
}

Layer Pastes::take_layer() {
  Layer layer;
  layer.width = axes_;
  layer.blend = {};
  layer.mask = std::move(masks_);
  layer.patch = std::move(patch_);
  layer.corner = std::move(corner_);
  layer.begin.assign(1, 0);
  layer.begin.reserve(mesh_.count + 1);
  layer.lookup.reserve(lookup_.size());
  for (std::uint32_t simplex = 0; simplex < mesh_.count; ++simplex) {
    for (std::uint32_t node = newest_[simplex]; node != none; node = older_[node])
      layer.lookup.push_back(lookup_[node]);
    layer.begin.push_back(static_cast<std::uint32_t>(layer.lookup.size()));
  }
  return layer;
}

} // namespace pith
