#pragma once
// The .pith file: a zip of model.json, recipe.json and arrays as .npy, so that a model opens with unzip and NumPy.
//
//   model.json                     format and version, name, units, counts, bounds, stages, pieces, what layers are
//   recipe.json                    the recipe, as it was given
//   mesh/position|corner|region    the root; neighbours and boundary follow from these and are made again on reading
//   boundary/input                 the input triangle of each boundary facet, where known
//   field/depth|axes|scale|singular  where computed
//   exemplar/N, mask/N             texels and alpha, each once however many layers share it; gaussian/N, inverse/N
//   layer/N/corner|begin|simplex|lookup|patch|frame|key
//   pieces/label|cut_begin|cut_corner|cut_root|cut_face|placement|edge|position|normal|
//                                  section|section_normal
//
// The same model gives the same bytes: times in the zip are fixed.
#include "volume/cut/piece.h"
#include "volume/layer/model.h"
#include "volume/mesh/region_measure.h"

#include <filesystem>
#include <map>
#include <string>

namespace pith {

/// What this program writes; it reads this and every earlier one.
inline constexpr int model_format_version = 1;

/// Everything in the file.
struct ModelFile {
  Model model;
  Pieces pieces;
  std::string recipe;                     ///< JSON text
  std::map<std::string, std::string> key; ///< stage → Merkle key
};

/// The file appears whole or not at all. Precondition: `model` and `pieces` are valid (a model that could not be read
/// back throws InvalidInput). Errors: IoFailure with the path.
void write_model(const std::filesystem::path& path, const Model& model, const Pieces& pieces,
                 const std::string& recipe, const std::map<std::string, std::string>& key);
void write_model(const std::filesystem::path& path, const ModelFile& file);

/// Errors: IoFailure when the file cannot be opened; InvalidInput, saying what and where, when it is not a .pith
/// file, is truncated or damaged (every part's CRC is checked), was written by a later version, or its parts do not
/// fit together.
ModelFile read_model(const std::filesystem::path& path);

/// What model.json tells without reading the arrays: for `pith info`. A few milliseconds for a file of any size.
struct ModelSummary {
  int version = 0;
  std::string name;
  std::string recipe;                     ///< JSON text
  std::map<std::string, std::string> key; ///< stage → Merkle key
  std::size_t file_bytes = 0;
  std::size_t vertices = 0, tets = 0, facets = 0, regions = 0;
  std::size_t patches = 0, lookups = 0; ///< of all layers together
  std::size_t cuts = 0, added_vertices = 0;
  Box bounds; ///< of the root, mm
  struct LayerSummary {
    std::string name, domain, blend; ///< "solid" | "skin"; "over", "max histogram" ...
    int region = -1, width = 3;
    std::size_t patches = 0, lookups = 0, corners = 0;
    std::vector<std::string> exemplars; ///< "kiwi 128×128×128"
    std::vector<std::string> channels;  ///< "color", "roughness" ...
    std::size_t masks = 0;
  };
  std::vector<LayerSummary> layer;
  struct PieceSummary {
    std::size_t whole_tets = 0, cut_tets = 0;
    double volume = 0; ///< mm³
    Box bounds;        ///< where it stands, mm
    bool moved = false;
  };
  std::vector<PieceSummary> piece;
  std::vector<RegionMeasure> region; ///< ascending; empty in files of pith 0.1.0 and before
};
ModelSummary read_model_summary(const std::filesystem::path& path);

/// True when the file starts like a zip: a .pith or an .exemplar file.
bool looks_like_zip(const std::filesystem::path& path);

} // namespace pith
