#include "volume/io/exemplar_io.h"

#include "io_fixture.h"
#include "volume/base/error.h"
#include "volume/base/image.h"
#include "volume/base/random.h"
#include "volume/io/image_io.h"
#include "volume/io/npy.h"

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
