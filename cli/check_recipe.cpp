// pith check RECIPE.json: what can be known before anything is meshed.
#include "cli/check.h"
#include "cli/scene_file.h"
#include "recipe/recipe.h"
#include "recipe/surface_source.h"
#include "volume/base/error.h"
#include "volume/io/atomic_file.h"
#include "volume/io/exemplar_io.h"
#include "volume/io/mesh_io.h"
#include "volume/mesh/surface_plan.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace pith::cli {
namespace {

class RecipeCheck {
public:
  RecipeCheck(const Recipe& recipe, std::filesystem::path folder) : recipe_(recipe), folder_(std::move(folder)) {}

  std::vector<Finding> findings;
  std::optional<TriMesh> surface;
  std::size_t shells = 0;
  std::string hint, note; ///< about units; what make would mend

  void look_at_surface(const Session& session) {
    const bool shape = !recipe_.surface.shape.empty();
    const std::string where = shape ? "/surface/shape" : "/surface/file";
    const std::optional<std::filesystem::path> path =
        shape ? std::filesystem::path() : input(recipe_.surface.file, where);
    if (!path) return;
    try {
      surface = surface_of(recipe_.surface, folder_, "/surface");
    } catch (const std::runtime_error& error) {
      add(where, error.what(), "give a closed surface");
      return;
    }
    session.stop_if_asked();
    bounds_ = bounds_of(*surface);
    hint = unit_hint(bounds_);
    shells = surface_defects(welded(*surface)).shells;
    const SurfacePlan plan = surface_plan(*surface, surface_name(recipe_.surface));
    if (plan.way == SurfacePlan::Way::mend) note = "make will mend the surface in place: " + plan.note;
    if (plan.way == SurfacePlan::Way::wrap) {
      note = "make will wrap the surface: " + plan.note;
      if (recipe_.tetrahedralize.method == TetrahedralizeOptions::Method::tetgen)
        add(where, plan.note, "repair the surface, or set tetrahedralize/method to automatic");
    }
    if (plan.way == SurfacePlan::Way::refuse) add(where, plan.note, "give a closed surface that encloses a volume");
  }

  void look_at_solid(std::size_t i) {
    const Solid& solid = recipe_.solids[i];
    const std::string at = "/solids/" + std::to_string(i);
    // Divides add regions to those of the shells.
    if (surface && shells > 0 && recipe_.divides.empty() && solid.region >= 0 &&
        static_cast<std::size_t>(solid.region) >= shells)
      add(at + "/region", "is " + std::to_string(solid.region),
          "the surface has " + std::to_string(shells) + " shell(s); regions count from 0");
    look_at_things(solid, at);
    if (solid.kind == Solid::Kind::plain) return;
    for (const auto& [name, constraints] :
         {std::pair{"/depth", &solid.depth}, {"/along", &solid.along}, {"/around", &solid.around}})
      for (std::size_t c = 0; c < constraints->size(); ++c) {
        const DepthConstraint& one = (*constraints)[c];
        const std::string place = at + name + "/" + std::to_string(c);
        look_at_triangles(one.triangles, place + "/triangles");
        if (!one.stroke.empty()) look_at_stroke(one.stroke, place + "/stroke");
      }
    for (std::size_t s = 0; s < solid.orientation.size(); ++s)
      look_at_stroke(solid.orientation[s].point, at + "/orientation/" + std::to_string(s) + "/stroke");
    for (std::size_t s = 0; s < solid.local_scale.size(); ++s)
      look_at_stroke(solid.local_scale[s].stroke, at + "/local_scale/" + std::to_string(s));
    look_at_exemplar(solid.exemplar, at + "/exemplar");
  }

  void look_at_divides() {
    for (std::size_t i = 0; i < recipe_.divides.size(); ++i)
      if (const std::optional<SurfaceSource>& source = recipe_.divides[i].surface; source && source->shape.empty())
        input(source->file, "/divide/" + std::to_string(i) + "/surface/file");
  }

