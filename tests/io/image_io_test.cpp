#include "volume/io/image_io.h"

#include "io_fixture.h"
#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/io/module.h"

#include <chrono>
#include <cmath>
#include <thread>

namespace pith {
namespace {

using testing::Folder;

Image some_image(int channels, float most = 1) {
  Image image(37, 23, channels);
  Random random(1, channels);
  for (float& value : image.pixel) value = static_cast<float>(random.uniform(0, most));
  return image;
}

/// Largest difference after encoding both to sRGB (alpha as it is).
double difference(const Image& a, const Image& b, bool linear = false) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.channels, b.channels);
  double most = 0;
  for (std::size_t i = 0; i < a.pixel.size(); ++i) {
    const bool alpha = a.channels % 2 == 0 && int(i % a.channels) == a.channels - 1;
    const auto value = [&](const Image& image) {
      return alpha || linear ? image.pixel[i] : srgb_from_linear(image.pixel[i]);
    };
    most = std::max(most, double(std::abs(value(a) - value(b))));
  }
  return most;
}

TEST(ImageFile, PngHoldsTheNearestByteOfEveryChannel) {
  const Folder folder;
  for (int channels = 1; channels <= 4; ++channels) {
    const Image image = some_image(channels);
    write_image(folder / "a.png", image);
    EXPECT_LE(difference(read_image(folder / "a.png"), image), 0.5001 / 255) << channels;
    write_image(folder / "b.png", image, {.bits = 16});
    EXPECT_LE(difference(read_image(folder / "b.png"), image), 0.51 / 65535) << channels;
    write_image(folder / "c.png", image, {.linear = true});
    EXPECT_LE(difference(read_image(folder / "c.png", {.linear = true}), image, true), 0.5001 / 255) << channels;
  }
}

TEST(ImageFile, FloatsComeBackBitForBit) {
  const Folder folder;
  for (int channels = 1; channels <= 4; ++channels) {
    Image image = some_image(channels, 1000);
    image.pixel[5] = -2;
    write_image(folder / "a.exr", image);
    EXPECT_EQ(read_image(folder / "a.exr").pixel, image.pixel) << channels;
    write_image(folder / "b.exr", image, {.half = true});
    const Image half = read_image(folder / "b.exr");
    for (std::size_t i = 0; i < image.pixel.size(); ++i)
      EXPECT_NEAR(half.pixel[i], image.pixel[i], std::abs(image.pixel[i]) / 1024 + 1e-6);
    write_image(folder / "a.tif", image);
    EXPECT_EQ(read_image(folder / "a.tif").pixel, image.pixel) << channels;
  }
  const Image image = some_image(3, 10);
  write_image(folder / "a.hdr", image);
  const Image shared_exponent = read_image(folder / "a.hdr");
  for (std::size_t i = 0; i < image.pixel.size(); ++i)
    EXPECT_NEAR(shared_exponent.pixel[i], image.pixel[i], 10.0 / 128);
}

TEST(ImageFile, JpegIsNearOnASmoothPicture) {
  const Folder folder;
  Image image(64, 64, 3);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      image.at(x, y)[0] = float(x) / 64;
      image.at(x, y)[1] = float(y) / 64;
      image.at(x, y)[2] = 0.5f;
    }
  write_image(folder / "a.jpg", image);
  EXPECT_LT(difference(read_image(folder / "a.jpg"), image), 0.06);
}

TEST(ImageFile, ValuesOutsideAreClampedAndNanIsBlack) {
  const Folder folder;
  Image image(3, 1, 1);
  image.pixel = {-5, 7, std::nanf("")};
  write_image(folder / "a.png", image);
  EXPECT_EQ(read_image(folder / "a.png").pixel, (std::vector<float>{0, 1, 0}));
}

