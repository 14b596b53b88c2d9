#include "tests/support/tri_shapes.h"
#include "volume/base/error.h"
#include "volume/mesh/boundary.h"
#include "volume/mesh/tetrahedralize.h"

#include <Eigen/Geometry>
#include <chrono>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <unistd.h>

namespace pith {
namespace {

namespace fs = std::filesystem;
using testing::box_surface;
using testing::inside_out;
using testing::sphere_surface;
using testing::together;

TetrahedralizeOptions usual() { return {.helper = fs::path(PITH_BINARY_DIR) / "pith-tetgen"}; }

double region_volume(const TetMesh& mesh, std::int32_t region) {
  double sum = 0;
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (mesh.region[t] == region) sum += signed_volume(mesh, t);
  return sum;
}

std::set<std::int32_t> regions_of(const TetMesh& mesh) { return {mesh.region.begin(), mesh.region.end()}; }

/// What holds for every result: a valid mesh, and facets that lie on the triangles they name and face the same way.
void expect_sound(const TetrahedralizeResult& result) {
  ASSERT_NO_THROW(validate(result.mesh));
  const Boundary boundary = boundary_of(result.mesh);
  ASSERT_EQ(result.input.size(), boundary.facet_count());
  const double size = bounds_of(result.surface).diagonal();
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    ASSERT_LT(result.input[f].value, result.surface.triangle_count());
    const auto& c = result.surface.corner[result.input[f]];
    const Vec3d &a = result.surface.position[c[0]], &b = result.surface.position[c[1]],
                &d = result.surface.position[c[2]];
    const Vec3d normal = (b - a).cross(d - a).normalized();
    for (const VertexId v : boundary.corner[f]) ASSERT_NEAR(normal.dot(result.mesh.position[v] - a), 0, 1e-9 * size);
    const auto& p = result.mesh.position;
    const auto& k = boundary.corner[f];
    const Vec3d own = (p[k[1]] - p[k[0]]).cross(p[k[2]] - p[k[0]]);
    if (!boundary.behind[f].exists()) {
      ASSERT_GT(own.dot(normal), 0);
    }
  }
  const BoundarySurface skin = surface_of(result.mesh, boundary);
  ASSERT_EQ(surface_defects(skin.surface).border_edges, 0u);
}

std::string complaint(const TriMesh& surface, const TetrahedralizeOptions& options = usual()) {
  try {
    tetrahedralize(surface, "name.obj", options);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Tetrahedralize, BoxKeepsItsBoundaryAndVolume) {
  const TriMesh box = box_surface({0, 0, 0}, {1, 2, 3});
  const TetrahedralizeResult result = tetrahedralize(box, "box", usual());
  expect_sound(result);
  EXPECT_EQ(result.method, "tetgen");
  EXPECT_EQ(result.note, "");
  EXPECT_EQ(result.surface_moved, 0);
  EXPECT_EQ(result.input.size(), 12u);
  EXPECT_NEAR(region_volume(result.mesh, 0), 6, 1e-12);
  EXPECT_EQ(std::set<std::uint32_t>(result.input.begin(), result.input.end()).size(), 12u);
}

TEST(Tetrahedralize, SameInputSameBytes) {
  const TriMesh sphere = sphere_surface(3);
  const TetrahedralizeResult a = tetrahedralize(sphere, "a", usual()), b = tetrahedralize(sphere, "b", usual());
  EXPECT_EQ(a.mesh.position, b.mesh.position);
  EXPECT_EQ(a.mesh.corner, b.mesh.corner);
  EXPECT_EQ(a.input, b.input);
}

TEST(Tetrahedralize, InteriorEdgeGradesTheInside) {
  TetrahedralizeOptions coarse = usual(), fine = usual();
  coarse.interior_edge = 2;
  fine.interior_edge = 0.15;
  const TriMesh sphere = sphere_surface(4);
  const auto a = tetrahedralize(sphere, "coarse", coarse), b = tetrahedralize(sphere, "fine", fine);
  expect_sound(a);
  expect_sound(b);
  EXPECT_GT(b.mesh.tet_count(), 3 * a.mesh.tet_count());
  std::size_t larger = 0; // at the surface, whose edges are longer than that and stay
  for (const TetId t : all_ids<TetId>(b.mesh.tet_count()))
    larger += signed_volume(b.mesh, t) > 1.001 * std::pow(0.15, 3) / (6 * std::sqrt(2.0)) ? 1 : 0;
  EXPECT_LT(larger, b.mesh.tet_count() / 50);
  EXPECT_NEAR(region_volume(b.mesh, 0), signed_volume(sphere), 1e-12);
}

TEST(Tetrahedralize, TetsAreFinerAlongACore) {
  TetrahedralizeOptions options = usual();
  options.interior_edge = 0.5;
  const TriMesh sphere = sphere_surface(3);
  const auto plain = tetrahedralize(sphere, "plain", options);
  options.core = {{{0, 0, -0.5}, {0, 0, 0}, {0, 0, 0.5}}};
  EXPECT_EQ(tetrahedralize(sphere, "no edge asked for", options).mesh.corner, plain.mesh.corner);
  options.core_edge = 0.05;
  options.core_growth = 0.3;
  const auto result = tetrahedralize(sphere, "cored", options);
  expect_sound(result);
  EXPECT_NEAR(region_volume(result.mesh, 0), signed_volume(sphere), 1e-12);
  EXPECT_EQ(boundary_of(result.mesh).facet_count(), boundary_of(plain.mesh).facet_count());
  std::size_t near = 0, far = 0, larger = 0; // at the surface, whose edges stay, and where TetGen improves shapes
  for (const TetId t : all_ids<TetId>(result.mesh.tet_count())) {
    const Vec3d x = barycenter(result.mesh, t);
    const double distance = (x - Vec3d(0, 0, std::clamp(x.z(), -0.5, 0.5))).norm(), edge = 0.05 + 0.3 * distance;
    larger += signed_volume(result.mesh, t) > 1.001 * edge * edge * edge / (6 * std::sqrt(2.0)) ? 1 : 0;
    (distance < 0.15 ? near : far) += 1;
  }
  EXPECT_LT(larger, result.mesh.tet_count() / 50);
  EXPECT_GT(near, 1000u);
  EXPECT_LT(far, 10 * near); // nor finer everywhere

  options.core_edge = 1e-7;
  EXPECT_THROW((void)tetrahedralize(sphere, "endless", options), InvalidInput);
  options.core_edge = -1;
  EXPECT_THROW((void)tetrahedralize(sphere, "negative", options), InvalidInput);
}

TEST(Tetrahedralize, BoundaryEdgeSplitsTheSurfaceWithoutMovingIt) {
  TetrahedralizeOptions options = usual();
  options.boundary_edge = 0.3;
  options.interior_edge = 1.5;
  const TriMesh box = box_surface({0, 0, 0}, {1, 2, 3});
  const TetrahedralizeResult result = tetrahedralize(box, "box", options);
  expect_sound(result);
  EXPECT_GT(result.input.size(), 500u);
  EXPECT_NEAR(region_volume(result.mesh, 0), 6, 1e-12);
  const Boundary boundary = boundary_of(result.mesh);
  double longest = 0;
  for (const auto& c : boundary.corner)
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (result.mesh.position[c[k]] - result.mesh.position[c[(k + 1) % 3]]).norm());
  EXPECT_LE(longest, 0.3);
  // Area of the facets of each input triangle: that of the triangle.
  PerTriangle<double> area(12, 0);
  for (const FacetId f : all_ids<FacetId>(boundary.facet_count())) {
    const auto& c = boundary.corner[f];
    const auto& p = result.mesh.position;
    area[result.input[f]] += 0.5 * (p[c[1]] - p[c[0]]).cross(p[c[2]] - p[c[0]]).norm();
  }
  for (const TriangleId t : all_ids<TriangleId>(12)) {
    const auto& c = box.corner[t];
    const auto& p = box.position;
    EXPECT_NEAR(area[t], 0.5 * (p[c[1]] - p[c[0]]).cross(p[c[2]] - p[c[0]]).norm(), 1e-12);
  }
}

TEST(Tetrahedralize, StoneInFleshIsARegionOfItsOwn) {
  // The stone stands first in the file; the outermost shell is region 0 all the same.
  const TriMesh stone = sphere_surface(2, 0.4), flesh = sphere_surface(3);
  const TetrahedralizeResult result = tetrahedralize(together(stone, flesh), "peach", usual());
  expect_sound(result);
  EXPECT_EQ(regions_of(result.mesh), (std::set<std::int32_t>{0, 1}));
  EXPECT_NEAR(region_volume(result.mesh, 1), signed_volume(stone), 1e-12);
  EXPECT_NEAR(region_volume(result.mesh, 0), signed_volume(flesh) - signed_volume(stone), 1e-12);
  // The interface appears twice, once for each side.
  EXPECT_EQ(result.input.size(), flesh.triangle_count() + 2 * stone.triangle_count());
}

TEST(Tetrahedralize, ShellThatFacesTheOtherWayIsACavity) {
  const TriMesh hole = sphere_surface(2, 0.4), solid = sphere_surface(3), kernel = sphere_surface(1, 0.1);
  const TetrahedralizeResult hollow = tetrahedralize(together(solid, inside_out(hole)), "hollow", usual());
  expect_sound(hollow);
  EXPECT_EQ(regions_of(hollow.mesh), (std::set<std::int32_t>{0}));
  EXPECT_NEAR(region_volume(hollow.mesh, 0), signed_volume(solid) - signed_volume(hole), 1e-12);
  // A kernel loose in the cavity is material again; all turned inside out means the same.
  const TriMesh nut = together(together(solid, inside_out(hole)), kernel);
  for (const TriMesh& surface : {nut, inside_out(nut)}) {
    const TetrahedralizeResult result = tetrahedralize(surface, "nut", usual());
    expect_sound(result);
    EXPECT_EQ(regions_of(result.mesh), (std::set<std::int32_t>{0, 1}));
    EXPECT_NEAR(region_volume(result.mesh, 1), signed_volume(kernel), 1e-12);
  }
}

TEST(Tetrahedralize, SeparateShellsAreNumberedInFileOrder) {
  const TriMesh a = sphere_surface(1, 1, {5, 0, 0}), b = sphere_surface(1, 2, {-5, 0, 0});
  const TetrahedralizeResult result = tetrahedralize(together(a, b), "two", usual());
  expect_sound(result);
  EXPECT_NEAR(region_volume(result.mesh, 0), signed_volume(a), 1e-12);
  EXPECT_NEAR(region_volume(result.mesh, 1), signed_volume(b), 1e-12);
}

TEST(Tetrahedralize, OrientationIsMendedAndSaidSo) {
  const TriMesh sphere = sphere_surface(2);
  const TetrahedralizeResult turned = tetrahedralize(inside_out(sphere), "inside out", usual());
  expect_sound(turned);
  EXPECT_NE(turned.note.find("inside out"), std::string::npos) << turned.note;
  TriMesh scrambled = sphere;
  for (std::size_t t = 0; t < scrambled.triangle_count(); t += 3)
    std::swap(scrambled.corner[TriangleId(t)][0], scrambled.corner[TriangleId(t)][1]);
  const TetrahedralizeResult mended = tetrahedralize(scrambled, "scrambled", usual());
  expect_sound(mended);
  EXPECT_NE(mended.note.find("1 shell oriented"), std::string::npos) << mended.note;
  EXPECT_EQ(mended.method, "tetgen");
  for (const auto* result : {&turned, &mended}) {
    EXPECT_NEAR(region_volume(result->mesh, 0), signed_volume(sphere), 1e-12);
    EXPECT_NEAR(signed_volume(result->surface), signed_volume(sphere), 1e-12);
  }
}

TEST(Tetrahedralize, DegenerateAndDuplicateTrianglesAreMendedInPlace) {
  // A vertex in the middle of an edge of one face, with a triangle of no area to close the gap.
  TriMesh box = box_surface({0, 0, 0}, {1, 1, 1});
  const auto [a, b, c] = box.corner[TriangleId(0u)];
  box.position.push_back(0.5 * (box.position[a] + box.position[b]));
  const VertexId m(8u);
  box.corner[TriangleId(0u)] = {a, m, c};
  box.corner.push_back({m, b, c});
  box.corner.push_back({a, b, m}); // flat
  box.corner.push_back(box.corner[TriangleId(4u)]);
  box.corner.push_back({a, a, b});
  const TetrahedralizeResult result = tetrahedralize(box, "box", usual());
  expect_sound(result);
  EXPECT_EQ(result.method, "tetgen");
  EXPECT_NEAR(region_volume(result.mesh, 0), 1, 1e-12);
  EXPECT_NE(result.note.find("1 triangle of no area replaced"), std::string::npos) << result.note;
  EXPECT_NE(result.note.find("1 duplicate triangle dropped"), std::string::npos) << result.note;
}

TEST(Tetrahedralize, HolesAreClosedAndSaidSo) {
  TriMesh sphere = sphere_surface(3);
  const double whole = signed_volume(sphere);
  sphere.corner.erase(sphere.corner.begin() + 7, sphere.corner.begin() + 12);
  const TetrahedralizeResult result = tetrahedralize(sphere, "sphere", usual());
  expect_sound(result);
  EXPECT_EQ(result.method, "tetgen");
  EXPECT_EQ(result.surface_moved, 0); // every triangle that was there still is
  EXPECT_NE(result.note.find("border edges"), std::string::npos) << result.note;
  EXPECT_NE(result.note.find("closed, up to"), std::string::npos) << result.note;
  EXPECT_NEAR(region_volume(result.mesh, 0), whole, 0.01 * whole);
  EXPECT_GT(result.surface.triangle_count(), sphere.triangle_count()); // the lids follow the input's triangles
}

TEST(Tetrahedralize, FewFaultsAreCutOutAndTheRestStays) {
  TriMesh sphere = sphere_surface(4);
  const double whole = signed_volume(sphere);
  sphere.position[VertexId(40u)] *= -1.05; // a spike through the other side
  ASSERT_GT(surface_defects(sphere).self_intersecting_triangles, 6u);
  const TetrahedralizeResult result = tetrahedralize(sphere, "spike", usual());
  expect_sound(result);
  EXPECT_EQ(result.method, "tetgen");
  EXPECT_NE(result.note.find("cut out and closed"), std::string::npos) << result.note;
  EXPECT_NEAR(region_volume(result.mesh, 0), whole, 0.01 * whole);
  EXPECT_LT(result.surface_moved, 0.8); // of the walls of the spike, inside
  std::size_t kept = 0;
  for (const TriangleId t : result.input) kept += t < sphere.triangle_count() ? 1 : 0;
  EXPECT_GT(kept, sphere.triangle_count() * 95 / 100);
}

TEST(Tetrahedralize, CrossingShellsAreWrapped) {
  const TriMesh cross = together(box_surface({-3, -1, -1}, {3, 1, 1}), box_surface({-1, -3, -0.9}, {1, 3, 0.9}));
  const TetrahedralizeResult result = tetrahedralize(cross, "cross", usual());
  expect_sound(result);
  EXPECT_EQ(result.method, "wrap");
  const double diagonal = bounds_of(cross).diagonal(), volume = region_volume(result.mesh, 0);
  const double exact = 24 + 2 * (2 * 2 * 1.8); // the long box, and the ends of the other that stand out of it
  EXPECT_NEAR(volume, exact, 0.05 * exact);
  EXPECT_GT(volume, exact); // a wrap lies outside
  EXPECT_GT(result.surface_moved, 0.0005 * diagonal);
  EXPECT_NE(result.note.find("self-intersecting triangles"), std::string::npos) << result.note;
  EXPECT_NE(result.note.find("moved by up to"), std::string::npos) << result.note;
}

TEST(Tetrahedralize, SizesBeyondWhatDoublesHoldAreRefused) {
  for (const double radius : {1e80, 1e13, 1e-10, 1e-100}) {
    try {
      tetrahedralize(sphere_surface(1, radius), "sized", usual());
      FAIL() << radius;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("surface/scale"), std::string::npos) << error.what();
    }
  }
}

