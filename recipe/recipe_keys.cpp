#include "recipe/recipe_keys.h"

#include "recipe/stage_keys.h"
#include "recipe/surface_source.h"
#include "volume/io/atomic_file.h"

namespace pith {
namespace fs = std::filesystem;
namespace {

class KeyChain {
public:
  KeyChain(StageRun& run, const Recipe& recipe, const fs::path& folder)
      : run_(run), recipe_(recipe), folder_(folder) {
    make();
  }
  RecipeKeys keys() && { return std::move(keys_); }

private:
  std::string where(const std::string& path) const { return recipe_.file + ": " + path; }
  std::string solid_path(std::size_t i) const { return where("/solids/" + std::to_string(i)); }

  /// A surface: the content of its file, or its shape's name.
  KeyMaker& add_source(KeyMaker& maker, const SurfaceSource& source, const std::string& at) const {
    maker.add(source.scale);
    if (!source.shape.empty()) return maker.add(source.shape).add(source.triangles);
    const fs::path path = input_path(folder_, source.file, at + "/file");
    return maker.add(key_of(file_content(path))).add(path.extension().string());
  }

  void make() {
    KeyMaker surface = run_.key("surface");
    keys_.surface = add_source(surface, recipe_.surface, where("/surface")).key();
    run_.announce("surface", keys_.surface);
    KeyMaker tets = run_.key("tets").add(keys_.surface);
    Key meshed = add(tets, meshing_of(recipe_)).key();
    run_.announce("tets", meshed);
    keys_.meshed.push_back(meshed);
    for (std::size_t k = 0; k < recipe_.divides.size(); ++k) {
      KeyMaker divided = run_.key("divide").add(keys_.meshed.back());
      if (const auto& source = recipe_.divides[k].surface)
        add_source(divided, *source, where("/divide/" + std::to_string(k) + "/surface"));
      keys_.meshed.push_back(add(divided, recipe_.divides[k]).key());
      run_.announce(numbered("divide", k), keys_.meshed.back());
    }
    KeyMaker refined = run_.key("refine").add(keys_.meshed.back());
    for (const std::vector<Vec3d>& stroke : axis_strokes(recipe_)) refined.add(stroke);
    keys_.root = refined.key();
    run_.announce("refine", keys_.root);
    for (std::size_t i = 0; i < recipe_.solids.size(); ++i) {
      const Solid& solid = recipe_.solids[i];
      SolidKeys keys;
      if (solid.kind == Solid::Kind::lapped) {
        KeyMaker frames = run_.key("frames").add(keys_.root).add(static_cast<int>(solid.region));
        for (const SolidField& field : fields_of(solid)) {
          if (!field.constraints->empty()) {
            KeyMaker maker = run_.key("depth").add(keys_.root).add(static_cast<int>(solid.region));
            keys.*field.key = add(add(maker, *field.constraints), solid.depth_options).key();
            run_.announce(numbered(field.name, i), keys.*field.key);
          }
          frames.add(keys.*field.key);
        }
        frames.add(solid.scale);
        keys.frames = add(add(add(frames, solid.orientation), solid.local_scale), solid.frame).key();
        keys.exemplar = exemplar_key(solid.exemplar, solid_path(i) + "/exemplar");
        KeyMaker fill = run_.key("fill").add(keys.frames).add(keys.exemplar);
        keys.fill = add(fill, solid.fill).key();
        run_.announce(numbered("frames", i), keys.frames);
        run_.announce(numbered("exemplar", i), keys.exemplar);
        run_.announce(numbered("fill", i), keys.fill);
      }
      make_thing_keys(i, keys);
      keys_.solid.push_back(keys);
    }
    Key before = keys_.root;
    for (std::size_t k = 0; k < recipe_.cuts.size(); ++k) {
      KeyMaker cut = run_.key("cut").add(before);
      if (const auto& source = recipe_.cuts[k].surface)
        add_source(cut, *source, where("/cuts/" + std::to_string(k) + "/surface"));
      if (recipe_.cuts[k].depth) // of all solids: on interfaces the first that is listed counts
        for (const SolidKeys& solid : keys_.solid) cut.add(solid.depth);
      keys_.step.push_back(before = add(cut, recipe_.cuts[k]).key());
      run_.announce(numbered("cut", k), before);
    }
    for (std::size_t k = 0; k < recipe_.moves.size(); ++k) {
      KeyMaker move = run_.key("move").add(before);
      keys_.step.push_back(before = add(move, recipe_.moves[k]).key());
      run_.announce(numbered("move", k), before);
    }
  }

