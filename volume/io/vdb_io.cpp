#include "volume/io/vdb_io.h"

#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/io/atomic_file.h"
#include "volume/io/module.h"
#include "volume/io/vdb_module/vdb_module.h"
#include "volume/mesh/orientation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>

namespace pith {

namespace {

using vdb_module::Leaf;

constexpr const char* module_file = "pith-vdb.so";
constexpr const char* purpose = "writing volumes";
constexpr int leaf_edge = 8;
constexpr double most_voxels = 2e9;
constexpr std::size_t batch = 2048; // leaves that are made side by side, then handed to the module in order

/// A tet of a piece, where the piece stands.
struct Voxelised {
  std::array<Vec3d, 4> corner; // rest space
  TetId root;
  std::uint32_t piece;
};

/// Leaves are numbered x slowest, as OpenVDB's voxels are; the number orders them in the file.
struct Candidate {
  std::uint64_t leaf;
  std::uint32_t tet; // ascending: pieces in order, so the lowest piece comes first
  auto operator<=>(const Candidate&) const = default;
};

using Cell = std::array<std::int64_t, 3>;

class Voxeliser {
public:
  Voxeliser(const Root& root, const Pieces& pieces, double voxel) : root_(root), pieces_(pieces), voxel_(voxel) {
    const TetMesh& mesh = root.model().mesh;
    for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
      for (const TetId t : all_ids<TetId>(mesh.tet_count()))
        if (pieces.label[t] == p) add(mesh.corner[t], t, p);
      for (const CutTet& tet : pieces.piece[p].cut) add(tet.corner, tet.root, p);
    }
  }
  const Box& bounds() const { return bounds_; }

  /// Finds which tets may reach into which leaves.
  void gather() {
    low_ = leaf_of(cell_at(bounds_.low, true));
    const Cell high = leaf_of(cell_at(bounds_.high, false));
    for (int i = 0; i < 3; ++i) leaves_[i] = std::max<std::int64_t>(1, high[i] - low_[i] + 1);

    constexpr std::size_t block = 1024;
    std::vector<std::vector<Candidate>> part((tet_.size() + block - 1) / block);
    parallel_blocks(tet_.size(), block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const auto [from, to] = cells_of(tet_[t]);
        if (from[0] > to[0] || from[1] > to[1] || from[2] > to[2]) continue; // between voxel centres
        const Cell a = leaf_of(from), b = leaf_of(to);
        for (std::int64_t x = a[0]; x <= b[0]; ++x)
          for (std::int64_t y = a[1]; y <= b[1]; ++y)
            for (std::int64_t z = a[2]; z <= b[2]; ++z)
              part[begin / block].push_back({number_of({x, y, z}), static_cast<std::uint32_t>(t)});
      }
    });
    for (auto& some : part) {
      candidate_.insert(candidate_.end(), some.begin(), some.end());
      some = {};
    }
    std::sort(candidate_.begin(), candidate_.end());
    for (std::size_t c = 0; c < candidate_.size(); ++c)
      if (c == 0 || candidate_[c].leaf != candidate_[c - 1].leaf) begin_.push_back(c);
  }
  std::size_t leaf_count() const { return begin_.size(); }

  /// The voxels of a leaf; returns how many are active.
  std::size_t fill(std::size_t number, Leaf& leaf) const {
    const std::size_t begin = begin_[number],
                      end = number + 1 < begin_.size() ? begin_[number + 1] : candidate_.size();
    std::uint64_t rest = candidate_[begin].leaf;
    Cell origin;
    for (int i = 2; i >= 0; --i) {
      origin[i] = (low_[i] + static_cast<std::int64_t>(rest % leaves_[i])) * leaf_edge;
      rest /= leaves_[i];
      leaf.origin[i] = static_cast<std::int32_t>(origin[i]);
    }
    std::memset(leaf.active, 0, sizeof(leaf.active));
    std::memset(leaf.color, 0, sizeof(leaf.color));

    const TetMesh& mesh = root_.model().mesh;
    const int component = std::max(0, root_.component_of("color"));
    std::size_t active = 0;
    for (std::size_t c = begin; c < end; ++c) {
      const Voxelised& tet = tet_[candidate_[c].tet];
      const Rigid& placement = pieces_.piece[tet.piece].placement;
      auto [from, to] = cells_of(tet);
      for (int i = 0; i < 3; ++i) {
        from[i] = std::max(from[i], origin[i]);
        to[i] = std::min(to[i], origin[i] + leaf_edge - 1);
      }
      for (std::int64_t x = from[0]; x <= to[0]; ++x)
        for (std::int64_t y = from[1]; y <= to[1]; ++y)
          for (std::int64_t z = from[2]; z <= to[2]; ++z) {
            const auto n = static_cast<std::uint32_t>((x - origin[0]) * 64 + (y - origin[1]) * 8 + (z - origin[2]));
            std::uint64_t& word = leaf.active[n / 64];
            const std::uint64_t bit = std::uint64_t(1) << (n % 64);
            if (word & bit) continue;
            const Vec3d center = placement.inverse(voxel_ * Vec3d(double(x), double(y), double(z)));
            if (!contains(tet, center)) continue;
            word |= bit;
            ++active;
            const Material material = material_at(
                root_, {.position = center, .region = mesh.region[tet.root], .facet = {}, .hint = tet.root});
            std::copy_n(material.value.begin() + component, 3, leaf.color[n]);
          }
    }
    return active;
  }

