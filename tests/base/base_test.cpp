// Random numbers are functions of their keys; parallel loops give the same result for any number of threads.
#include "volume/base/error.h"
#include "volume/base/image.h"
#include "volume/base/parallel.h"
#include "volume/base/random.h"
#include "volume/base/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace pith {
namespace {

TEST(Random, IsAFunctionOfItsKeysAlone) {
  Random a(1, 2, 3), b(1, 2, 3), c(1, 3, 2);
  for (int i = 0; i < 10; ++i) {
    const std::uint64_t bits = a.bits();
    EXPECT_EQ(bits, b.bits());
    EXPECT_NE(bits, c.bits());
  }
}

TEST(Random, HasTheMomentsOfItsDistributions) {
  double mean = 0, square = 0, normal_mean = 0, normal_square = 0;
  int below[7] = {};
  constexpr int count = 200000;
  Random random(5);
  for (int i = 0; i < count; ++i) {
    const double u = random.uniform(), n = random.normal();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    mean += u / count;
    square += u * u / count;
    normal_mean += n / count;
    normal_square += n * n / count;
    ++below[random.below(7)];
  }
  EXPECT_NEAR(mean, 0.5, 0.003);
  EXPECT_NEAR(square, 1.0 / 3, 0.003);
  EXPECT_NEAR(normal_mean, 0, 0.01);
  EXPECT_NEAR(normal_square, 1, 0.02);
  for (int k : below) EXPECT_NEAR(k, count / 7.0, 5 * std::sqrt(count / 7.0));
}

TEST(Parallel, VisitsEveryElementOnceAndPassesErrorsOn) {
  std::vector<std::atomic<int>> visits(10007);
  parallel_for(visits.size(), 64, [&](std::size_t i) { ++visits[i]; });
  for (const auto& v : visits) EXPECT_EQ(v, 1);
  EXPECT_THROW(parallel_for(1000, 10,
                            [](std::size_t i) {
                              if (i == 777) throw InvalidInput("a", "b", "c");
                            }),
               InvalidInput);
}

TEST(Parallel, OrderedSumsHaveTheSameBitsForAnyNumberOfThreads) {
  const auto term = [](std::size_t i) { return unit_double(hash_of(i)) * (i % 3 ? 1e-8 : 1e8); };
  double sums[2];
  for (int threads : {1, 2}) {
    ThreadLimit limit(threads);
    sums[threads - 1] = ordered_sum(100003, term);
  }
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(ordered_sum(0, term), 0);
}

TEST(Parallel, ReportCancelsWhenAskedTo) {
  EXPECT_NO_THROW(report({}, 0.5));
  EXPECT_NO_THROW(report([](double) { return true; }, 0.5));
  EXPECT_THROW(report([](double) { return false; }, 0.5), Cancelled);
}

TEST(Parallel, SharedProgressReportsOneCallAtATime) {
  std::atomic<int> inside{0}, calls{0};
  std::atomic<bool> together{false};
  double furthest = 0;
  const Progress progress = [&](double fraction) {
    if (++inside > 1) together = true;
    std::this_thread::sleep_for(std::chrono::microseconds(200)); // long enough for another to arrive
    furthest = std::max(furthest, fraction);
    ++calls;
    --inside;
    return true;
  };
  SharedProgress shared(progress, 400);
  parallel_for(400, 1, [&](std::size_t) {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
    shared.add();
  });
  EXPECT_FALSE(together);
  EXPECT_GT(calls, 0);
  EXPECT_LE(furthest, 1);
  EXPECT_GT(furthest, 0.5);

  const Progress stop = [](double) { return false; };
  SharedProgress stopped(stop, 8);
  EXPECT_THROW(parallel_for(8, 1, [&](std::size_t) { stopped.add(); }), Cancelled);
}

TEST(Image, TransferCurvesAreInverse) {
  for (int i = 0; i <= 255; ++i) EXPECT_NEAR(srgb_from_linear(linear_from_srgb(i / 255.0f)), i / 255.0f, 1e-6f);
}

TEST(View, RaysPassThroughWhatTheyShow) {
  View view;
  view.eye = {10, 20, 100};
  for (double angle : {0.0, 0.7}) {
    view.vertical_angle = angle;
    const View::Ray ray = view.ray(0.3, -0.2);
    const Vec2d at = view.project(ray.origin + 37 * ray.direction);
    EXPECT_NEAR(at.x(), 0.3, 1e-12);
    EXPECT_NEAR(at.y(), -0.2, 1e-12);
  }
}

} // namespace
} // namespace pith
