// Recorded sessions replayed: every tool, menu item and setting; what they leave behind.
#include "tests/support/scratch.h"
#include "viewer/replay.h"
#include "volume/base/error.h"
#include "volume/io/image_io.h"

#include <gtest/gtest.h>
#include <set>

namespace pith {
namespace {

namespace fs = std::filesystem;
const fs::path source = PITH_SOURCE_DIR, sessions = source / "tests/viewer/sessions";

/// What is left when a session has been played.
struct Played {
  std::size_t pieces = 0;
  std::vector<std::string> history; ///< labels up to where the session stands
  bool stale = false;
  Recipe recipe;
  std::size_t lookups = 0;
  double coverage_drawn = 0; ///< share of the picture that is not background
};

class Sessions : public ::testing::TestWithParam<const char*> {
protected:
  void SetUp() override { fs::create_directory_symlink(source / "data", scratch / "data"); }

  Played played(const std::string& name) {
    const std::string file = name + ".json";
    const EventList events = parse_session(testing::content_of(sessions / file), file);
    ReplayOptions options;
    options.document.build.cache = fs::path(PITH_BINARY_DIR) / "test-cache";
    options.document.recovery = scratch / "recovery";
    options.picture = scratch / "end.png";
    Played result;
    replay(events, file, scratch.path(), options, [&](Workbench& bench, Screen&) {
      const Document& document = bench.document();
      if (bench.pieces()) result.pieces = bench.pieces()->piece.size();
      for (std::size_t i = 0; i <= document.position() && !document.empty(); ++i)
        result.history.push_back(document.history()[i].label);
      result.stale = document.stale();
      result.recipe = document.recipe();
      if (bench.root())
        for (const Layer& layer : bench.root()->model().layer) result.lookups += layer.lookup.size();
    });
    const Image image = read_image(scratch / "end.png");
    for (int i = 0; i < image.width * image.height; ++i) result.coverage_drawn += image.pixel[4 * i + 3];
    result.coverage_drawn /= image.width * image.height;
    return result;
  }

