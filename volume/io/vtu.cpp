// VTU: VTK's XML format for unstructured grids, with its arrays appended raw (VTK file formats, "XML formats").
#include "volume/io/atomic_file.h"
#include "volume/io/surface_export.h"
#include "volume/io/surface_files.h"

#include <algorithm>

namespace pith {

namespace {

constexpr std::uint8_t vtk_tetra = 10;
constexpr std::size_t block = 512;

struct Cell {
  std::array<VertexId, 4> corner;
  TetId root;
  std::uint32_t piece;
};

/// Pieces one after the other: whole tets, then cut ones.
std::vector<Cell> cells_of(const Pieces& pieces, const TetMesh& mesh) {
  std::vector<Cell> cell;
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    for (const TetId t : all_ids<TetId>(mesh.tet_count()))
      if (pieces.label[t] == p) cell.push_back({mesh.corner[t], t, p});
    for (const CutTet& tet : pieces.piece[p].cut) cell.push_back({tet.corner, tet.root, p});
  }
  return cell;
}

/// The XML head grows with each array while the arrays themselves gather behind it.
class VtuWriter {
public:
  VtuWriter(std::size_t points, std::size_t cells) {
    head_ = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
            std::to_string(points) + "\" NumberOfCells=\"" + std::to_string(cells) + "\">\n";
  }
  void open(const std::string& element) { head_ += "<" + element + ">\n"; }
  void close(const std::string& element) { head_ += "</" + element + ">\n"; }

  template <class T>
  void array(const char* name, const char* type, int components, const std::vector<T>& numbers) {
    head_ += std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
             std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(data_.size()) +
             "\"/>\n";
    append(data_, static_cast<std::uint64_t>(numbers.size() * sizeof(T)));
    data_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
  }
  void write(const std::filesystem::path& path) const {
    AtomicFile file(path);
    file.write(head_ + "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    file.write(data_);
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
  }

private:
  std::string head_, data_;
};

} // namespace

TetCounts write_vtu(const std::filesystem::path& path, const Root& root, const Pieces& pieces) {
  const TetMesh& mesh = root.model().mesh;
  const std::vector<Cell> cell = cells_of(pieces, mesh);

  // Points of each piece by ascending vertex; a piece has its own, since pieces stand apart.
  std::vector<MaterialPoint> at;
  std::vector<double> position;
  std::vector<std::int64_t> connectivity(4 * cell.size());
  std::vector<std::uint32_t> row(pieces.root_vertex_count + pieces.added.size());
  constexpr std::uint32_t unused = 0xffffffffu;
  for (std::size_t begin = 0, end = 0; begin < cell.size(); begin = end) {
    std::fill(row.begin(), row.end(), unused);
    const std::uint32_t piece = cell[begin].piece;
    while (end < cell.size() && cell[end].piece == piece) ++end;
    std::vector<std::pair<VertexId, TetId>> vertex; // with a tet that has it
    for (std::size_t c = begin; c < end; ++c)
      for (const VertexId v : cell[c].corner)
        if (row[v] == unused) {
          row[v] = 0;
          vertex.emplace_back(v, cell[c].root);
        }
    std::sort(vertex.begin(), vertex.end());
    for (const auto& [v, tet] : vertex) {
      row[v] = static_cast<std::uint32_t>(at.size());
      const Vec3d& x = pieces.position(mesh, v);
      at.push_back({.position = x, .facet = {}, .hint = tet});
      const Vec3d world = pieces.piece[piece].placement(x);
      position.insert(position.end(), world.data(), world.data() + 3);
    }
    for (std::size_t c = begin; c < end; ++c)
      for (int i = 0; i < 4; ++i) connectivity[4 * c + i] = row[cell[c].corner[i]];
  }

  const int component = std::max(0, root.component_of("color"));
  const auto put_color = [&](const MaterialPoint& point, float* color) {
    const Material material = material_at(root, point);
    std::copy_n(material.value.begin() + component, 3, color);
  };
  std::vector<float> point_color(3 * at.size()), cell_color(3 * cell.size());
  parallel_for(at.size(), block, [&](std::size_t i) { put_color(at[i], &point_color[3 * i]); });
  parallel_for(cell.size(), block, [&](std::size_t c) {
    const auto& corner = cell[c].corner;
    const Vec3d sum = pieces.position(mesh, corner[0]) + pieces.position(mesh, corner[1]) +
                      pieces.position(mesh, corner[2]) + pieces.position(mesh, corner[3]);
    put_color({.position = sum / 4, .region = mesh.region[cell[c].root], .facet = {}, .hint = cell[c].root},
              &cell_color[3 * c]);
  });

  std::vector<std::int64_t> offset(cell.size());
  std::vector<std::uint8_t> type(cell.size(), vtk_tetra);
  std::vector<std::int32_t> region(cell.size()), root_tet(cell.size()), piece(cell.size());
  for (std::size_t c = 0; c < cell.size(); ++c) {
    offset[c] = static_cast<std::int64_t>(4 * (c + 1));
    region[c] = mesh.region[cell[c].root];
    root_tet[c] = static_cast<std::int32_t>(cell[c].root.value);
    piece[c] = static_cast<std::int32_t>(cell[c].piece);
  }
  VtuWriter vtu(at.size(), cell.size());
  vtu.open("PointData");
  vtu.array("color", "Float32", 3, point_color);
  vtu.close("PointData");
  vtu.open("CellData");
  vtu.array("region", "Int32", 1, region);
  vtu.array("root", "Int32", 1, root_tet);
  vtu.array("piece", "Int32", 1, piece);
  vtu.array("color", "Float32", 3, cell_color);
  vtu.close("CellData");
  vtu.open("Points");
  vtu.array("Points", "Float64", 3, position);
  vtu.close("Points");
  vtu.open("Cells");
  vtu.array("connectivity", "Int64", 1, connectivity);
  vtu.array("offsets", "Int64", 1, offset);
  vtu.array("types", "UInt8", 1, type);
  vtu.close("Cells");
  vtu.write(path);
  return {cell.size(), at.size()};
}

} // namespace pith
