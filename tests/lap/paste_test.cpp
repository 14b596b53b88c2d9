// Things pasted by hand and scattered: whole, apart, inside, where they were put, the same bytes at any number of
// threads; and the steps alone against brute force.
#include "tests/lap/kiwi_fixture.h"
#include "tests/support/tet_grid.h"

#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/lap/scatter.h"
#include "volume/layer/sample.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

namespace pith {
namespace {

using testing::KiwiSolid;

Mat3d random_rotation(Random& random) {
  const Vec3d axis(random.normal(), random.normal(), random.normal());
  return Eigen::AngleAxisd(random.uniform(0, 6.3), axis.normalized()).toRotationMatrix();
}

float alpha_at(const MaskGrid& mask, const Vec3d& u) {
  const std::array<float, 4> w{float(u[0]), float(u[1]), float(u[2]), 0};
  return mask.alpha(lanes_at(w.data()));
}

class Things : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    solid = new KiwiSolid(testing::kiwi_solid());
    locator = new Locator(solid->mesh, solid->boundary);
    seed = new Thing(thing_of(procedural_exemplar("kiwi-seed", {.resolution = 48})));
  }
  static void TearDownTestSuite() {
    delete seed;
    delete locator;
    delete solid;
  }
  static ScatterGround ground() {
    return {{solid->mesh, *locator, 0, solid->frames.axes, solid->frames.scale}, solid->depth.value};
  }
  static ScatterOptions seeds() {
    ScatterOptions o;
    o.count = 300;
    o.size = 2.3;
    o.size_variation = 0.1;
    o.depth = {0.70, 0.89};
    o.axis = {Vec3d(0, 0, -20), Vec3d(0, 0, 20)};
    o.along = {0.05, 0.95};
    o.groups = 26;
    o.group_width = 0.7;
    o.jitter = 0.3;
    o.spin = 0.5;
    return o;
  }
  static Root root_with(const std::vector<PastedThing>& pasted, const Thing& thing) {
    const PastedKind kind{&thing, pasted};
    return root_of(*solid, layer_of({&kind, 1}, 0, "things"));
  }
  /// Where a point of the mask's cube lies in rest space.
  static Vec3d rest_point(const Thing& thing, const PlacedBox& box, const Vec3d& u) {
    const double width = 2 * box.half.maxCoeff() / thing.solid.extent().maxCoeff();
    return box.center + box.axes * (width * (u - thing.solid.center()));
  }
  static inline KiwiSolid* solid = nullptr;
  static inline Locator* locator = nullptr;
  static inline Thing* seed = nullptr;
};

TEST_F(Things, AreWholeApartAndInside) {
  const ScatterResult result = scatter(ground(), *seed, seeds(), {}, "seeds");
  ASSERT_EQ(result.pasted.size(), 300u);
  const Root root = root_with(result.pasted, *seed);
  const MaskGrid mask(seed->mask);
  std::size_t whole = 0, overlaps = 0, outside = 0, wrong_place = 0;
  for (std::size_t i = 0; i < result.pasted.size(); ++i) {
    const PlacedBox& box = result.pasted[i].box;
    for (std::size_t j = 0; j < i; ++j) overlaps += box.meets(result.pasted[j].box);
    // Alpha summed over the cube, as the model shows it, against the exemplar's. Neighbours' veils may add a little:
    // each point counts at most as much as the mask has there.
    constexpr int n = 24;
    double shown = 0, there = 0;
    for (int k = 0; k < n; ++k)
      for (int l = 0; l < n; ++l)
        for (int m = 0; m < n; ++m) {
          const Vec3d u((k + 0.5) / n, (l + 0.5) / n, (m + 0.5) / n);
          const double alpha = alpha_at(mask, u);
          if (alpha == 0) continue;
          const Vec3d x = rest_point(*seed, box, u);
          if (!locator->owner(x, 0).exists()) {
            outside += alpha > 0.5;
            continue;
          }
          there += alpha;
          shown += std::min<double>(alpha, material_at(root, {.position = x}).coverage);
        }
    EXPECT_NEAR(there / (n * n * n), seed->volume, 0.03 * seed->volume);
    whole += shown > 0.98 * there;
    const Location at = locator->locate(box.center, 0);
    double depth = 0;
    for (int c = 0; c < 4; ++c) depth += at.barycentric[c] * solid->depth.value[solid->mesh.corner[at.tet][c]];
    wrong_place += depth < 0.70 - 1e-6 || depth > 0.89 + 1e-6 || std::abs(box.center.z()) > 18 + 1e-9;
  }
  EXPECT_EQ(whole, result.pasted.size());
  EXPECT_EQ(overlaps, 0u);
  EXPECT_EQ(outside, 0u);
  EXPECT_EQ(wrong_place, 0u);
}

