// The verbs, on a small ball: what they write, what --json says, and what an end in the middle leaves behind.
#include "tests/cli/program.h"
#include "tests/support/tri_shapes.h"
#include "volume/io/mesh_io.h"
#include "volume/io/model_io.h"
#include "volume/io/npy.h"

#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace pith {
namespace {

using nlohmann::json;
using testing::Outcome;
using testing::Program;
using testing::write_text;

class Cli : public ::testing::Test {
protected:
  Cli() {
    write_tri_mesh(program.folder / "ball.obj", testing::sphere_surface(3, 20));
    write_text(program.folder / "ball.json",
               R"({"pith": 1, "surface": {"file": "ball.obj"}, "tetrahedralize": {"interior_edge": 6},
      "solids": [{"type": "2-b",
        "depth": [{"skin": true, "value": 0}, {"stroke": [[0, 0, -8], [0, 0, 8]], "value": 1}],
        "orientation": [{"stroke": [[0, 0, -8], [0, 0, 8]]}],
        "exemplar": {"procedural": "kiwi", "resolution": 16}}]})");
  }

  json run(std::vector<std::string> command) {
    command.push_back("--json");
    const Outcome outcome = program.run(command);
    EXPECT_EQ(outcome.code, 0) << outcome.complaint;
    EXPECT_EQ(outcome.complaint, "");
    const json object = json::parse(outcome.output, nullptr, false);
    EXPECT_TRUE(object.is_object()) << outcome.output;
    return object;
  }
  void make() { ASSERT_EQ(program.run({"make", "ball.json", "-o", "ball.pith"}).code, 0); }
  std::string bytes(const std::string& name) { return testing::content_of(program.folder / name); }

  Program program;
};

TEST_F(Cli, MakeTellsItsStagesAndRemembersThem) {
  const json first = run({"make", "ball.json", "-o", "ball.pith"});
  std::vector<std::string> names;
  for (const json& stage : first["stages"]) {
    names.push_back(stage["name"]);
    EXPECT_FALSE(stage["cached"]) << stage["name"];
    EXPECT_GE(stage["seconds"], 0);
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"surface", "tets", "refine", "depth 0", "frames 0", "exemplar 0", "fill 0"}));
  EXPECT_GT(first["peak_memory_bytes"], 1'000'000);
  const std::string model = bytes("ball.pith");
  const json second = run({"make", "ball.json", "-o", "again.pith"});
  for (const json& stage : second["stages"]) EXPECT_TRUE(stage["cached"]) << stage["name"];
  EXPECT_TRUE(bytes("again.pith") == model);
  EXPECT_TRUE(std::filesystem::exists(program.folder / ".cache/pith"));
}

TEST_F(Cli, TheModelIsTheSameForAnyNumberOfThreadsAndDiffersBySeed) {
  run({"make", "ball.json", "-o", "one.pith", "--threads", "1", "--no-cache"});
  run({"make", "ball.json", "-o", "two.pith", "--threads", "2", "--no-cache"});
  EXPECT_TRUE(bytes("one.pith") == bytes("two.pith"));
  run({"make", "ball.json", "-o", "other.pith", "--seed", "99", "--no-cache"});
  EXPECT_FALSE(bytes("one.pith") == bytes("other.pith"));
}

TEST_F(Cli, InfoListsTheRegionsThatDividesMade) {
  write_text(program.folder / "layers.json",
             R"({"pith": 1, "surface": {"file": "ball.obj"}, "tetrahedralize": {"interior_edge": 6},
      "divide": [{"plane": {"normal": [0, 0, 1], "offset": -5}}, {"plane": {"normal": [0, 0, 1], "offset": 7}, "only": 1}]})");
  EXPECT_EQ(run({"info", "layers.json"})["divides"], 2);
  const json made = run({"make", "layers.json", "-o", "layers.pith"});
  EXPECT_EQ(made["stages"][2]["name"], "divide 0");
  EXPECT_EQ(made["stages"][3]["name"], "divide 1");
  const json info = run({"info", "layers.pith"});
  EXPECT_EQ(info["regions"], 3);
  ASSERT_EQ(info["region_measures"].size(), 3u);
  double sum = 0;
  for (const json& region : info["region_measures"]) {
    sum += region["volume"].get<double>();
    EXPECT_GT(region["minimum_dihedral"], 0.005);
  }
  EXPECT_NEAR(sum, info["pieces"][0]["volume"], 1e-9 * sum);
  EXPECT_EQ(info["region_measures"][1]["beside"], json::array({0, 2}));
  const auto cap = [](double height) { return M_PI * height * height * (3 * 20 - height) / 3; };
  EXPECT_NEAR(info["region_measures"][0]["volume"], cap(15), 0.05 * cap(15));
  EXPECT_NEAR(info["region_measures"][2]["volume"], cap(13), 0.05 * cap(13));
  const Outcome told = program.run({"info", "layers.pith"});
  EXPECT_NE(told.output.find("region 2: "), std::string::npos) << told.output;
}

