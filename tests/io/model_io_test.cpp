#include "volume/io/model_io.h"

#include "io_fixture.h"
#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/io/zip_file.h"

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

namespace pith {
namespace {

using testing::cut_pieces;
using testing::Folder;
using testing::ramp_model;

ModelFile full_file() {
  ModelFile file;
  file.model = ramp_model(true);
  Fields& field = file.model.field;
  Random random(3);
  for (std::size_t v = 0; v < file.model.mesh.vertex_count(); ++v) field.depth.push_back(float(random.uniform()));
  for (std::size_t t = 0; t < file.model.mesh.tet_count(); ++t) {
    field.axes.push_back(Mat3d::Identity() * random.uniform(0.5, 2));
    field.axes.back()(0, 1) = random.uniform();
    field.scale.push_back(float(random.uniform(1, 9)));
    field.singular.push_back(random.below(2));
  }
  file.pieces = cut_pieces(file.model);
  file.recipe = "{\"name\": \"ramp\", \"μ\": 0.1}\n";
  file.key = {{"fill", "0123abcd"}, {"tetrahedralize", "ffff"}};
  return file;
}

template <class T, class Allocator>
void expect_same(const std::vector<T, Allocator>& a, const std::vector<T, Allocator>& b, const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0) << what;
}

void expect_same(const Exemplar& a, const Exemplar& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.axes, b.axes);
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.wrap, b.wrap);
  EXPECT_EQ(a.channel, b.channel);
  expect_same(a.texel, b.texel, "texel");
  expect_same(a.gaussian, b.gaussian, "gaussian");
  expect_same(a.inverse, b.inverse, "inverse");
}

void expect_same(const Layer& a, const Layer& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.domain, b.domain);
  EXPECT_EQ(a.region, b.region);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.blend.select, b.blend.select);
  EXPECT_EQ(a.blend.grace, b.blend.grace);
  EXPECT_EQ(a.blend.mix, b.blend.mix);
  EXPECT_EQ(a.blend.mean_over, b.blend.mean_over);
  EXPECT_EQ(a.blend.correlation, b.blend.correlation);
  EXPECT_EQ(a.evaluation.scale, b.evaluation.scale);
  EXPECT_EQ(a.evaluation.offset, b.evaluation.offset);
  ASSERT_EQ(a.exemplar.size(), b.exemplar.size());
  for (std::size_t i = 0; i < a.exemplar.size(); ++i) expect_same(a.exemplar[i], b.exemplar[i]);
  ASSERT_EQ(a.mask.size(), b.mask.size());
  for (std::size_t i = 0; i < a.mask.size(); ++i) {
    EXPECT_EQ(a.mask[i].axes, b.mask[i].axes);
    EXPECT_EQ(a.mask[i].size, b.mask[i].size);
    EXPECT_EQ(a.mask[i].open, b.mask[i].open);
    EXPECT_EQ(a.mask[i].alpha, b.mask[i].alpha);
  }
  ASSERT_EQ(a.patch.size(), b.patch.size());
  for (std::size_t i = 0; i < a.patch.size(); ++i) {
    EXPECT_EQ(a.patch[i].exemplar, b.patch[i].exemplar);
    EXPECT_EQ(a.patch[i].mask, b.patch[i].mask);
    EXPECT_EQ(a.patch[i].frame.scale, b.patch[i].frame.scale);
    EXPECT_EQ(a.patch[i].frame.offset, b.patch[i].frame.offset);
    EXPECT_EQ(a.patch[i].key, b.patch[i].key);
  }
  expect_same(a.corner, b.corner, "corner");
  expect_same(a.begin, b.begin, "begin");
  expect_same(a.simplex, b.simplex, "simplex");
  expect_same(a.lookup, b.lookup, "lookup");
}

