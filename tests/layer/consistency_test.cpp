// Colour is a function of (rest position, side) and of nothing else: hints, cuts, moved pieces, threads and a round
// trip to disk leave every bit of it alone.
#include "tests/layer/five_models.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/cut/arrange.h"
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

TEST_P(Consistency, SurvivesALongSessionAtAHundredThousandPoints) {
  // Planes, spheres, noise that would pinch, joining and moving; then vertices, facets and insides of all pieces.
  const Root root(GetParam().make());
  const TetMesh& mesh = root.model().mesh;
  const Box box = bounds_of(mesh);
  Cutter cutter(mesh, root.model().boundary);
  Pieces pieces = whole_piece(mesh);
  Random random(47, 0);
  const auto inside = [&] {
    return Vec3d(box.low + Vec3d(random.uniform(0.2, 0.8), random.uniform(0.2, 0.8), random.uniform(0.2, 0.8))
                               .cwiseProduct(box.extent()));
  };
  for (int k = 0; k < 8; ++k) {
    try {
      if (k % 4 == 2) {
        std::vector<double> value(mesh.vertex_count() + pieces.added.size());
        for (double& v : value) v = std::floor(random.uniform(-1, 2));
        cutter.cut_by_values(pieces, value, nullptr, {.only = {0}});
      } else if (k % 4 == 3) {
        join_pieces(pieces, std::vector<std::uint32_t>{0, static_cast<std::uint32_t>(pieces.piece.size() - 1)});
      } else if (k % 4 == 1) {
        cutter.cut(pieces, *level_set_of(SphereCut{inside(), 0.3 * box.diagonal()}));
      } else {
        const Vec3d n(random.uniform(-1, 1), random.uniform(-1, 1), 1);
        cutter.cut(pieces, *level_set_of(PlaneCut{n, n.dot(inside())}));
      }
    } catch (const InvalidInput&) { // pieces that share no section, a sphere that misses
    }
    pieces.piece[random.below(pieces.piece.size())].placement.translation += Vec3d(0.1, 0, 0.2);
  }
  std::vector<MaterialPoint> points = piece_points(pieces, root);
  std::vector<const CutTet*> tets;
  for (const Piece& piece : pieces.piece)
    for (const CutTet& tet : piece.cut) tets.push_back(&tet);
  ASSERT_GT(tets.size(), 500u);
  while (points.size() < 100'000) { // inside cut tets, on their faces and at their corners
    const CutTet& tet = *tets[random.below(tets.size())];
    const std::size_t kind = random.below(3);
    Vec3d x = Vec3d::Zero();
    double sum = 0;
    for (std::size_t i = 0; i < (kind == 0 ? 4u : kind == 1 ? 3u : 1u); ++i) {
      const double weight = 0.01 + random.uniform();
      x += weight * pieces.position(mesh, tet.corner[i]);
      sum += weight;
    }
    points.push_back({.position = x / sum, .region = mesh.region[tet.root], .facet = {}, .hint = tet.root});
  }
  const std::vector<Material> through_pieces = materials(root, points);
  for (MaterialPoint& point : points) point.hint = {};
  const std::vector<Material> of_root = materials(root, points);
  std::size_t different = 0;
  for (std::size_t i = 0; i < points.size(); ++i) different += !same_bits(through_pieces[i], of_root[i]);
  EXPECT_EQ(different, 0u);
}

INSTANTIATE_TEST_SUITE_P(FiveMethods, Consistency, ::testing::ValuesIn(methods),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace pith
