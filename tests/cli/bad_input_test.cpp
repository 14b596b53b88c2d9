// Whatever is handed in: exit code 1, one line that says what is wrong, and no file left behind.
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"
#include "tests/support/tri_shapes.h"
#include "volume/io/mesh_io.h"

#include <gtest/gtest.h>

namespace pith {
namespace {

using testing::Outcome;
using testing::Program;
using testing::write_text;

class BadInput : public ::testing::Test {
protected:
  /// The command fails as it should, naming `what`, and the folder is as it was.
  void expect_refused(std::vector<std::string> command, const std::string& what) {
    command.push_back("--quiet"); // on a slow machine progress takes lines of its own
    const auto before = program.files();
    const Outcome outcome = program.run(command);
    EXPECT_EQ(outcome.code, 1) << outcome.complaint << outcome.output;
    EXPECT_EQ(outcome.complaint_lines(), 1u) << outcome.complaint;
    EXPECT_EQ(outcome.complaint.find("pith: "), 0u) << outcome.complaint;
    EXPECT_NE(outcome.complaint.find(what), std::string::npos) << "'" << what << "' is not in: " << outcome.complaint;
    EXPECT_EQ(outcome.output, "");
    EXPECT_EQ(program.files(), before);
  }

  void write_recipe(const std::string& surface, const std::string& more = "") {
    write_text(program.folder / "r.json", R"({"pith": 1, "surface": {"file": ")" + surface + "\"}" + more + "}");
  }

  void expect_surface_refused(const std::string& surface, const std::string& what, const std::string& more = "") {
    write_recipe(surface, more);
    expect_refused({"make", "r.json", "-o", "out.pith"}, what);
  }

  /// Made all the same (by the fall-back), or refused cleanly.
  void expect_made_or_refused(const std::string& surface) {
    write_recipe(surface);
    const auto before = program.files();
    const Outcome outcome = program.run({"make", "r.json", "-o", "out.pith", "--quiet"});
    if (outcome.code == 0) {
      EXPECT_EQ(outcome.complaint, "");
      const Outcome check = program.run({"check", "out.pith", "--points", "1000"});
      EXPECT_EQ(check.code, 0) << check.complaint << check.output;
      std::filesystem::remove(program.folder / "out.pith");
    } else {
      EXPECT_EQ(outcome.code, 1);
      EXPECT_EQ(outcome.complaint_lines(), 1u) << outcome.complaint;
    }
    EXPECT_EQ(program.files(), before);
  }

  void write_ball(const std::string& name) { write_tri_mesh(program.folder / name, testing::sphere_surface(2, 20)); }