private:
  void add(const std::array<VertexId, 4>& corner, TetId root, std::uint32_t piece) {
    Voxelised& tet = tet_.emplace_back();
    for (int i = 0; i < 4; ++i) {
      tet.corner[i] = pieces_.position(root_.model().mesh, corner[i]);
      bounds_.add(pieces_.piece[piece].placement(tet.corner[i]));
    }
    tet.root = root;
    tet.piece = piece;
  }
  static bool contains(const Voxelised& tet, const Vec3d& x) {
    const auto& p = tet.corner;
    for (const auto& f : facet_corners)
      if (orientation(p[f[0]], p[f[1]], p[f[2]], x) > 0) return false; // x lies beyond that facet
    return true;
  }
  Cell cell_at(const Vec3d& world, bool up) const {
    Cell cell;
    for (int i = 0; i < 3; ++i)
      cell[i] = static_cast<std::int64_t>(up ? std::ceil(world[i] / voxel_) : std::floor(world[i] / voxel_));
    return cell;
  }
  /// Voxels whose centres lie in the box around a tet, one wider for rounding in the placement.
  std::pair<Cell, Cell> cells_of(const Voxelised& tet) const {
    Box box;
    for (const Vec3d& x : tet.corner) box.add(pieces_.piece[tet.piece].placement(x));
    const Vec3d slack = Vec3d::Constant(1e-9 * voxel_);
    return {cell_at(box.low - slack, true), cell_at(box.high + slack, false)};
  }
  static Cell leaf_of(const Cell& cell) {
    Cell leaf;
    for (int i = 0; i < 3; ++i)
      leaf[i] = cell[i] >= 0 ? cell[i] / leaf_edge : -((leaf_edge - 1 - cell[i]) / leaf_edge);
    return leaf;
  }
  std::uint64_t number_of(const Cell& leaf) const {
    const auto at = [&](int i) {
      return static_cast<std::uint64_t>(std::clamp<std::int64_t>(leaf[i] - low_[i], 0, leaves_[i] - 1));
    };
    return (at(0) * leaves_[1] + at(1)) * leaves_[2] + at(2);
  }

  const Root& root_;
  const Pieces& pieces_;
  double voxel_;
  Box bounds_;
  Cell low_{}, leaves_{1, 1, 1};
  std::vector<Voxelised> tet_;
  std::vector<Candidate> candidate_;
  std::vector<std::size_t> begin_;
};

/// OpenVDB gives each file a random identifier; here it is a hash of the rest, so that the same volume has the same
/// bytes.
void fix_identifier(std::span<char> bytes, const std::string& where) {
  constexpr std::size_t at = 21, length = 36; // magic (8), three versions (4 each), a flag (1)
  if (bytes.size() < at + length || bytes[at + 8] != '-' || bytes[at + 23] != '-')
    throw IoFailure(where, "was not encoded as this version of OpenVDB should; build or install pith again");
  std::memset(bytes.data() + at, '0', length);
  std::array<std::uint64_t, 2> hash = {1, 2};
  for (std::size_t i = 0; i < bytes.size(); i += 16) {
    std::array<std::uint64_t, 2> word{};
    std::memcpy(word.data(), bytes.data() + i, std::min<std::size_t>(16, bytes.size() - i));
    for (int k = 0; k < 2; ++k) hash[k] = mix_bits(hash[k] ^ word[k]);
  }
  char* const identifier = bytes.data() + at;
  constexpr const char* digits = "0123456789abcdef";
  int digit = 0;
  for (std::size_t i = 0; i < length; ++i) {
    if (i == 8 || i == 13 || i == 18 || i == 23) {
      identifier[i] = '-';
      continue;
    }
    identifier[i] = digits[hash[digit / 16] >> (4 * (digit % 16)) & 15];
    ++digit;
  }
}