TEST_F(Things, StandInTheirGroupsWithTheirPointsInwards) {
  const ScatterResult result = scatter(ground(), *seed, seeds(), {}, "seeds");
  for (const PastedThing& thing : result.pasted) {
    const Vec3d& x = thing.box.center;
    double turn = std::atan2(x.y(), x.x()) / (2 * 3.14159265358979323846) * 26;
    // The helper direction of a z axis is x or y: both see sectors of 26 in a quarter turn's symmetry of ½.
    const double off = std::min(std::abs(turn - std::round(turn)), std::abs(turn + 0.5 - std::round(turn + 0.5)));
    EXPECT_LE(off, 0.35 + 1e-9);
    const Vec3d inwards = -Vec3d(x.x(), x.y(), 0).normalized();
    if (std::abs(x.z()) < 10) {
      EXPECT_GT(thing.box.axes.col(1).dot(inwards), 0.7);
    }
  }
}

TEST_F(Things, AreTheSameAtOneAndTwoThreadsAndFewerComeFirst) {
  const auto placed = [&](int threads, int count) {
    const ThreadLimit limit(threads);
    ScatterOptions o = seeds();
    o.count = count;
    return scatter(ground(), *seed, o, {}, "seeds").pasted;
  };
  const auto one = placed(1, 300), two = placed(2, 300), more = placed(2, 310);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].tet, two[i].tet);
    EXPECT_EQ(one[i].corner, two[i].corner);
    EXPECT_EQ(one[i].coordinate, two[i].coordinate);
    EXPECT_EQ(one[i].key, more[i].key);
  }
}

TEST_F(Things, KeepClearOfWhatIsTaken) {
  ScatterOptions o = seeds();
  o.count = 0;
  o.spacing = 4;
  const ScatterResult all = scatter(ground(), *seed, o, {}, "seeds");
  PlacedBox taken;
  taken.center = {9, 0, 0};
  taken.half = {4, 4, 4};
  const ScatterResult rest = scatter(ground(), *seed, o, std::span(&taken, 1), "seeds");
  std::size_t met = 0;
  for (const PastedThing& thing : all.pasted) met += thing.box.meets(taken);
  EXPECT_GT(met, 0u);
  std::set<std::uint64_t> keys;
  for (const PastedThing& thing : all.pasted) keys.insert(thing.key);
  std::size_t moved = 0;
  for (const PastedThing& thing : rest.pasted) {
    EXPECT_FALSE(thing.box.meets(taken));
    if (!keys.contains(thing.key)) ++moved;
    for (const PastedThing& other : rest.pasted)
      if (other.key != thing.key) {
        EXPECT_GE((other.box.center - thing.box.center).norm(), 4.0);
      }
  }
  EXPECT_LT(moved, all.pasted.size() / 4); // a local change stays local
}

TEST_F(Things, APasteLiesWhereItWasPutAndAsItWasTurned) {
  Random random(3);
  const MaskGrid mask(seed->mask);
  for (int i = 0; i < 20; ++i) {
    PasteOptions o;
    o.place = {random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(-18, 18)};
    o.size = random.uniform(1, 9);
    o.rotation = random_rotation(random);
    o.in_frame = i % 2 == 0;
    const PastedThing thing = paste(ground().paste, *seed, o, "paste");
    EXPECT_TRUE(std::is_sorted(thing.tet.begin(), thing.tet.end()));
    EXPECT_EQ(thing.box.center, o.place);
    EXPECT_NEAR(2 * thing.box.half.maxCoeff(), o.size, 1e-9);
    if (!o.in_frame) {
      EXPECT_TRUE(thing.box.axes.isApprox(o.rotation, 1e-12));
    }
    EXPECT_TRUE((thing.box.axes.transpose() * thing.box.axes).isIdentity(1e-9));
    const Root root = root_with({thing}, *seed);
    for (int k = 0; k < 200; ++k) {
      const Vec3d u(random.uniform(), random.uniform(), random.uniform());
      const Vec3d x = rest_point(*seed, thing.box, u);
      if (!locator->owner(x, 0).exists()) continue;
      const float alpha = alpha_at(mask, u);
      EXPECT_NEAR(material_at(root, {.position = x}).coverage, alpha, 5e-3); // over 0.996 counts as opaque
    }
  }
}