TEST(ModelFile, ComesBackBitForBit) {
  const Folder folder;
  ModelFile file = full_file();
  file.model.layer[0].evaluation = {{1, 0.1f, 2, -3}, {0.3f, 1e-7f, 0, 0}};
  file.model.layer[0].patch[0].frame = {{0.7f, 0.1f, 2, 1}, {0.3f, 1e-7f, 0, 0}};
  file.model.layer[0].region = 1;
  write_model(folder / "a.pith", file);
  const ModelFile back = read_model(folder / "a.pith");

  EXPECT_EQ(back.recipe, file.recipe);
  EXPECT_EQ(back.key, file.key);
  EXPECT_EQ(back.model.name, file.model.name);
  expect_same<Vec3d>(back.model.mesh.position, file.model.mesh.position, "position");
  expect_same<std::array<VertexId, 4>>(back.model.mesh.corner, file.model.mesh.corner, "corner");
  expect_same<std::array<TetId, 4>>(back.model.mesh.neighbor, file.model.mesh.neighbor, "neighbor");
  expect_same<std::int32_t>(back.model.mesh.region, file.model.mesh.region, "region");
  expect_same<TetId>(back.model.boundary.tet, file.model.boundary.tet, "boundary tet");
  expect_same<std::array<VertexId, 3>>(back.model.boundary.corner, file.model.boundary.corner, "boundary corner");
  expect_same<TetId>(back.model.boundary.behind, file.model.boundary.behind, "behind");
  expect_same<TriangleId>(back.model.boundary.input, file.model.boundary.input, "input");
  expect_same<float>(back.model.field.depth, file.model.field.depth, "depth");
  expect_same<Mat3d>(back.model.field.axes, file.model.field.axes, "axes");
  expect_same<float>(back.model.field.scale, file.model.field.scale, "scale");
  expect_same<std::uint8_t>(back.model.field.singular, file.model.field.singular, "singular");
  ASSERT_EQ(back.model.layer.size(), 2u);
  for (int i = 0; i < 2; ++i) expect_same(back.model.layer[i], file.model.layer[i]);

  EXPECT_EQ(back.pieces.root_vertex_count, file.pieces.root_vertex_count);
  EXPECT_EQ(back.pieces.cut_count, file.pieces.cut_count);
  expect_same<std::uint32_t>(back.pieces.label, file.pieces.label, "label");
  expect_same(back.pieces.added, file.pieces.added, "added");
  expect_same(back.pieces.added_position, file.pieces.added_position, "added position");
  expect_same(back.pieces.added_normal, file.pieces.added_normal, "added normal");
  expect_same(back.pieces.on_section, file.pieces.on_section, "on section");
  ASSERT_EQ(back.pieces.piece.size(), file.pieces.piece.size());
  ASSERT_GE(back.pieces.piece.size(), 4u);
  for (std::size_t p = 0; p < file.pieces.piece.size(); ++p) {
    expect_same(back.pieces.piece[p].cut, file.pieces.piece[p].cut, "cut tets");
    EXPECT_EQ(back.pieces.piece[p].placement.rotation, file.pieces.piece[p].placement.rotation);
    EXPECT_EQ(back.pieces.piece[p].placement.translation, file.pieces.piece[p].placement.translation);
  }

  write_model(folder / "b.pith", back);
  EXPECT_EQ(file_content(folder / "a.pith"), file_content(folder / "b.pith"));
  EXPECT_EQ(folder.file_count(), 2u);
}

TEST(ModelFile, SharedExemplarsAreStoredOnce) {
  const Folder folder;
  ModelFile file = full_file();
  write_model(folder / "one.pith", file);
  file.model.layer.push_back(file.model.layer[0]);
  file.model.layer.back().exemplar[0].name = "ramp"; // the same in all respects
  write_model(folder / "two.pith", file);
  const std::size_t grown =
      std::filesystem::file_size(folder / "two.pith") - std::filesystem::file_size(folder / "one.pith");
  EXPECT_LT(grown, file.model.layer[0].exemplar[0].texel.size());
  EXPECT_EQ(read_model(folder / "two.pith").model.layer[2].exemplar[0].texel, file.model.layer[0].exemplar[0].texel);
}

