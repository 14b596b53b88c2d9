#include "volume/lap/align.h"

#include "volume/base/random.h"

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

std::array<int, 3> texel_of(const Exemplar& e, const std::array<float, 3>& u) {
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
  return at;
}

/// An exemplar's texels that meetings fall on at some phase, and the difference from what is there when all of them
/// are shifted by whole texels: no position is computed twice.
class Shifts {
public:
  Shifts(const Exemplar& e, std::span<const Meeting> meetings, const std::array<float, 3>& phase)
      : e_(e), meetings_(meetings), components_(e.component_count()) {
    base_.reserve(meetings.size());
    for (const Meeting& m : meetings)
      base_.push_back(texel_of(e, {m.w[0] + phase[0], m.w[1] + phase[1], m.w[2] + phase[2]}));
  }

  /// Weighted squared difference; stops once it is no better than `give_up`. `shift`: 0 along axes that do not
  /// repeat, else above −texels and below +texels.
  double difference(const std::array<int, 3>& shift, double give_up) const {
    double sum = 0;
    for (std::size_t i = 0; i < meetings_.size(); ++i) {
      std::array<int, 3> at;
      for (int a = 0; a < 3; ++a) {
        at[a] = base_[i][a] + shift[a];
        at[a] += at[a] < 0 ? e_.size[a] : at[a] >= e_.size[a] ? -e_.size[a] : 0;
      }
      const std::uint8_t* texel =
          e_.texel.data() + ((std::size_t(at[2]) * e_.size[1] + at[1]) * e_.size[0] + at[0]) * components_;
      float squared = 0;
      for (int c = 0; c < components_; ++c)
        squared += (texel[c] - meetings_[i].color[c]) * (texel[c] - meetings_[i].color[c]);
      sum += meetings_[i].weight * squared;
      if (sum >= give_up) break;
    }
    return sum;
  }

private:
  const Exemplar& e_;
  std::span<const Meeting> meetings_;
  int components_;
  std::vector<std::array<int, 3>> base_;
};

/// A phase and how far it is from what is there.
struct Candidate {
  double difference;
  std::array<float, 3> phase;
};

/// The best few candidates, the best first; of equals the earlier.
class Shortlist {
public:
  explicit Shortlist(std::size_t most) : most_(most) {}
  double worst() const {
    return kept_.size() < most_ ? std::numeric_limits<double>::infinity() : kept_.back().difference;
  }
  void offer(const Candidate& c) {
    if (!(c.difference < worst())) return;
    if (kept_.size() == most_) kept_.pop_back();
    kept_.insert(std::upper_bound(kept_.begin(), kept_.end(), c,
                                  [](const auto& a, const auto& b) { return a.difference < b.difference; }),
                 c);
  }
  const std::vector<Candidate>& kept() const { return kept_; }

private:
  std::size_t most_;
  std::vector<Candidate> kept_;
};

} // namespace

Aligner::Aligner(const Exemplar& exemplar, bool structured) : structured_(structured) {
  for (const int most : structured ? std::vector{32, 64, 128} : std::vector{16, 64})
    level_.push_back(reduced(exemplar, most));
}

