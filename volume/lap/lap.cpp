// Takayama, Okabe, Ijiri, Igarashi: Lapped Solid Textures (SIGGRAPH 2008), §5.2.
//
// Order of work: masks (§5.2.1) → rounds of { seeds (§5.2.3) → grow and warp (§5.2.4, §5.2.5; depth as coordinate
// §5.2.7) → coverage (§5.2.6) } until no tet is open. Departures: newer pastes lie beneath older ones; seeds are
// chosen by a hash of their place instead of a running random number, in rounds of seeds that keep apart, so that the
// fill runs in parallel and a local edit changes it locally; the seed's point is one that is still open instead of
// the barycentre.
#include "volume/lap/lap.h"

#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/lap/affine_layer.h"
#include "volume/lap/align.h"
#include "volume/lap/mixing.h"
#include "volume/lap/pastes.h"
#include "volume/lap/pivots.h"
#include "volume/lap/seam_cut.h"
#include "volume/lap/turning.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace pith {

namespace {

constexpr std::uint64_t stage = 0x1a9; // of random numbers

[[noreturn]] void refuse_length(const LapInput& input, const std::string& what, std::size_t have, std::size_t need,
                                const std::string& of) {
  throw InvalidInput(input.where,
                     "was given " + what + " for " + std::to_string(have) + " of " + std::to_string(need) + " " + of,
                     "make " + what + " for the whole mesh first");
}

void check(const LapInput& input, const Exemplar& exemplar, const LapOptions& options) {
  const TextureTraits& traits = traits_of(options.type);
  const std::string type = std::string("type ") + traits.name;
  const std::size_t tets = input.mesh.tet_count(), vertices = input.mesh.vertex_count();
  const std::string where = input.where + "/exemplar";
  validate(exemplar);
  if (exemplar.axes != 3)
    throw InvalidInput(where, "'" + exemplar.name + "' is not a volume", "a solid is filled from a volume of 3 axes");
  constexpr const char* field_name[3] = {"around", "depth", "along"};
  for (int axis = 0; axis < 3; ++axis) {
    if (traits.imposed[axis]) {
      if (input.coordinate[axis].empty())
        throw InvalidInput(input.where + "/" + field_name[axis],
                           "is missing: " + type + " takes its coordinate " + axis_letter(axis) + " from it",
                           "give it two places and their values, or choose another type");
      if (input.coordinate[axis].size() != vertices)
        refuse_length(input, field_name[axis], input.coordinate[axis].size(), vertices, "vertices");
    } else if (exemplar.wrap[axis] != Wrap::repeat) {
      throw InvalidInput(where,
                         "'" + exemplar.name + "' does not repeat along axis " + std::to_string(axis) + " (" +
                             axis_letter(axis) + "), along which " + type + " tiles",
                         "take an exemplar with wrap \"repeat\" there, or a type in which \"" +
                             std::string(field_name[axis]) + "\" is that coordinate (" +
                             (axis == 1   ? "1-b, 2-b"
                              : axis == 2 ? "2-c, 2-d"
                                          : "2-d") +
                             ")");
    }
  }
  if (traits.imposed[0] && traits.imposed[1] && traits.imposed[2]) return;
  if (traits.fixed_axes > 0 && input.axes.size() != tets)
    refuse_length(input, "frames", input.axes.size(), tets, "tets");
  if (input.scale.size() != tets) refuse_length(input, "scales", input.scale.size(), tets, "tets");
  for (const TetId t : all_ids<TetId>(tets))
    if (input.mesh.region[t] == input.region && !(input.scale[t] > 0 && std::isfinite(input.scale[t])))
      throw InvalidInput(input.where + "/scale", "is " + std::to_string(input.scale[t]) + " mm in some tet",
                         "give millimetres per texture width, above 0");
}

/// Outer, middle and inner masks (Fig. 14) along depth, where that is a coordinate: the scale follows the thickness,
/// so that no piece fits both skin and core. Along a further coordinate the scale hardly changes, and as the texture
/// is in place there whatever the piece, pieces need no end: type 2-c pastes sheets, whose only seams run along S and
/// T.
std::vector<SplotchPart> parts_of(TextureType type) {
  if (traits_of(type).imposed[1]) return {SplotchPart::outer, SplotchPart::middle, SplotchPart::inner};
  return {SplotchPart::whole};
}

/// Each part's masks in a few variants, one part after the other.
std::vector<Mask> masks_of(const LapOptions& options) {
  std::vector<Mask> masks;
  for (SplotchPart part : parts_of(options.type))
    for (int variant = 0; variant < options.mask_variants; ++variant) {
      SplotchOptions splotch = options.splotch;
      splotch.axes = 3;
      splotch.variation_axis = 1;
      splotch.endless_axis = traits_of(options.type).imposed[2] ? 2 : -1;
      splotch.seed = hash_of(options.seed, stage, variant, splotch.seed);
      masks.push_back(splotch_mask(splotch, part));
    }
  return masks;
}

/// A seed's priority: a hash of where it is.
std::uint64_t priority_of(const Vec3d& place, std::uint64_t seed) {
  return hash_of(seed, stage, std::bit_cast<std::uint64_t>(place.x()), std::bit_cast<std::uint64_t>(place.y()),
                 std::bit_cast<std::uint64_t>(place.z()));
}

void show(const Exemplar& exemplar, Layer& layer) {
  layer.name = exemplar.name;
  layer.exemplar.push_back(exemplar);
}

class Filler {
public:
  Filler(const LapInput& input, const Exemplar& exemplar, const LapOptions& options)
      : input_(input), exemplar_(exemplar), options_(options), traits_(traits_of(options.type)),
        mesh_(simplices_of(input.mesh, input.region)),
        pastes_(mesh_, coverage(), masks_of(options), options.structured), aligner_(exemplar, options.structured),
        attempts_(mesh_.count, 0), failures_(mesh_.count, 0), workspace_(most_seeds) {
    field_.frames = {.axes = input.axes,
                     .fixed_axes = traits_.fixed_axes,
                     .fixed_axis = traits_.fixed_axis,
                     .unsigned_axis = input.unsigned_axis && traits_.uses_stroke};
    field_.scale = input.scale;
    for (int a = 0; a < 3; ++a)
      if (traits_.imposed[a]) field_.coordinate[a] = input.coordinate[a];
    field_.singular = input.singular;
    pivot_ = pivots_of(mesh_, field_.frames, input.singular);
    field_.pivot = pivot_;
    if (options.length_weight < 1 && traits_.fixed_axes > 0) {
      length_weight_ = length_weights();
      field_.length_weight = length_weight_;
    }
    for (std::uint32_t s = 0; s < mesh_.count; ++s)
      if (pastes_.coverage().open(s)) queue_.push_back(s);
    std::vector<std::uint64_t> priority(mesh_.count);
    for (std::uint32_t s : queue_) priority[s] = priority_of(mesh_.center[s], options.seed);
    std::sort(queue_.begin(), queue_.end(),
              [&](auto a, auto b) { return std::pair(priority[a], a) < std::pair(priority[b], b); });
  }