TEST_F(Cli, InfoAnswersFastAndInFull) {
  make();
  const json info = run({"info", "ball.pith"});
  EXPECT_EQ(info["kind"], "model");
  EXPECT_GT(info["tets"], 100);
  EXPECT_GT(info["lookups"], 100);
  EXPECT_EQ(info["pieces"].size(), 1u);
  EXPECT_NEAR(double(info["bounds"]["high"][0]), 20, 1e-9);
  const json quality = run({"info", "ball.pith", "--quality"});
  EXPECT_EQ(quality["pieces"][0]["watertight"], true);
  EXPECT_EQ(quality["pieces"][0]["manifold"], true);
  const json mesh = run({"info", "ball.obj"});
  EXPECT_EQ(mesh["triangles"], 512);
  EXPECT_EQ(run({"info", "ball.json"})["kind"], "recipe");
  double best = 1;
  for (int i = 0; i < 10; ++i) {
    const auto start = std::chrono::steady_clock::now();
    program.run({"info", "ball.obj", "--quiet"});
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  EXPECT_LE(best, 0.05);
}

TEST_F(Cli, CutsAppendToTheRecipeAndGiveWhatABuildGives) {
  make();
  const json cut = run({"cut", "ball.pith", "--plane", "0,0,1,1", "--sphere", "0,0,0,9", "-o", "cut.pith"});
  EXPECT_EQ(cut["pieces"].size(), 4u);
  double volume = 0;
  for (const json& piece : cut["pieces"]) volume += double(piece["volume"]);
  const json whole = run({"check", "ball.pith", "--points", "20000"});
  EXPECT_NEAR(volume, double(whole["root_volume"]), 1e-6 * volume);
  EXPECT_EQ(whole["holes"], 0);
  EXPECT_EQ(run({"check", "cut.pith", "--points", "1000"})["usable"], true);

  // The recipe inside the cut model builds the same file.
  write_text(program.folder / "cut.json", read_model(program.folder / "cut.pith").recipe);
  run({"make", "cut.json", "-o", "built.pith"});
  EXPECT_TRUE(bytes("built.pith") == bytes("cut.pith"));

  const json kept = run({"cut", "ball.pith", "--plane", "0,0,1,1", "--keep", "right", "-o", "kept.pith"});
  EXPECT_EQ(kept["pieces"].size(), 1u);
  EXPECT_LT(double(kept["pieces"][0]["volume"]), volume / 2);
  write_text(
      program.folder / "s.json",
      R"({"points": [[-0.9, -0.1], [0, 0.1], [0.9, -0.1]], "view": {"eye": [0, -90, 0], "up": [0, 0, 1], "vertical_angle": 0}})");
  EXPECT_EQ(run({"cut", "ball.pith", "--stroke", "s.json", "--spread", "4", "-o", "spread.pith"})["pieces"].size(),
            2u);
}

TEST_F(Cli, SampleIsTheMaterialInsideAndNothingOutside) {
  make();
  const std::vector<double> points{0, 0, 0, 5, 6, 7, 0, 0, 30, std::nan(""), 0, 0, 0, 0, -12};
  write_npy<double>(program.folder / "points.npy", points, {5, 3});
  const json said = run({"sample", "ball.pith", "points.npy", "-o", "out.npy"});
  EXPECT_EQ(said["outside"], 2);
  EXPECT_EQ(said["channels"][0], "r");
  EXPECT_EQ(said["channels"][3], "alpha");
  const NpyArray out = read_npy(program.folder / "out.npy");
  EXPECT_EQ(out.type, NpyType::f4);
  const std::size_t width = said["channels"].size();
  ASSERT_EQ(out.shape, (std::vector<std::size_t>{5, width}));
  const std::vector<double> value = out.as_double();
  ModelFile file = read_model(program.folder / "ball.pith");
  const Root root(std::move(file.model));
  for (const std::size_t i : {0, 1, 4}) {
    const Vec3d x(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    const Material material = material_at(root, {.position = x, .region = -1, .facet = {}, .hint = {}});
    for (int c = 0; c < 3; ++c) EXPECT_EQ(static_cast<float>(value[i * width + c]), material.value[c]);
    EXPECT_EQ(static_cast<float>(value[i * width + 3]), material.coverage);
    EXPECT_GE(material.coverage, 0.98);
  }
  for (const std::size_t i : {2, 3}) EXPECT_TRUE(std::isnan(value[i * width]));
  // A half that was taken away is outside.
  run({"cut", "ball.pith", "--plane", "0,0,1,-3", "--keep", "right", "-o", "kept.pith"});
  EXPECT_EQ(run({"sample", "kept.pith", "points.npy", "-o", "out.npy"})["outside"], 3);
}

TEST_F(Cli, ExportsAndPictures) {
  make();
  run({"cut", "ball.pith", "--plane", "0,0,1,1", "--spread", "10", "-o", "cut.pith"});
  for (const char* name : {"out.ply", "out.obj", "out.stl", "out.glb", "out.vtu", "out.vdb"}) {
    const json said = run({"export", "cut.pith", "-o", name});
    EXPECT_GT(said["bytes"], 1000) << name;
  }
  const TriMesh surface = read_tri_mesh(program.folder / "out.stl");
  EXPECT_TRUE(surface_defects(surface).clean()) << surface_defects(surface).summary();
  for (const char* name : {"out.png", "out.exr"}) {
    run({"render", "cut.pith", "-o", name, "--size", "64x48", "--spp", "2"});
    const json image = run({"info", name});
    EXPECT_EQ(image["width"], 64);
    EXPECT_EQ(image["height"], 48);
  }
}

TEST_F(Cli, ExemplarsAndShapes) {
  run({"exemplar", "kiwi", "-o", "kiwi.exemplar", "--resolution", "16"});
  EXPECT_EQ(run({"info", "kiwi.exemplar"})["size"], (json{16, 16, 16}));
  run({"shape", "kiwi", "-o", "kiwi.obj", "--triangles", "2000"});
  EXPECT_EQ(run({"check", "kiwi.obj"})["clean"], true);
}

TEST_F(Cli, QuietSaysNothing) {
  const Outcome outcome = program.run({"make", "ball.json", "-o", "ball.pith", "--quiet"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.output + outcome.complaint, "");
}

/// A recipe that takes long enough to be ended in the middle.
class CliEnd : public Cli {
protected:
  const std::string slow = PITH_SOURCE_DIR "/data/recipes/kiwi.json";
  void SetUp() override {
    if (!std::filesystem::exists(slow)) GTEST_SKIP() << "no " << slow;
  }
};

TEST_F(CliEnd, CtrlCLeavesNothing) {
  const auto before = program.files();
  for (const int milliseconds : {30, 400, 1200}) {
    const Program::Process process = program.start({"make", slow, "-o", "kiwi.pith", "--no-cache"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    ::kill(process.id, SIGINT);
    const Outcome outcome = program.finish(process);
    EXPECT_EQ(outcome.code, 130) << milliseconds;
    EXPECT_EQ(outcome.complaint, "pith: cancelled\n");
    EXPECT_EQ(program.files(), before);
  }
}

TEST_F(CliEnd, KillLeavesNoBrokenOutputAndAUsableCache) {
  make();
  const std::string whole = bytes("ball.pith");
  for (int milliseconds = 5; milliseconds < 700; milliseconds = milliseconds * 3 / 2) {
    std::filesystem::remove_all(program.folder / ".cache");
    std::filesystem::remove(program.folder / "killed.pith");
    const Program::Process process = program.start({"make", "ball.json", "-o", "killed.pith"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    ::kill(process.id, SIGKILL);
    program.finish(process);
    if (std::filesystem::exists(program.folder / "killed.pith")) {
      EXPECT_TRUE(bytes("killed.pith") == whole) << milliseconds;
    }
    run({"make", "ball.json", "-o", "after.pith"}); // on what the killed one left in the cache
    EXPECT_TRUE(bytes("after.pith") == whole) << milliseconds;
  }
}

} // namespace
} // namespace pith
