#include "volume/io/exemplar_io.h"

#include "io_fixture.h"
#include "volume/base/error.h"
#include "volume/base/image.h"
#include "volume/base/random.h"
#include "volume/io/image_io.h"
#include "volume/io/npy.h"

#include <fstream>

namespace pith {
namespace {

using testing::Folder;

Exemplar some_exemplar() {
  Exemplar exemplar;
  exemplar.name = "fibres";
  exemplar.size = {4, 3, 2, 1};
  exemplar.wrap = {Wrap::repeat, Wrap::clamp, Wrap::mirror, Wrap::clamp};
  exemplar.channel = {
      {},
      {.name = "fibre", .semantic = Semantic::direction, .components = 3, .srgb = false, .low = -1, .high = 1},
      {.name = "extinction", .semantic = Semantic::scalar, .components = 1, .srgb = false, .low = 0, .high = 0.7f}};
  for (std::size_t i = 0; i < 4 * 3 * 2 * 7; ++i) exemplar.texel.push_back(static_cast<std::uint8_t>(i * 5));
  return exemplar;
}

void expect_same(const Exemplar& a, const Exemplar& b) {
  EXPECT_EQ(a.axes, b.axes);
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.texel, b.texel);
}

TEST(ExemplarFile, ComesBackWithTheSameBytes) {
  const Folder folder;
  const Exemplar exemplar = some_exemplar();
  write_exemplar(folder / "a.exemplar", exemplar);
  const Exemplar back = read_exemplar(folder / "a.exemplar");
  expect_same(back, exemplar);
  EXPECT_EQ(back.name, "fibres");
  EXPECT_EQ(back.wrap, exemplar.wrap);
  EXPECT_EQ(back.channel, exemplar.channel);
  write_exemplar(folder / "b.exemplar", back);
  EXPECT_EQ(file_content(folder / "a.exemplar"), file_content(folder / "b.exemplar"));
}

TEST(ExemplarFile, BareTexelsHaveTheirAxesSlowestFirst) {
  const Folder folder;
  Exemplar exemplar = some_exemplar();
  exemplar.channel = {{}};
  exemplar.texel.resize(4 * 3 * 2 * 3);
  write_exemplar(folder / "kiwi.npy", exemplar);
  EXPECT_EQ(read_npy(folder / "kiwi.npy").shape, (std::vector<std::size_t>{2, 3, 4, 3}));
  const Exemplar back = read_exemplar(folder / "kiwi.npy");
  expect_same(back, exemplar);
  EXPECT_EQ(back.name, "kiwi");
  EXPECT_EQ(back.channel, std::vector<Channel>{{}});
}

TEST(ExemplarFile, APictureBecomesTwoAxes) {
  const Folder folder;
  Image image(3, 2, 4);
  for (std::size_t i = 0; i < image.pixel.size(); ++i) image.pixel[i] = float(i) / 24;
  write_image(folder / "leaf.png", image);
  const Exemplar exemplar = read_exemplar(folder / "leaf.png");
  EXPECT_EQ(exemplar.axes, 2);
  EXPECT_EQ(exemplar.size, (std::array<int, 4>{3, 2, 1, 1}));
  ASSERT_EQ(exemplar.component_count(), 4);
  EXPECT_EQ(exemplar.at(1, 0)[3], std::lround(255 * 7 / 24.0));
  EXPECT_EQ(exemplar.at(2, 1)[0], std::lround(255 * srgb_from_linear(20 / 24.0f)));
}

/// A TIFF of grey 8-bit pages, uncompressed (TIFF 6.0, §2 and §4): pages of 3 × 2, then one of another size.
std::string tiff_of_pages(int pages, bool preview) {
  std::string bytes = "II*";
  bytes.push_back(0);
  const auto number = [&](std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
  };
  number(8, 4);
  const int all = pages + preview;
  for (int page = 0; page < all; ++page) {
    const std::uint32_t width = page < pages ? 3 : 1, height = page < pages ? 2 : 1;
    constexpr std::uint32_t entries = 9, directory = 2 + 12 * entries + 4;
    const std::uint32_t data = static_cast<std::uint32_t>(bytes.size()) + directory, count = width * height;
    number(entries, 2);
    const std::pair<int, std::uint32_t> entry[] = {{256, width}, {257, height}, {258, 8},      {259, 1},    {262, 1},
                                                   {273, data},  {277, 1},      {278, height}, {279, count}};
    for (const auto& [tag, value] : entry) number(tag, 2), number(4, 2), number(1, 4), number(value, 4);
    number(page + 1 < all ? data + count + count % 2 : 0, 4);
    for (std::uint32_t i = 0; i < count; ++i) bytes.push_back(static_cast<char>(100 * page + 10 * i));
    if (count % 2) bytes.push_back(0);
  }
  return bytes;
}

TEST(ExemplarFile, ATiffOfPagesBecomesAVolume) {
  const Folder folder;
  std::ofstream(folder / "scan.tif", std::ios::binary) << tiff_of_pages(2, false);
  const Exemplar scan = read_exemplar(folder / "scan.tif");
  EXPECT_EQ(scan.axes, 3);
  EXPECT_EQ(scan.size, (std::array<int, 4>{3, 2, 2, 1}));
  EXPECT_EQ(scan.channel, std::vector<Channel>{{}});
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        for (int c = 0; c < 3; ++c) EXPECT_EQ(scan.at(x, y, z)[c], 100 * z + 10 * (3 * y + x));
  // A small preview behind a picture does not make a volume of it.
  std::ofstream(folder / "leaf.tif", std::ios::binary) << tiff_of_pages(1, true);
  EXPECT_EQ(read_exemplar(folder / "leaf.tif").axes, 2);
  EXPECT_EQ(read_image(folder / "scan.tif").width, 3);
  EXPECT_EQ(read_pages(folder / "scan.tif").size(), 2u);
  // Cut off within the second page.
  std::ofstream(folder / "short.tif", std::ios::binary) << tiff_of_pages(2, false).substr(0, 140);
  EXPECT_NO_THROW(read_image(folder / "short.tif"));
}

TEST(ExemplarFile, WhatCannotBeUsedIsRefused) {
  const Folder folder;
  EXPECT_THROW(read_exemplar(folder / "missing.exemplar"), IoFailure);
  EXPECT_THROW(read_exemplar(folder / "missing.npy"), IoFailure);
  write_npy<float>(folder / "f.npy", std::vector<float>(12), {2, 2, 3});
  EXPECT_THROW(read_exemplar(folder / "f.npy"), InvalidInput);
  write_npy<std::uint8_t>(folder / "u.npy", std::vector<std::uint8_t>(12), {12});
  EXPECT_THROW(read_exemplar(folder / "u.npy"), InvalidInput);
  EXPECT_THROW(write_exemplar(folder / "a.tiff", some_exemplar()), InvalidInput);
  Exemplar wrong = some_exemplar();
  wrong.texel.pop_back();
  EXPECT_THROW(write_exemplar(folder / "a.exemplar", wrong), InvalidInput);
  EXPECT_EQ(folder.file_count(), 2u);
}

TEST(ExemplarFile, DamagedFilesAreRefused) {
  const Folder folder;
  write_exemplar(folder / "good.exemplar", some_exemplar());
  const std::string good = file_content(folder / "good.exemplar");
  for (std::size_t length = 0; length < good.size(); length += 7) {
    write_file(folder / "bad.exemplar", std::string_view(good).substr(0, length));
    EXPECT_THROW(read_exemplar(folder / "bad.exemplar"), InvalidInput) << length;
  }
  Random random(5);
  int refused = 0;
  for (int round = 0; round < 500; ++round) {
    std::string bad = good;
    const std::uint32_t at = random.below(static_cast<std::uint32_t>(bad.size()));
    bad[at] = static_cast<char>(bad[at] ^ (1 << random.below(8)));
    write_file(folder / "bad.exemplar", bad);
    try {
      expect_same(read_exemplar(folder / "bad.exemplar"), some_exemplar());
    } catch (const InvalidInput&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 300);
}

} // namespace
} // namespace pith