TEST_F(Things, WarpedThingsAreWholeAndFollowTheFrames) {
  PasteOptions o;
  o.place = {8, 2, 3};
  o.size = 6;
  o.follow = Follow::warped;
  const PastedThing warped = paste(ground().paste, *seed, o, "paste");
  const Root root = root_with({warped}, *seed);
  EXPECT_GT(material_at(root, {.position = o.place}).coverage, 0.99f);
  // Every part of the thing is somewhere: of its alpha, all lies in the images of its tets.
  const MaskGrid mask(seed->mask);
  Random random(9);
  double there = 0, found = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d u(random.uniform(), random.uniform(), random.uniform());
    const double alpha = alpha_at(mask, u);
    if (alpha == 0) continue;
    there += alpha;
    for (std::size_t k = 0; k < warped.tet.size(); ++k) {
      std::array<Vec3d, 4> p;
      for (int c = 0; c < 4; ++c)
        for (int axis = 0; axis < 3; ++axis) p[c][axis] = warped.coordinate[warped.corner[k][c]][axis];
      Mat3d edges;
      for (int c = 0; c < 3; ++c) edges.col(c) = p[c + 1] - p[0];
      const Vec3d weights = edges.inverse() * (u - p[0]);
      if (weights.minCoeff() < -1e-9 || weights.sum() > 1 + 1e-9) continue;
      found += alpha;
      break;
    }
  }
  EXPECT_GT(found, 0.98 * there);
  // Along its long axis its gradient is the frame's S at its middle.
  const Location at = locator->locate(o.place, 0);
  const auto row = std::find(warped.tet.begin(), warped.tet.end(), at.tet.value) - warped.tet.begin();
  ASSERT_LT(row, std::ptrdiff_t(warped.tet.size()));
  Mat3d edges, images;
  for (int k = 0; k < 3; ++k) {
    edges.col(k) =
        solid->mesh.position[solid->mesh.corner[at.tet][k + 1]] - solid->mesh.position[solid->mesh.corner[at.tet][0]];
    for (int a = 0; a < 3; ++a)
      images(a, k) =
          double(warped.coordinate[warped.corner[row][k + 1]][a]) - warped.coordinate[warped.corner[row][0]][a];
  }
  const Mat3d map = images * edges.inverse();
  EXPECT_GT(map.row(1).normalized().dot(solid->frames.axes[at.tet].col(1)), 0.95);
}

TEST_F(Things, WhatCannotBePastedIsRefused) {
  const auto message = [&](const PasteOptions& o) -> std::string {
    try {
      paste(ground().paste, *seed, o, "recipe: /solids/0/pastes/0");
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message({.place = {100, 0, 0}}).find("recipe: /solids/0/pastes/0/place: lies outside region 0, 7"), 0u)
      << message({.place = {100, 0, 0}});
  EXPECT_EQ(message({.size = 0}).find("recipe: /solids/0/pastes/0/size: is 0"), 0u);
  EXPECT_EQ(message({.size = 3, .rotation = 2 * Mat3d::Identity()})
                .find("recipe: /solids/0/pastes/0/rotate: is no rotation"),
            0u);
  EXPECT_EQ(message({.place = {0, 0, 28}, .size = 12, .clip = false}).find("recipe: /solids/0/pastes/0: reaches out"),
            0u);
  EXPECT_EQ(message({.place = {0, 0, 28}, .size = 12}), "accepted");
  ScatterOptions o = seeds();
  o.depth = {0.99, 1};
  o.along = {3, 4};
  EXPECT_THROW(scatter(ground(), *seed, o, {}, "seeds"), InvalidInput);
  o = seeds();
  o.count = 0;
  EXPECT_THROW(scatter(ground(), *seed, o, {}, "seeds"), InvalidInput);
  Exemplar plain = procedural_exemplar("kiwi", {.resolution = 16});
  EXPECT_THROW(thing_of(plain), InvalidInput);
  EXPECT_NO_THROW(thing_of(plain, SplotchOptions{}));
  Exemplar empty = procedural_exemplar("kiwi-seed", {.resolution = 16});
  for (std::size_t i = 3; i < empty.texel.size(); i += 4) empty.texel[i] = 100;
  EXPECT_THROW(thing_of(empty), InvalidInput);
}

TEST_F(Things, ASparseLayerReadsLikeItsDenseSelf) {
  const ScatterResult result = scatter(ground(), *seed, seeds(), {}, "seeds");
  const PastedKind kind{seed, result.pasted};
  const Layer sparse = layer_of({&kind, 1}, 0, "things");
  ASSERT_TRUE(std::is_sorted(sparse.simplex.begin(), sparse.simplex.end()));
  ASSERT_LT(sparse.simplex.size(), solid->mesh.tet_count());
  Layer dense = sparse;
  dense.simplex.clear();
  dense.begin.assign(1, 0);
  for (std::uint32_t t = 0, row = 0; t < solid->mesh.tet_count(); ++t) {
    if (row < sparse.simplex.size() && sparse.simplex[row] == t) ++row;
    dense.begin.push_back(sparse.begin[row]);
  }
  const Root a = root_of(*solid, sparse), b = root_of(*solid, dense);
  Random random(4);
  std::size_t seen = 0, different = 0;
  for (int i = 0; i < 50000; ++i) {
    const MaterialPoint p{.position = {random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-25, 25)}};
    const Material x = material_at(a, p), y = material_at(b, p);
    seen += x.coverage > 0;
    different += x.coverage != y.coverage || x.value != y.value;
  }
  EXPECT_GT(seen, 100u);
  EXPECT_EQ(different, 0u);
}

