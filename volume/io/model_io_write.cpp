#include "volume/io/layer_json.h"
#include "volume/io/model_io.h"
#include "volume/io/zip_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace pith {

using nlohmann::json;

namespace {

/// Exemplars or masks, each once however many layers share it.
template <class T, class Same>
class Shared {
public:
  std::size_t number_of(const T& value) {
    const auto found =
        std::find_if(once_.begin(), once_.end(), [&](const T* known) { return Same()(*known, value); });
    if (found != once_.end()) return std::size_t(found - once_.begin());
    once_.push_back(&value);
    return once_.size() - 1;
  }
  const std::vector<const T*>& all() const { return once_; }

private:
  std::vector<const T*> once_;
};

struct SameExemplar {
  bool operator()(const Exemplar& a, const Exemplar& b) const {
    return a.name == b.name && a.axes == b.axes && a.size == b.size && a.wrap == b.wrap && a.channel == b.channel &&
           a.texel == b.texel && a.gaussian == b.gaussian && a.inverse == b.inverse;
  }
};
struct SameMask {
  bool operator()(const Mask& a, const Mask& b) const {
    return a.axes == b.axes && a.size == b.size && a.open == b.open && a.alpha == b.alpha;
  }
};

/// Columns of structs, which the zip refers to until it is written.
struct Columns {
  std::deque<std::vector<std::uint32_t>> u4;
  std::deque<std::vector<std::int32_t>> i4;
  std::deque<std::vector<std::uint64_t>> u8;
  std::deque<std::vector<float>> f4;
  std::deque<std::vector<double>> f8;
};

void add_exemplar(ZipWriter& zip, const std::string& number, const Exemplar& exemplar) {
  std::vector<std::size_t> shape; // slowest first, channels last
  for (int axis = exemplar.axes; axis-- > 0;) shape.push_back(static_cast<std::size_t>(exemplar.size[axis]));
  const auto components = static_cast<std::size_t>(exemplar.component_count());
  shape.push_back(components);
  zip.add_array<std::uint8_t>("exemplar/" + number, exemplar.texel, shape);
  if (exemplar.gaussian.empty()) return;
  zip.add_array<std::uint8_t>("gaussian/" + number, exemplar.gaussian, shape);
  zip.add_array<float>("inverse/" + number, exemplar.inverse, {components, 256});
}

void add_layer(ZipWriter& zip, Columns& columns, const std::string& folder, const Layer& layer) {
  const std::size_t row = static_cast<std::size_t>(layer.width) + 1;
  zip.add_array<float>(folder + "corner", layer.corner, {layer.corner.size() / row, row});
  zip.add_rows<std::uint32_t>(folder + "begin", layer.begin);
  if (!layer.simplex.empty()) zip.add_rows<std::uint32_t>(folder + "simplex", layer.simplex);
  static_assert(sizeof(Lookup) == 5 * sizeof(std::uint32_t));
  zip.add_rows<std::uint32_t>(folder + "lookup", layer.lookup);

  auto& reads = columns.u4.emplace_back();
  auto& frame = columns.f4.emplace_back();
  auto& key = columns.u8.emplace_back();
  for (const Patch& patch : layer.patch) {
    reads.insert(reads.end(), {patch.exemplar, patch.mask});
    frame.insert(frame.end(), patch.frame.scale.begin(), patch.frame.scale.end());
    frame.insert(frame.end(), patch.frame.offset.begin(), patch.frame.offset.end());
    key.push_back(patch.key);
  }
  zip.add_array<std::uint32_t>(folder + "patch", reads, {layer.patch.size(), 2});
  zip.add_array<float>(folder + "frame", frame, {layer.patch.size(), 2, 4});
  zip.add_array<std::uint64_t>(folder + "key", key, {layer.patch.size()});
}

void add_pieces(ZipWriter& zip, Columns& columns, const Pieces& pieces) {
  auto& begin = columns.u4.emplace_back();
  auto& corner = columns.u4.emplace_back();
  auto& root = columns.u4.emplace_back();
  auto& face = columns.i4.emplace_back();
  auto& placement = columns.f8.emplace_back();
  for (const Piece& piece : pieces.piece) {
    begin.push_back(static_cast<std::uint32_t>(root.size()));
    for (const CutTet& tet : piece.cut) {
      for (const VertexId v : tet.corner) corner.push_back(v);
      root.push_back(tet.root);
      for (const FaceTag tag : tet.face) face.push_back(tag.code);
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) placement.push_back(piece.placement.rotation(i, j));
      placement.push_back(piece.placement.translation[i]);
    }
  }
  begin.push_back(static_cast<std::uint32_t>(root.size()));

