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
  EXPECT_FALSE(quality["pieces"][0].contains("minimum_dihedral")); // no tet is cut
  run({"cut", "ball.pith", "--plane", "0,0,1,1", "-o", "cut.pith"});
  const double dihedral = run({"info", "cut.pith", "--quality"})["pieces"][0]["minimum_dihedral"];
  EXPECT_GT(dihedral, 0);
  EXPECT_LT(dihedral, 1.3);
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
    if (std::string(name) == "out.ply" || std::string(name) == "out.obj") {
      const TriMesh written = read_tri_mesh(program.folder / name);
      EXPECT_EQ(said["vertices"], written.vertex_count()) << name;
      EXPECT_EQ(said["triangles"], written.triangle_count()) << name;
    }
    if (std::string(name) == "out.vtu") {
      const std::string head = bytes(name).substr(0, 1000);
      EXPECT_NE(head.find("NumberOfPoints=\"" + std::to_string(std::size_t(said["vertices"])) + "\""),
                std::string::npos);
      EXPECT_NE(head.find("NumberOfCells=\"" + std::to_string(std::size_t(said["tets"])) + "\""), std::string::npos);
    }
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

/// Scripts ask `check` whether a surface keeps its shape.
TEST_F(Cli, CheckOfSurfaces) {
  const TriMesh ball = testing::sphere_surface(2, 20);
  const auto verdict = [&](const TriMesh& mesh, const std::string& words, int code) {
    write_tri_mesh(program.folder / "surface.off", mesh);
    const Outcome outcome = program.run({"check", "surface.off", "--json"});
    EXPECT_EQ(outcome.code, code) << words;
    EXPECT_EQ(outcome.complaint_lines(), code == 0 ? 0u : 1u) << outcome.complaint;
    const json object = json::parse(outcome.output, nullptr, false); // one object, also where it fails
    EXPECT_EQ(object["verdict"], words);
    EXPECT_EQ(object["usable"], code == 0);
    return object;
  };
  EXPECT_EQ(verdict(ball, "clean", 0)["unit_hint"], "");
  TriMesh open = ball;
  open.corner.pop_back();
  EXPECT_EQ(verdict(open, "mendable", 0)["moved"], 0);
  verdict(testing::inside_out(ball), "mendable", 0);
  const TriMesh crossing = testing::together(ball, testing::sphere_surface(2, 20, Vec3d(13, 1, 2)));
  EXPECT_GT(verdict(crossing, "wrap", 1)["findings"].size(), 0u);

  const std::string small = verdict(testing::sphere_surface(2, 0.02), "clean", 0)["unit_hint"];
  EXPECT_NE(small.find("in metres"), std::string::npos) << small;
  EXPECT_NE(small.find("\"scale\": 1000"), std::string::npos) << small;
  const std::string large = verdict(testing::sphere_surface(2, 20'000), "clean", 0)["unit_hint"];
  EXPECT_NE(large.find("0.001"), std::string::npos) << large;
}

TEST_F(Cli, CheckOfRecipes) {
  EXPECT_EQ(run({"check", "ball.json"})["usable"], true);
  EXPECT_FALSE(std::filesystem::exists(program.folder / ".cache/pith")); // nothing was built
  write_text(program.folder / "bad.json",
             R"({"pith": 1, "surface": {"file": "ball.obj"},
      "solids": [{"type": "2-b", "region": 1,
        "depth": [{"triangles": [3, 99999], "value": 0}, {"stroke": [[0, 0, -800], [0, 0, -500]], "value": 1}],
        "orientation": [{"stroke": [[0, 90, -8], [0, 90, 8]]}],
        "exemplar": {"file": "gone.exemplar"},
        "scatter": [{"exemplar": {"file": "gone.exemplar"}, "count": 5, "size": 500, "groups": 3,
                     "axis": [[90, 0, 0], [90, 0, 10]]}],
        "pastes": [{"exemplar": {"procedural": "almond"}, "place": [0, 0, 70], "size": 4},
                   {"exemplar": {"procedural": "almond"}, "place": [0, 0, 5], "size": 90}]}],
      "cuts": [{"plane": {"normal": [0, 0, 1], "offset": 33}}], "scene": "gone_scene.json"})");
  const Outcome outcome = program.run({"check", "bad.json", "--json"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.complaint_lines(), 1u);
  const json object = json::parse(outcome.output, nullptr, false);
  std::string all;
  for (const json& finding : object["findings"]) all += std::string(finding["what"]) + "\n";
  for (const char* place :
       {"/solids/0/region", "/solids/0/depth/0/triangles", "/solids/0/depth/1/stroke",
        "/solids/0/orientation/0/stroke", "/solids/0/exemplar/file", "/solids/0/scatter/0/exemplar/file",
        "/solids/0/scatter/0/axis", "/solids/0/scatter/0/size", "/solids/0/pastes/0/place", "/solids/0/pastes/1/size",
        "/cuts/0", "/scene"})
    EXPECT_NE(all.find(std::string("bad.json: ") + place + ":"), std::string::npos) << place << " not in\n" << all;
  EXPECT_EQ(object["findings"].size(), 12u) << all;
}

TEST_F(Cli, AnErrorIsAnObjectToo) {
  const auto failed = [&](std::vector<std::string> command, int code, const std::string& kind) {
    command.push_back("--json");
    const Outcome outcome = program.run(command);
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(outcome.complaint_lines(), 1u) << outcome.complaint;
    const json object = json::parse(outcome.output, nullptr, false);
    ASSERT_TRUE(object.is_object()) << outcome.output;
    EXPECT_EQ("pith: " + std::string(object["error"]) + "\n", outcome.complaint);
    EXPECT_EQ(object["kind"], kind);
    EXPECT_EQ(object["exit_code"], code);
  };
  failed({"info", "gone.pith"}, 1, "file");
  failed({"exemplar", "nothing", "-o", "a.exemplar"}, 1, "input");
  failed({"render", "a.pith", "-o", "b.png", "--size", "10"}, 2, "usage");
  failed({"info"}, 2, "usage");
  failed({"infos"}, 2, "usage");
}

TEST_F(Cli, HelpTellsDefaultsAndCommonOptions) {
  for (const auto& [verb, defaults] :
       std::vector<std::pair<std::string, std::vector<std::string>>>{{"make", {"=2"}},
                                                                     {"info", {}},
                                                                     {"check", {"=200000"}},
                                                                     {"cut", {"=both", "=0", "=0.01"}},
                                                                     {"sample", {"=0"}},
                                                                     {"render", {"=800x600", "=64"}},
                                                                     {"export", {"=0.001", "=color"}},
                                                                     {"exemplar", {"=128"}},
                                                                     {"shape", {"=20000"}}}) {
    const Outcome outcome = program.run({verb, "--help"});
    EXPECT_EQ(outcome.code, 0);
    for (const std::string& text : defaults)
      EXPECT_NE(outcome.output.find(text), std::string::npos) << verb << " " << text << "\n" << outcome.output;
    for (const char* common : {"--json", "--quiet", "--threads", "--seed"})
      EXPECT_NE(outcome.output.find(common), std::string::npos) << verb << " " << common;
  }
}

TEST_F(Cli, AnUnknownVerbIsNamedWithTheNearest) {
  const auto said = [&](const std::vector<std::string>& command) { return program.run(command).complaint; };
  EXPECT_NE(said({"rendr", "a.pith"}).find("there is no verb 'rendr'; did you mean 'render'?"), std::string::npos);
  const std::string frob = said({"--threads", "2", "frob"});
  EXPECT_NE(frob.find("there is no verb 'frob'"), std::string::npos) << frob;
  EXPECT_NE(frob.find("exemplar"), std::string::npos) << frob;
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
  for (const int milliseconds : {150, 400, 1200}) {
    const Program::Process process = program.start({"make", slow, "-o", "kiwi.pith", "--no-cache", "--quiet"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    ::kill(process.id, SIGINT);
    const Outcome outcome = program.finish(process);
    EXPECT_EQ(outcome.code, 130) << milliseconds;
    EXPECT_EQ(outcome.complaint, "pith: cancelled\n");
    EXPECT_EQ(program.files(), before);
  }
}

TEST_F(CliEnd, CtrlCKeepsThePassesOfAPicture) {
  make();
  // So many samples that it cannot finish; a pass of 16 over so few pixels takes some hundredths of a second.
  const Program::Process process =
      program.start({"render", "ball.pith", "-o", "ball.png", "--size", "40x30", "--spp", "1000000"});
  std::this_thread::sleep_for(std::chrono::milliseconds(3000));
  ::kill(process.id, SIGINT);
  const Outcome outcome = program.finish(process);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.complaint.find("pith: ball.png: cancelled after "), std::string::npos) << outcome.complaint;
  EXPECT_NE(outcome.complaint.find("rendering 40 × 30 pixels, 1000000 samples each …\n"), std::string::npos)
      << outcome.complaint;
  EXPECT_EQ(run({"info", "ball.png"})["width"], 40);
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