  LapResult run(const Progress& progress) {
    const double all = static_cast<double>(std::max<std::size_t>(1, queue_.size()));
    const double pasting = options_.structured ? 0.7 : 1; // of the time
    while (pastes_.coverage().open_count() > 0) {
      report(progress, pasting * (1 - pastes_.coverage().open_count() / all));
      paste(next_seeds());
      ++statistics_.rounds;
    }
    LapResult result;
    result.layer = pastes_.take_layer();
    result.layer.region = input_.region;
    show(exemplar_, result.layer);
    if (options_.structured)
      cut_seams(mesh_, coverage(), result.layer,
                [&](double done) { return !progress || progress(pasting + (1 - pasting) * done); });
    if (options_.preserve_variance) {
      for (int a = 0; a < 3; ++a) result.layer.blend.mean_over[a] = !traits_.imposed[a];
      result.layer.blend.correlation = correlation_where_mixed(mesh_, result.layer);
    }
    report(progress, 1);
    statistics_.pastes = result.layer.patch.size();
    statistics_.lookups = result.layer.lookup.size();
    if (!shares_.empty()) {
      std::nth_element(shares_.begin(), shares_.begin() + shares_.size() / 2, shares_.end());
      statistics_.median_share_used = shares_[shares_.size() / 2];
    }
    result.statistics = statistics_;
    return result;
  }

private:
  static constexpr std::size_t most_seeds = 16; ///< in one round; fixed, so that the result is

  /// Per simplex, for the warp.
  std::vector<float> length_weights() const {
    constexpr double resolved = 0.7; // radians from a simplex to the next, from which on lengths count in full
    std::vector<float> weight = turning_of(mesh_, field_.frames, field_.singular);
    for (float& w : weight)
      w = static_cast<float>(std::clamp(w * w / (resolved * resolved), options_.length_weight, 1.0));
    return weight;
  }

  /// With nothing covered yet.
  Coverage coverage() const {
    std::vector<float> size(mesh_.count, -1.0f);
    parallel_for(mesh_.count, 4096, [&](std::size_t s) {
      if (!(mesh_.measure[s] > 0)) return;
      double longest = 0;
      for (int i = 0; i < mesh_.corners; ++i)
        for (int j = 0; j < i; ++j)
          longest = std::max(longest, (mesh_.position[mesh_.corner[s * mesh_.corners + i]] -
                                       mesh_.position[mesh_.corner[s * mesh_.corners + j]])
                                          .norm());
      size[s] = static_cast<float>(longest / input_.scale[s]);
    });
    return Coverage(mesh_.corners, size, options_.sample_spacing, options_.coverage_order);
  }

