#include "volume/io/atomic_file.h"

#include "io_fixture.h"
#include "volume/base/error.h"

namespace pith {
namespace {

using testing::Folder;

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const Folder folder;
  const auto path = folder / "result.bin";
  write_file(path, "old");
  {
    AtomicFile file(path);
    file.write("new");
    EXPECT_EQ(file.beside().extension(), ".bin");
    EXPECT_EQ(file_content(path), "old");
    file.write(" content");
    file.commit();
  }
  EXPECT_EQ(file_content(path), "new content");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, LeavesNothingBehindAfterAnException) {
  const Folder folder;
  EXPECT_THROW(
      {
        AtomicFile file(folder / "result.bin");
        file.write("half of it");
        throw InvalidInput("here", "this is wrong", "mend it");
      },
      InvalidInput);
  EXPECT_EQ(folder.file_count(), 0u);
  {
    AtomicFile named(folder / "result.bin");
    named.beside();
    EXPECT_EQ(folder.file_count(), 1u);
  }
  EXPECT_EQ(folder.file_count(), 0u);
}

TEST(AtomicFile, HasNoNameBeforeItIsAskedForOne) {
  const Folder folder;
  AtomicFile file(folder / "result.bin");
  file.write("half of it");
  EXPECT_EQ(folder.file_count(), 0u) << "a killed process would leave this behind";
  EXPECT_EQ(file_content(file.beside()), "half of it");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, TwoWritersOfOnePathDoNotMix) {
  const Folder folder;
  AtomicFile one(folder / "x"), two(folder / "x");
  one.write("one");
  two.write("two");
  two.commit();
  one.commit();
  EXPECT_EQ(file_content(folder / "x"), "one");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, RefusesPlacesWhereNoFileCanBe) {
  const Folder folder;
  EXPECT_THROW(AtomicFile(folder / "missing" / "x.ply"), IoFailure);
  EXPECT_THROW(AtomicFile(std::filesystem::temp_directory_path()), IoFailure);
  EXPECT_THROW(AtomicFile("/dev/null"), IoFailure);
  EXPECT_THROW(AtomicFile(""), IoFailure);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, WritesThroughASymbolicLink) {
  const Folder folder;
  write_file(folder / "real", "old");
  std::filesystem::create_symlink(folder / "real", folder / "link");
  write_file(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(file_content(folder / "real"), "new");
}

TEST(AtomicFile, FullDiskIsAnErrorAndLeavesTheOldFile) {
  const Folder folder;
  write_file(folder / "x", "old");
  {
    const testing::FullDisk full(10000);
    EXPECT_THROW(write_file(folder / "x", std::string(100000, 'x')), IoFailure);
  }
  EXPECT_EQ(file_content(folder / "x"), "old");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(FileContent, IsTheWholeFileOrAnError) {
  const Folder folder;
  const std::string bytes(300000, 'q');
  write_file(folder / "big", bytes);
  EXPECT_EQ(file_content(folder / "big"), bytes);
  write_file(folder / "empty", "");
  EXPECT_EQ(file_content(folder / "empty"), "");
  EXPECT_THROW(file_content(folder / "missing"), IoFailure);
}

} // namespace
} // namespace pith
