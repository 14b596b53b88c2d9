#include "volume/field/frames.h"

#include "tests/support/tet_grid.h"
#include "volume/base/error.h"
#include "volume/base/parallel.h"

#include <gtest/gtest.h>

using namespace pith;

namespace {

constexpr double degree = M_PI / 180;

struct Scene {
  TetMesh mesh;
  Boundary boundary;
  Locator locator;
  DepthField depth;

  explicit Scene(TetMesh m) : mesh(std::move(m)), boundary(boundary_of(mesh)), locator(mesh, boundary) {}
  Scene(const Scene&) = delete;

  FrameField frames(const std::vector<AxisStroke>& strokes, const FrameOptions& options = {}) const {
    return frames_from_depth(mesh, locator, 0, depth, strokes, "fields.axis", options);
  }
  std::string refusal(const std::vector<AxisStroke>& strokes) const {
    try {
      frames(strokes);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }
};

/// An ellipsoid, 20 × 20 × 40 mm, with depth from its skin to a stroke on its axis.
struct Fruit : Scene {
  explicit Fruit(int n = 14) : Scene(stretched(n)) {
    depth = depth_field(mesh, boundary, 0,
                        {{.value = 0, .skin = true, .triangles = {}, .stroke = {}},
                         {.value = 1, .skin = false, .triangles = {}, .stroke = {{0, 0, -16}, {0, 0, 16}}}},
                        "depth");
  }
  static TetMesh stretched(int n) {
    TetMesh ball = tet_ball(n, 10);
    for (Vec3d& p : ball.position) p.z() *= 2;
    return ball;
  }
};

/// A bar along z, 8 × 8 × 20 mm, whose depth is given in closed form: the distance from the axis x = y = 4.
struct Bar : Scene {
  Bar() : Scene(tet_grid(8, 8, 20)) {
    for (const Vec3d& p : mesh.position) depth.value.push_back(static_cast<float>(1 - radius(p) / 6));
    for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
      const Vec3d x = barycenter(mesh, t);
      depth.gradient.push_back(Vec3d(4 - x.x(), 4 - x.y(), 0).normalized() / 6);
    }
  }
  static double radius(const Vec3d& p) { return std::hypot(p.x() - 4, p.y() - 4); }
};

/// From pole to pole along the skin of the fruit.
AxisStroke meridian(double longitude) {
  AxisStroke stroke;
  for (int i = -60; i <= 60; i += 5)
    stroke.point.push_back({10 * std::cos(i * degree) * std::cos(longitude),
                            10 * std::cos(i * degree) * std::sin(longitude), 20 * std::sin(i * degree)});
  return stroke;
}

void expect_frames(const Scene& scene, const FrameField& field) {
  for (const TetId t : all_ids<TetId>(scene.mesh.tet_count())) {
    const Mat3d& a = field.axes[t];
    EXPECT_LT((a.transpose() * a - Mat3d::Identity()).norm(), 1e-12);
    EXPECT_LT((a.col(0).cross(a.col(1)) - a.col(2)).norm(), 1e-12);
    EXPECT_GT(a.col(1).dot(scene.depth.gradient[t].normalized()), 1 - 1e-12);
  }
}

} // namespace

TEST(Frames, OfABarAreCylindrical) {
  const Bar bar;
  const FrameField field = bar.frames({{.point = {{0.5, 4, 2}, {0.5, 4, 18}}}});
  expect_frames(bar, field);
  for (const TetId t : all_ids<TetId>(bar.mesh.tet_count())) {
    const Vec3d x = barycenter(bar.mesh, t), s = Vec3d(4 - x.x(), 4 - x.y(), 0).normalized();
    EXPECT_EQ(field.singular[t], 0);
    EXPECT_GT(field.axes[t].col(2).z(), std::cos(0.1 * degree));
    EXPECT_GT(field.axes[t].col(0).dot(s.cross(Vec3d::UnitZ())), std::cos(0.1 * degree));
    EXPECT_NEAR(field.scale[t], 6, 1e-5);
  }
}

