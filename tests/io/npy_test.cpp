#include "volume/io/npy.h"

#include "io_fixture.h"
#include "volume/base/error.h"
#include "volume/base/random.h"

#include <cstring>

namespace pith {
namespace {

using testing::Folder;

std::string raw_array(int version, const std::string& dictionary, const std::string& data) {
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  bytes += static_cast<char>(dictionary.size() & 0xff);
  bytes += static_cast<char>(dictionary.size() >> 8);
  if (version > 1) bytes += std::string(2, '\0');
  return bytes + dictionary + data;
}

template <class T>
void expect_round_trip(const Folder& folder, const std::vector<T>& values, const std::vector<std::size_t>& shape) {
  const auto path = folder / (name_of(NpyTypeOf<T>::type) + ".npy");
  write_npy<T>(path, values, shape);
  const NpyArray array = read_npy(path);
  EXPECT_EQ(array.type, NpyTypeOf<T>::type);
  EXPECT_EQ(array.shape, shape);
  ASSERT_EQ(array.data.size(), values.size() * sizeof(T));
  EXPECT_TRUE(values.empty() || std::memcmp(array.data.data(), values.data(), array.data.size()) == 0);
  const auto numbers = array.as_double();
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(numbers[i], static_cast<double>(values[i]));
  EXPECT_EQ(file_content(path), npy_bytes(array));
}

TEST(Npy, EveryTypeComesBackBitForBit) {
  const Folder folder;
  expect_round_trip<float>(folder, {1.5f, -2.25f, 1e-30f, 3, 4, 5}, {2, 3});
  expect_round_trip<double>(folder, {0.1, -1e300, 5e-324}, {3});
  expect_round_trip<std::uint8_t>(folder, {0, 255, 7, 8}, {1, 2, 2, 1});
  expect_round_trip<std::uint32_t>(folder, {0, 4294967295u}, {2});
  expect_round_trip<std::uint64_t>(folder, {1ull << 52}, {1});
  expect_round_trip<std::int32_t>(folder, {-2147483647 - 1, 2147483647}, {2, 1});
  expect_round_trip<std::int64_t>(folder, {-(1ll << 52)}, {1});
  expect_round_trip<float>(folder, {}, {0, 3});
  expect_round_trip<double>(folder, {2.5}, {});
}

TEST(Npy, NumbersBeginAtAMultipleOf64) {
  for (std::size_t n = 1; n < 10000000000; n *= 10) {
    const std::size_t shape[] = {n, 3};
    EXPECT_EQ(npy_header_bytes(NpyType::f4, shape).size() % 64, 0u);
  }
}

TEST(Npy, AllFormatVersionsAndSpellingsAreRead) {
  const float value = 2.5f;
  std::string data(4, '\0');
  std::memcpy(data.data(), &value, 4);
  const std::string little = "{'descr': '<f4', 'fortran_order': False, 'shape': (1,), }\n";
  for (const int version : {1, 2, 3})
    EXPECT_EQ(npy_from_bytes(raw_array(version, little, data), "x").as_double(), std::vector<double>{2.5});
  const std::string shuffled = "{\"shape\":(1L,) , \"fortran_order\":False,\"descr\":\"<f4\"}";
  EXPECT_EQ(npy_from_bytes(raw_array(1, shuffled, data), "x").as_double(), std::vector<double>{2.5});
  const std::string big = "{'descr': '>f4', 'fortran_order': False, 'shape': (1,), }\n";
  std::reverse(data.begin(), data.end());
  EXPECT_EQ(npy_from_bytes(raw_array(1, big, data), "x").as_double(), std::vector<double>{2.5});
}

void expect_refused(const std::string& bytes, const std::string& words) {
  try {
    npy_from_bytes(bytes, "points.npy");
    ADD_FAILURE() << "accepted, where this was expected: " << words;
  } catch (const InvalidInput& problem) {
    const std::string message = problem.what();
    EXPECT_NE(message.find(words), message.npos) << message;
    EXPECT_EQ(message.find('\n'), message.npos) << message;
    EXPECT_EQ(message.find("points.npy: "), 0u) << message;
  }
}

TEST(Npy, WhatCannotBeUsedIsRefusedWithItsReason) {
  const auto header = [](const std::string& descr, const std::string& order, const std::string& shape) {
    return "{'descr': " + descr + ", 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  };
  const std::string eight(8, '\0');
  expect_refused("", "not a NumPy array");
  expect_refused("P6 is a picture, not an array", "not a NumPy array");
  expect_refused(raw_array(4, header("'<f4'", "False", "(2,)"), eight), "format 4");
  expect_refused(raw_array(1, header("'<f4'", "True", "(2,)"), eight), "Fortran order");
  expect_refused(raw_array(1, header("'<c8'", "False", "(1,)"), eight), "'<c8'");
  expect_refused(raw_array(1, header("'|O'", "False", "(1,)"), eight), "'|O'");
  expect_refused(raw_array(1, header("'<f4'", "False", "(3,)"), eight), "fewer numbers");
  expect_refused(raw_array(1, header("'<f4'", "False", "(1,)"), eight), "8 bytes");
  expect_refused(raw_array(1, header("'<f4'", "False", "(4294967296, 4294967296, 4294967296)"), eight), "fewer");
  expect_refused(raw_array(1, header("'<f4'", "False", "(-1,)"), eight), "shape");
  expect_refused(raw_array(1, header("'<f4'", "False", "(2"), eight), "shape");
  expect_refused(raw_array(1, "{'descr': '<f4'}", eight), "incomplete");
  expect_refused(raw_array(2, header("'<f4'", "False", "(2,)"), eight).substr(0, 30), "cut off");
}

TEST(Npy, RowsNamesTheShapeThatItFound) {
  const NpyArray array = npy_array<float>(std::vector<float>(8), {2, 4});
  EXPECT_EQ(array.rows(4, "x"), 2u);
  EXPECT_THROW(array.rows(3, "x"), InvalidInput);
}

TEST(Npy, DamagedArraysNeverCrash) {
  const std::vector<float> values(64, 1.5f);
  const std::string good = npy_bytes(npy_array<float>(values, {16, 4}));
  Random random(7);
  int refused = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string bad = good;
    for (int flips = 0; flips < 2; ++flips) bad[random.below(128)] = static_cast<char>(random.below(256));
    if (round % 3 == 0) bad.resize(random.below(static_cast<std::uint32_t>(bad.size())));
    try {
      const NpyArray array = npy_from_bytes(bad, "x");
      EXPECT_EQ(array.data.size(), array.value_count() * bytes_of(array.type));
    } catch (const InvalidInput&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10000);
}

} // namespace
} // namespace pith
