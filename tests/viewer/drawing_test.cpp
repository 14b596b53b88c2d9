// What is drawn against what material_at says: every blend rule, sections and skin.
#include "raytrace/scene_surface.h"
#include "recipe/build.h"
#include "tests/layer/five_models.h"
#include "viewer/drawing.h"
#include "viewer/offscreen.h"
#include "volume/base/image.h"
#include "volume/cut/cut.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

struct Difference {
  std::size_t pixels = 0, skin = 0, section = 0; ///< compared
  int worst = 0;                                 ///< of 255
  std::size_t beyond = 0;                        ///< that differ by more than 2
};

/// Draws and compares each pixel whose four neighbours lie on the same triangle with material_at.
Difference difference(const Root& root, const Pieces& pieces, const View& view, int size = 160) {
  const OffscreenContext context;
  Drawing drawing;
  drawing.set_material(material_tables(root));
  const auto normals = facet_corner_normals(root.model().mesh, root.model().boundary, 0.6);
  const DrawnSurface surface = drawn_surface(root, pieces, normals, {.scale = 0});
  drawing.set_surface(surface);
  const Image image = drawing.picture(view, size, size, {.lit = false, .filtered = false, .transparent = true});
  const int color = root.component_of("color");
  const auto hit_at = [&](double x, double y) {
    const View::Ray ray = view.ray(2 * x / size - 1, 1 - 2 * y / size);
    return nearest_hit(surface, ray.origin, ray.direction);
  };
  Difference result;
  for (int y = 0; y < size; y += 3)
    for (int x = 0; x < size; x += 3) {
      const auto hit = hit_at(x + 0.5, y + 0.5);
      if (!hit) {
        EXPECT_LE(image.at(x, y)[3], 1.0f);
        continue;
      }
      bool inner = true;
      for (const auto& [dx, dy] :
           {std::pair(0.05, 0.5), std::pair(0.95, 0.5), std::pair(0.5, 0.05), std::pair(0.5, 0.95)}) {
        const auto near = hit_at(x + dx, y + dy);
        inner &= near && near->triangle == hit->triangle;
      }
      if (!inner) continue;
      const Material material = material_at(root, {.position = hit->rest,
                                                   .region = root.model().mesh.region[hit->tet],
                                                   .facet = hit->facet,
                                                   .hint = hit->tet});
      ++result.pixels;
      ++(hit->facet.exists() ? result.skin : result.section);
      int worst = 0;
      for (int k = 0; k < 3; ++k) {
        const double linear = 0.5 + material.coverage * (material.value[color + k] - 0.5);
        const double expected = 255 * srgb_from_linear(static_cast<float>(std::clamp(linear, 0.0, 1.0)));
        worst = std::max(worst, static_cast<int>(std::ceil(std::abs(255 * image.at(x, y)[k] - expected) - 0.501)));
      }
      result.worst = std::max(result.worst, worst);
      result.beyond += worst > 2;
    }
  return result;
}

/// Schuster 2020: two noisy patches that win by height, mixed by histogram.
Model patches_by_height() {
  return testing::two_patches({.select = Blend::Select::max, .grace = 0.3f, .mix = Blend::Mix::histogram},
                              testing::skewed_noise(1), testing::skewed_noise(2));
}

class DrawnMethods : public ::testing::TestWithParam<int> {};

TEST_P(DrawnMethods, PixelsAreMaterialAt) {
  const std::array<Model (*)(), 5> make = {
      [] { return testing::masked_volumes(); }, [] { return testing::masked_images(); },
      [] { return testing::periodic_tile(0.3f); }, [] { return testing::gutter_atlas(); },
      [] { return patches_by_height(); }};
  const Root root(make[GetParam()]());
  Pieces pieces = whole_piece(root.model().mesh);
  const auto plane = level_set_of(PlaneCut{.normal = {0.3, 0.2, 1}, .offset = 1.2});
  cut(pieces, root.model().mesh, root.model().boundary, *plane);
  pieces.piece[1].placement.translation = {0, 2.2, 0.4};
  const Difference d = difference(root, pieces, {.eye = {5, 4, 9}, .target = {1, 1.8, 1}, .vertical_angle = 0.6});
  EXPECT_GT(d.skin, 200u);
  EXPECT_GT(d.section, 100u);
  EXPECT_EQ(d.beyond, 0u) << d.worst << " of 255 at worst, " << d.pixels << " pixels";
}
INSTANTIATE_TEST_SUITE_P(All, DrawnMethods, ::testing::Range(0, 5));

/// A cube in two halves, one farther back: it is darker in the step between them, and nowhere else.
TEST(Drawing, CrevicesAreDarker) {
  const Root root(testing::masked_images());
  Pieces pieces = whole_piece(root.model().mesh);
  const auto plane = level_set_of(PlaneCut{.normal = {1, 0, 0}, .offset = 0.9});
  cut(pieces, root.model().mesh, root.model().boundary, *plane);
  pieces.piece[1].placement.translation = {0, 0, -0.8};
  const OffscreenContext context;
  Drawing drawing;
  drawing.set_material(material_tables(root));
  drawing.set_surface(
      drawn_surface(root, pieces, facet_corner_normals(root.model().mesh, root.model().boundary, 0.6), {.scale = 0}));
  for (const double angle : {0.5, 0.0}) { // in perspective and without
    const View view{.eye = {2.2, 1, 9}, .target = {1.1, 1, 1}, .vertical_angle = angle, .height = 4};
    const Image bright = drawing.picture(view, 200, 200, {.occlusion = false, .transparent = true});
    const Image shaded = drawing.picture(view, 200, 200, {.transparent = true});
    double faces = 0, crevice = 1;
    int count = 0;
    for (int i = 0; i < 200 * 200; ++i) {
      const float* a = bright.pixel.data() + 4 * i;
      const float* b = shaded.pixel.data() + 4 * i;
      EXPECT_EQ(a[3], b[3]);
      if (a[3] < 1) continue;
      const double before = a[0] + a[1] + a[2], after = b[0] + b[1] + b[2];
      EXPECT_LE(after, before + 0.02);
      crevice = std::min(crevice, after / before);
      faces += after / before;
      ++count;
    }
    EXPECT_GT(count, 5000);
    EXPECT_LT(crevice, 0.85);
    EXPECT_GT(faces / count, 0.95);
    EXPECT_LT(faces / count, 0.999);
  }
}

TEST(Drawing, KiwiAcrossIsMaterialAt) {
  const std::filesystem::path source = PITH_SOURCE_DIR;
  Recipe recipe = read_recipe(source / "data/recipes/table1/kiwi.json");
  CutStep across;
  across.shape = PlaneCut{.normal = {0, 0, 1}, .offset = 0.5};
  across.keep = Keep::left;
  recipe.cuts = {across};
  recipe.moves.clear();
  Builder builder;
  BuildResult built = builder.build(recipe, source / "data/recipes/table1");
  const Root root(std::move(built.model));
  const Box box = bounds_of(root.model().mesh);
  const Difference d = difference(
      root, built.pieces,
      {.eye = box.center() + Vec3d(1.0, 0.9, 0.75) * box.diagonal(), .target = box.center(), .vertical_angle = 0.6},
      240);
  EXPECT_GT(d.section, 300u);
  EXPECT_GT(d.skin, 100u);
  EXPECT_EQ(d.beyond, 0u) << d.worst << " of 255 at worst, " << d.pixels << " pixels";
}

} // namespace
} // namespace pith