std::array<float, 4> Aligner::phase(const Pastes& pastes, const Simplices& mesh, const Paste& paste,
                                    const std::array<bool, 3>& free, const std::array<float, 4>& random) const {
  const Exemplar& coarse = level_.front();
  if (coarse.axes != 3) return random;
  const Exemplar& source = structured_ ? level_.back() : coarse; // of what is there
  const Clump& clump = paste.growth.clump;
  const MaskGrid& mask = pastes.grids()[paste.patch.mask];
  const int n = mesh.corners, components = coarse.component_count();
  const std::size_t enough = structured_ ? 600 : 96;

  // Where older pastes fade out and this one shows below them: that is the seam somebody would see. Seams that are
  // cut afterwards may run anywhere in the overlap, so there all of it counts.
  const float least = structured_ ? -1.0f : 0.05f;
  std::vector<Meeting> meetings;
  for (std::uint32_t s = 0; s < clump.simplex.size(); ++s) {
    const std::uint32_t simplex = clump.simplex[s];
    if (!pastes.coverage().open(simplex) && !structured_) continue;
    const auto samples = pastes.coverage().samples(simplex);
    const auto shining = pastes.coverage().shining(simplex);
    const std::size_t stride = std::max<std::size_t>(1, samples.size() / 12);
    for (std::size_t i = s % stride; i < samples.size(); i += stride) {
      if (shining[i] <= least || shining[i] >= 0.95f) continue;
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
        const std::array<int, 3> at = texel_of(source, u);
        const std::uint8_t* texel = source.at(at[0], at[1], at[2]);
        for (int c = 0; c < components; ++c) m.color[c] += through * a * texel[c];
        through *= 1 - a;
        return through > 0.01f;
      });
      if (through > 0.95f) continue;
      for (int c = 0; c < components; ++c) m.color[c] /= 1 - through;
      m.weight = structured_ ? alpha * (1 - through) : alpha * std::min(shining[i], 1 - shining[i]);
      meetings.push_back(m);
    }
  }
  if (meetings.size() < 6) return random;
  if (meetings.size() > enough) { // thin evenly
    std::vector<Meeting> thinned;
    for (std::size_t i = 0; i < enough; ++i) thinned.push_back(meetings[i * meetings.size() / enough]);
    meetings = std::move(thinned);
  }
  if (structured_) { // far apart places one after the other, so that a bad phase is soon given up
    Random order(paste.patch.key);
    for (std::size_t i = meetings.size(); i > 1; --i)
      std::swap(meetings[i - 1], meetings[order.below(static_cast<int>(i))]);
  }
  const std::span<const Meeting> some(meetings.data(), std::min<std::size_t>(meetings.size(), 200));

  // Every coarse texel of phase, from the random start on (so that ties are broken at random), then finer steps
  // around the best.
  Shortlist best(structured_ ? 48 : 1);
  /// Tries start and all phases low ≤ i, j, k < high texels from it along free axes.
  const auto attempt_all = [&](const Exemplar& e, const std::array<float, 3>& start, std::array<int, 3> low,
                               std::array<int, 3> high, std::span<const Meeting> at, Shortlist& list) {
    const Shifts shifts(e, at, start);
    for (int a = 0; a < 3; ++a)
      if (!free[a]) low[a] = 0, high[a] = 1;
    for (int k = low[2]; k < high[2]; ++k)
      for (int j = low[1]; j < high[1]; ++j)
        for (int i = low[0]; i < high[0]; ++i)
          list.offer(
              {shifts.difference({i, j, k}, list.worst()),
               {start[0] + float(i) / e.size[0], start[1] + float(j) / e.size[1], start[2] + float(k) / e.size[2]}});
  };
  attempt_all(coarse, {random[0], random[1], random[2]}, {0, 0, 0}, {coarse.size[0], coarse.size[1], coarse.size[2]},
              some, best);
  for (std::size_t l = 1; l < level_.size(); ++l) {
    Shortlist refined(l + 1 < level_.size() ? 16 : 1);
    std::array<int, 3> low, high;
    for (int a = 0; a < 3; ++a) {
      high[a] = std::max(1, level_[l].size[a] / level_[l - 1].size[a]); // texels of this level in one of the last
      low[a] = 1 - high[a];
    }
    for (const Candidate& c : best.kept()) attempt_all(level_[l], c.phase, low, high, meetings, refined);
    best = std::move(refined);
  }
  std::array<float, 4> phase = random;
  const std::array<float, 3>& found = best.kept().front().phase;
  for (int a = 0; a < 3; ++a)
    if (free[a]) phase[a] = found[a] - std::floor(found[a]);
  return phase;
}

} // namespace pith