TEST(PlacedBox, MeetsExactlyWhereAPointIsShared) {
  Random random(5);
  int met = 0;
  for (int i = 0; i < 400; ++i) {
    PlacedBox a, b;
    a.axes = random_rotation(random), b.axes = random_rotation(random);
    a.half = {random.uniform(0.2, 2), random.uniform(0.2, 2), random.uniform(0.2, 2)};
    b.half = {random.uniform(0.2, 2), random.uniform(0.2, 2), random.uniform(0.2, 2)};
    b.center = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    // Nearest points of two convex bodies by alternating projections: the distance goes to 0 exactly when they meet.
    const auto nearest = [](const PlacedBox& box, const Vec3d& x) -> Vec3d {
      const Vec3d local = box.axes.transpose() * (x - box.center);
      return box.center + box.axes * local.cwiseMax(-box.half).cwiseMin(box.half);
    };
    Vec3d x = a.center;
    const auto gap = [&] { return (x - nearest(b, x)).norm(); };
    for (int k = 0; k < 200000 && (k < 2000 || (gap() > 1e-7 && gap() < 0.02)); ++k) x = nearest(a, nearest(b, x));
    const double distance = gap();                    // bodies that touch at a narrow angle take long
    if (distance > 1e-6 && distance < 1e-3) continue; // too near to tell
    met += distance <= 1e-6;
    EXPECT_EQ(a.meets(b), distance <= 1e-6) << i << ": " << distance;
    EXPECT_EQ(b.meets(a), distance <= 1e-6) << i;
    if (distance > 0.01) {
      EXPECT_TRUE(a.meets(b, distance * 1.01)) << i;
    }
  }
  EXPECT_GT(met, 50);
}

TEST(Occupancy, NeverMissesATetThatShowsAlpha) {
  const Thing thing = thing_of(procedural_exemplar("kiwi-seed", {.resolution = 24}));
  const MaskGrid mask(thing.mask);
  Random random(6);
  int shown = 0, spared = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<Vec3d, 4> u;
    const Vec3d at(random.uniform(-0.3, 1.3), random.uniform(-0.3, 1.3), random.uniform(-0.3, 1.3));
    for (Vec3d& corner : u)
      corner = at + random.uniform(0.05, 0.8) * Vec3d(random.normal(), random.normal(), random.normal());
    const bool meets = thing.any.meets(u);
    spared += !meets;
    for (int k = 0; k < 300; ++k) {
      Eigen::Vector4d b(random.uniform(), random.uniform(), random.uniform(), random.uniform());
      b = (-b.array().log()).matrix();
      b /= b.sum();
      const Vec3d x = b[0] * u[0] + b[1] * u[1] + b[2] * u[2] + b[3] * u[3];
      if (alpha_at(mask, x) > 0) {
        ++shown;
        ASSERT_TRUE(meets) << i;
      }
    }
  }
  EXPECT_GT(shown, 1000);
  EXPECT_GT(spared, 500);
}

TEST(Thing, ColoursGoOnBeyondTheEdge) {
  const Thing thing = thing_of(procedural_exemplar("watermelon-seed", {.resolution = 32}));
  EXPECT_EQ(thing.exemplar.component_count(), 3);
  EXPECT_EQ(thing.exemplar.texel.size(), thing.mask.alpha.size() * 3);
  EXPECT_GT(thing.volume, 0.02);
  EXPECT_TRUE(Box(thing.solid).contains(Vec3d(0.5, 0.5, 0.5)));
  // An exemplar whose outside is white: none of it must be left where alpha is 0.
  Exemplar white = procedural_exemplar("kiwi-seed", {.resolution = 32});
  for (std::size_t i = 0; i < white.texel.size(); i += 4)
    if (white.texel[i + 3] == 0) white.texel[i] = white.texel[i + 1] = white.texel[i + 2] = 255;
  const Thing dark = thing_of(white);
  for (const std::uint8_t byte : dark.exemplar.texel) ASSERT_LT(byte, 200);
}

} // namespace
} // namespace pith