  /// Open simplices in order of priority that keep a texture width from one another (§5.2.3).
  std::vector<std::uint32_t> next_seeds() {
    std::erase_if(queue_, [&](std::uint32_t s) { return !pastes_.coverage().open(s); });
    std::vector<std::uint32_t> seeds;
    for (std::size_t i = 0; i < queue_.size() && (i < 4096 || options_.structured) && seeds.size() < most_seeds;
         ++i) {
      const std::uint32_t s = queue_[i];
      if (options_.structured && pastes_.count() > 0 && !at_front(s)) continue;
      const bool apart = std::all_of(seeds.begin(), seeds.end(), [&](std::uint32_t other) {
        const double reach = 0.6 * (input_.scale[s] + input_.scale[other]);
        return (mesh_.center[s] - mesh_.center[other]).squaredNorm() > reach * reach;
      });
      if (apart) seeds.push_back(s);
      if (options_.structured && pastes_.count() == 0) break;
    }
    if (seeds.empty()) seeds.push_back(queue_.front());
    return seeds;
  }

  /// Partly covered: a piece there can continue what is pasted. A structured fill grows from its first piece, as
  /// pieces with nothing between them could not be brought into line later.
  bool at_front(std::uint32_t s) const {
    const auto shining = pastes_.coverage().shining(s);
    return std::any_of(shining.begin(), shining.end(), [](float through) { return through < 0.5f; });
  }

