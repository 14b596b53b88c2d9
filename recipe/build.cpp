#include "recipe/build.h"

#include "recipe/plain_layer.h"
#include "recipe/recipe_keys.h"
#include "recipe/stage_run.h"
#include "recipe/steps.h"
#include "recipe/surface_source.h"
#include "volume/base/error.h"
#include "volume/cut/divide.h"
#include "volume/exemplar/procedural.h"
#include "volume/io/exemplar_io.h"
#include "volume/mesh/refine.h"

#include <algorithm>
#include <set>

namespace pith {
namespace fs = std::filesystem;
namespace {

const Vec3d neutral_grey{0.5, 0.5, 0.5}; ///< regions that no solid fills

class RecipeBuild {
public:
  RecipeBuild(StageRun& run, const Recipe& recipe, const fs::path& folder)
      : run_(run), recipe_(recipe), folder_(folder), keys_(announced_keys(run, recipe, folder)) {}

  BuildResult result() {
    BuildResult built;
    const auto tets = root();
    built.note = tets->note;
    Model& model = built.model;
    model.name = recipe_.name;
    model.mesh = tets->mesh;
    model.boundary = boundary_of(model.mesh);
    if (!tets->input.empty()) model.boundary.input.assign(tets->input.begin(), tets->input.end());
    fill_solids(model);
    add_plain_regions(model);
    built.pieces = recipe_.cuts.empty() && recipe_.moves.empty()
                       ? whole_piece(model.mesh)
                       : *pieces_after(model, recipe_.cuts.size() + recipe_.moves.size());
    built.stages = run_.reports();
    built.fills = std::move(fills_);
    built.scatters = std::move(scatters_);
    return built;
  }

private:
  std::string where(const std::string& path) const { return recipe_.file + ": " + path; }
  std::string solid_path(std::size_t i) const { return where("/solids/" + std::to_string(i)); }

  /// The root: what TetGen made, refined once for all that follows.
  std::shared_ptr<const TetrahedralizeResult> root() {
    return run_.result<TetrahedralizeResult>("refine", keys_.root, true, [&](const Progress&) {
      const auto meshed = divided(recipe_.divides.size());
      TetrahedralizeResult result = *meshed;
      RefineResult refined = refine(meshed->mesh, meshed->input, {.stroke = axis_strokes(recipe_)});
      result.mesh = std::move(refined.mesh);
      result.input = std::move(refined.input);
      return result;
    });
  }

  /// The mesh after the first `count` divides: the last that is remembered, and from there on one by one.
  std::shared_ptr<const TetrahedralizeResult> divided(std::size_t count) {
    if (count == 0) return tets();
    const std::size_t k = count - 1;
    return run_.result<TetrahedralizeResult>(numbered("divide", k), keys_.meshed[count], true, [&](const Progress&) {
      TetrahedralizeResult result = *divided(k);
      const DivideStep& step = recipe_.divides[k];
      const std::string at = where("/divide/" + std::to_string(k));
      const auto level_set = step.surface
                                 ? level_set_of(surface_of(*step.surface, folder_, at + "/surface"), at + "/surface")
                                 : level_set_of(step.shape, at);
      DivideResult parted = divide(result.mesh, result.input, *level_set, {.only = step.only, .snap = step.snap}, at);
      result.mesh = std::move(parted.mesh);
      result.input = std::move(parted.input);
      return result;
    });
  }

  std::shared_ptr<const TetrahedralizeResult> tets() {
    return run_.result<TetrahedralizeResult>("tets", keys_.meshed[0], true, [&](const Progress& progress) {
      const auto surface = run_.result<TriMesh>("surface", keys_.surface, false, [&](const Progress&) {
        return surface_of(recipe_.surface, folder_, where("/surface"));
      });
      TetrahedralizeResult result =
          tetrahedralize(*surface, surface_name(recipe_.surface), meshing_of(recipe_), progress);
      result.surface = {};
      return result;
    });
  }