  /// Pastes stand on the frames alone, or on the tets where they follow none; a scatter also on what it keeps clear
  /// of: the pastes and the scatters before it.
  void make_thing_keys(std::size_t i, SolidKeys& keys) {
    const Solid& solid = recipe_.solids[i];
    const bool framed = solid.kind == Solid::Kind::lapped;
    const auto thing_key = [&](const ThingSource& source, const std::string& at) {
      KeyMaker maker = run_.key("thing").add(exemplar_key(source.exemplar, at + "/exemplar")).add(bool(source.mask));
      if (source.mask) add(maker, *source.mask);
      const Key key = maker.key();
      if (keys_.thing_name.emplace(key, numbered("thing", keys_.thing_name.size())).second)
        run_.announce(keys_.thing_name[key], key);
      return key;
    };
    for (std::size_t k = 0; k < solid.pastes.size(); ++k) {
      const PasteStep& step = solid.pastes[k];
      keys.paste_thing.push_back(thing_key(step.thing, solid_path(i) + "/pastes/" + std::to_string(k)));
      const bool follows = framed && (step.options.in_frame || step.options.follow == Follow::warped);
      KeyMaker maker = run_.key("paste").add(follows ? keys.frames : keys_.root).add(keys.paste_thing.back());
      keys.paste.push_back(add(maker.add(static_cast<int>(solid.region)), step).key());
      run_.announce(numbered("paste", i, k), keys.paste.back());
    }
    for (std::size_t k = 0; k < solid.scatter.size(); ++k) {
      keys.scatter_thing.push_back(
          thing_key(solid.scatter[k].thing, solid_path(i) + "/scatter/" + std::to_string(k)));
      KeyMaker maker = run_.key("scatter").add(framed ? keys.frames : keys_.root).add(keys.scatter_thing.back());
      for (const Key& taken : keys.paste) maker.add(taken);
      for (const Key& taken : keys.scatter) maker.add(taken);
      keys.scatter.push_back(add(maker.add(static_cast<int>(solid.region)), solid.scatter[k]).key());
      run_.announce(numbered("scatter", i, k), keys.scatter.back());
    }
  }

  Key exemplar_key(const ExemplarSource& source, const std::string& at) const {
    KeyMaker maker = run_.key("exemplar");
    if (source.file.empty()) return maker.add(source.procedural).add(source.resolution).add(source.seed).key();
    const fs::path path = input_path(folder_, source.file, at + "/file");
    maker.add(path.extension().string()).add(key_of(file_content(path)));
    if (source.tile) {
      maker.add("tile").add(source.tile->border);
      for (const bool along : source.tile->axis) maker.add(along);
    }
    return maker.key();
  }

  StageRun& run_;
  const Recipe& recipe_;
  const fs::path& folder_;
  RecipeKeys keys_;
};

} // namespace

std::array<SolidField, 3> fields_of(const Solid& solid) {
  return {{{"depth", &solid.depth, &SolidKeys::depth},
           {"along", &solid.along, &SolidKeys::along},
           {"around", &solid.around, &SolidKeys::around}}};
}

RecipeKeys announced_keys(StageRun& run, const Recipe& recipe, const fs::path& folder) {
  return KeyChain(run, recipe, folder).keys();
}

std::string numbered(const char* stage, std::size_t i) { return std::string(stage) + " " + std::to_string(i); }
std::string numbered(const char* stage, std::size_t i, std::size_t k) {
  return numbered(stage, i) + "." + std::to_string(k);
}

std::vector<std::vector<Vec3d>> axis_strokes(const Recipe& recipe) {
  std::vector<std::vector<Vec3d>> strokes;
  for (const Solid& solid : recipe.solids)
    for (const DepthConstraint& constraint : solid.depth)
      if (constraint.value == 1 && constraint.stroke.size() > 1) strokes.push_back(constraint.stroke);
  return strokes;
}

TetrahedralizeOptions meshing_of(const Recipe& recipe) {
  TetrahedralizeOptions options = recipe.tetrahedralize;
  options.core = axis_strokes(recipe);
  return options;
}

} // namespace pith
