#include "bench/fixtures.h"

#include "recipe/recipe.h"
#include "volume/base/random.h"

namespace pith::bench {

BuiltRecipe built_recipe(const Settings& settings, const std::string& name,
                         const std::function<void(Recipe&)>& edit) {
  const std::filesystem::path path = settings.source / "data/recipes" / name;
  if (!std::filesystem::exists(path)) throw Skipped("there is no data/recipes/" + name);
  BuiltRecipe built;
  built.recipe = read_recipe(path);
  if (edit) edit(built.recipe);
  Recipe uncut = built.recipe;
  uncut.cuts.clear();
  uncut.moves.clear();
  uncut.tetrahedralize.helper = settings.programs / "pith-tetgen";
  built.result = Builder().build(uncut, path.parent_path());
  return built;
}

TetMesh jittered_cube(int cells) {
  TetMesh mesh;
  const int side = cells + 1;
  const auto vertex = [&](int x, int y, int z) { return VertexId((z * side + y) * side + x); };
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        Random random(7, mesh.position.size());
        Vec3d p(x, y, z);
        for (int a = 0; a < 3; ++a) // border vertices stay on the border
          if (p[a] > 0 && p[a] < cells) p[a] += random.uniform(-0.1, 0.1);
        mesh.position.push_back(p);
      }
  // Each cell in six tets along its diagonal (Kuhn): one for each order of the three axes.
  static constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int z = 0; z < cells; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x)
        for (int k = 0; k < 6; ++k) {
          int at[3] = {x, y, z};
          std::array<VertexId, 4> corner;
          corner[0] = vertex(x, y, z);
          for (int i = 0; i < 3; ++i) {
            ++at[orders[k][i]];
            corner[i + 1] = vertex(at[0], at[1], at[2]);
          }
          if (k >= 3) std::swap(corner[1], corner[2]); // odd orders are mirrored
          mesh.corner.push_back(corner);
          mesh.region.push_back(0);
        }
  connect(mesh);
  return mesh;
}

Layer lattice_of_patches(const TetMesh& mesh, int cells, const Exemplar& exemplar) {
  constexpr int spacing = 6, width = 12; // cells
  Layer layer;
  layer.name = "lattice";
  layer.exemplar = {exemplar};
  SplotchOptions splotch;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    splotch.seed = seed;
    layer.mask.push_back(splotch_mask(splotch));
  }
  const int side = cells + 1, patches = cells / spacing + 2; // patch p covers cells [(p − 1) · spacing, + width)
  const auto low = [&](int p) { return (p - 1) * spacing; };

  // A table of corners for each patch, over the vertices of the cells that it covers.
  struct Block {
    int begin[3], count[3];
    std::uint32_t first_row;
  };
  std::vector<Block> block;
  for (int pz = 0; pz < patches; ++pz)
    for (int py = 0; py < patches; ++py)
      for (int px = 0; px < patches; ++px) {
        const int p[3] = {px, py, pz};
        Block b;
        for (int a = 0; a < 3; ++a) {
          b.begin[a] = std::clamp(low(p[a]), 0, cells);
          b.count[a] = std::clamp(low(p[a]) + width, 0, cells) + 1 - b.begin[a];
        }
        b.first_row = static_cast<std::uint32_t>(layer.corner_count());
        for (int z = 0; z < b.count[2]; ++z)
          for (int y = 0; y < b.count[1]; ++y)
            for (int x = 0; x < b.count[0]; ++x) {
              const VertexId v(((b.begin[2] + z) * side + b.begin[1] + y) * side + b.begin[0] + x);
              for (int a = 0; a < 3; ++a)
                layer.corner.push_back(static_cast<float>((mesh.position[v][a] - low(p[a])) / width));
              layer.corner.push_back(1);
            }
        Patch patch;
        patch.key = hash_of(1, block.size());
        patch.mask = static_cast<std::uint32_t>(patch.key % layer.mask.size());
        layer.patch.push_back(patch);
        block.push_back(b);
      }

  layer.begin.push_back(0);
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    const int cell = static_cast<int>(t.value / 6);
    const int at[3] = {cell % cells, cell / cells % cells, cell / cells / cells};
    for (int k = 0; k < 8; ++k) {
      int p[3];
      for (int a = 0; a < 3; ++a) p[a] = at[a] / spacing + (k >> a & 1);
      Lookup lookup;
      lookup.patch = static_cast<std::uint32_t>((p[2] * patches + p[1]) * patches + p[0]);
      const Block& b = block[lookup.patch];
      for (int i = 0; i < 4; ++i) {
        const int v = static_cast<int>(mesh.corner[t][i].value);
        const int x = v % side - b.begin[0], y = v / side % side - b.begin[1], z = v / side / side - b.begin[2];
        lookup.corner[i] = b.first_row + static_cast<std::uint32_t>((z * b.count[1] + y) * b.count[0] + x);
      }
      layer.lookup.push_back(lookup);
    }
    layer.begin.push_back(static_cast<std::uint32_t>(layer.lookup.size()));
  }
  return layer;
}

} // namespace pith::bench