  Program program;
};

TEST_F(BadInput, SurfacesThatAreNone) {
  expect_surface_refused("gone.obj", "r.json: /surface/file: \"gone.obj\" does not exist");
  write_text(program.folder / "empty.obj", "");
  expect_surface_refused("empty.obj", "empty.obj");
  write_text(program.folder / "noise.ply", std::string(1000, '\7'));
  expect_surface_refused("noise.ply", "noise.ply");
  write_text(program.folder / "kind.xyz", "0 0 0");
  expect_surface_refused("kind.xyz", "kind.xyz");
  std::filesystem::create_directory(program.folder / "folder.obj");
  expect_surface_refused("folder.obj", "is not a file");
  write_ball("ball.off");
  const std::string whole = testing::content_of(program.folder / "ball.off");
  write_text(program.folder / "short.off", whole.substr(0, whole.size() / 2));
  expect_surface_refused("short.off", "short.off");
  write_text(program.folder / "nan.obj",
             "v 0 0 0\nv 1 0 nan\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  expect_surface_refused("nan.obj", "nan.obj");
  write_text(program.folder / "index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  expect_surface_refused("index.obj", "index.obj");
}

TEST_F(BadInput, SurfacesWithoutVolume) {
  write_text(program.folder / "flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\nf 1 3 2\nf 2 3 4\n");
  expect_surface_refused("flat.obj", "flat.obj");
  write_text(program.folder / "point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  expect_surface_refused("point.obj", "point.obj");
}

TEST_F(BadInput, DirtySurfacesAreMadeOrRefused) {
  const TriMesh ball = testing::sphere_surface(2, 20);
  TriMesh open = ball;
  open.corner.pop_back();
  write_tri_mesh(program.folder / "open.obj", open);
  expect_made_or_refused("open.obj");
  write_tri_mesh(program.folder / "inside_out.obj", testing::inside_out(ball));
  expect_made_or_refused("inside_out.obj");
  write_tri_mesh(program.folder / "crossing.obj",
                 testing::together(ball, testing::sphere_surface(2, 20, Vec3d(13, 1, 2))));
  expect_made_or_refused("crossing.obj");
  TriMesh fin = ball; // an edge with three triangles
  fin.position.push_back({0, 0, 40});
  fin.corner.push_back(
      {fin.corner[TriangleId(0)][0], fin.corner[TriangleId(0)][1], VertexId(fin.vertex_count() - 1)});
  write_tri_mesh(program.folder / "fin.obj", fin);
  expect_made_or_refused("fin.obj");
  // Who insists on TetGen hears what is wrong.
  for (const char* surface : {"open.obj", "crossing.obj", "fin.obj"})
    expect_surface_refused(surface, surface, R"(, "tetrahedralize": {"method": "tetgen"})");
}

TEST_F(BadInput, RealSurfaces) {
  PITH_REQUIRE_SHARED(degenerate, "meshes/dirty_all_degenerate.off");
  expect_surface_refused(degenerate.string(), "dirty_all_degenerate.off: all of its 7 triangles are degenerate");
  for (const char* name :
       {"dirty_apple.ply", "dirty_beetle.obj", "dirty_elephant_holes.off", "dirty_shuffled_orientation.off",
        "dirty_unwelded_soup.ply", "thing88566_8parts.stl", "food_donut.obj", "bell_pepper_1k.obj"}) {
    PITH_REQUIRE_SHARED(surface, std::string("meshes/") + name);
    SCOPED_TRACE(name);
    write_recipe(surface.string());
    const Outcome outcome = program.run({"make", "r.json", "-o", "out.pith", "--no-cache"});
    EXPECT_EQ(outcome.code, 0) << outcome.complaint;
    const Outcome check = program.run({"check", "out.pith", "--points", "2000"});
    EXPECT_EQ(check.code, 0) << check.complaint << check.output;
    std::filesystem::remove(program.folder / "out.pith");
  }
}

TEST_F(BadInput, Recipes) {
  write_ball("ball.obj");
  expect_refused({"make", "gone.json", "-o", "out.pith"}, "gone.json");
  const auto refused = [&](const std::string& text, const std::string& what) {
    write_text(program.folder / "r.json", text);
    expect_refused({"make", "r.json", "-o", "out.pith"}, what);
  };
  refused("", "r.json: is empty");
  refused("{\"pith\": 1, ", "r.json: is not JSON");
  refused(R"({"pith": 1, "surfaces": {"file": "ball.obj"}})",
          "r.json: /surfaces: is not a known key; did you mean \"surface\"?");
  refused(R"({"pith": 1, "surface": {"file": 3}})", "r.json: /surface/file: is 3, must be a text");
  refused(R"({"pith": 1, "surface": {"file": "ball.obj", "scale": -1}})",
          "r.json: /surface/scale: is -1, must be positive");
  const std::string solid = R"({"pith": 1, "surface": {"file": "ball.obj"}, "solids": [{"type": "2-b",
    "depth": [{"skin": true, "value": 0}, {"stroke": [[0, 0, STROKE], [0, 0, 9]], "value": 1}],
    "orientation": [{"stroke": [[0, 0, -9], [0, 0, 9]]}], "exemplar": EXEMPLAR}]})";
  const auto with = [&](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  refused(with(with(solid, "STROKE", "-9"), "EXEMPLAR", R"({"file": "gone.exemplar"})"),
          "\"gone.exemplar\" does not exist");
  refused(with(with(solid, "STROKE", "-9"), "EXEMPLAR", R"({"procedural": "nothing"})"), "known names");
  write_text(program.folder / "foreign.exemplar", "not a zip");
  refused(with(with(solid, "STROKE", "-9"), "EXEMPLAR", R"({"file": "foreign.exemplar"})"), "foreign.exemplar");
  refused(with(with(solid, "STROKE", "-999"), "EXEMPLAR", R"({"procedural": "kiwi", "resolution": 16})"),
          "r.json: /solids/0/depth");
  refused(with(with(solid, "STROKE", "-1e200"), "EXEMPLAR", R"({"procedural": "kiwi", "resolution": 16})"),
          "/solids/0/depth/1/stroke/0/2: is -1e+200, must be between");
  refused(with(with(with(solid, R"({"skin": true, "value": 0})",
                         R"({"skin": true, "value": 0}, {"triangles": [1, 99999], "value": 0})"),
                    "STROKE", "-9"),
               "EXEMPLAR", R"({"procedural": "kiwi", "resolution": 16})"),
          "triangle 99999 is named");
  refused(with(with(solid, "STROKE", "-9"), "EXEMPLAR",
               R"({"procedural": "kiwi", "resolution": 16}, "mask": {"reach_outer": 1e-9})"),
          "mask/reach_outer");
  // A surface in metres, strokes in millimetres that miss it.
  write_tri_mesh(program.folder / "ball.obj", testing::sphere_surface(2, 0.02));
  refused(with(with(solid, "STROKE", "8"), "EXEMPLAR", R"({"procedural": "kiwi", "resolution": 16})"),
          "\"surface\": {\"scale\": 1000}");
}

TEST_F(BadInput, Models) {
  write_ball("ball.obj");
  write_recipe("ball.obj");
  ASSERT_EQ(program.run({"make", "r.json", "-o", "ball.pith"}).code, 0);
  const std::string whole = testing::content_of(program.folder / "ball.pith");
  write_text(program.folder / "short.pith", whole.substr(0, whole.size() * 2 / 3));
  write_text(program.folder / "foreign.pith", "solid something else entirely");
  write_text(program.folder / "empty.pith", "");
  std::string damaged = whole;
  damaged[damaged.size() / 3] ^= 0x10;
  write_text(program.folder / "damaged.pith", damaged);
  write_text(program.folder / "zip.pith", std::string("PK\5\6", 4) + std::string(18, '\0'));
  for (const char* model : {"gone.pith", "short.pith", "foreign.pith", "empty.pith", "zip.pith"}) {
    expect_refused({"info", model}, model);
    expect_refused({"check", model}, model);
    expect_refused({"cut", model, "--plane", "1,0,0,0", "-o", "out.pith"}, model);
    expect_refused({"export", model, "-o", "out.ply"}, model);
    expect_refused({"render", model, "-o", "out.png"}, model);
  }
  expect_refused({"cut", "damaged.pith", "--plane", "1,0,0,0", "-o", "out.pith"}, "damaged.pith");

  expect_refused({"cut", "ball.pith", "--plane", "1,0,0,99", "-o", "out.pith"}, "cut 1 of 1");
  const std::string once = program.run({"cut", "ball.pith", "--plane", "1,0,0,99", "-o", "out.pith"}).complaint;
  EXPECT_EQ(once.find("move the cut"), once.rfind("move the cut")) << once;
  EXPECT_NE(once.find("cannot be made: nothing is cut"), std::string::npos) << once;
  for (const char* name : {"a.vdb", "a.vtu", "a.glb"}) {
    write_text(program.folder / name, "anything");
    expect_refused({"info", name}, "info reads .pith");
  }
  expect_refused({"cut", "ball.pith", "--plane", "1,0,0,1", "--only", "0,0,99", "-o", "out.pith"},
                 "lies outside the solid");
  expect_refused({"cut", "ball.pith", "--plane", "1,0,0,1", "-o", "out.obj"}, "out.obj: has the extension .obj");
  expect_refused({"cut", "ball.pith", "--plane", "1,0,0,1", "-o", "no/folder/out.pith"}, "its folder does not exist");
  expect_refused({"export", "ball.pith", "-o", "out.xyz"}, "out.xyz: has the extension .xyz");
  expect_refused({"cut", "ball.pith", "--stroke", "gone.json", "-o", "out.pith"}, "gone.json");
  write_text(program.folder / "stroke.json", R"({"points": [[0, 0]], "view": {"eye": [0, 0, 90]}})");
  expect_refused({"cut", "ball.pith", "--stroke", "stroke.json", "-o", "out.pith"},
                 "stroke.json: /points: has 1 entries");
  write_text(program.folder / "points.npy", "foreign");
  expect_refused({"sample", "ball.pith", "points.npy", "-o", "out.npy"}, "points.npy");
  expect_refused({"sample", "ball.pith", "gone.npy", "-o", "out.npy"}, "gone.npy");
  write_text(program.folder / "scene.json", R"({"environment": {"file": "gone.hdr"}})");
  expect_refused({"render", "ball.pith", "-o", "out.png", "--scene", "scene.json"}, "scene.json: /environment/file");
}

TEST_F(BadInput, AFullDiskLeavesNoFile) {
  write_ball("ball.obj");
  write_recipe("ball.obj");
  ASSERT_EQ(program.run({"make", "r.json", "-o", "ball.pith"}).code, 0);
  program.most_file_bytes = 2000;
  for (const char* out : {"out.pith", "out2.pith"})
    expect_refused({"cut", "ball.pith", "--plane", "1,0,0,0", "-o", out}, "raise the limit on file sizes");
  for (const char* out : {"out.vdb", "out.ply", "out.glb", "out.vtu"})
    expect_refused({"export", "ball.pith", "-o", out}, "raise the limit on file sizes");
  for (const char* out : {"out.png", "out.jpg", "out.exr"})
    expect_refused({"render", "ball.pith", "--size", "96x96", "--spp", "1", "-o", out},
                   "raise the limit on file sizes");
}

TEST_F(BadInput, AFileNameThatIsNoTextMakesAModel) {
  write_ball("ball.obj");
  write_recipe("ball.obj");
  std::filesystem::rename(program.folder / "r.json", program.folder / "b\xff\x01.json");
  const Outcome made = program.run({"make", "b\xff\x01.json", "-o", "out.pith"});
  EXPECT_EQ(made.code, 0) << made.complaint;
  EXPECT_NE(program.run({"info", "out.pith"}).output.find("b__"), std::string::npos);
}

TEST_F(BadInput, APictureBeyondAllMemoryIsRefusedAtOnce) {
  if (double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE)) > 250e9) GTEST_SKIP() << "it would fit";
  expect_refused({"render", "gone.pith", "-o", "out.png", "--size", "32768x32768"}, "million pixels or fewer");
}