TEST(ModelFile, SummaryTellsWhatIsInIt) {
  const Folder folder;
  const ModelFile file = full_file();
  write_model(folder / "a.pith", file);
  const ModelSummary summary = read_model_summary(folder / "a.pith");
  EXPECT_EQ(summary.version, model_format_version);
  EXPECT_EQ(summary.name, "ramp");
  EXPECT_EQ(summary.recipe, file.recipe);
  EXPECT_EQ(summary.key, file.key);
  EXPECT_EQ(summary.file_bytes, std::filesystem::file_size(folder / "a.pith"));
  EXPECT_EQ(summary.vertices, file.model.mesh.vertex_count());
  EXPECT_EQ(summary.tets, file.model.mesh.tet_count());
  EXPECT_EQ(summary.facets, file.model.boundary.facet_count());
  EXPECT_EQ(summary.regions, 2u);
  EXPECT_EQ(summary.cuts, 3u);
  EXPECT_EQ(summary.patches, 2u);
  EXPECT_EQ(summary.lookups, file.model.layer[0].lookup.size() + file.model.layer[1].lookup.size());
  EXPECT_EQ(summary.bounds.high, bounds_of(file.model.mesh).high);
  ASSERT_EQ(summary.layer.size(), 2u);
  EXPECT_EQ(summary.layer[0].blend, "over");
  EXPECT_EQ(summary.layer[1].blend, "max linear");
  EXPECT_EQ(summary.layer[1].domain, "skin");
  EXPECT_EQ(summary.layer[0].exemplars, std::vector<std::string>{"ramp 51×51×51"});
  EXPECT_EQ(summary.layer[1].channels, (std::vector<std::string>{"color", "height"}));
  ASSERT_EQ(summary.piece.size(), file.pieces.piece.size());
  double volume = 0;
  for (std::uint32_t p = 0; p < summary.piece.size(); ++p) {
    const PieceMeasure known = measure(file.pieces, p, file.model.mesh);
    EXPECT_NEAR(summary.piece[p].volume, known.volume, 1e-9 * known.volume);
    EXPECT_EQ(summary.piece[p].whole_tets, known.whole_tets);
    EXPECT_EQ(summary.piece[p].cut_tets, known.cut_tets);
    EXPECT_EQ(summary.piece[p].moved, true);
    volume += summary.piece[p].volume;
  }
  double whole = 0;
  for (const TetId t : all_ids<TetId>(file.model.mesh.tet_count())) whole += signed_volume(file.model.mesh, t);
  EXPECT_NEAR(volume, whole, 1e-9 * whole);
}

TEST(ModelFile, AModelThatIsNotValidIsNotWritten) {
  const Folder folder;
  ModelFile file = full_file();
  file.model.layer[0].lookup[5].corner[2] = 1000000;
  EXPECT_THROW(write_model(folder / "a.pith", file), InvalidInput);
  file = full_file();
  file.pieces.label[TetId(0)] = 77;
  EXPECT_THROW(write_model(folder / "a.pith", file), InvalidInput);
  EXPECT_EQ(folder.file_count(), 0u);
}

/// The message of the InvalidInput that reading throws, checked to be one line that names the file.
std::string refusal(const std::filesystem::path& path) {
  try {
    read_model(path);
  } catch (const InvalidInput& problem) {
    const std::string message = problem.what();
    EXPECT_EQ(message.find(path.string()), 0u) << message;
    EXPECT_EQ(message.find('\n'), message.npos) << message;
    return message;
  }
  ADD_FAILURE() << path << " was accepted";
  return {};
}

void expect_says(const std::filesystem::path& path, const std::string& words) {
  const std::string message = refusal(path);
  EXPECT_NE(message.find(words), message.npos) << message;
}

TEST(ModelFile, ForeignFilesAreRefused) {
  const Folder folder;
  EXPECT_THROW(read_model(folder / "missing.pith"), IoFailure);
  EXPECT_THROW(read_model(std::filesystem::temp_directory_path()), IoFailure);
  write_file(folder / "empty.pith", "");
  expect_says(folder / "empty.pith", "empty");
  write_file(folder / "text.pith", std::string(5000, 'v'));
  expect_says(folder / "text.pith", "not a .pith file");
  ZipWriter other;
  other.add_text("mimetype", "application/epub+zip");
  other.write(folder / "book.pith");
  expect_says(folder / "book.pith", "no model.json");
  EXPECT_THROW(read_model_summary(folder / "text.pith"), InvalidInput);
  EXPECT_THROW(read_model_summary(folder / "book.pith"), InvalidInput);
}