  /// Cuts up to the first that moves pieces apart: where later ones find them is not known yet.
  void look_at_cuts() {
    bool moved = !surface;
    for (std::size_t i = 0; i < recipe_.cuts.size(); ++i) {
      const CutStep& step = recipe_.cuts[i];
      const std::string at = "/cuts/" + std::to_string(i);
      if (step.surface && step.surface->shape.empty()) input(step.surface->file, at + "/surface/file");
      if (step.surface || step.depth || !step.join.empty()) continue;
      std::unique_ptr<LevelSet> level_set;
      try {
        level_set = level_set_of(step.shape, at);
      } catch (const InvalidInput& error) {
        add(at, error.what(), "change the shape");
        continue;
      }
      moved = moved || !step.placements.empty();
      if (!moved) {
        std::vector<Vec3d> corner(surface->position.begin(), surface->position.end());
        std::vector<double> value(corner.size());
        level_set->values(corner, value);
        const bool below = std::any_of(value.begin(), value.end(), [](double v) { return v < 0; });
        const bool above = std::any_of(value.begin(), value.end(), [](double v) { return v > 0; });
        // What is closed may lie inside without touching the surface.
        const auto within = [&](const Vec3d& x) { return bounds_.contains(x); };
        bool inside = std::holds_alternative<SheetCut>(step.shape);
        if (const auto* sphere = std::get_if<SphereCut>(&step.shape)) inside = within(sphere->center);
        if (const auto* box = std::get_if<BoxCut>(&step.shape)) inside = within(box->center);
        if (const auto* rod = std::get_if<CylinderCut>(&step.shape))
          inside = rod->endless || within(0.5 * (rod->from + rod->to));
        if (const auto* stroke = std::get_if<StrokeCut>(&step.shape)) inside = stroke->closed;
        if (!(below && above) && !inside)
          add(at, "passes by the surface, which spans " + box_text(), "move it so that it passes through");
      }
      moved = moved || step.spread > 0;
    }
  }

  void look_at_scene() {
    if (recipe_.scene.empty()) return;
    const std::optional<std::filesystem::path> path = input(recipe_.scene, "/scene");
    if (!path) return;
    try {
      parse_scene(file_content(*path), path->filename().string(), path->parent_path());
    } catch (const std::runtime_error& error) {
      add("/scene", error.what(), "correct the scene file");
    }
  }

private:
  void add(const std::string& where, const std::string& what, const std::string& mend) {
    findings.push_back({recipe_.file + ": " + where + ": " + what, 1, mend});
  }

  std::optional<std::filesystem::path> input(const std::string& file, const std::string& where) {
    const std::filesystem::path given = file, path = given.is_absolute() ? given : folder_ / given;
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) return path;
    add(where, "\"" + file + "\" does not exist", "paths count from the recipe's folder");
    return {};
  }

  std::string box_text() const {
    const auto text = [](const Vec3d& x) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", x.x(), x.y(), x.z()); };
    return text(bounds_.low) + " to " + text(bounds_.high);
  }

  /// Strokes may be longer than the solid, but not all of one may lie beside it.
  void look_at_stroke(const std::vector<Vec3d>& stroke, const std::string& where) {
    if (!surface || bounds_.empty() || stroke.empty()) return;
    const double margin = 0.01 * bounds_.diagonal();
    Box box;
    for (const Vec3d& p : stroke) box.add(p);
    const bool apart =
        ((box.low.array() > bounds_.high.array() + margin) || (box.high.array() < bounds_.low.array() - margin))
            .any();
    if (!apart) return;
    add(where, "lies beside the surface, which spans " + box_text(),
        hint.empty() ? "draw it on or inside the surface" : "is \"scale\" of the surface right? " + hint);
  }