TEST_F(BadInput, WrongUsageIsTwo) {
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {},
           {"mke"},
           {"make"},
           {"make", "r.json"},
           {"info", "a", "b"},
           {"info", "--sed", "1", "a"},
           {"info", "a", "--threads", "-1"},
           {"cut", "a.pith", "-o", "b.pith"},
           {"cut", "a.pith", "--plane", "1,2,3", "-o", "b.pith"},
           {"cut", "a.pith", "--plane", "0,0,0,1", "-o", "b.pith"},
           {"cut", "a.pith", "--sphere", "0,0,0,-1", "-o", "b.pith"},
           {"cut", "a.pith", "--plane", "1,0,0,x", "-o", "b.pith"},
           {"cut", "a.pith", "--plane", "1,0,0,1", "--keep", "up", "-o", "b.pith"},
           {"cut", "a.pith", "--plane", "1,0,0,nan", "-o", "b.pith"},
           {"cut", "a.pith", "--plane", "1,0,0,1", "--keep", "left", "--spread", "3", "-o", "b.pith"},
           {"cut", "a.pith", "--plane", "1,0,0,1", "--spread", "nan", "-o", "b.pith"},
           {"cut", "a.pith", "--plane", "1,0,0,1", "-o", ""},
           {"make", "a.json", "-o", "b.pith", "--cache-gigabytes", "nan"},
           {"make", "a.json", "-o", "b.pith", "--cache", ""},
           {"make", "a.json", "-o", "b.pith", "--seed", "-1"},
           {"sample", "a.pith", "p.npy", "-o", "b.npy", "--footprint", "nan"},
           {"export", "a.pith", "-o", "b.ply", "--max-edge", "nan"},
           {"render", "a.pith", "-o", "b.png", "--exposure", "inf"},
           {"render", "a.pith", "-o", "b.png", "--time", "nan"},
           {"render", "a.pith", "-o", "b.png", "--size", "10"},
           {"render", "a.pith", "-o", "b.png", "--spp", "0"}}) {
    const Outcome outcome = program.run(command);
    std::string line;
    for (const std::string& word : command) line += " " + word;
    EXPECT_EQ(outcome.code, 2) << line << ": " << outcome.complaint;
    EXPECT_EQ(outcome.complaint_lines(), 1u) << line << ": " << outcome.complaint;
    EXPECT_EQ(outcome.output, "") << line;
    EXPECT_TRUE(program.files().empty());
  }
}

} // namespace
} // namespace pith