/// Copies a .pith file with one change: to model.json, or to one array (its bytes), or without one part.
void copy_with(const std::filesystem::path& from, const std::filesystem::path& to,
               const std::function<void(nlohmann::json&)>& change, const std::string& part = {},
               const std::function<bool(NpyArray&)>& change_array = {}) {
  const ZipReader source(from, ".pith file", "");
  nlohmann::json description = nlohmann::json::parse(source.text("model.json"));
  if (change) change(description);
  std::deque<NpyArray> keep;
  ZipWriter zip;
  zip.add_text("model.json", description.dump());
  zip.add_text("recipe.json", source.text("recipe.json"));
  std::vector<std::string> names = {"mesh/position", "mesh/corner", "mesh/region",    "boundary/input", "field/depth",
                                    "field/axes",    "field/scale", "field/singular", "exemplar/0",     "exemplar/1",
                                    "gaussian/1",    "inverse/1",   "mask/0"};
  for (const char* folder : {"layer/0/", "layer/1/"})
    for (const char* name : {"corner", "begin", "lookup", "patch", "frame", "key"})
      names.push_back(std::string(folder) + name);
  names.push_back("layer/1/simplex");
  for (const char* name : {"label", "cut_begin", "cut_corner", "cut_root", "cut_face", "placement", "edge",
                           "position", "normal", "section", "section_normal"})
    names.push_back(std::string("pieces/") + name);
  for (const std::string& name : names) {
    NpyArray& array = keep.emplace_back(npy_from_bytes(source.text(name + ".npy"), name));
    if (name == part && change_array && !change_array(array)) continue;
    const auto add = [&]<class T>(T) {
      zip.add_array<T>(name, {reinterpret_cast<const T*>(array.data.data()), array.data.size() / sizeof(T)},
                       array.shape);
    };
    switch (array.type) {
    case NpyType::f4:
      add(float());
      break;
    case NpyType::f8:
      add(double());
      break;
    case NpyType::u1:
      add(std::uint8_t());
      break;
    case NpyType::u4:
      add(std::uint32_t());
      break;
    case NpyType::u8:
      add(std::uint64_t());
      break;
    case NpyType::i4:
      add(std::int32_t());
      break;
    case NpyType::i8:
      add(std::int64_t());
      break;
    }
  }
  zip.write(to);
}

template <class T>
void put(NpyArray& array, std::size_t at, T value) {
  std::memcpy(array.data.data() + at * sizeof(T), &value, sizeof(T));
}

TEST(ModelFile, WhatDoesNotFitTogetherIsRefused) {
  const Folder folder;
  const auto good = folder / "good.pith", bad = folder / "bad.pith";
  write_model(good, full_file());
  copy_with(good, bad, {});
  read_model(bad); // the copy itself is sound

  using nlohmann::json;
  const auto refuses_json = [&](const std::function<void(json&)>& change, const std::string& words) {
    copy_with(good, bad, change);
    expect_says(bad, words);
  };
  refuses_json([](json& d) { d["version"] = 2; }, "format 2");
  refuses_json([](json& d) { d["version"] = "1"; }, "version");
  refuses_json([](json& d) { d["format"] = "something else"; }, "not a pith model");
  refuses_json([](json& d) { d.erase("layers"); }, "layers");
  refuses_json([](json& d) { d["layers"] = 7; }, "layers");
  refuses_json([](json& d) { d["layers"][0]["width"] = 7; }, "width");
  refuses_json([](json& d) { d["layers"][0]["width"] = 2; }, "layer/0/corner");
  refuses_json([](json& d) { d["layers"][0]["exemplars"] = {5}; }, "exemplars");
  refuses_json([](json& d) { d["layers"][0]["exemplars"] = {1}; }, "does not fit");
  refuses_json([](json& d) { d["layers"][0]["exemplars"] = {-1}; }, "exemplars");
  refuses_json([](json& d) { d["layers"][0]["domain"] = "hair"; }, "domain");
  refuses_json([](json& d) { d["layers"][0]["blend"] = nullptr; }, "select");
  refuses_json([](json& d) { d["exemplars"][0]["size"] = {51, 51, 50, 1}; }, "exemplar/0");
  refuses_json([](json& d) { d["exemplars"][0]["channels"][0]["components"] = 300; }, "components");
  refuses_json([](json& d) { d["masks"][0]["size"] = {0, 1, 1}; }, "size");
  refuses_json([](json& d) { d["counts"]["cuts"] = 0; }, "does not fit");
  refuses_json([](json& d) { d["stages"] = {1, 2}; }, "");

  const auto refuses = [&](const std::string& part, const std::function<bool(NpyArray&)>& change,
                           const std::string& words) {
    copy_with(good, bad, {}, part, change);
    expect_says(bad, words);
  };
  refuses(
      "mesh/position", [](NpyArray& a) { return put(a, 4, std::nan("")), true; }, "finite");
  refuses(
      "mesh/corner", [](NpyArray& a) { return put(a, 9, 0xfffffff0u), true; }, "names vertex");
  refuses(
      "mesh/region", [](NpyArray&) { return false; }, "without its part mesh/region.npy");
  refuses(
      "layer/0/lookup", [](NpyArray& a) { return put(a, 7, 0x7fffffffu), true; }, "does not fit");
  refuses(
      "layer/0/begin", [](NpyArray& a) { return put(a, 7, 0u), true; }, "does not fit");
  refuses(
      "layer/0/patch", [](NpyArray& a) { return put(a, 0, 3u), true; }, "does not fit");
  refuses(
      "layer/1/simplex", [](NpyArray& a) { return put(a, 0, 9999999u), true; }, "does not fit");
  refuses(
      "pieces/label", [](NpyArray& a) { return put(a, 0, 9u), true; }, "does not fit");
  refuses(
      "pieces/cut_corner", [](NpyArray& a) { return put(a, 0, 0x7fffffffu), true; }, "does not fit");
  refuses(
      "pieces/cut_root", [](NpyArray& a) { return put(a, 0, 0x7fffffffu), true; }, "does not fit");
  refuses(
      "pieces/cut_face", [](NpyArray& a) { return put(a, 0, 0x7ffffff0), true; }, "does not fit");
  refuses(
      "pieces/cut_begin", [](NpyArray& a) { return put(a, 1, 0x7ffffff0u), true; }, "length");
  refuses(
      "pieces/placement", [](NpyArray& a) { return put(a, 0, 5.0), true; }, "does not fit");
  refuses(
      "pieces/section_normal", [](NpyArray& a) { return a.shape[0]--, a.data.resize(a.data.size() - 12), true; },
      "section_normal");
  refuses(
      "field/depth", [](NpyArray& a) { return a.shape[0]--, a.data.resize(a.data.size() - 4), true; },
      "does not fit");
}

