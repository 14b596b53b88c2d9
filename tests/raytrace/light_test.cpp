#include "raytrace/light_sampler.h"
#include "volume/base/error.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

constexpr double pi = std::numbers::pi;

Environment spotted() {
  Environment environment;
  environment.image = Image(32, 16, 3);
  for (float& p : environment.image.pixel) p = 0.2f;
  for (int c = 0; c < 3; ++c) environment.image.at(20, 4)[c] = 60;
  for (int c = 0; c < 3; ++c) environment.image.at(3, 11)[c] = 25;
  return environment;
}

TEST(EnvironmentSampler, DensityIntegratesToOneAndSamplesKnowTheirOwn) {
  for (const bool upper : {false, true}) {
    const Environment environment = spotted();
    const EnvironmentSampler sampler(environment, Vec3d(0.2, 1, 0.1), upper);
    const LocalFrame frame(Vec3d(0.2, 1, 0.1).normalized());
    double sum = 0;
    constexpr int rows = 4000, columns = 640; // columns: a multiple of the cells
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) {
        const double cosine = 1 - 2 * (i + 0.5) / rows, angle = 2 * pi * (j + 0.5) / columns;
        const double sine = std::sqrt(1 - cosine * cosine);
        sum += sampler.density(frame.world({sine * std::cos(angle), sine * std::sin(angle), cosine}));
      }
    EXPECT_NEAR(sum * 4 * pi / (double(rows) * columns), 1, 2e-3);
    int apart = 0;
    for (int i = 0; i < 5000; ++i) {
      Random random(1, i);
      const double a = random.uniform();
      double density;
      const Vec3d w = sampler.sample({a, random.uniform()}, density);
      EXPECT_NEAR(w.norm(), 1, 1e-12);
      EXPECT_TRUE(!upper || w.dot(frame.normal) >= -1e-12);
      apart += std::abs(sampler.density(w) / density - 1) > 1e-9; // only where rounding puts it into the next cell
    }
    EXPECT_LE(apart, 2);
  }
}

TEST(EnvironmentSampler, EstimatesTheIrradianceOfASpottedSky) {
  const Environment environment = spotted();
  const EnvironmentSampler sampler(environment, Vec3d::UnitY(), false);
  const Vec3d normal = Vec3d(1, 1, -2).normalized();
  const LocalFrame frame(normal);
  double sampled = 0, uniform = 0;
  constexpr int count = 400000;
  for (int i = 0; i < count; ++i) {
    PixelSampler numbers(2, 0, i);
    double density;
    const Vec3d w = sampler.sample(numbers.next(), density);
    sampled += environment.scale * sampler.radiance(w).x() * std::max(0.0, w.dot(normal)) / density / count;
    uniform += pi * sampler.radiance(frame.world(cosine_direction(numbers.next()))).x() / count;
  }
  EXPECT_NEAR(sampled / uniform, 1, 5e-3);
}

TEST(EnvironmentSampler, UpwardIrradianceOfAConstantSkyIsPi) {
  Environment environment;
  EXPECT_NEAR(EnvironmentSampler(environment, Vec3d::UnitZ(), true).upward_irradiance().x(), pi, 1e-12);
}

TEST(EnvironmentSampler, MiddleColumnLooksForwardAndColumnsGoRight) {
  Environment environment;
  environment.image = Image(8, 4, 3);
  environment.image.at(4, 1)[0] = 1; // just right of the middle, above the horizon
  const EnvironmentSampler sampler(environment, Vec3d::UnitY(), false);
  const SkyFrame frame(Vec3d::UnitY(), 0);
  EXPECT_NEAR((frame.forward + Vec3d::UnitZ()).norm(), 0, 1e-12); // up y: forward −z, right x
  EXPECT_NEAR((frame.right - Vec3d::UnitX()).norm(), 0, 1e-12);
  const double angle = 2 * pi / 16, rise = pi / 8;
  const Vec3d towards(std::sin(angle) * std::cos(rise), std::sin(rise), -std::cos(angle) * std::cos(rise));
  EXPECT_NEAR(sampler.radiance(towards).x(), 1, 1e-6);
}

TEST(AreaSampler, RadianceIsSeenWithTheDensityOfItsSamples) {
  std::vector<AreaLight> lights(2);
  lights[0] = {{0, 5, 0}, {2, 0, 0}, {0, 0, 3}, {1, 1, 1}, true}; // x × z = −y: shines down
  lights[1] = {{4, 4, 0}, {0, 0, 2}, {-1, 1, 0}, {3, 3, 3}, true};
  const AreaSampler sampler(lights, Vec3d::Zero());
  int facing = 0;
  for (int i = 0; i < 2000; ++i) {
    Random random(4, i);
    const double a = random.uniform();
    const auto sample = sampler.sample({0.3, 0.1, -0.2}, {a, random.uniform()});
    if (!(sample.density > 0)) continue;
    ++facing;
    double seen = 0;
    sampler.radiance({0.3, 0.1, -0.2}, sample.direction, 1e9, true, [&](double d) { return seen = d; });
    EXPECT_NEAR(seen / sample.density, 1, 1e-9);
  }
  EXPECT_GT(facing, 500);
}

TEST(Lights, NeutralExposureShowsWhiteAsFourFifths) {
  Lights lights;
  for (Vec3d* sky : {&lights.environment.zenith, &lights.environment.horizon, &lights.environment.nadir})
    *sky = Vec3d::Constant(3.2);
  EXPECT_NEAR(neutral_exposure(lights, {1, 2, 3}, {0, 0, 2}), -2, 1e-9); // white shows 3.2
  View view;
  const double built_in =
      neutral_exposure(default_lights(view, Vec3d::Zero(), 30, {0, 1, 0}), Vec3d::Zero(), {0, 1, 0});
  EXPECT_LT(std::abs(built_in), 0.5);
  EXPECT_EQ(neutral_exposure(default_lights(view, Vec3d::Zero(), 60, {0, 1, 0}), Vec3d::Zero(), {0, 1, 0}), built_in);
  lights.environment.scale = 0;
  EXPECT_EQ(neutral_exposure(lights, {1, 2, 3}, {0, 0, 2}), 0);
}

TEST(Lights, RefusesWhatCannotShine) {
  Lights lights;
  lights.area.push_back({});
  lights.area[0].edge_v = Vec3d::Zero();
  EXPECT_THROW(validate(lights), InvalidInput);
  lights.area[0].edge_v = {0.5, 1, 0};
  EXPECT_THROW(validate(lights), InvalidInput);
  lights.area.clear();
  validate(lights);
  lights.environment.horizon.x() = -1;
  EXPECT_THROW(validate(lights), InvalidInput);
  lights.environment.horizon.x() = std::nan("");
  EXPECT_THROW(validate(lights), InvalidInput);
}

} // namespace
} // namespace pith