  zip.add_rows<std::uint32_t>("pieces/label", pieces.label, Packing::deflated);
  zip.add_rows<std::uint32_t>("pieces/cut_begin", begin);
  zip.add_array<std::uint32_t>("pieces/cut_corner", corner, {root.size(), 4});
  zip.add_rows<std::uint32_t>("pieces/cut_root", root);
  zip.add_array<std::int32_t>("pieces/cut_face", face, {root.size(), 4});
  zip.add_array<double>("pieces/placement", placement, {pieces.piece.size(), 3, 4});
  static_assert(sizeof(AddedVertex) == 3 * sizeof(std::uint32_t));
  zip.add_rows<std::uint32_t>("pieces/edge", pieces.added);
  zip.add_rows<double>("pieces/position", pieces.added_position);
  zip.add_rows<float>("pieces/normal", pieces.added_normal);

  auto& section = columns.u4.emplace_back();
  auto& section_normal = columns.f4.emplace_back();
  for (const SectionNormal& known : pieces.on_section) {
    section.insert(section.end(), {known.vertex, known.cut});
    section_normal.insert(section_normal.end(), {known.normal.x(), known.normal.y(), known.normal.z()});
  }
  zip.add_array<std::uint32_t>("pieces/section", section, {pieces.on_section.size(), 2});
  zip.add_array<float>("pieces/section_normal", section_normal, {pieces.on_section.size(), 3});
}

json json_of(const Box& box) {
  if (box.empty()) return nullptr;
  return {{box.low.x(), box.low.y(), box.low.z()}, {box.high.x(), box.high.y(), box.high.z()}};
}

/// What a summary says of each piece.
json piece_summaries(const TetMesh& root, const Pieces& pieces) {
  struct Sum {
    std::size_t whole = 0;
    double volume = 0;
    Box bounds;
  };
  std::vector<Sum> sum(pieces.piece.size());
  const auto add = [&](std::uint32_t p, const std::array<VertexId, 4>& corner) {
    std::array<Vec3d, 4> x;
    for (int i = 0; i < 4; ++i) {
      x[i] = pieces.position(root, corner[i]);
      sum[p].bounds.add(pieces.piece[p].placement(x[i]));
    }
    const Vec3d a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    sum[p].volume += (a.x() * (b.y() * c.z() - b.z() * c.y()) - a.y() * (b.x() * c.z() - b.z() * c.x()) +
                      a.z() * (b.x() * c.y() - b.y() * c.x())) /
                     6;
  };
  for (const TetId t : all_ids<TetId>(root.tet_count()))
    if (const std::uint32_t p = pieces.label[t]; p < sum.size()) {
      add(p, root.corner[t]);
      ++sum[p].whole;
    }
  json all = json::array();
  for (std::uint32_t p = 0; p < pieces.piece.size(); ++p) {
    for (const CutTet& tet : pieces.piece[p].cut) add(p, tet.corner);
    all.push_back({{"whole_tets", sum[p].whole},
                   {"cut_tets", pieces.piece[p].cut.size()},
                   {"volume", sum[p].volume},
                   {"bounds", json_of(sum[p].bounds)},
                   {"moved", !pieces.piece[p].placement.identity()}});
  }
  return all;
}

} // namespace