TEST(Frames, OfAFruitGoAroundItsAxis) {
  const Fruit fruit;
  const FrameField field =
      fruit.frames({meridian(0.3), meridian(0.3 + M_PI / 2), meridian(0.3 + M_PI), meridian(0.3 - M_PI / 2)});
  expect_frames(fruit, field);
  int seen = 0;
  double worst_r = 0, worst_t = 0;
  for (const TetId t : all_ids<TetId>(fruit.mesh.tet_count())) {
    const Vec3d x = barycenter(fruit.mesh, t);
    if (x.head<2>().norm() < 2.5 || std::abs(x.z()) > 12) continue; // away from the axis and the poles
    ++seen;
    EXPECT_EQ(field.singular[t], 0);
    // S points to the axis, T to the upper pole along the layers, R around: R = S × T.
    const Vec3d inward = fruit.depth.gradient[t].normalized();
    const Vec3d around = Vec3d(-x.x(), -x.y(), 0).normalized().cross(Vec3d::UnitZ());
    const Vec3d upward = (Vec3d::UnitZ() - inward.z() * inward).normalized();
    worst_r = std::max(worst_r, std::acos(std::min(1.0, field.axes[t].col(0).dot(around))));
    worst_t = std::max(worst_t, std::acos(std::min(1.0, field.axes[t].col(2).dot(upward))));
  }
  EXPECT_GT(seen, 3000);
  EXPECT_LT(worst_r / degree, 6);
  EXPECT_LT(worst_t / degree, 6);
}

TEST(Frames, ScaleIsTheInverseGradientClamped) {
  const Fruit fruit(8);
  const FrameField field = fruit.frames({meridian(0)}, {.smallest_scale = 6, .largest_scale = 9});
  int low = 0, high = 0, free = 0;
  for (const TetId t : all_ids<TetId>(fruit.mesh.tet_count())) {
    const double inverse = 1 / fruit.depth.gradient[t].norm();
    EXPECT_FLOAT_EQ(field.scale[t], static_cast<float>(std::clamp(inverse, 6.0, 9.0)));
    ++(inverse < 6 ? low : inverse > 9 ? high : free);
  }
  EXPECT_GT(std::min({low, high, free}), 20);
}

TEST(Frames, AreSingularWhereAxisAndGradientMeet) {
  // Depth rises along x on the left and along z on the right; the axis is z everywhere.
  Bar bar;
  for (const TetId t : all_ids<TetId>(bar.mesh.tet_count()))
    bar.depth.gradient[t] = barycenter(bar.mesh, t).x() < 4 ? Vec3d(0.1, 0, 0) : Vec3d(0, 0.001, 0.1);
  const FrameField field = bar.frames({{.point = {{0.5, 4, 2}, {0.5, 4, 18}}}});
  expect_frames(bar, field);
  for (const TetId t : all_ids<TetId>(bar.mesh.tet_count()))
    EXPECT_EQ(field.singular[t], barycenter(bar.mesh, t).x() < 4 ? 0 : 1);
}

TEST(Frames, AreSingularWhereTheGradientVanishes) {
  Bar bar;
  bar.depth.gradient[TetId(3)] = Vec3d::Zero();
  bar.depth.gradient[TetId(4)] = Vec3d(1e-6, 0, 0);
  const FrameField field = bar.frames({{.point = {{0.5, 4, 2}, {0.5, 4, 18}}}});
  EXPECT_EQ(std::count(field.singular.begin(), field.singular.end(), 1), 2);
  for (const TetId t : {TetId(3), TetId(4)}) {
    EXPECT_EQ(field.singular[t], 1);
    EXPECT_EQ(field.scale[t], 20.0f);
    EXPECT_LT((field.axes[t].transpose() * field.axes[t] - Mat3d::Identity()).norm(), 1e-12);
    EXPECT_GT(field.axes[t].determinant(), 0);
  }
}

TEST(Frames, AreTheSameOnAnyNumberOfThreads) {
  const Fruit fruit(10);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return fruit.frames({meridian(0), meridian(3)});
  };
  const FrameField one = run(1), two = run(2);
  EXPECT_EQ(one.axes, two.axes);
  EXPECT_EQ(one.scale, two.scale);
  EXPECT_EQ(one.singular, two.singular);
}