TEST(Tetrahedralize, AWrapThatWouldNotEndIsRefused) {
  TetrahedralizeOptions options = usual();
  options.method = TetrahedralizeOptions::Method::wrap;
  options.wrap_alpha = 1e-4;
  try {
    tetrahedralize(sphere_surface(2), "fine", options);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("give a wrap_alpha above"), std::string::npos) << error.what();
  }
}

TEST(Tetrahedralize, UnusableSurfacesAreRefusedInOneLine) {
  TriMesh nan = sphere_surface(1);
  nan.position[VertexId(4u)].z() = std::nan("");
  TriMesh out_of_range = sphere_surface(1);
  out_of_range.corner[TriangleId(3u)][1] = VertexId(1000u);
  TriMesh line; // only degenerate triangles
  for (int i = 0; i < 6; ++i) line.position.push_back({double(i), 2.0 * i, 3.0 * i});
  for (unsigned i = 0; i < 4; ++i) line.corner.push_back({VertexId(i), VertexId(i + 1), VertexId(i + 2)});
  TriMesh sheet; // open and flat
  sheet.position = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 0}};
  for (unsigned i = 0; i < 4; ++i) sheet.corner.push_back({VertexId(i), VertexId((i + 1) % 4), VertexId(4u)});
  TriMesh pillow = together(sheet, inside_out(sheet)); // closed and flat
  TetrahedralizeOptions wild = usual();
  wild.radius_edge = 0.5;
  TetrahedralizeOptions endless = usual();
  endless.interior_edge = 1e-5;
  TetrahedralizeOptions needles = usual();
  needles.boundary_edge = 1e-5;
  TetrahedralizeOptions strict = usual();
  strict.method = TetrahedralizeOptions::Method::tetgen;
  TriMesh open = sphere_surface(1);
  open.corner.pop_back();
  const std::tuple<std::string, const char*> cases[] = {
      {complaint(TriMesh()), "no triangles"},
      {complaint(nan), "vertex 4 is not finite"},
      {complaint(out_of_range), "triangle 3 names vertex 1000"},
      {complaint(line), "all of its 4 triangles are degenerate"},
      {complaint(sheet), "encloses no volume"},
      {complaint(pillow), "encloses no volume"},
      {complaint(sphere_surface(1), wild), "radius_edge"},
      {complaint(sphere_surface(1), endless), "would make"},
      {complaint(sphere_surface(1), needles), "would make"},
      {complaint(open, strict), "3 border edges"},
  };
  for (const auto& [said, words] : cases) {
    EXPECT_NE(said.find(words), std::string::npos) << words << ": " << said;
    EXPECT_EQ(said.find("name.obj: "), 0u) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    EXPECT_NE(said.find("; "), std::string::npos) << said; // how to mend it
  }
}