  void fill_solids(Model& model) {
    std::int32_t regions = 0;
    for (const std::int32_t region : model.mesh.region) regions = std::max(regions, region + 1);
    std::vector<std::uint8_t> vertex_taken(model.mesh.vertex_count(), 0);
    for (std::size_t i = 0; i < recipe_.solids.size(); ++i) {
      const Solid& solid = recipe_.solids[i];
      if (solid.region >= regions)
        throw InvalidInput(solid_path(i) + "/region", "is " + std::to_string(solid.region),
                           "the solid has " + std::to_string(regions) + " region(s), counted from 0");
      if (solid.kind == Solid::Kind::plain)
        model.layer.push_back(plain_layer(model.mesh, solid.region, solid.color, "plain " + std::to_string(i)));
      else
        model.layer.push_back(lapped_layer(model, i, vertex_taken));
      add_things(model, i);
    }
  }

  Exemplar exemplar_of(const ExemplarSource& source, const std::string& at) const {
    if (!source.file.empty()) {
      const Exemplar exemplar = read_exemplar(input_path(folder_, source.file, at + "/file"));
      return source.tile ? tiled(exemplar, *source.tile, at + "/tile") : exemplar;
    }
    return procedural_exemplar(source.procedural, {.resolution = source.resolution, .seed = source.seed});
  }

  std::shared_ptr<const Thing> thing_of_source(const Key& key, const ThingSource& source, const std::string& at) {
    return run_.result<Thing>(keys_.thing_name.at(key), key, true, [&](const Progress&) {
      return thing_of(exemplar_of(source.exemplar, at + "/exemplar"), source.mask);
    });
  }

  /// Scattered things and pastes of a solid, as sparse layers on top of what it has: one for each run of things that
  /// have the same channels.
  void add_things(Model& model, std::size_t i) {
    const Solid& solid = recipe_.solids[i];
    const SolidKeys& keys = keys_.solid[i];
    if (solid.scatter.empty() && solid.pastes.empty()) return;
    std::optional<ScatterGround> made; // only when something has to be computed: the locator takes time
    const auto ground = [&]() -> const ScatterGround& {
      if (made) return *made;
      made.emplace(ScatterGround{{model.mesh, locator(model), solid.region, {}, {}}, {}});
      if (const auto fields = solid_fields_.find(i); fields != solid_fields_.end()) {
        made->paste.axes = fields->second.frames->axes;
        made->paste.scale = fields->second.frames->scale;
        if (fields->second.depth) made->depth = fields->second.depth->value;
      }
      return *made;
    };
    std::vector<std::shared_ptr<const Thing>> scatter_thing, paste_thing;
    std::vector<std::shared_ptr<const ScatterResult>> scattered, pasted;
    std::vector<PlacedBox> taken;
    const auto take = [&](const ScatterResult& result) {
      for (const PastedThing& thing : result.pasted) taken.push_back(thing.box);
    };
    for (std::size_t k = 0; k < solid.pastes.size(); ++k) {
      const std::string at = solid_path(i) + "/pastes/" + std::to_string(k);
      paste_thing.push_back(thing_of_source(keys.paste_thing[k], solid.pastes[k].thing, at));
      pasted.push_back(run_.result<ScatterResult>(numbered("paste", i, k), keys.paste[k], true, [&](const Progress&) {
        PasteOptions options = solid.pastes[k].options;
        options.rotation = solid.pastes[k].turn.rotation();
        return ScatterResult{{paste(ground().paste, *paste_thing[k], options, at)}, 1};
      }));
      take(*pasted[k]);
    }
    for (std::size_t k = 0; k < solid.scatter.size(); ++k) {
      const std::string at = solid_path(i) + "/scatter/" + std::to_string(k);
      scatter_thing.push_back(thing_of_source(keys.scatter_thing[k], solid.scatter[k].thing, at));
      scattered.push_back(
          run_.result<ScatterResult>(numbered("scatter", i, k), keys.scatter[k], true, [&](const Progress& progress) {
            ScatterOptions options = solid.scatter[k].options;
            options.rotation = solid.scatter[k].turn.rotation();
            return scatter(ground(), *scatter_thing[k], options, taken, at, progress);
          }));
      take(*scattered[k]);
      scatters_.push_back({i, k, static_cast<int>(scattered[k]->pasted.size()), scattered[k]->wanted});
    }
    std::vector<PastedKind> kinds;
    const auto add_layer = [&] {
      if (kinds.empty()) return;
      model.layer.push_back(layer_of(kinds, solid.region, "things " + std::to_string(i)));
      kinds.clear();
    };
    const auto add_kind = [&](const Thing& thing, const ScatterResult& result) {
      if (!kinds.empty() && kinds.back().thing->exemplar.channel != thing.exemplar.channel) add_layer();
      kinds.push_back({&thing, result.pasted});
    };
    for (std::size_t k = 0; k < scattered.size(); ++k) add_kind(*scatter_thing[k], *scattered[k]);
    for (std::size_t k = 0; k < pasted.size(); ++k) add_kind(*paste_thing[k], *pasted[k]);
    add_layer();
  }

