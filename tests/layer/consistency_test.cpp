// Colour is a function of (rest position, side) and of nothing else: hints, cuts, moved pieces, threads and a round
// trip to disk leave every bit of it alone.
#include "tests/layer/five_models.h"

#include "volume/base/parallel.h"
#include "volume/cut/cut.h"
#include "volume/io/model_io.h"

#include <gtest/gtest.h>

#include <cstring>

namespace pith {
namespace {

using namespace testing;

struct Method {
  const char* name;
  Model (*make)();
};

Model patches_max_histogram() {
  Exemplar a = skewed_noise(1), b = skewed_noise(2);
  return two_patches({Blend::Select::max, 0.2f, Blend::Mix::histogram}, a, b);
}
Model tile_moved() { return periodic_tile(0.15f); }

const Method methods[] = {{"masked_volumes", masked_volumes},
                          {"masked_images", masked_images},
                          {"periodic_tile", tile_moved},
                          {"gutter_atlas", gutter_atlas},
                          {"patches", patches_max_histogram}};

bool same_bits(const Material& a, const Material& b) {
  return std::memcmp(a.value.data(), b.value.data(), sizeof(a.value)) == 0 &&
         std::memcmp(&a.coverage, &b.coverage, sizeof(float)) == 0 && a.tet == b.tet;
}

class Consistency : public ::testing::TestWithParam<Method> {};

/// Points of all pieces: vertices and inner points of their surfaces' triangles, with the hints a consumer would
/// give.
std::vector<MaterialPoint> piece_points(const Pieces& pieces, const Root& root) {
  std::vector<MaterialPoint> points;
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    const PieceSurface surface = surface_of(pieces, p, root.model().mesh, root.model().boundary);
    Random random(17, p);
    for (const auto& t : surface.triangle) {
      const std::int32_t region = root.model().mesh.region[t.root];
      for (std::uint32_t c : t.corner) points.push_back({surface.position[c], region, t.tag.facet(), t.root});
      for (int k = 0; k < 3; ++k) {
        double a = random.uniform(), b = random.uniform();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const Vec3d x = (1 - a - b) * surface.position[t.corner[0]] + a * surface.position[t.corner[1]] +
                        b * surface.position[t.corner[2]];
        points.push_back({x, region, t.tag.facet(), t.root});
      }
    }
  }
  return points;
}

std::vector<Material> materials(const Root& root, const std::vector<MaterialPoint>& points) {
  std::vector<Material> result(points.size());
  parallel_for(points.size(), 64, [&](std::size_t i) { result[i] = material_at(root, points[i]); });
  return result;
}

TEST_P(Consistency, SurvivesTwoCutsMovesThreadsAndDisk) {
  const Root root(GetParam().make());
  const TetMesh& mesh = root.model().mesh;
  Pieces pieces = whole_piece(mesh);
  cut(pieces, mesh, root.model().boundary, *level_set_of(PlaneCut{{0.3, 1, 0.2}, 1.4}));
  pieces.piece[1].placement.translation = {5, 0, 1};
  cut(pieces, mesh, root.model().boundary, *level_set_of(SphereCut{{1, 1, 1}, 0.8}));
  ASSERT_EQ(pieces.piece.size(), 3u);

  const std::vector<MaterialPoint> points = piece_points(pieces, root);
  ASSERT_GT(points.size(), 500u);
  std::vector<Material> one_thread, two_threads;
  {
    ThreadLimit limit(1);
    one_thread = materials(root, points);
  }
  {
    ThreadLimit limit(2);
    two_threads = materials(root, points);
  }
  const std::filesystem::path path =
      std::filesystem::path(::testing::TempDir()) / (std::string("consistency_") + GetParam().name + ".pith");
  write_model(path, root.model(), pieces, "{}", {});
  ModelFile file = read_model(path);
  std::filesystem::remove(path);
  const Root read(std::move(file.model));
  const std::vector<MaterialPoint> read_points = piece_points(file.pieces, read);
  ASSERT_EQ(read_points.size(), points.size());

  std::size_t different = 0, colors = 0;
  std::vector<Material> together(points.size());
  materials_at(root, points, together);
  for (std::size_t i = 0; i < points.size(); ++i) {
    MaterialPoint plain = points[i]; // as somebody asks who knows nothing of pieces
    plain.hint = {};
    different += !same_bits(one_thread[i], material_at(root, plain));
    different += !same_bits(one_thread[i], two_threads[i]);
    different += !same_bits(one_thread[i], together[i]);
    ASSERT_EQ(read_points[i].position, points[i].position);
    different += !same_bits(one_thread[i], material_at(read, read_points[i]));
    colors += one_thread[i].coverage > 0;
  }
  EXPECT_EQ(different, 0u);
  EXPECT_GT(colors, 200u);
}

INSTANTIATE_TEST_SUITE_P(FiveMethods, Consistency, ::testing::ValuesIn(methods),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace pith
