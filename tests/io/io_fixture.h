#pragma once
// A model whose colours are known in closed form, and a folder that goes away.
#include "tests/support/tet_grid.h"
#include "volume/cut/cut.h"
#include "volume/io/atomic_file.h"
#include "volume/layer/model.h"

#include <Eigen/Geometry>
#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace pith::testing {

/// A fresh folder of the running test; removed at the end.
class Folder {
public:
  Folder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            (std::string("pith-") + info->test_suite_name() + "-" + info->name() + "-" + std::to_string(::getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::size_t file_count() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++count;
    return count;
  }

private:
  std::filesystem::path path_;
};

/// Files cannot grow beyond `bytes` while this lives: a stand-in for a full disk.
class FullDisk {
public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit small = before_;
    small.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

private:
  rlimit before_{};
  void (*handler_)(int);
};

/// A ball of radius 10 mm in two regions (z below and above 0) whose flesh has the colour (x, y, z) / 25 + ½, to
/// within 1/255, and whose skin, if asked for, is pure blue.
inline Model ramp_model(bool skin, int cells = 6) {
  Model model;
  model.name = "ramp";
  model.mesh = tet_ball(cells, 10);
  for (const TetId t : all_ids<TetId>(model.mesh.tet_count()))
    model.mesh.region[t] = barycenter(model.mesh, t).z() > 0 ? 1 : 0;
  model.boundary = boundary_of(model.mesh);
  for (const FacetId f : all_ids<FacetId>(model.boundary.facet_count()))
    model.boundary.input.push_back(TriangleId(f.value * 3));

  Layer flesh;
  flesh.name = "flesh";
  Exemplar ramp;
  ramp.name = "ramp";
  ramp.size = {51, 51, 51, 1};
  ramp.channel = {{.name = "color", .semantic = Semantic::color, .components = 3, .srgb = false}};
  for (int z = 0; z < 51; ++z)
    for (int y = 0; y < 51; ++y)
      for (int x = 0; x < 51; ++x)
        for (const int i : {x, y, z}) ramp.texel.push_back(static_cast<std::uint8_t>(5 * i + 2));
  flesh.exemplar.push_back(ramp);
  flesh.mask.push_back({.axes = 3, .size = {1, 1, 1}, .open = {true, true, true}, .alpha = {255}});
  flesh.patch.push_back({.exemplar = 0, .mask = 0, .frame = {}, .key = 0x1234567890abcdefull});
  for (const Vec3d& x : model.mesh.position) {
    for (int i = 0; i < 3; ++i) flesh.corner.push_back(static_cast<float>(x[i] / 25 + 0.5));
    flesh.corner.push_back(1);
  }
  flesh.begin.push_back(0);
  for (const TetId t : all_ids<TetId>(model.mesh.tet_count())) {
    const auto& c = model.mesh.corner[t];
    flesh.lookup.push_back({0, {c[0], c[1], c[2], c[3]}});
    flesh.begin.push_back(static_cast<std::uint32_t>(flesh.lookup.size()));
  }
  model.layer.push_back(std::move(flesh));
  if (!skin) return model;

  Layer blue;
  blue.name = "blue";
  blue.domain = Domain::skin;
  blue.width = 2;
  blue.blend = {.select = Blend::Select::max, .grace = 0.3f, .mix = Blend::Mix::linear, .mean_over = {true, false}, .correlation = 0.25f};
  Exemplar image;
  image.name = "blue";
  image.axes = 2;
  image.size = {2, 2, 1, 1};
  image.wrap = {Wrap::repeat, Wrap::mirror, Wrap::clamp, Wrap::clamp};
  image.channel = {{.name = "color", .semantic = Semantic::color, .components = 3, .srgb = true},
                   {.name = "height", .semantic = Semantic::height, .components = 1, .srgb = false, .high = 0.25f}};
  for (int i = 0; i < 4; ++i) image.texel.insert(image.texel.end(), {0, 0, 255, 128});
  make_gaussian_twin(image);
  blue.exemplar.push_back(image);
  blue.patch.push_back({});
  blue.corner = {0, 0, 1, 1, 0, 1, 0, 1, 1};
  blue.begin.push_back(0);
  for (const FacetId f : all_ids<FacetId>(model.boundary.facet_count())) {
    if (model.boundary.behind[f].exists()) continue; // sparse: the outer skin only
    blue.simplex.push_back(f);
    blue.lookup.push_back({0, {0, 1, 2, 0}});
    blue.begin.push_back(static_cast<std::uint32_t>(blue.lookup.size()));
  }
  model.layer.push_back(std::move(blue));
  return model;
}

inline Vec3d ramp_color(const Vec3d& x) { return x / 25 + Vec3d::Constant(0.5); }

/// The ball cut by a sphere and two planes, and its pieces moved apart.
inline Pieces cut_pieces(const Model& model) {
  Pieces pieces = whole_piece(model.mesh);
  cut(pieces, model.mesh, model.boundary, *level_set_of(PlaneCut{.normal = {1, 0.2, 0.1}, .offset = 0.3}));
  cut(pieces, model.mesh, model.boundary, *level_set_of(SphereCut{.center = {8, 1, 0}, .radius = 6}));
  cut(pieces, model.mesh, model.boundary, *level_set_of(PlaneCut{.normal = {0, 1, 0}, .offset = 0}));
  for (std::size_t p = 0; p < pieces.piece.size(); ++p) {
    pieces.piece[p].placement.rotation =
        Eigen::AngleAxisd(0.1 * double(p), Vec3d(1, 2, 3).normalized()).toRotationMatrix();
    pieces.piece[p].placement.translation = Vec3d(25.0 * double(p), 0, 1);
  }
  return pieces;
}

} // namespace pith::testing
