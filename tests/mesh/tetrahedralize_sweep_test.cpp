// Every real mesh, clean or dirty, through tetrahedralize.
#include "tests/support/shared_data.h"
#include "volume/base/error.h"
#include "volume/io/mesh_io.h"
#include "volume/mesh/boundary.h"
#include "volume/mesh/tetrahedralize.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace pith {
namespace {

/// A mesh and what must become of it. `volume` (mm³, 0: not known) stands for dirty surfaces that have to come out
/// solid.
struct Case {
  const char* file;
  enum Way { untouched, mended, wrapped } way;
  double volume = 0;
};

class EveryMesh : public ::testing::TestWithParam<Case> {};

TEST_P(EveryMesh, BecomesTets) {
  PITH_REQUIRE_SHARED(path, std::string("meshes/") + GetParam().file);
  const TriMesh surface = read_tri_mesh(path);
  const TetrahedralizeOptions options{.helper = std::filesystem::path(PITH_BINARY_DIR) / "pith-tetgen"};
  const TetrahedralizeResult result = tetrahedralize(surface, GetParam().file, options);
  RecordProperty("note", result.note);

  ASSERT_NO_THROW(validate(result.mesh));
  const Boundary boundary = boundary_of(result.mesh);
  ASSERT_EQ(result.input.size(), boundary.facet_count());
  const double size = bounds_of(result.surface).diagonal();
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    ASSERT_LT(result.input[f].value, result.surface.triangle_count());
    const auto& c = result.surface.corner[result.input[f]];
    const auto& p = result.surface.position;
    const Vec3d normal = (p[c[1]] - p[c[0]]).cross(p[c[2]] - p[c[0]]).normalized();
    for (const VertexId v : boundary.corner[f])
      ASSERT_NEAR(normal.dot(result.mesh.position[v] - p[c[0]]), 0, 1e-6 * size) << "facet " << f;
  }
  double volume = 0;
  for (const TetId t : all_ids<TetId>(result.mesh.tet_count())) volume += signed_volume(result.mesh, t);
  switch (GetParam().way) {
  case Case::untouched:
    EXPECT_EQ(result.method, "tetgen");
    EXPECT_EQ(result.note, "");
    EXPECT_EQ(result.surface_moved, 0);
    EXPECT_NEAR(volume / signed_volume(surface), 1, 1e-6);
    break;
  case Case::mended: // in place: tets fill the very surface
    EXPECT_EQ(result.method, "tetgen");
    EXPECT_NE(result.note, "");
    break;
  case Case::wrapped:
    EXPECT_EQ(result.method, "wrap");
    EXPECT_NE(result.note, "");
    EXPECT_GT(result.surface_moved, 0);
    break;
  }
  if (GetParam().volume > 0) {
    EXPECT_NEAR(volume / GetParam().volume, 1, 0.05);
  }
  EXPECT_LT(result.surface_moved, 0.3 * size);
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  std::string name = info.param.file;
  for (char& c : name)
    if (c == '.') c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    Clean, EveryMesh,
    ::testing::Values(Case{"anchor_8k_genus4.off", Case::untouched}, Case{"armadillo_52k.off", Case::untouched},
                      Case{"banana_16k_uv.obj", Case::untouched}, Case{"bell_pepper_1k.obj", Case::untouched},
                      Case{"bunny_12k.off", Case::untouched}, Case{"bunny_7k.off", Case::untouched},
                      Case{"cat_16k.obj", Case::untouched}, Case{"cheese_18k_genus133.off", Case::untouched},
                      Case{"dragon_41k.obj", Case::untouched}, Case{"eight_11k.off", Case::untouched},
                      Case{"elephant_6k_genus3.off", Case::untouched}, Case{"fandisk_14k.off", Case::untouched},
                      Case{"fertility_9k.off", Case::untouched}, Case{"food_donut.obj", Case::untouched},
                      Case{"food_egg.obj", Case::untouched}, Case{"food_lemon.obj", Case::untouched},
                      Case{"food_orange.obj", Case::untouched}, Case{"horse_6k.off", Case::untouched},
                      Case{"pepper_30k.ply", Case::untouched}, Case{"rocker_arm_20k.obj", Case::untouched},
                      Case{"spot_6k_uv.obj", Case::untouched}, Case{"thing472042_4k_genus2.stl", Case::untouched},
                      Case{"thing60745_24k.obj", Case::untouched}, Case{"thing88566_8parts.stl", Case::untouched},
                      Case{"torus_5k.obj", Case::untouched}, Case{"dirty_unwelded_soup.ply", Case::untouched}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Dirty, EveryMesh,
    ::testing::Values(Case{"food_loaf.obj", Case::mended}, Case{"food_pumpkin.obj", Case::mended},
                      Case{"dirty_shuffled_orientation.off", Case::mended, 0.0500825},
                      Case{"dirty_elephant_holes.off", Case::mended, 0.0462012},
                      Case{"dirty_bunny_res2_16k.ply", Case::mended, 0.000753},
                      Case{"dirty_dragon_res3_48k.ply", Case::mended, 0.000476},
                      Case{"dirty_dragon_res4_11k.ply", Case::mended, 0.000468},
                      Case{"dirty_apple.ply", Case::mended, 0.0005}, Case{"cow_5k.off", Case::mended, 0.0535},
                      Case{"dragon_25k.off", Case::mended, 27018}, Case{"dirty_beetle.obj", Case::mended},
                      Case{"avocado_1k_uv.obj", Case::wrapped}, Case{"dirty_chair_dupfaces.obj", Case::wrapped},
                      Case{"dirty_stratocaster_94parts.ply", Case::wrapped}, Case{"dirty_suzanne.obj", Case::wrapped},
                      Case{"dirty_teapot.obj", Case::wrapped}, Case{"dirty_truck.obj", Case::wrapped},
                      Case{"food_cake.obj", Case::wrapped}, Case{"food_watermelon.obj", Case::wrapped}),
    name_of);

TEST(EveryMesh, OnlyDegenerateTrianglesAreRefused) {
  PITH_REQUIRE_SHARED(path, "meshes/dirty_all_degenerate.off");
  EXPECT_THROW(tetrahedralize(read_tri_mesh(path), "dirty_all_degenerate.off"), InvalidInput);
}

} // namespace
} // namespace pith
