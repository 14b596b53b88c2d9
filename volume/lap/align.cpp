#include "volume/lap/align.h"

#include <algorithm>
#include <cmath>

namespace pith {

namespace {

/// An exemplar no larger than `most` texels along any axis.
Exemplar reduced(const Exemplar& exemplar, int most) {
  Exemplar e = exemplar;
  e.gaussian.clear();
  e.inverse.clear();
  while (std::max({e.size[0], e.size[1], e.size[2]}) > most) e = half_size(e);
  return e;
}

/// A place where the new paste and older ones are both seen.
struct Meeting {
  std::array<float, 3> w;                  ///< coordinates of the new paste there, in texture widths
  std::array<float, max_components> color; ///< of the older ones, in bytes
  float weight;
};

const std::uint8_t* nearest_texel(const Exemplar& e, const std::array<float, 3>& u) {
  std::array<int, 3> at;
  for (int a = 0; a < 3; ++a) {
    const int n = e.size[a];
    int i = static_cast<int>(std::floor(u[a] * n));
    if (e.wrap[a] == Wrap::repeat) {
      if ((i %= n) < 0) i += n;
    } else {
      i = std::clamp(i, 0, n - 1);
    }
    at[a] = i;
  }
  return e.at(at[0], at[1], at[2]);
}

/// Weighted squared difference of a phase.
double difference(const Exemplar& e, const std::vector<Meeting>& meetings, const std::array<float, 3>& phase,
                  double give_up) {
  const int components = e.component_count();
  double sum = 0;
  for (const Meeting& m : meetings) {
    const std::uint8_t* texel = nearest_texel(e, {m.w[0] + phase[0], m.w[1] + phase[1], m.w[2] + phase[2]});
    float squared = 0;
    for (int c = 0; c < components; ++c) squared += (texel[c] - m.color[c]) * (texel[c] - m.color[c]);
    sum += m.weight * squared;
    if (sum >= give_up) break;
  }
  return sum;
}

} // namespace

Aligner::Aligner(const Exemplar& exemplar) : coarse_(reduced(exemplar, 16)), fine_(reduced(exemplar, 64)) {}

std::array<float, 4> Aligner::phase(const Pastes& pastes, const Simplices& mesh, const Paste& paste,
                                    const std::array<bool, 3>& free, const std::array<float, 4>& random) const {
  if (coarse_.axes != 3) return random;
  const Clump& clump = paste.growth.clump;
  const MaskGrid& mask = pastes.grids()[paste.patch.mask];
  const int n = mesh.corners, components = coarse_.component_count();
  constexpr std::size_t enough = 96;

  // Where older pastes fade out and this one shows below them: that is the seam somebody would see.
  std::vector<Meeting> meetings;
  for (std::uint32_t s = 0; s < clump.simplex.size(); ++s) {
    const std::uint32_t simplex = clump.simplex[s];
    if (!pastes.coverage().open(simplex)) continue;
    const auto samples = pastes.coverage().samples(simplex);
    const auto shining = pastes.coverage().shining(simplex);
    const std::size_t stride = std::max<std::size_t>(1, samples.size() / 12);
    for (std::size_t i = s % stride; i < samples.size(); i += stride) {
      if (shining[i] <= 0.05f || shining[i] >= 0.95f) continue;
      Meeting m{};
      for (int c = 0; c < n; ++c)
        for (int a = 0; a < 3; ++a)
          m.w[a] += samples[i][c] * static_cast<float>(clump.coordinate[clump.corner[s * n + c] * 3 + a]);
      const float alpha = mask.alpha(Lanes{m.w[0], m.w[1], m.w[2], 0});
      if (alpha < 0.1f) continue;
      for (int a = 0; a < 3; ++a) m.w[a] *= paste.patch.frame.scale[a];
      float through = 1;
      pastes.visit(simplex, samples[i], [&](const Patch& patch, const std::array<float, 4>& w, float a) {
        std::array<float, 3> u;
        for (int k = 0; k < 3; ++k) u[k] = patch.frame.scale[k] * w[k] + patch.frame.offset[k];
        const std::uint8_t* texel = nearest_texel(coarse_, u);
        for (int c = 0; c < components; ++c) m.color[c] += through * a * texel[c];
        through *= 1 - a;
        return through > 0.01f;
      });
      if (through > 0.95f) continue;
      for (int c = 0; c < components; ++c) m.color[c] /= 1 - through;
      m.weight = alpha * std::min(shining[i], 1 - shining[i]);
      meetings.push_back(m);
    }
  }
  if (meetings.size() < 6) return random;
  if (meetings.size() > enough) { // thin evenly
    std::vector<Meeting> thinned;
    for (std::size_t i = 0; i < enough; ++i) thinned.push_back(meetings[i * meetings.size() / enough]);
    meetings = std::move(thinned);
  }

  // Every coarse texel of phase, from the random start on (so that ties are broken at random), then finer steps.
  std::array<float, 3> best{random[0], random[1], random[2]};
  double least = std::numeric_limits<double>::infinity();
  const auto attempt = [&](const Exemplar& e, const std::array<float, 3>& phase) {
    const double d = difference(e, meetings, phase, least);
    if (d < least) {
      least = d;
      best = phase;
    }
  };
  /// Calls with start + step · (i, j, k) for low ≤ i, j, k < high along free axes.
  const auto attempt_all = [&](const Exemplar& e, std::array<float, 3> start, std::array<float, 3> step,
                               std::array<int, 3> low, std::array<int, 3> high) {
    for (int a = 0; a < 3; ++a)
      if (!free[a]) low[a] = 0, high[a] = 1;
    for (int k = low[2]; k < high[2]; ++k)
      for (int j = low[1]; j < high[1]; ++j)
        for (int i = low[0]; i < high[0]; ++i)
          attempt(e, {start[0] + i * step[0], start[1] + j * step[1], start[2] + k * step[2]});
  };
  std::array<float, 3> step;
  for (int a = 0; a < 3; ++a) step[a] = 1.0f / coarse_.size[a];
  attempt_all(coarse_, best, step, {0, 0, 0}, {coarse_.size[0], coarse_.size[1], coarse_.size[2]});
  least = std::numeric_limits<double>::infinity();
  attempt_all(fine_, best, {step[0] / 4, step[1] / 4, step[2] / 4}, {-3, -3, -3}, {4, 4, 4});
  std::array<float, 4> phase = random;
  for (int a = 0; a < 3; ++a)
    if (free[a]) phase[a] = best[a] - std::floor(best[a]);
  return phase;
}

} // namespace pith