/// A helper program that misbehaves, as a script.
class BadHelper : public ::testing::Test {
protected:
  BadHelper() : folder_(fs::temp_directory_path() / ("pith_helper_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~BadHelper() override { fs::remove_all(folder_); }
  std::string failure(const std::string& script, double time_limit = 20) const {
    const fs::path path = folder_ / "helper";
    std::ofstream(path) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(path, fs::perms::owner_all);
    try {
      tetrahedralize(sphere_surface(1), "sphere", {.time_limit = time_limit, .helper = path});
    } catch (const SolverFailure& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

TEST_F(BadHelper, BecomesAnErrorWhateverItDoes) {
  EXPECT_NE(failure("kill -SEGV $$").find("SIGSEGV"), std::string::npos);
  EXPECT_NE(failure("echo 'Assertion failed' >&2; kill -ABRT $$").find("SIGABRT): Assertion failed"),
            std::string::npos);
  EXPECT_NE(failure("exit 4").find("refused"), std::string::npos);
  EXPECT_NE(failure("exit 77").find("code 77"), std::string::npos);
  EXPECT_NE(failure("exit 0").find("no tets"), std::string::npos);
  EXPECT_NE(failure("head -c 5000 /dev/zero").find("cut short"), std::string::npos);
  EXPECT_NE(failure("yes | head -c 100000 >&2; exit 5").find("changed the surface: y"), std::string::npos);
}

TEST_F(BadHelper, IsGivenUpAfterTheTimeLimit) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_NE(failure("exec sleep 100", 0.2).find("did not end"), std::string::npos);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 30);
}

TEST_F(BadHelper, MissingIsAFaultOfTheInstallation) {
  EXPECT_THROW(tetrahedralize(sphere_surface(1), "sphere", {.helper = folder_ / "nobody"}), IoFailure);
}

TEST(Tetrahedralize, StopsWhenAsked) {
  const TriMesh sphere = sphere_surface(4);
  EXPECT_THROW(tetrahedralize(sphere, "sphere", usual(), [](double) { return false; }), Cancelled);
  double last = -1;
  tetrahedralize(sphere, "sphere", usual(), [&](double fraction) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    last = fraction;
    return true;
  });
  EXPECT_GE(last, 0);
}

} // namespace
} // namespace pith