  void look_at_things(const Solid& solid, const std::string& at) {
    for (std::size_t k = 0; k < solid.pastes.size(); ++k) {
      const PasteOptions& paste = solid.pastes[k].options;
      const std::string place = at + "/pastes/" + std::to_string(k);
      look_at_exemplar(solid.pastes[k].thing.exemplar, place + "/exemplar");
      look_at_stroke({paste.place}, place + "/place");
      look_at_size(paste.size, place + "/size");
    }
    for (std::size_t k = 0; k < solid.scatter.size(); ++k) {
      const ScatterOptions& scatter = solid.scatter[k].options;
      const std::string place = at + "/scatter/" + std::to_string(k);
      look_at_exemplar(solid.scatter[k].thing.exemplar, place + "/exemplar");
      if (scatter.groups > 0 || std::isfinite(scatter.along[0]) || std::isfinite(scatter.along[1]))
        look_at_stroke({scatter.axis[0], scatter.axis[1]}, place + "/axis");
      look_at_size(scatter.size, place + "/size");
    }
  }

  /// Things that are larger than what they are pasted on.
  void look_at_size(double size, const std::string& where) {
    if (!surface || bounds_.empty() || !(size > bounds_.extent().maxCoeff())) return;
    add(where, fmt::format("is {:.4g} mm, more than the surface, which spans {}", size, box_text()),
        hint.empty() ? "make the thing smaller" : "is \"scale\" of the surface right? " + hint);
  }

  void look_at_triangles(const std::vector<TriangleId>& triangles, const std::string& where) {
    if (!surface) return;
    for (const TriangleId t : triangles)
      if (t.value >= surface->triangle_count()) {
        add(where, "triangle " + std::to_string(t) + " does not exist",
            "the surface has " + std::to_string(surface->triangle_count()) + " triangles, counted from 0");
        return;
      }
  }

  void look_at_exemplar(const ExemplarSource& source, const std::string& where) {
    if (source.file.empty()) return; // the parser knows the names of the generators
    const std::optional<std::filesystem::path> path = input(source.file, where + "/file");
    if (!path) return;
    try {
      read_exemplar(*path);
    } catch (const std::runtime_error& error) {
      add(where + "/file", error.what(), "give a solid texture");
    }
  }

  const Recipe& recipe_;
  std::filesystem::path folder_;
  Box bounds_;
};

} // namespace

void check_recipe(const std::filesystem::path& path, const Session& session) {
  const Recipe recipe = read_recipe(path);
  RecipeCheck check(recipe, path.parent_path());
  check.look_at_surface(session);
  check.look_at_divides();
  for (std::size_t i = 0; i < recipe.solids.size(); ++i) check.look_at_solid(i);
  check.look_at_cuts();
  check.look_at_scene();
  const bool usable = check.findings.empty();
  session.say(fmt::format("{}: surface {}, {} solid(s), {} cut(s), {} move(s): {}", path.string(),
                          surface_name(recipe.surface), recipe.solids.size(), recipe.cuts.size(), recipe.moves.size(),
                          usable ? "nothing wrong that can be seen before meshing"
                                 : fmt::format("{} finding(s)", check.findings.size())));
  for (const Finding& finding : check.findings) session.say("  " + finding.what + "; " + finding.mend);
  if (!check.note.empty()) session.say("  " + check.note);
  if (!check.hint.empty()) session.say("  " + check.hint);
  session.print({{"file", path.string()},
                 {"kind", "recipe"},
                 {"usable", usable},
                 {"findings", json_from(check.findings)},
                 {"note", check.note},
                 {"unit_hint", check.hint},
                 {"triangles", check.surface ? Json(check.surface->triangle_count()) : Json(nullptr)},
                 {"solids", recipe.solids.size()},
                 {"cuts", recipe.cuts.size()},
                 {"moves", recipe.moves.size()}});
  if (!usable) {
    const std::string& first = check.findings.front().what; // "FILE: PLACE: what"
    throw std::runtime_error(first + "; " + check.findings.front().mend);
  }
}

} // namespace pith::cli