  Layer lapped_layer(Model& model, std::size_t i, std::vector<std::uint8_t>& vertex_taken) {
    const Solid& solid = recipe_.solids[i];
    const SolidKeys& keys = keys_.solid[i];
    std::array<std::shared_ptr<const DepthField>, 3> field; // depth, along, around
    for (std::size_t f = 0; f < field.size(); ++f) {
      const SolidField one = fields_of(solid)[f];
      if (!one.constraints->empty())
        field[f] = run_.result<DepthField>(numbered(one.name, i), keys.*one.key, true, [&](const Progress&) {
          return depth_field(model.mesh, model.boundary, solid.region, *one.constraints,
                             solid_path(i) + "/" + one.name, solid.depth_options);
        });
    }
    const auto& [depth, along, around] = field;
    const auto frames = run_.result<FrameField>(numbered("frames", i), keys.frames, true, [&](const Progress&) {
      return frames_of({.mesh = model.mesh,
                        .locator = locator(model),
                        .region = solid.region,
                        .depth = depth.get(),
                        .along = along.get(),
                        .around = around.get(),
                        .stroke = solid.orientation,
                        .scale = solid.scale,
                        .local_scale = solid.local_scale,
                        .where = solid_path(i)},
                       solid.frame);
    });
    const auto exemplar = run_.result<Exemplar>(numbered("exemplar", i), keys.exemplar, true, [&](const Progress&) {
      return exemplar_of(solid.exemplar, solid_path(i) + "/exemplar");
    });
    // The exemplar has a cache entry of its own: the fill's is stored without it.
    const auto fill = run_.result<LapResult>(numbered("fill", i), keys.fill, true, [&](const Progress& progress) {
      const LapInput input{.mesh = model.mesh,
                           .boundary = model.boundary,
                           .region = solid.region,
                           .axes = frames->axes,
                           .scale = frames->scale,
                           .coordinate = {values(around), values(depth), values(along)},
                           .singular = frames->singular,
                           .unsigned_axis = solid.frame.unsigned_axis,
                           .where = solid_path(i)};
      LapResult result = lap(input, *exemplar, solid.fill, progress);
      result.layer.exemplar.clear();
      return result;
    });
    add_fields(model, solid.region, depth.get(), *frames, vertex_taken);
    solid_fields_[i] = {depth, frames};
    fills_.push_back(
        {i, solid.fill.type, fill->statistics, singular_set(model.mesh, solid.region, frames->singular)});
    Layer layer = fill->layer;
    layer.exemplar = {*exemplar};
    return layer;
  }

  static std::span<const float> values(const std::shared_ptr<const DepthField>& field) {
    return field ? std::span<const float>(field->value) : std::span<const float>();
  }

