// pith view without a display: pictures, sessions, and what it says of those that cannot be played.
#include "tests/cli/program.h"
#include "volume/io/image_io.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

using testing::Outcome;
using testing::Program;
using testing::write_text;

const std::string kiwi = PITH_SOURCE_DIR "/data/recipes/table1/kiwi.json";

class View : public ::testing::Test {
protected:
  void SetUp() override {
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
  }
  void expect_refused(const std::vector<std::string>& command, const std::string& what, int code = 1) {
    const auto before = program.files();
    const Outcome outcome = program.run(command);
    EXPECT_EQ(outcome.code, code) << outcome.complaint;
    EXPECT_EQ(outcome.complaint.find("pith: "), 0u) << outcome.complaint;
    EXPECT_EQ(outcome.complaint_lines(), 1u) << outcome.complaint;
    EXPECT_NE(outcome.complaint.find(what), std::string::npos) << "'" << what << "' is not in: " << outcome.complaint;
    EXPECT_EQ(program.files(), before);
  }
  void write_session(const std::string& events) {
    write_text(program.folder / "s.json",
               "{ \"pith session\": 1, \"size\": [200, 150], \"events\": [" + events + "] }");
  }
  Program program;
};

TEST_F(View, DrawsAPictureWithoutADisplay) {
  write_session(R"({"picture": "first.png"}, {"do": "view +x"})");
  const Outcome outcome = program.run({"view", kiwi, "--replay", "s.json", "--screenshot", "end.png", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.complaint;
  EXPECT_NE(outcome.output.find("\"driver\""), std::string::npos);
  const Image end = read_image(program.folder / "end.png");
  EXPECT_EQ(end.width, 200);
  EXPECT_EQ(end.height, 150);
  EXPECT_EQ(end.channels, 4);
  EXPECT_TRUE(testing::content_of(program.folder / "first.png") != testing::content_of(program.folder / "end.png"));

  const Outcome with_panels =
      program.run({"view", kiwi, "--screenshot", "panels.png", "--panels", "--size", "900x600"});
  ASSERT_EQ(with_panels.code, 0) << with_panels.complaint;
  const Image panels = read_image(program.folder / "panels.png");
  EXPECT_NE(panels.at(60, 40)[0], panels.at(850, 300)[0]); // a button on the left, background on the right
  EXPECT_EQ(panels.at(850, 300)[3], 1);
}

TEST_F(View, SaysWhatIsWrong) {
  expect_refused({"view", kiwi}, "--replay"); // no display
  expect_refused({"view", "absent.json", "--screenshot", "x.png"}, "absent.json");
  expect_refused({"view", kiwi, "--screenshot", "x.jpg"}, ".png");
  expect_refused({"view", kiwi, "--screenshot", "absent/x.png"}, "folder");
  expect_refused({"view", kiwi, "--screenshot", "x.png", "--size", "1x1"}, "--size", 2);
  write_text(program.folder / "broken.json", "{");
  expect_refused({"view", kiwi, "--replay", "broken.json"}, "broken.json");
  write_session(R"({"wait": true}, {"do": "dance"})");
  expect_refused({"view", kiwi, "--replay", "s.json"}, "s.json: /events/1: command: there is no 'dance'");
  write_session(R"({"set": "depth", "to": "2"})");
  expect_refused({"view", kiwi, "--replay", "s.json"}, "/events/0: depth");
  write_session(R"({"do": "open", "with": "absent.obj"}, {"wait": true})");
  expect_refused({"view", "--replay", "s.json"}, "absent.obj");
  write_session(R"({"do": "save as", "with": "absent/copy.json"})");
  expect_refused({"view", kiwi, "--replay", "s.json"}, "absent");
}

TEST_F(View, AFullDiskLosesNothing) {
  write_session(R"({"do": "save as", "with": "copy.pith"})");
  ASSERT_EQ(program.run({"view", kiwi, "--replay", "s.json"}).code, 0);
  const std::string before = testing::content_of(program.folder / "copy.pith");
  program.most_file_bytes = 20000;
  write_session(R"({"do": "whole again"}, {"wait": true}, {"do": "save as", "with": "copy.pith"})");
  expect_refused({"view", kiwi, "--replay", "s.json"}, "copy.pith");
  EXPECT_EQ(testing::content_of(program.folder / "copy.pith"), before);
  expect_refused({"view", kiwi, "--screenshot", "end.png", "--size", "1600x1200"}, "end.png");
}

} // namespace
} // namespace pith
