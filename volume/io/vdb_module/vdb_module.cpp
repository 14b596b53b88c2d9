// pith-vdb.so: the only file that sees OpenVDB.
#include "vdb_module.h"

#include <cstdio>
#include <exception>
#include <ios>
#include <new>
#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>
#include <sstream>
#include <string>

using namespace pith::vdb_module;

struct pith::vdb_module::Grids {
  Volume about;
  std::string color_name;
  openvdb::FloatGrid::Ptr density;
  openvdb::Vec3SGrid::Ptr color;
  std::string file; ///< once encoded
};

namespace {

void add(Grids& grids, const Leaf& leaf) {
  const openvdb::Coord origin(leaf.origin[0], leaf.origin[1], leaf.origin[2]);
  auto density = std::make_unique<openvdb::FloatTree::LeafNodeType>(origin, 0.0f, false);
  auto color = std::make_unique<openvdb::Vec3STree::LeafNodeType>(origin, openvdb::Vec3s(0), false);
  for (openvdb::Index n = 0; n < 512; ++n) {
    if (!(leaf.active[n / 64] >> (n % 64) & 1)) continue;
    density->setValueOn(n, grids.about.density);
    color->setValueOn(n, openvdb::Vec3s(leaf.color[n]));
  }
  grids.density->tree().addLeaf(density.release());
  grids.color->tree().addLeaf(color.release());
}

/// What OpenVDB's own File writes, offsets of the grids included, but into memory.
struct MemoryFile : openvdb::io::Archive {
  using Archive::write;
  Ptr copy() const override { return std::make_shared<MemoryFile>(*this); }
};

void encode(Grids& grids) {
  openvdb::tools::prune(grids.density->tree());
  std::ostringstream file(std::ios::binary);
  const openvdb::GridCPtrVec all = {grids.density, grids.color};
  MemoryFile().write(file, all, /*seekable=*/true);
  if (!file) throw std::bad_alloc();
  grids.file = std::move(file).str();
}

} // namespace

#define PITH_EXPORT extern "C" __attribute__((visibility("default")))

PITH_EXPORT Grids* pith_vdb_begin_1(const Volume* volume) {
  try {
    openvdb::initialize();
    auto grids = std::make_unique<Grids>();
    grids->about = *volume;
    grids->color_name = volume->color_name;
    grids->density = openvdb::FloatGrid::create(0.0f);
    grids->color = openvdb::Vec3SGrid::create(openvdb::Vec3s(0));
    grids->density->setName("density");
    grids->color->setName(grids->color_name);
    grids->color->setVectorType(openvdb::VEC_INVARIANT);
    for (openvdb::GridBase* grid : {static_cast<openvdb::GridBase*>(grids->density.get()),
                                    static_cast<openvdb::GridBase*>(grids->color.get())}) {
      grid->setGridClass(openvdb::GRID_FOG_VOLUME);
      grid->setTransform(openvdb::math::Transform::createLinearTransform(volume->voxel));
      grid->setCreator("pith");
    }
    return grids.release();
  } catch (const std::exception&) {
    return nullptr;
  }
}

PITH_EXPORT int pith_vdb_add_1(Grids* grids, const Leaf* leaf, std::uint64_t count) {
  try {
    for (std::uint64_t i = 0; i < count; ++i) add(*grids, leaf[i]);
    return 0;
  } catch (const std::exception&) {
    return 1;
  }
}

PITH_EXPORT int pith_vdb_encode_2(Grids* grids, char** bytes, std::uint64_t* count, char* message) {
  try {
    encode(*grids);
    *bytes = grids->file.data();
    *count = grids->file.size();
    return 0;
  } catch (const std::exception& problem) {
    const std::string text = problem.what();
    std::snprintf(message, 512, "%s", text.substr(0, text.find('\n')).c_str());
    return 1;
  }
}

PITH_EXPORT void pith_vdb_end_1(Grids* grids) { delete grids; }