template <class Function>
Function* function(const char* symbol) {
  return reinterpret_cast<Function*>(module_function(module_file, symbol, purpose));
}

} // namespace

VdbResult write_vdb(const std::filesystem::path& path, const Root& root, const Pieces& pieces,
                    const VdbOptions& options, const Progress& progress) {
  const std::string where = path.string();
  const auto check = [&](bool good, const char* name, double value) {
    if (!good || !std::isfinite(value))
      throw InvalidInput(where, std::string(name) + " is " + std::to_string(value), "give a positive number");
  };
  check(options.voxel >= 0, "the voxel's edge", options.voxel);
  check(options.scale > 0, "the scale", options.scale);
  check(options.density > 0, "the density", options.density);
  if (options.color_name.empty()) throw InvalidInput(where, "the colour has no name", "call it color or Cd");

  VdbResult result;
  result.voxel = options.voxel > 0 ? options.voxel : 1;
  const Box bounds = Voxeliser(root, pieces, result.voxel).bounds();
  const Vec3d extent = bounds.extent();
  if (options.voxel == 0) result.voxel = std::max(extent.maxCoeff() / 256, 1e-9);
  double voxels = 1;
  for (int i = 0; i < 3; ++i) {
    const double n = std::floor(extent[i] / result.voxel) + 1;
    voxels *= n;
    result.extent[i] = static_cast<int>(std::min(n, 2e9));
  }
  const double reach = std::max(bounds.low.cwiseAbs().maxCoeff(), bounds.high.cwiseAbs().maxCoeff());
  if (!bounds.empty() && (voxels > most_voxels || reach / result.voxel > 1e9))
    throw InvalidInput(where, "would have " + std::to_string(voxels / 1e9) + " billion voxels",
                       "give voxels larger than " + std::to_string(result.voxel) + " mm");

  AtomicFile file(path);
  const vdb_module::Volume volume = {result.voxel * options.scale, options.density, options.color_name.c_str()};
  const auto add = function<vdb_module::AddFunction>("pith_vdb_add_1");
  const auto encode = function<vdb_module::EncodeFunction>("pith_vdb_encode_2");
  const std::unique_ptr<vdb_module::Grids, vdb_module::EndFunction*> grids(
      function<vdb_module::BeginFunction>("pith_vdb_begin_1")(&volume),
      function<vdb_module::EndFunction>("pith_vdb_end_1"));
  if (!grids) throw IoFailure(where, "does not fit into memory; ask for larger voxels (--voxel)");

  Voxeliser voxeliser(root, pieces, result.voxel);
  if (!voxeliser.bounds().empty()) voxeliser.gather();
  std::vector<Leaf> leaf(std::min(batch, voxeliser.leaf_count()));
  std::vector<std::size_t> active(leaf.size());
  for (std::size_t begin = 0; begin < voxeliser.leaf_count(); begin += batch) {
    report(progress, double(begin) / double(voxeliser.leaf_count()));
    const std::size_t count = std::min(batch, voxeliser.leaf_count() - begin);
    parallel_for(count, 4, [&](std::size_t i) { active[i] = voxeliser.fill(begin + i, leaf[i]); });
    std::size_t kept = 0; // leaves that a tet's box reached but no voxel of it
    for (std::size_t i = 0; i < count; ++i) {
      result.active += active[i];
      if (active[i] == 0) continue;
      if (kept != i) leaf[kept] = leaf[i];
      ++kept;
    }
    if (add(grids.get(), leaf.data(), kept) != 0)
      throw IoFailure(where, "does not fit into memory; ask for larger voxels (--voxel)");
  }
  char message[512] = {};
  char* bytes = nullptr;
  std::uint64_t count = 0;
  if (encode(grids.get(), &bytes, &count, message) != 0)
    throw IoFailure(where, std::string("cannot be encoded (") + message + "); ask for larger voxels (--voxel)");
  fix_identifier({bytes, count}, where);
  file.write(bytes, count);
  report(progress, 1);
  file.commit();
  return result;
}

} // namespace pith
