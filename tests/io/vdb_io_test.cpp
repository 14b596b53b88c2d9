#include "volume/cut/arrange.h"
#include "volume/io/vdb_io.h"

#include "io_fixture.h"
#include "volume/base/error.h"

#include <cmath>

namespace pith {
namespace {

using testing::cut_pieces;
using testing::Folder;
using testing::ramp_model;

TEST(VdbFile, ActiveVoxelsFillTheVolumeOfThePieces) {
  const Folder folder;
  const Root root(ramp_model(false));
  const Pieces whole = whole_piece(root.model().mesh), cut = cut_pieces(root.model());
  double volume = 0;
  for (const TetId t : all_ids<TetId>(root.model().mesh.tet_count())) volume += signed_volume(root.model().mesh, t);
  for (const double voxel : {1.0, 0.31}) {
    const VdbResult one = write_vdb(folder / "a.vdb", root, whole, {.voxel = voxel});
    const double voxels = volume / std::pow(voxel, 3);
    EXPECT_NEAR(double(one.active), voxels, 0.02 * voxels);
    EXPECT_EQ(one.voxel, voxel);
    const VdbResult many = write_vdb(folder / "b.vdb", root, cut, {.voxel = voxel});
    EXPECT_NEAR(double(many.active), voxels, 0.02 * voxels);
  }
}

TEST(VdbFile, FullDiskIsAnErrorAndLeavesNothing) {
  const Folder folder;
  const Root root(ramp_model(false));
  const testing::FullDisk full(4096);
  EXPECT_THROW(write_vdb(folder / "a.vdb", root, whole_piece(root.model().mesh), {.voxel = 0.5}), IoFailure);
  EXPECT_EQ(folder.file_count(), 0u);
}

TEST(VdbFile, TheVoxelFollowsTheLongestExtentUnlessItIsGiven) {
  const Folder folder;
  const Root root(ramp_model(false));
  const TetMesh& mesh = root.model().mesh;
  Pieces plate = whole_piece(mesh);
  cut(plate, mesh, root.model().boundary, *level_set_of(PlaneCut{.normal = {0, 1, 0}, .offset = 0.2}));
  cut(plate, mesh, root.model().boundary, *level_set_of(PlaneCut{.normal = {0, -1, 0}, .offset = 0.2}));
  for (std::uint32_t p = 0; p < plate.piece.size(); ++p)
    if (const Box box = measure(plate, p, mesh).bounds; box.extent().y() < 1) {
      keep_pieces(plate, mesh, std::span(&p, 1));
      break;
    }
  ASSERT_EQ(plate.piece.size(), 1u);
  const VdbResult result = write_vdb(folder / "a.vdb", root, plate);
  EXPECT_NEAR(result.voxel, 20.0 / 256, 1e-3);
  EXPECT_GE(result.extent[0], 256);
}

TEST(VdbFile, PiecesInPlaceAddUpToTheWhole) {
  const Folder folder;
  const Root root(ramp_model(false));
  const Pieces whole = whole_piece(root.model().mesh);
  Pieces halves = whole;
  cut(halves, root.model().mesh, root.model().boundary, *level_set_of(PlaneCut{.normal = {1, 2, 3}, .offset = 1}));
  ASSERT_EQ(halves.piece.size(), 2u);
  const auto active = [&](const Pieces& pieces) {
    return write_vdb(folder / "a.vdb", root, pieces, {.voxel = 0.37}).active;
  };
  EXPECT_EQ(active(halves), active(whole));
}

TEST(VdbFile, SameBytesForAnyNumberOfThreads) {
  const Folder folder;
  const Root root(ramp_model(true));
  const Pieces pieces = cut_pieces(root.model());
  {
    const ThreadLimit one(1);
    write_vdb(folder / "a.vdb", root, pieces, {.voxel = 0.5});
  }
  write_vdb(folder / "b.vdb", root, pieces, {.voxel = 0.5});
  const std::string a = file_content(folder / "a.vdb");
  EXPECT_EQ(a, file_content(folder / "b.vdb"));
  write_vdb(folder / "b.vdb", root, pieces, {.voxel = 0.5, .color_name = "Cd"});
  EXPECT_NE(a, file_content(folder / "b.vdb"));
  EXPECT_EQ(folder.file_count(), 2u);
}

TEST(VdbFile, OptionsOutOfRangeAreRefused) {
  const Folder folder;
  const Root root(ramp_model(false, 2));
  const Pieces pieces = whole_piece(root.model().mesh);
  EXPECT_THROW(write_vdb(folder / "a.vdb", root, pieces, {.voxel = -1}), InvalidInput);
  EXPECT_THROW(write_vdb(folder / "a.vdb", root, pieces, {.voxel = std::nan("")}), InvalidInput);
  EXPECT_THROW(write_vdb(folder / "a.vdb", root, pieces, {.voxel = 0.001}), InvalidInput);
  EXPECT_THROW(write_vdb(folder / "a.vdb", root, pieces, {.scale = 0}), InvalidInput);
  EXPECT_THROW(write_vdb(folder / "a.vdb", root, pieces, {.voxel = 1}, [](double) { return false; }), Cancelled);
  EXPECT_EQ(folder.file_count(), 0u);
}

} // namespace
} // namespace pith