  testing::ScratchFolder scratch;
};

TEST_P(Sessions, LeavesWhatItShould) {
  const std::string name = GetParam();
  const std::map<std::string, std::size_t> pieces = {
      {"look", 1},      {"views", 1},       {"stroke", 2},  {"stroke_left", 1}, {"stroke_right", 1},
      {"one_piece", 3}, {"plane_drawn", 2}, {"plane_x", 2}, {"plane_y", 2},     {"plane_z", 2},
      {"scoop", 2},     {"punch", 2},       {"corer", 2},   {"peel", 2},        {"move", 2},
      {"join", 1},      {"arrange", 2},     {"history", 4}, {"whole_again", 1}, {"display", 1},
      {"design", 2},    {"paint", 1},       {"paste", 1},   {"scale", 1},       {"face", 1}};
  const Played p = played(name);
  if (const auto expected = pieces.find(name); expected != pieces.end()) {
    EXPECT_EQ(p.pieces, expected->second);
  }
  EXPECT_FALSE(p.stale);
  EXPECT_GT(p.coverage_drawn, 0.05);
  EXPECT_LT(p.coverage_drawn, 0.8);
  if (name == "join") {
    EXPECT_EQ(p.history, (std::vector<std::string>{"open", "whole again", "cut", "join"}));
  }
  if (name == "move") {
    EXPECT_EQ(p.recipe.moves.size(), 2u);
  }
  if (name == "arrange") {
    EXPECT_EQ(p.history, (std::vector<std::string>{"open", "whole again", "cut", "explode", "drop"}));
  }
  if (name == "scoop") {
    EXPECT_EQ(p.recipe.moves.size(), 1u);
  }
  if (name == "face") {
    EXPECT_TRUE(p.recipe.solids.empty()); // taken back
  }
  if (name == "paste") {
    ASSERT_EQ(p.recipe.solids.at(0).pastes.size(), 2u);
    EXPECT_FALSE(p.recipe.solids[0].pastes[0].thing.mask); // an almond says itself where it is
    EXPECT_TRUE(p.recipe.solids[0].pastes[1].thing.mask);
    EXPECT_GT(p.recipe.solids[0].pastes[0].options.size, 5);
  }
  if (name == "scale") {
    ASSERT_EQ(p.recipe.solids.at(0).local_scale.size(), 2u);
    EXPECT_LT(p.recipe.solids[0].local_scale[0].factor, p.recipe.solids[0].local_scale[1].factor);
  }
  if (name == "paint") {
    ASSERT_EQ(p.recipe.solids.size(), 1u);
    EXPECT_EQ(p.recipe.solids[0].exemplar.procedural, "sponge");
  }
}
INSTANTIATE_TEST_SUITE_P(All, Sessions,
                         ::testing::Values("look", "views", "stroke", "stroke_left", "stroke_right", "one_piece",
                                           "plane_drawn", "plane_x", "plane_y", "plane_z", "scoop", "punch", "corer",
                                           "peel", "move", "join", "arrange", "history", "whole_again", "save",
                                           "stop", "display", "design", "paint", "face", "paste", "scale"),
                         [](const auto& info) { return std::string(info.param); });

/// From a bare mesh to a filled kiwi in at most 12 gestures; then cut, all undone, all redone: the same bytes.
TEST_F(Sessions, FromABareMeshToAKiwiAndBackAgain) {
  const EventList events = parse_session(testing::content_of(sessions / "design.json"), "design.json");
  int gestures = 0;
  for (const Event& event : events.event) {
    gestures +=
        event.kind == Event::Kind::press || event.kind == Event::Kind::command || event.kind == Event::Kind::set;
    if (event.kind == Event::Kind::command && event.name == "fill solids") break;
  }
  EXPECT_LE(gestures, 12);
  const Played p = played("design");
  EXPECT_GT(p.lookups, 1000u);
  ASSERT_EQ(p.recipe.solids.size(), 1u);
  EXPECT_EQ(p.recipe.solids[0].depth.size(), 2u);
  EXPECT_EQ(p.recipe.solids[0].orientation.size(), 1u);
  EXPECT_EQ(testing::content_of(scratch / "before.pith"), testing::content_of(scratch / "after.pith"));
  EXPECT_GT(fs::file_size(scratch / "before.pith"), 100000u);

  // Its section is green around a pale core, as a kiwi's is.
  const Image image = read_image(scratch / "designed.png");
  std::size_t green = 0, pale = 0;
  for (int i = 0; i < image.width * image.height; ++i) {
    const float* c = image.pixel.data() + 4 * i;
    if (c[3] < 1) continue;
    green += c[1] > 1.3f * c[0] && c[1] > 3 * c[2];
    pale += c[2] > 0.15f && c[2] > 0.4f * c[1];
  }
  EXPECT_GT(green, 2000u);
  EXPECT_GT(pale, 200u);
}

TEST_F(Sessions, HistoryComesBackBitForBit) {
  played("history");
  EXPECT_EQ(testing::content_of(scratch / "before.pith"), testing::content_of(scratch / "after.pith"));
}

TEST(SessionCoverage, EveryCommandToolAndSettingIsInSomeSession) {
  std::set<std::string> commands, settings;
  for (const auto& entry : fs::directory_iterator(sessions)) {
    const EventList events = parse_session(testing::content_of(entry.path()), entry.path().filename().string());
    for (const Event& event : events.event) {
      if (event.kind == Event::Kind::command) commands.insert(event.name);
      if (event.kind == Event::Kind::set) settings.insert(event.name);
    }
  }
  for (const Command& command : command_table()) EXPECT_TRUE(commands.contains(command.name)) << command.name;
  Settings values;
  for (const Setting& setting : setting_table(values)) EXPECT_TRUE(settings.contains(setting.name)) << setting.name;
}

TEST(SessionText, ReadsWhatItWrites) {
  for (const auto& entry : fs::directory_iterator(sessions)) {
    const EventList events = parse_session(testing::content_of(entry.path()), entry.path().filename().string());
    const std::string text = session_text(events);
    EXPECT_EQ(session_text(parse_session(text, "again")), text);
  }
}

TEST(SessionText, RefusesWhatItCannotPlay) {
  const auto message = [](const std::string& text) {
    try {
      parse_session(text, "s.json");
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  const std::string head = R"({ "pith session": 1, "events": [ { "wait": true }, )";
  EXPECT_EQ(message("{").find("s.json"), 0u);
  EXPECT_EQ(message("[]").find("s.json"), 0u);
  EXPECT_EQ(message(R"({ "pith session": 2, "events": [] })").find("s.json"), 0u);
  for (const char* event :
       {R"({ "press": [0] })", R"({ "press": [0, "a"] })", R"({ "wheel": 1 })", R"({ "set": "keep" })",
        R"({ "press": [0, 0], "button": "top" })", R"({ "jump": 1 })", "7"})
    EXPECT_EQ(message(head + event + " ] }").find("s.json: /events/1"), 0u) << event;
}

TEST(Workbenches, WhatFailsBecomesAMessageAndTheWorkGoesOn) {
  testing::ScratchFolder scratch;
  Workbench bench;
  const auto failed = [&](const Event& event) {
    bench.say("");
    bench.handle(event);
    return bench.message_is_error() && !bench.message().empty();
  };
  EXPECT_TRUE(failed({.kind = Event::Kind::command, .name = "dance"}));
  EXPECT_TRUE(failed({.kind = Event::Kind::set, .name = "keep", .text = "most"}));
  EXPECT_TRUE(failed({.kind = Event::Kind::set, .name = "spread", .text = "far"}));
  EXPECT_TRUE(failed({.kind = Event::Kind::set, .name = "depth", .text = "1.5"}));
  EXPECT_TRUE(failed({.kind = Event::Kind::command, .name = "open", .text = (scratch / "absent.json").string()}));
  testing::write_text(scratch / "picture.obj", "\x89PNG\r\n");
  bench.handle({.kind = Event::Kind::command, .name = "open", .text = (scratch / "picture.obj").string()});
  EXPECT_TRUE(failed({.kind = Event::Kind::wait}));
  // Every tool on nothing at all, and on what is not made: no harm.
  for (const ToolEntry& tool : tool_table()) {
    bench.handle({.kind = Event::Kind::command, .name = "tool " + tool.name});
    for (const Event::Kind kind : {Event::Kind::drag, Event::Kind::release, Event::Kind::press, Event::Kind::press,
                                   Event::Kind::drag, Event::Kind::release, Event::Kind::double_click})
      bench.handle({.kind = kind, .at = {0.1 * int(kind), 0.1}});
    bench.handle({.kind = Event::Kind::wheel, .at = {0, 0}, .amount = 300});
    bench.handle({.kind = Event::Kind::wheel, .at = {0, 0}, .amount = -300});
  }
  bench.handle(
      {.kind = Event::Kind::command, .name = "open", .text = (source / "data/recipes/table1/kiwi.json").string()});
  bench.handle({.kind = Event::Kind::wait});
  EXPECT_FALSE(bench.message_is_error()) << bench.message();
  EXPECT_GE(bench.pieces()->piece.size(), 1u);
}

TEST(Workbenches, AnotherDocumentIsFramedAfresh) {
  testing::ScratchFolder scratch;
  Workbench bench;
  const auto does = [&](const char* name, const std::string& text = {}) {
    bench.handle({.kind = Event::Kind::command, .name = name, .text = text});
    bench.handle({.kind = Event::Kind::wait});
    ASSERT_FALSE(bench.message_is_error()) << bench.message();
  };
  const std::string model = (scratch / "kiwi.pith").string();
  does("open", (source / "data/recipes/table1/kiwi.json").string());
  does("save as", model);
  const Vec3d eye = bench.view().eye;
  const double spread = bench.settings().spread;
  const std::uint64_t material = bench.material_version();
  bench.handle({.kind = Event::Kind::wheel, .at = {0.3, 0.2}, .amount = 9});
  bench.handle({.kind = Event::Kind::set, .name = "spread", .text = "1"});
  EXPECT_NE(bench.view().eye, eye);
  does("open", model); // there at once, without a build
  EXPECT_EQ(bench.view().eye, eye);
  EXPECT_EQ(bench.settings().spread, spread);
  EXPECT_GT(bench.material_version(), material);
}

TEST(Workbenches, AMoveThatIsBrokenOffMovesNothing) {
  Workbench bench;
  bench.handle(
      {.kind = Event::Kind::command, .name = "open", .text = (source / "data/recipes/table1/kiwi.json").string()});
  bench.handle({.kind = Event::Kind::wait});
  bench.handle({.kind = Event::Kind::command, .name = "whole again"});
  bench.handle({.kind = Event::Kind::wait});
  bench.handle({.kind = Event::Kind::command, .name = "home"});
  bench.handle({.kind = Event::Kind::command, .name = "tool move"});
  bench.handle({.kind = Event::Kind::press, .at = {0, 0}});
  bench.handle({.kind = Event::Kind::drag, .at = {0.3, 0.1}});
  EXPECT_GT(bench.surface().piece.at(0).placement.translation.norm(), 1);
  bench.handle({.kind = Event::Kind::command, .name = "tool navigate"});
  EXPECT_EQ(bench.surface().piece.at(0).placement.translation.norm(), 0);
}

TEST(Workbenches, AToolChosenInTheMiddleOfAGestureEndsIt) {
  Workbench bench;
  bench.handle(
      {.kind = Event::Kind::command, .name = "open", .text = (source / "data/recipes/table1/kiwi.json").string()});
  bench.handle({.kind = Event::Kind::wait});
  const std::string before = recipe_text(bench.document().recipe());
  for (const ToolEntry& first : tool_table())
    for (const ToolEntry& second : tool_table()) {
      bench.handle({.kind = Event::Kind::command, .name = "tool " + first.name});
      bench.handle({.kind = Event::Kind::press, .at = {0, 0}});
      bench.handle({.kind = Event::Kind::drag, .at = {0.02, 0.01}});
      bench.handle({.kind = Event::Kind::command, .name = "tool " + second.name});
      for (const double u : {0.1, 0.2, 0.3}) bench.handle({.kind = Event::Kind::drag, .at = {u, 0.05}});
      bench.handle({.kind = Event::Kind::wheel, .at = {0, 0}, .amount = 0});
      bench.tool().lines(bench);
      bench.handle({.kind = Event::Kind::release, .at = {0.3, 0.05}});
    }
  EXPECT_EQ(recipe_text(bench.document().recipe()), before);
}

} // namespace
} // namespace pith