void write_model(const std::filesystem::path& path, const Model& model, const Pieces& pieces,
                 const std::string& recipe, const std::map<std::string, std::string>& key) {
  validate(model);
  validate(pieces, model.mesh, model.boundary);

  ZipWriter zip;
  Columns columns;
  Shared<Exemplar, SameExemplar> exemplars;
  Shared<Mask, SameMask> masks;
  json layers = json::array();
  for (const Layer& layer : model.layer) {
    json entry = json_of(layer);
    entry["exemplars"] = json::array();
    entry["masks"] = json::array();
    for (const Exemplar& exemplar : layer.exemplar) entry["exemplars"].push_back(exemplars.number_of(exemplar));
    for (const Mask& mask : layer.mask) entry["masks"].push_back(masks.number_of(mask));
    layers.push_back(std::move(entry));
  }
  json exemplar_list = json::array(), mask_list = json::array();
  for (const Exemplar* exemplar : exemplars.all()) {
    exemplar_list.push_back(json_of(*exemplar));
    exemplar_list.back()["gaussian"] = !exemplar->gaussian.empty();
  }
  for (const Mask* mask : masks.all()) mask_list.push_back(json_of(*mask));

  json regions = json::array();
  for (const RegionMeasure& region : measure_regions(model.mesh))
    regions.push_back({{"region", region.region},
                       {"tets", region.tets},
                       {"volume", region.volume},
                       {"bounds", json_of(region.bounds)},
                       {"minimum_dihedral", region.minimum_dihedral},
                       {"outside_area", region.outside_area},
                       {"interface_area", region.interface_area},
                       {"beside", region.beside}});

  const json description = {{"format", "pith model"},
                            {"version", model_format_version},
                            {"name", model.name},
                            {"units", "mm"},
                            {"counts",
                             {{"vertices", model.mesh.vertex_count()},
                              {"tets", model.mesh.tet_count()},
                              {"facets", model.boundary.facet_count()},
                              {"regions", regions.size()},
                              {"added_vertices", pieces.added.size()},
                              {"cuts", pieces.cut_count}}},
                            {"bounds", json_of(bounds_of(model.mesh))},
                            {"regions", regions},
                            {"fields",
                             {{"input", !model.boundary.input.empty()},
                              {"depth", !model.field.depth.empty()},
                              {"axes", !model.field.axes.empty()},
                              {"scale", !model.field.scale.empty()},
                              {"singular", !model.field.singular.empty()}}},
                            {"exemplars", exemplar_list},
                            {"masks", mask_list},
                            {"layers", layers},
                            {"pieces", piece_summaries(model.mesh, pieces)},
                            {"stages", key}};
  try {
    zip.add_text("model.json", description.dump(1) + "\n");
  } catch (const json::exception&) {
    throw InvalidInput(path.string(), "a name in the model is not valid UTF-8",
                       "rename the layer, exemplar or channel");
  }
  zip.add_text("recipe.json", recipe);

  zip.add_rows<double>("mesh/position", model.mesh.position);
  zip.add_rows<std::uint32_t>("mesh/corner", model.mesh.corner);
  zip.add_rows<std::int32_t>("mesh/region", model.mesh.region, Packing::deflated);
  if (!model.boundary.input.empty()) zip.add_rows<std::uint32_t>("boundary/input", model.boundary.input);
  if (!model.field.depth.empty()) zip.add_rows<float>("field/depth", model.field.depth);
  if (!model.field.axes.empty()) zip.add_rows<double>("field/axes", model.field.axes);
  if (!model.field.scale.empty()) zip.add_rows<float>("field/scale", model.field.scale);
  if (!model.field.singular.empty())
    zip.add_rows<std::uint8_t>("field/singular", model.field.singular, Packing::deflated);

  for (std::size_t i = 0; i < exemplars.all().size(); ++i) add_exemplar(zip, std::to_string(i), *exemplars.all()[i]);
  for (std::size_t i = 0; i < masks.all().size(); ++i) {
    const Mask& mask = *masks.all()[i];
    std::vector<std::size_t> shape;
    for (int axis = mask.axes; axis-- > 0;) shape.push_back(static_cast<std::size_t>(mask.size[axis]));
    zip.add_array<std::uint8_t>("mask/" + std::to_string(i), mask.alpha, shape, Packing::deflated);
  }
  for (std::size_t i = 0; i < model.layer.size(); ++i)
    add_layer(zip, columns, "layer/" + std::to_string(i) + "/", model.layer[i]);
  add_pieces(zip, columns, pieces);
  zip.write(path);
}

void write_model(const std::filesystem::path& path, const ModelFile& file) {
  write_model(path, file.model, file.pieces, file.recipe, file.key);
}

} // namespace pith