TEST(Frames, RefuseStrokesThatDoNotServe) {
  Bar bar;
  const auto expect = [&](const std::vector<AxisStroke>& strokes, const std::string& part) {
    const std::string message = bar.refusal(strokes);
    EXPECT_EQ(message.rfind("fields.axis/orientation", 0), 0u) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  const AxisStroke good{.point = {{0.5, 4, 2}, {0.5, 4, 18}}};
  EXPECT_EQ(bar.refusal({good}), "");
  expect({}, "no stroke");
  expect({good, {.point = {{1, 1, 1}}}}, "fields.axis/orientation/1: a stroke of 1 points has no length");
  expect({{.point = {{1, 1, 1}, {NAN, 1, 1}}}}, "not finite");
  expect({{.point = {{50, 1, 1}, {60, 1, 1}}}}, "none of its 1 strokes touches region 0");
  for (Vec3d& g : bar.depth.gradient) g = {0, 0, 0.1};
  expect({good}, "along the depth's gradient everywhere");
  for (Vec3d& g : bar.depth.gradient) g = {0, 0, 0};
  expect({good}, "everywhere");
  EXPECT_THROW(frames_from_depth(bar.mesh, bar.locator, 3, bar.depth, {good}, "x"), InvalidInput);
}

namespace {

/// A box 8 × 4 × 16 with opposite strokes along z on two of its sides.
struct OpposedBox : Scene {
  OpposedBox() : Scene(tet_grid(8, 4, 16)) {}
  const std::vector<AxisStroke> stroke{{.point = {{0, 2, 0}, {0, 2, 16}}}, {.point = {{8, 2, 16}, {8, 2, 0}}}};
  FrameInput input() const { return {.mesh = mesh, .locator = locator, .stroke = stroke, .scale = 2}; }
};

std::string refusal_of(const FrameInput& input, const FrameOptions& options = {}) {
  try {
    frames_of(input, options);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

} // namespace

TEST(Frames, OppositeStrokesAgreeAsAnAxisButCancelAsVectors) {
  const OpposedBox box;
  const FrameField vectors = frames_of(box.input()), axis = frames_of(box.input(), {.unsigned_axis = true});
  double worst = 1;
  int against = 0, first = 0;
  for (const TetId t : all_ids<TetId>(box.mesh.tet_count())) {
    EXPECT_EQ(axis.singular[t], 0);
    worst = std::min(worst, axis.axes[t].col(2).z()); // with its sign: signs agree
    EXPECT_LT((axis.axes[t].transpose() * axis.axes[t] - Mat3d::Identity()).norm(), 1e-9);
    EXPECT_GT(axis.axes[t].determinant(), 0);
    against += vectors.axes[t].col(2).z() < 0;
    first += vectors.axes[t].col(2).z() > 0;
  }
  EXPECT_GT(worst, std::cos(1 * degree));
  // The signed field turns over in the middle.
  EXPECT_GT(against, 500);
  EXPECT_GT(first, 500);
  EXPECT_NEAR(axis.scale[TetId(0)], 2, 1e-6);
}

TEST(Frames, AnAxisWithoutSignStaysAcrossTheDepth) {
  const Bar bar;
  const std::vector<AxisStroke> stroke{{.point = {{0.5, 4, 2}, {0.5, 4, 18}}},
                                       {.point = {{7.5, 4, 18}, {7.5, 4, 2}}}};
  const FrameField field = bar.frames(stroke, {.unsigned_axis = true});
  expect_frames(bar, field);
  for (const TetId t : all_ids<TetId>(bar.mesh.tet_count())) {
    EXPECT_EQ(field.singular[t], 0);
    EXPECT_GT(std::abs(field.axes[t].col(2).z()), std::cos(1 * degree));
  }
}

TEST(Frames, OfStrokesAloneBendWithThem) {
  // A quarter circle around (0, ·, 0) on a box: the field turns with the stroke.
  const Scene scene(tet_grid(10, 3, 10));
  AxisStroke arc;
  for (int i = 0; i <= 30; ++i)
    arc.point.push_back({8 * std::cos(3 * i * degree), 1.5, 8 * std::sin(3 * i * degree)});
  const std::vector<AxisStroke> strokes{arc};
  const FrameField field = frames_of({.mesh = scene.mesh, .locator = scene.locator, .stroke = strokes, .scale = 3});
  for (int i = 2; i < 29; ++i) {
    const TetId t = scene.locator.owner(arc.point[i]);
    EXPECT_GT(field.axes[t].col(2).dot(Vec3d(-arc.point[i].z(), 0, arc.point[i].x()).normalized()),
              std::cos(6 * degree));
  }
}

TEST(Frames, OfDepthAloneFollowItsGradient) {
  const Fruit fruit(8);
  const FrameField field = frames_of({.mesh = fruit.mesh, .locator = fruit.locator, .depth = &fruit.depth});
  expect_frames(fruit, field);
  const SingularSet set = singular_set(fruit.mesh, 0, field.singular);
  EXPECT_EQ(set.tets, static_cast<std::size_t>(std::count(field.singular.begin(), field.singular.end(), 1)));
  EXPECT_LT(set.share, 0.05);
}

TEST(Frames, OfFieldsFollowBothGradients) {
  Bar bar;
  DepthField along = bar.depth, around = bar.depth;
  for (const TetId t : all_ids<TetId>(bar.mesh.tet_count())) {
    along.gradient[t] = Vec3d(0.02, 0, 0.05);
    const Vec3d x = barycenter(bar.mesh, t);
    around.gradient[t] = Vec3d(x.y() - 4, 4 - x.x(), 0).normalized() / 6;
  }
  const FrameField two = frames_of({.mesh = bar.mesh, .locator = bar.locator, .depth = &bar.depth, .along = &along});
  expect_frames(bar, two);
  for (const TetId t : all_ids<TetId>(bar.mesh.tet_count())) {
    const Vec3d r = two.axes[t].col(0); // across both gradients, so that nothing shears along it
    EXPECT_LT(std::abs(r.dot(along.gradient[t].normalized())), 1e-9);
    EXPECT_GT(two.axes[t].col(2).dot(along.gradient[t]), 0);
    EXPECT_EQ(two.singular[t], 0);
  }
  // A part of the map that is turned inside out is singular; a mirror image as a whole is not.
  FrameInput three{.mesh = bar.mesh, .locator = bar.locator, .depth = &bar.depth, .along = &along, .around = &around};
  EXPECT_EQ(singular_set(bar.mesh, 0, frames_of(three).singular).tets, 0u);
  for (Vec3d& g : around.gradient) g = -g;
  EXPECT_EQ(singular_set(bar.mesh, 0, frames_of(three).singular).tets, 0u);
  around.gradient[TetId(7)] = -around.gradient[TetId(7)];
  EXPECT_EQ(singular_set(bar.mesh, 0, frames_of(three).singular).tets, 1u);
}

TEST(Frames, LocalScaleIsInterpolatedWithinItsFactors) {
  const Scene box(tet_grid(4, 4, 20));
  const std::vector<ScaleConstraint> local{{.stroke = {{2, 2, 0}}, .factor = 1},
                                           {.stroke = {{0, 0, 10}, {4, 4, 10}}, .factor = 4}};
  const FrameField field = frames_of({.mesh = box.mesh, .locator = box.locator, .scale = 5, .local_scale = local});
  for (const TetId t : all_ids<TetId>(box.mesh.tet_count())) {
    const double z = barycenter(box.mesh, t).z();
    EXPECT_GE(field.scale[t], 5 * 0.999f);
    EXPECT_LE(field.scale[t], 20 * 1.001f); // does not run on beyond the second
    if (std::abs(z - 5) < 0.6) {
      EXPECT_NEAR(field.scale[t], 10, 4.5); // half way: about the geometric mean
    }
    if (z > 10.5) {
      EXPECT_GT(field.scale[t], 17);
    }
  }
  const std::vector<ScaleConstraint> alone{{.stroke = {{2, 2, 0}}, .factor = 3}};
  for (const float s : frames_of({.mesh = box.mesh, .locator = box.locator, .scale = 5, .local_scale = alone}).scale)
    EXPECT_NEAR(s, 15, 1e-4);
}

TEST(Frames, RefuseWhatContradictsByKey) {
  const OpposedBox box;
  const auto expect_begin = [](const std::string& text, const std::string& begin) {
    EXPECT_EQ(text.substr(0, begin.size()), begin);
  };
  FrameInput input = box.input();
  input.where = "x.json: /solids/0";
  input.scale = 0;
  expect_begin(refusal_of(input), "x.json: /solids/0/scale: is missing");
  input.scale = -1;
  expect_begin(refusal_of(input), "x.json: /solids/0/scale: is -1");
  input.scale = 2;
  DepthField depth;
  depth.value.assign(box.mesh.vertex_count(), 0);
  depth.gradient.assign(box.mesh.tet_count(), Vec3d(1, 0, 0));
  input.along = &depth;
  expect_begin(refusal_of(input), "x.json: /solids/0/along: is given without \"depth\"");
  input.depth = &depth;
  expect_begin(refusal_of(input), "x.json: /solids/0/orientation: and \"along\" both give the T axis");
  input.stroke = {};
  expect_begin(refusal_of(input), "x.json: /solids/0/along: rises along \"depth\" everywhere");
  input.along = nullptr;
  const std::vector<ScaleConstraint> outside{{.stroke = {{50, 0, 0}}, .factor = 2}};
  input.local_scale = outside;
  expect_begin(refusal_of(input), "x.json: /solids/0/local_scale/0: touches no place");
  const std::vector<ScaleConstraint> nothing{{.stroke = {{1, 1, 1}}, .factor = 0}};
  input.local_scale = nothing;
  expect_begin(refusal_of(input), "x.json: /solids/0/local_scale/0/factor: is 0");
  EXPECT_EQ(refusal_of(box.input()), "accepted");
}