TEST(ImageFile, SameBytesAtAnyTime) {
  const Folder folder;
  const Image image = some_image(4);
  const std::vector<ImageLayer> layers = {{"depth", some_image(1)}};
  const std::vector<std::string> names = {"a.png", "a.exr", "a.hdr", "a.tif", "a.jpg"};
  const auto write_all = [&] {
    std::vector<std::string> content;
    for (const std::string& name : names) {
      write_image(folder / name, image, {}, name == "a.exr" ? layers : std::vector<ImageLayer>());
      content.push_back(file_content(folder / name));
    }
    return content;
  };
  const auto before = write_all();
  std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // time stamps count seconds
  const auto after = write_all();
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(before[i], after[i]) << names[i];
  EXPECT_EQ(folder.file_count(), names.size());
}

TEST(ImageFile, FurtherLayersGoIntoExrOnly) {
  const Folder folder;
  const Image image = some_image(4);
  const std::vector<ImageLayer> layers = {{"depth", some_image(1)}, {"normal", some_image(3)}};
  write_image(folder / "a.exr", image, {}, layers);
  EXPECT_EQ(read_image(folder / "a.exr").pixel, image.pixel);
  const std::string bytes = file_content(folder / "a.exr");
  EXPECT_NE(bytes.find("normal.R"), bytes.npos);
  EXPECT_NE(bytes.find("depth"), bytes.npos);
  EXPECT_THROW(write_image(folder / "a.png", image, {}, layers), InvalidInput);
  const std::vector<ImageLayer> other = {{"depth", Image(3, 3, 1)}};
  EXPECT_THROW(write_image(folder / "b.exr", image, {}, other), InvalidInput);
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(ImageFile, FullDiskIsAnErrorAndLeavesNothing) {
  const Folder folder;
  Image noise(200, 200, 3); // too large for the disk in every format, however it is packed
  Random random(7, 1);
  for (float& value : noise.pixel) value = static_cast<float>(random.uniform(0, 1));
  for (const char* name : {"a.png", "a.jpg", "a.exr", "a.hdr", "a.tif"}) {
    const testing::FullDisk full(4096);
    EXPECT_THROW(write_image(folder / name, noise), IoFailure) << name;
    EXPECT_EQ(folder.file_count(), 0u) << name;
  }
}

TEST(ImageFile, ADamagedPngIsRefusedWithoutAWordOfTheLibrary) {
  const Folder folder;
  write_image(folder / "good.png", some_image(3));
  const std::string whole = file_content(folder / "good.png");
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 1;
  for (const std::string& bytes : {whole.substr(0, whole.size() / 2), whole.substr(0, whole.size() - 1), damaged}) {
    write_file(folder / "bad.png", bytes);
    ::testing::internal::CaptureStderr();
    EXPECT_THROW(read_image(folder / "bad.png"), InvalidInput);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  }
}

TEST(ImageFile, BadFilesAndNamesAreRefused) {
  const Folder folder;
  EXPECT_THROW(read_image(folder / "missing.png"), IoFailure);
  write_file(folder / "empty.png", "");
  EXPECT_THROW(read_image(folder / "empty.png"), InvalidInput);
  write_file(folder / "text.png", "this is no picture");
  EXPECT_THROW(read_image(folder / "text.png"), InvalidInput);
  write_image(folder / "good.png", some_image(3));
  const std::string good = file_content(folder / "good.png");
  write_file(folder / "cut.png", std::string_view(good).substr(0, good.size() / 2));
  EXPECT_THROW(read_image(folder / "cut.png"), InvalidInput);
  EXPECT_THROW(write_image(folder / "a.xyz", some_image(3)), InvalidInput);
  EXPECT_THROW(write_image(folder / "a.png", Image()), InvalidInput);
  EXPECT_THROW(write_image(folder / "missing" / "a.png", some_image(3)), IoFailure);
  EXPECT_TRUE(is_image_path("x.PNG"));
  EXPECT_FALSE(is_image_path("x.pith"));
}

TEST(Module, AMissingOneIsNamed) {
  try {
    module_function("pith-nothing.so", "f", "testing");
    FAIL();
  } catch (const IoFailure& problem) {
    const std::string message = problem.what();
    EXPECT_NE(message.find("pith-nothing.so"), message.npos);
    EXPECT_NE(message.find("needed for testing"), message.npos);
  }
  EXPECT_THROW(module_function("pith-images.so", "no_such_function", "testing"), IoFailure);
}

} // namespace
} // namespace pith
