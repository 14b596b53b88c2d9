#include "tests/support/shared_data.h"
#include "tests/support/tri_shapes.h"
#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/io/mesh_io.h"

#include <clocale>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pith {
namespace {

namespace fs = std::filesystem;

/// A folder of the test's own, gone with it.
class MeshFiles : public ::testing::Test {
protected:
  MeshFiles() : folder_(fs::temp_directory_path() / ("pith_mesh_io_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~MeshFiles() override { fs::remove_all(folder_); }

  fs::path file(const std::string& name, const std::string& contents) const {
    std::ofstream(folder_ / name, std::ios::binary) << contents;
    return folder_ / name;
  }
  TriMesh read(const std::string& name, const std::string& contents, double scale = 1) const {
    return read_tri_mesh(file(name, contents), scale);
  }
  /// The complaint about a file; empty when it is read without one.
  std::string complaint(const std::string& name, const std::string& contents) const {
    try {
      read(name, contents);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

std::string contents_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void expect_indices_in_range(const TriMesh& mesh) {
  ASSERT_FALSE(mesh.corner.empty());
  for (const auto& corner : mesh.corner)
    for (const VertexId v : corner) ASSERT_LT(v.value, mesh.vertex_count());
  for (const Vec3d& p : mesh.position) ASSERT_TRUE(p.allFinite());
}

constexpr const char* off_tetrahedron =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
constexpr const char* obj_tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
constexpr const char* ply_tetrahedron =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 "
    "3 2\n";
constexpr const char* stl_tetrahedron =
    "solid t\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal nan 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\nendsolid t\n";

template <class T>
void append(std::string& bytes, T value, bool big) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

/// The tetrahedron as binary PLY with properties that have to be skipped.
std::string binary_ply(bool big) {
  std::string bytes =
      std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
      "_endian 1.0\r\ncomment end_header is not here\r\nelement extra 2\r\nproperty list short ushort q\r\n"
      "element vertex 4\r\nproperty uchar red\r\nproperty double x\r\nproperty float y\r\nproperty double z\r\n"
      "element face 2\r\nproperty int flags\r\nproperty list ushort uint vertex_index\r\nend_header\r\n";
  for (const int length : {2, 0}) {
    append(bytes, std::int16_t(length), big);
    for (int i = 0; i < length; ++i) append(bytes, std::uint16_t(7), big);
  }
  const double points[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
  for (const auto& p : points) {
    append(bytes, std::uint8_t(200), big);
    append(bytes, p[0], big);
    append(bytes, float(p[1]), big);
    append(bytes, p[2], big);
  }
  for (const std::vector<std::uint32_t>& face : {std::vector<std::uint32_t>{0, 1, 2, 3}, {0, 3, 2}}) {
    append(bytes, std::int32_t(-1), big);
    append(bytes, std::uint16_t(face.size()), big);
    for (const std::uint32_t v : face) append(bytes, v, big);
  }
  return bytes;
}

TEST_F(MeshFiles, EveryFormatReadsTheSameTetrahedron) {
  for (const auto& [name, contents] : {std::pair("t.off", off_tetrahedron), std::pair("t.obj", obj_tetrahedron),
                                       std::pair("t.ply", ply_tetrahedron), std::pair("t.STL", stl_tetrahedron)}) {
    const TriMesh mesh = read(name, contents);
    EXPECT_EQ(mesh.vertex_count(), 4u) << name;
    EXPECT_EQ(mesh.triangle_count(), 4u) << name;
    EXPECT_DOUBLE_EQ(signed_volume(mesh), 1.0 / 6) << name;
    EXPECT_TRUE(surface_defects(mesh).clean()) << name;
  }
  EXPECT_DOUBLE_EQ(signed_volume(read("t.off", off_tetrahedron, 1000)), 1e9 / 6);
}

TEST_F(MeshFiles, BinaryPlyOfBothByteOrders) {
  for (const bool big : {false, true}) {
    const TriMesh mesh = read("b.ply", binary_ply(big));
    ASSERT_EQ(mesh.vertex_count(), 4u);
    ASSERT_EQ(mesh.triangle_count(), 3u); // a quad and a triangle
    EXPECT_EQ(mesh.position[VertexId(3u)], Vec3d(0, 1, 0.5));
    EXPECT_EQ(mesh.corner[TriangleId(1u)], (std::array{VertexId(0u), VertexId(2u), VertexId(3u)}));
  }
}

TEST_F(MeshFiles, PlyStripsAlternate) {
  const TriMesh mesh = read("s.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                                     "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
                                     "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 2 3 4 4\n");
  ASSERT_EQ(mesh.triangle_count(), 3u);
  for (const auto& c : mesh.corner) // all face upwards
    EXPECT_GT((mesh.position[c[1]] - mesh.position[c[0]]).cross(mesh.position[c[2]] - mesh.position[c[0]]).z(), 0);
}

TEST_F(MeshFiles, ObjWithEverythingAtOnce) {
  const TriMesh mesh =
      read("o.obj", "# a comment\r\nmtllib x.mtl\r\no thing\r\nv 0 0 0 1.0\r\nv +1 0 0 0.5 0.5 0.5\r\n"
                    "v 1 1 .0\r\nv 0 1e0 0\r\nvt 0 0\r\nvn 0 0 1\r\ng front\r\nusemtl red\r\n"
                    "f -4/1/1 -3//1 -2/1 \\\r\n -1\r\ng back\r\nf 4 3 2 \r\nusemtl blue\r\n"
                    "f 1/1/1 3/1/1 2/1/1\r\ng front\r\nusemtl red\r\nf 6 1 2\r\nl 1 2\r\n"
                    "v 0 0 1\r\nv 0 0 2");
  EXPECT_EQ(mesh.vertex_count(), 6u);
  ASSERT_EQ(mesh.triangle_count(), 5u);
  EXPECT_EQ(mesh.corner[TriangleId(1u)], (std::array{VertexId(0u), VertexId(2u), VertexId(3u)}));
  EXPECT_EQ(mesh.corner[TriangleId(4u)][0], VertexId(5u)); // a vertex that follows its face
  EXPECT_EQ(mesh.part, (PerTriangle<std::int32_t>{0, 0, 1, 2, 0}));
}

TEST_F(MeshFiles, ObjMayBeginWithAByteOrderMark) {
  const TriMesh mesh = read("b.obj", "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.vertex_count(), 3u);
}

TEST_F(MeshFiles, OffWithCountsOnTheFirstLineColoursAndPolygons) {
  const TriMesh mesh = read("c.off", "COFF 4 2 0 # counts\n\n0 0 0 255 0 0 255\n1 0 0\n# between\n1 1 0\n0 1 0\n"
                                     "4 0 1 2 3 0.5 0.5 0.5\n2 0 1\n");
  EXPECT_EQ(mesh.triangle_count(), 2u);
}

TEST_F(MeshFiles, NumbersReadAlikeInEveryLocale) {
  const char* before = std::setlocale(LC_ALL, nullptr);
  const std::string kept = before ? before : "C";
  for (const char* comma : {"de_DE.UTF-8", "fr_FR.UTF-8"})
    if (std::setlocale(LC_ALL, comma)) break;
  const TriMesh mesh = read("l.obj", "v 0.5 0 0\nv 1.5 0 0\nv 0 2.25 0\nf 1 2 3\n");
  const fs::path written = folder_ / "l.off";
  write_tri_mesh(written, mesh);
  std::setlocale(LC_ALL, kept.c_str());
  EXPECT_EQ(mesh.position[VertexId(2u)].y(), 2.25);
  EXPECT_EQ(contents_of(written).find(','), std::string::npos);
}

TEST_F(MeshFiles, WritingAndReadingBackKeepsEveryBit) {
  TriMesh mesh = testing::sphere_surface(2, 1.0 / 3, {1e-3, 12345.678901234567, -7});
  mesh.part.assign(mesh.triangle_count(), 0);
  mesh.part[TriangleId(5u)] = 1;
  for (const char* name : {"r.obj", "r.off", "r.ply"}) {
    write_tri_mesh(folder_ / name, mesh);
    const TriMesh back = read_tri_mesh(folder_ / name);
    EXPECT_EQ(back.position, mesh.position) << name;
    EXPECT_EQ(back.corner, mesh.corner) << name;
  }
  EXPECT_EQ(read_tri_mesh(folder_ / "r.obj").part, mesh.part);
  const TriMesh round = testing::box_surface({0, 0, 0}, {1, 2, 3}); // floats hold it
  write_tri_mesh(folder_ / "r.stl", round);
  EXPECT_DOUBLE_EQ(signed_volume(read_tri_mesh(folder_ / "r.stl")), 6);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 4); // nothing left beside them
}

TEST_F(MeshFiles, WritingWhereItCannotLeavesNothing) {
  EXPECT_THROW(write_tri_mesh(folder_ / "no" / "such.ply", testing::sphere_surface(0)), IoFailure);
  EXPECT_THROW(write_tri_mesh(folder_ / "x.fbx", testing::sphere_surface(0)), InvalidInput);
  fs::create_directory(folder_ / "taken.ply");
  EXPECT_THROW(write_tri_mesh(folder_ / "taken.ply", testing::sphere_surface(0)), IoFailure);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(MeshFiles, BadFilesAreRefusedInOneLine) {
  EXPECT_THROW(read_tri_mesh(folder_ / "missing.obj"), IoFailure);
  EXPECT_THROW(read_tri_mesh(folder_), InvalidInput); // no extension
  fs::create_directory(folder_ / "folder.obj");
  EXPECT_THROW(read_tri_mesh(folder_ / "folder.obj"), IoFailure);
  EXPECT_THROW(read("t.off", off_tetrahedron, 0), InvalidInput);
  EXPECT_THROW(read("t.off", off_tetrahedron, std::nan("")), InvalidInput);
  const std::tuple<const char*, std::string, const char*> cases[] = {
      {"e.obj", "", "is empty"},
      {"e.obj", "v 0 0 0\n", "no triangles"},
      {"e.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n", "line 3: a face names vertex 3 of 2"},
      {"e.obj", "v 0 0 0\nf 1 0 1\n", "line 2: a face names vertex 0"},
      {"e.obj", "v 0 0 0\nf -2 1 1\n", "names vertex -2"},
      {"e.obj", "v 0 0\nf 1 1 1\n", "line 1: there is no number where z belongs"},
      {"e.obj", "v 0 nan 0\n", "line 1: y is not finite"},
      {"e.obj", "v 0 1e999 0\n", "line 1: y is not finite"},
      {"e.obj", "v 0 0 0\nf 1 1\n", "a face has 2 corners"},
      {"e.obj", "v 0 0 0\nf 1.5 1 1\n", "line 2: there is no whole number where a corner of the face belongs"},
      {"e.obj",
       std::string("\x7f"
                   "ELF\2\1\1\0\0",
                   9),
       "holds binary data, not text"},
      {"e.obj", "v 0 0 0\nv 1e100 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 1 lies 1e+100 mm from the origin"},
      {"e.obj", "v 0 0 0\nv 1e-100 0 0\nv 0 1e-100 0\nf 1 2 3\n", "the surface is 1e-100 mm across"},
      {"e.off", "PFF\n", "does not begin with OFF"},
      {"e.off", "OFF\n4 1 0\n0 0 0\n", "ends after 1 of 4 vertices"},
      {"e.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "names vertex 3 of 3"},
      {"e.off", "OFF\n999999999999 1 0\n0 0 0\n", "can hold"},
      {"e.off", "OFF\n-1 1 0\n", "announces"},
      {"e.ply", "ply\nformat ascii 1.0\n", "ends before 'end_header'"},
      {"e.ply", "solid\n", "does not begin with 'ply'"},
      {"e.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n", "no x, y, z"},
      {"e.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "ends where 'vertex' belongs"},
      {"e.stl", std::string(100, 'x'), "it announces"},
      {"e.stl", "xx", "no STL"},
      {"e.xyz", "1 2 3\n", "no reader for '.xyz'"},
  };
  for (const auto& [name, contents, words] : cases) {
    const std::string said = complaint(name, contents);
    EXPECT_NE(said.find(words), std::string::npos) << name << ": " << said;
    EXPECT_NE(said.find(name), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

/// The same small mesh in every format and encoding.
std::vector<std::pair<std::string, std::string>> samples(const fs::path& folder) {
  std::vector<std::pair<std::string, std::string>> files = {
      {"a.off", off_tetrahedron}, {"a.obj", obj_tetrahedron},    {"a.ply", ply_tetrahedron},
      {"a.stl", stl_tetrahedron}, {"big.ply", binary_ply(true)}, {"little.ply", binary_ply(false)}};
  for (const char* name : {"w.stl", "w.ply"}) {
    write_tri_mesh(folder / name, testing::sphere_surface(0));
    files.emplace_back(name, contents_of(folder / name));
  }
  return files;
}

TEST_F(MeshFiles, EveryTruncationIsRefusedOrGivesAValidMesh) {
  for (const auto& [name, contents] : samples(folder_)) {
    std::size_t refused = 0;
    for (std::size_t length = 0; length < contents.size(); ++length) {
      try {
        expect_indices_in_range(read(name, contents.substr(0, length)));
      } catch (const InvalidInput&) {
        ++refused;
      }
    }
    // Only OBJ can be cut between two faces, and a text file in its last number or word, without that being seen.
    EXPECT_GE(refused + (name == "a.obj" ? 35 : 12), contents.size()) << name;
    EXPECT_NO_THROW(read(name, contents)) << name;
  }
}

TEST_F(MeshFiles, DamagedBytesAreRefusedOrGiveAValidMesh) {
  std::size_t refused = 0, taken = 0;
  for (const auto& [name, contents] : samples(folder_))
    for (std::uint64_t trial = 0; trial < 800; ++trial) {
      Random random(2, hash_of(name.size(), contents.size()), trial);
      std::string damaged = contents;
      for (std::uint32_t n = random.below(3) + 1; n > 0; --n) {
        char& byte = damaged[random.below(static_cast<std::uint32_t>(damaged.size()))];
        byte =
            random.below(2) ? static_cast<char>(byte ^ (1 << random.below(8))) : static_cast<char>(random.below(256));
      }
      if (random.below(8) == 0)
        damaged.insert(random.below(static_cast<std::uint32_t>(damaged.size())), 1 + random.below(9), '9');
      try {
        expect_indices_in_range(read(name, damaged));
        ++taken;
      } catch (const InvalidInput&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 500u);
  EXPECT_GT(taken, 500u);
}

TEST_F(MeshFiles, RealFilesHaveTheCountsOfTheirCatalogue) {
  const std::tuple<const char*, std::size_t, std::size_t> catalogue[] = {
      {"bunny_12k.off", 11764, 5884},        {"pepper_30k.ply", 29956, 14980}, {"spot_6k_uv.obj", 5856, 2930},
      {"thing88566_8parts.stl", 5344, 2624}, {"bell_pepper_1k.obj", 968, 486}, {"dirty_suzanne.obj", 968, 507}};
  for (const auto& [name, triangles, vertices] : catalogue) {
    PITH_REQUIRE_SHARED(path, std::string("meshes/") + name);
    const TriMesh mesh = read_tri_mesh(path);
    EXPECT_EQ(mesh.triangle_count(), triangles) << name;
    EXPECT_EQ(mesh.vertex_count(), vertices) << name;
  }
}

} // namespace
} // namespace pith
