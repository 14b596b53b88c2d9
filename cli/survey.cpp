#include "cli/survey.h"

#include "volume/base/random.h"

#include <algorithm>
#include <atomic>

namespace pith::cli {
namespace {

constexpr double seen = 0.98, covered = 254.0 / 255.0;
constexpr std::uint64_t stage = 0x73757276; // "surv"

/// Uniform in a tet: the gaps between three sorted uniform numbers.
Vec3d random_point_in(const TetMesh& mesh, TetId tet, Random& random) {
  std::array<double, 3> cut{random.uniform(), random.uniform(), random.uniform()};
  std::sort(cut.begin(), cut.end());
  const auto& corner = mesh.corner[tet];
  return cut[0] * mesh.position[corner[0]] + (cut[1] - cut[0]) * mesh.position[corner[1]] +
         (cut[2] - cut[1]) * mesh.position[corner[2]] + (1 - cut[2]) * mesh.position[corner[3]];
}

} // namespace

Survey survey_of(const Root& root, std::size_t points, std::uint64_t seed, const Progress& progress) {
  const TetMesh& mesh = root.model().mesh;
  std::vector<double> volume_up_to;
  double total = 0;
  for (const TetId tet : all_ids<TetId>(mesh.tet_count())) volume_up_to.push_back(total += signed_volume(mesh, tet));

  struct Answer {
    float coverage;
    std::uint16_t lookups;
    Vec3d position;
  };
  std::vector<Answer> answer(points);
  constexpr std::size_t block = 2048;
  std::atomic<std::size_t> finished{0};
  parallel_blocks(points, block, [&](std::size_t begin, std::size_t end) {
    std::vector<MaterialPoint> place;
    for (std::size_t i = begin; i < end; ++i) {
      Random random(seed, stage, i);
      const auto found = std::upper_bound(volume_up_to.begin(), volume_up_to.end(), random.uniform() * total);
      const TetId tet(std::min<std::size_t>(found - volume_up_to.begin(), mesh.tet_count() - 1));
      place.push_back(
          {.position = random_point_in(mesh, tet, random), .region = mesh.region[tet], .facet = {}, .hint = tet});
    }
    std::vector<Material> material(place.size());
    materials_at(root, place, material);
    for (std::size_t i = begin; i < end; ++i)
      answer[i] = {material[i - begin].coverage, material[i - begin].lookups_read, place[i - begin].position};
    report(progress, static_cast<double>(finished += end - begin) / static_cast<double>(points));
  });

  Survey survey;
  survey.points = points;
  std::vector<std::uint16_t> lookups;
  for (const Answer& one : answer) {
    lookups.push_back(one.lookups);
    if (one.coverage < seen) ++survey.holes;
    if (one.coverage < covered) ++survey.thin;
    if (one.coverage < survey.least_coverage) survey.least_coverage = one.coverage, survey.worst = one.position;
  }
  std::sort(lookups.begin(), lookups.end());
  if (!lookups.empty()) {
    survey.median_lookups = lookups[lookups.size() / 2];
    survey.p99_lookups = lookups[std::min(lookups.size() - 1, lookups.size() * 99 / 100)];
    survey.most_lookups = lookups.back();
  }
  return survey;
}

} // namespace pith::cli
