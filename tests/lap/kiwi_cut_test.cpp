// A filled kiwi with scattered seeds, a sparse layer, through three cuts: at every vertex and at random points of
// every section and skin facet of every piece the colour is the root's, bit for bit, whatever the hint and the number
// of threads.
#include "tests/lap/kiwi_fixture.h"

#include "volume/base/random.h"
#include "volume/cut/cut.h"
#include "volume/lap/scatter.h"

#include <gtest/gtest.h>

#include <cstring>

namespace pith {
namespace {

TEST(KiwiCut, ColoursAreTheRootsBitForBit) {
  const testing::KiwiSolid solid = testing::kiwi_solid();
  LapResult fill = lap(solid.input(), solid.exemplar, {.frame_tolerance = 2.0});
  const Thing thing = thing_of(procedural_exemplar("kiwi-seed", {.resolution = 32}));
  const Locator locator(solid.mesh, solid.boundary);
  const ScatterResult seeds =
      scatter({{solid.mesh, locator, 0, solid.frames.axes, solid.frames.scale}, solid.depth.value}, thing,
              {.count = 400, .size = 2.3, .depth = {0.6, 0.9}}, {}, "seeds");
  const PastedKind kind{&thing, seeds.pasted};
  Model model;
  model.mesh = solid.mesh;
  model.boundary = solid.boundary;
  model.layer = {std::move(fill.layer), layer_of({&kind, 1}, 0, "seeds")};
  const Root root(std::move(model), {.mips = false});
  const TetMesh& mesh = root.model().mesh;
  const Boundary& boundary = root.model().boundary;

  Pieces pieces = whole_piece(mesh);
  View view;
  view.eye = {0, -200, 0};
  view.up = {0, 0, 1};
  view.vertical_angle = 0;
  view.height = 80;
  cut(pieces, mesh, boundary, *level_set_of(StrokeCut{{{-1, 0.1}, {-0.3, -0.05}, {0.3, 0.12}, {1, 0}}, view}));
  cut(pieces, mesh, boundary, *level_set_of(PlaneCut{{1, 0.2, 0.1}, 2.0}));
  cut(pieces, mesh, boundary, *level_set_of(SphereCut{{0, 0, 0}, 14}));
  ASSERT_GE(pieces.piece.size(), 8u);

  std::vector<MaterialPoint> points;
  std::size_t sections = 0;
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    const PieceSurface surface = surface_of(pieces, p, mesh, boundary);
    Random random(5, p);
    for (const auto& t : surface.triangle) {
      sections += t.tag.is_section();
      for (std::uint32_t c : t.corner) points.push_back({surface.position[c], 0, t.tag.facet(), t.root});
      for (int k = 0; k < 4; ++k) {
        double a = random.uniform(), b = random.uniform();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        points.push_back({(1 - a - b) * surface.position[t.corner[0]] + a * surface.position[t.corner[1]] +
                              b * surface.position[t.corner[2]],
                          0, t.tag.facet(), t.root});
      }
    }
  }
  ASSERT_GT(sections, 1000u);
  const auto colors = [&](int threads, bool hints) {
    const ThreadLimit limit(threads);
    std::vector<Material> result(points.size());
    parallel_for(points.size(), 256, [&](std::size_t i) {
      MaterialPoint point = points[i];
      if (!hints) point.hint = {}, point.facet = {};
      result[i] = material_at(root, point);
    });
    return result;
  };
  const std::vector<Material> plain = colors(1, false);
  for (const std::vector<Material>& other : {colors(1, true), colors(2, true), colors(2, false)}) {
    std::size_t different = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      different += std::memcmp(plain[i].value.data(), other[i].value.data(), sizeof(plain[i].value)) != 0 ||
                   plain[i].coverage != other[i].coverage || plain[i].tet != other[i].tet;
    EXPECT_EQ(different, 0u) << "of " << points.size();
  }
}

} // namespace
} // namespace pith