  void paste(const std::vector<std::uint32_t>& seeds) {
    std::vector<Paste> pastes(seeds.size());
    std::vector<std::size_t> pin(seeds.size());
    std::vector<float> shone(seeds.size());
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      pin[i] = open_sample(seeds[i]);
      shone[i] = pastes_.coverage().shining(seeds[i])[pin[i]];
    }
    parallel_for(seeds.size(), 1, [&](std::size_t i) {
      pastes[i] = grown(seeds[i], pastes_.coverage().samples(seeds[i])[pin[i]], workspace_[i]);
    });
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const std::size_t before = pastes_.count();
      pastes_.commit(pastes[i]);
      failures_[seeds[i]] += pastes_.coverage().shining(seeds[i])[pin[i]] > 0.5f * shone[i];
      statistics_.inverted += pastes[i].inverted;
      statistics_.warp_iterations += pastes[i].growth.warp_iterations;
      if (pastes_.count() > before) shares_.push_back(pastes[i].share_used);
      if (pastes_.coverage().open(seeds[i]) && ++attempts_[seeds[i]] > options_.max_attempts) {
        const Vec3d& at = mesh_.center[seeds[i]];
        throw SolverFailure(input_.where + ": the tet near (" + std::to_string(at.x()) + ", " +
                                std::to_string(at.y()) + ", " + std::to_string(at.z()) + ") stays uncovered after " +
                                std::to_string(attempts_[seeds[i]]) + " pastes; " + mend(seeds[i]),
                            *std::max_element(pastes_.coverage().shining(seeds[i]).begin(),
                                              pastes_.coverage().shining(seeds[i]).end()));
      }
    }
  }

  /// What to do about a tet that pastes do not cover: its mask is next to nothing, or it is larger than a texture.
  std::string mend(std::uint32_t seed) const {
    constexpr double tiny = 0.1; // texture widths: no more than the ramp at a mask's border
    const SplotchOptions& mask = options_.splotch;
    std::vector<std::pair<const char*, double>> sizes = {{"radius", mask.radius}};
    if (traits_.imposed[1])
      sizes.insert(sizes.end(), {{"radius_outer", mask.radius_outer},
                                 {"radius_along", mask.radius_along},
                                 {"reach_outer", mask.reach_outer},
                                 {"reach_inner", mask.reach_inner}});
    std::string small;
    for (const auto& [key, size] : sizes)
      if (size < tiny) small += std::string(small.empty() ? "" : ", ") + "mask/" + key;
    if (!small.empty())
      return "make the mask larger: below 0.1 texture widths it covers next to nothing (" + small + ")";

    bool at_skin = false;
    for (int i = 0; i < mesh_.corners; ++i)
      at_skin = at_skin || mesh_.neighbor[seed * mesh_.corners + i] == Simplices::none;
    return std::string("make the tets smaller than the texture (tetrahedralize/") +
           (at_skin ? "boundary_edge, as it lies at the skin, and interior_edge)" : "interior_edge)") +
           (traits_.uses_scale ? ", or the texture larger (scale)" : "");
  }

  /// `at`: barycentrics of the seed's point, of an open sample.
  Paste grown(std::uint32_t seed, const std::array<float, 4>& at, GrowWorkspace& workspace) const {
    Paste paste;
    paste.patch.key = hash_of(priority_of(mesh_.center[seed], options_.seed), attempts_[seed]);
    std::array<double, 3> pin{0.5, 0.5, 0.5}; // (½, d_seed, ½) where depth is a coordinate, §5.2.7
    for (int a = 0; a < 3; ++a) {
      if (!traits_.imposed[a]) continue;
      pin[a] = 0;
      for (int i = 0; i < 4; ++i) pin[a] += at[i] * field_.coordinate[a][mesh_.corner[4 * std::size_t(seed) + i]];
    }
    const int part = !traits_.imposed[1] ? 0 : pin[1] < 0.2 ? 0 : pin[1] > 0.83 ? 2 : 1;
    GrowField field = field_;
    field.extent.fill(splotch_extent(options_.splotch, parts_of(options_.type)[part]));
    for (int a = 0; a < 3; ++a) {
      if (traits_.imposed[a]) field.extent[a] = 1;
      paste.patch.frame.scale[a] = static_cast<float>(field.extent[a]);
    }
    Random random(paste.patch.key);
    paste.patch.mask = part * options_.mask_variants + random.below(options_.mask_variants);

    // A seed whose point its paste failed to cover is tried again with more freedom: a wider tolerance, then tets
    // that turn further, then all, at last itself in mirror image. (That pastes leave some of a large tet open is no
    // failure.)
    const int failures = failures_[seed];
    GrowRule rule;
    rule.seed_frame = seed_frame(field.frames, seed, random);
    rule.frame_tolerance = options_.frame_tolerance * (failures > 0 ? 1.5 : 1);
    if (traits_.uses_scale) rule.scale_tolerance = options_.scale_tolerance * (failures > 0 ? 1.5 : 1);
    if (failures > 1) rule.reach = std::numbers::pi / 2;
    if (failures > 2 || 3 * attempts_[seed] > options_.max_attempts) rule.reach = 4;
    rule.mirrored = failures > 3 || 3 * attempts_[seed] > 2 * options_.max_attempts;
    paste.growth = grow(mesh_, field, pastes_.masks()[paste.patch.mask], seed, pin, at, rule, workspace);
    pastes_.look(paste);
    std::array<bool, 3> free{};
    std::array<float, 4> phase{};
    for (int a : {0, 2, 1}) {
      free[a] = !traits_.imposed[a];
      if (free[a]) phase[a] = static_cast<float>(random.uniform());
    }
    paste.patch.frame.offset = options_.align ? aligner_.phase(pastes_, mesh_, paste, free, phase) : phase;
    return paste;
  }

  /// The open sample nearest to the middle of what is open of a simplex.
  std::size_t open_sample(std::uint32_t s) const {
    const auto samples = pastes_.coverage().samples(s);
    const auto shining = pastes_.coverage().shining(s);
    std::array<float, 4> mean{};
    float sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (shining[i] <= 1 / 255.0f) continue;
      for (int k = 0; k < 4; ++k) mean[k] += shining[i] * samples[i][k];
      sum += shining[i];
    }
    for (float& m : mean) m /= sum;
    float nearest = std::numeric_limits<float>::infinity();
    std::size_t sample = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (shining[i] <= 1 / 255.0f) continue;
      float squared = 0;
      for (int k = 0; k < 4; ++k) squared += (samples[i][k] - mean[k]) * (samples[i][k] - mean[k]);
      if (squared < nearest) nearest = squared, sample = i;
    }
    return sample;
  }

  const LapInput& input_;
  const Exemplar& exemplar_;
  const LapOptions& options_;
  const TextureTraits& traits_;
  Simplices mesh_;
  Pastes pastes_;
  Aligner aligner_;
  GrowField field_;
  std::vector<std::uint8_t> pivot_;
  std::vector<float> length_weight_;
  std::vector<std::uint32_t> queue_;
  std::vector<int> attempts_; ///< pastes at each seed
  std::vector<int> failures_; ///< of them, those that left its point open
  std::vector<GrowWorkspace> workspace_;
  std::vector<float> shares_;
  LapStatistics statistics_;
};

} // namespace

LapResult lap(const LapInput& input, const Exemplar& exemplar, const LapOptions& options, const Progress& progress) {
  check(input, exemplar, options);
  if (options.type != TextureType::tensor_2d) return Filler(input, exemplar, options).run(progress);
  LapResult result; // nothing tiles: one paste shows the whole exemplar
  result.layer = affine_layer(input);
  show(exemplar, result.layer);
  result.statistics.pastes = 1;
  result.statistics.lookups = result.layer.lookup.size();
  result.statistics.median_share_used = 1;
  return result;
}

} // namespace pith