  /// Copies one region's fields into the model's. A vertex on an interface keeps the depth of the solid listed first.
  static void add_fields(Model& model, std::int32_t region, const DepthField* depth, const FrameField& frames,
                         std::vector<std::uint8_t>& vertex_taken) {
    const TetMesh& mesh = model.mesh;
    Fields& field = model.field;
    field.depth.resize(mesh.vertex_count(), 0);
    field.axes.resize(mesh.tet_count(), Mat3d::Identity());
    field.scale.resize(mesh.tet_count(), 1);
    field.singular.resize(mesh.tet_count(), 1);
    std::vector<std::uint8_t> mine(mesh.vertex_count(), 0);
    for (const TetId tet : all_ids<TetId>(mesh.tet_count())) {
      if (mesh.region[tet] != region) continue;
      field.axes[tet] = frames.axes[tet];
      field.scale[tet] = frames.scale[tet];
      field.singular[tet] = frames.singular[tet];
      for (const VertexId v : mesh.corner[tet]) {
        if (!depth) continue; // a solid without depth leaves its vertices to its neighbours
        if (!vertex_taken[v]) field.depth[v] = depth->value[v];
        mine[v] = 1;
      }
    }
    for (std::size_t v = 0; v < mine.size(); ++v) vertex_taken[v] |= mine[v];
  }

  void add_plain_regions(Model& model) const {
    if (recipe_.solids.empty()) {
      model.layer.push_back(plain_layer(model.mesh, -1, neutral_grey, "plain"));
      return;
    }
    std::set<std::int32_t> bare(model.mesh.region.begin(), model.mesh.region.end());
    for (const Solid& solid : recipe_.solids) bare.erase(solid.region);
    for (const std::int32_t region : bare)
      model.layer.push_back(plain_layer(model.mesh, region, neutral_grey, "plain region " + std::to_string(region)));
  }

  /// The pieces after the first `count` steps: the last that is remembered, and from there on one by one.
  std::shared_ptr<const Pieces> pieces_after(const Model& model, std::size_t count) {
    if (count == 0) return std::make_shared<const Pieces>(whole_piece(model.mesh));
    const std::size_t k = count - 1;
    const std::size_t cuts = recipe_.cuts.size();
    const bool is_cut = k < cuts;
    const std::string name = is_cut ? numbered("cut", k) : numbered("move", k - cuts);
    return run_.result<Pieces>(name, keys_.step[k], true, [&](const Progress&) {
      Pieces pieces = *pieces_after(model, k);
      if (is_cut)
        apply_cut(pieces, {model, locator(model), folder_}, recipe_.cuts[k], where("/cuts/" + std::to_string(k)));
      else
        apply_move(pieces, model.mesh, locator(model), recipe_.moves[k - cuts],
                   where("/moves/" + std::to_string(k - cuts)));
      return pieces;
    });
  }

  const Locator& locator(const Model& model) {
    if (!locator_) locator_ = std::make_unique<Locator>(model.mesh, model.boundary);
    return *locator_;
  }

  StageRun& run_;
  const Recipe& recipe_;
  const fs::path& folder_;
  RecipeKeys keys_;
  struct SolidFields {
    std::shared_ptr<const DepthField> depth;
    std::shared_ptr<const FrameField> frames;
  };
  std::map<std::size_t, SolidFields> solid_fields_; ///< of lapped solids
  std::vector<FillReport> fills_;
  std::vector<ScatterReport> scatters_;
  std::unique_ptr<Locator> locator_;
};

} // namespace

Builder::Builder(BuildOptions options)
    : options_(std::move(options)), memory_(options_.memory_bytes), disk_(options_.cache, options_.cache_bytes) {
  if (options_.code.empty()) options_.code = code_version();
}

BuildResult Builder::build(const Recipe& recipe, const fs::path& folder, const BuildProgress& progress) {
  StageRun run(options_, memory_, disk_, progress);
  return RecipeBuild(run, recipe, folder).result();
}

} // namespace pith