TEST(ModelFile, TruncatedAnywhereIsRefused) {
  const Folder folder;
  ModelFile file = full_file();
  write_model(folder / "good.pith", file);
  const std::string good = file_content(folder / "good.pith");
  for (std::size_t length = 0; length < good.size(); length += 1024) {
    write_file(folder / "bad.pith", std::string_view(good).substr(0, length));
    refusal(folder / "bad.pith");
    EXPECT_THROW(read_model_summary(folder / "bad.pith"), InvalidInput);
  }
  write_file(folder / "bad.pith", std::string_view(good).substr(0, good.size() - 1));
  refusal(folder / "bad.pith");
}

TEST(ModelFile, DamagedBytesNeverGiveAnotherModel) {
  const Folder folder;
  const ModelFile file = full_file();
  write_model(folder / "good.pith", file);
  const std::string good = file_content(folder / "good.pith");
  Random random(11);
  int refused = 0;
  constexpr int rounds = 600;
  for (int round = 0; round < rounds; ++round) {
    std::string bad = good;
    // Half of them in the directory at the end and the small parts at the beginning, where most can go wrong.
    const std::size_t tail = 8000, size = bad.size();
    const std::size_t at = round % 2 == 0   ? random.below(static_cast<std::uint32_t>(size))
                           : round % 4 == 1 ? size - 1 - random.below(tail)
                                            : random.below(tail);
    bad[at] = static_cast<char>(bad[at] ^ (1 << random.below(8)));
    write_file(folder / "bad.pith", bad);
    try {
      const ModelFile back = read_model(folder / "bad.pith");
      // Only a byte that means nothing (a time stamp in the directory, say) may pass.
      write_model(folder / "again.pith", back);
      EXPECT_EQ(file_content(folder / "again.pith"), good) << "byte " << at;
    } catch (const InvalidInput& problem) {
      EXPECT_EQ(std::string(problem.what()).find('\n'), std::string::npos);
      ++refused;
    }
    try {
      read_model_summary(folder / "bad.pith");
    } catch (const InvalidInput&) {
    }
  }
  EXPECT_GT(refused, rounds * 3 / 4);
}

} // namespace
} // namespace pith
