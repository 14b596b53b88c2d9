#include "cli/quality.h"

#include "volume/measure/copy_map.h"
#include "volume/measure/coverage.h"
#include "volume/measure/distortion.h"
#include "volume/measure/objects.h"
#include "volume/measure/seams.h"
#include "volume/measure/slice_metric.h"
#include "volume/measure/things.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace pith::cli {
namespace {

constexpr const char* class_names[] = {"across R", "across S", "across T", "oblique"};

/// What a figure should be at most (or at least).
struct Bar {
  double value = std::numeric_limits<double>::quiet_NaN();
  bool at_least = false;
  bool exists() const { return !std::isnan(value); }
  bool holds(double figure) const { return at_least ? figure >= value : figure <= value; }
};
Bar at_most(double value) { return {value, false}; }
Bar at_least(double value) { return {value, true}; }
constexpr double as_itself = 1.3; // a relative distance: at 1 like one half of the exemplar to the other

class Figures {
public:
  explicit Figures(const Session& session) : session_(session) {}

  void section(const std::string& layer, const std::string& what) {
    layer_ = layer;
    session_.say(fmt::format("  {}{}", what, layer.empty() ? "" : " (layer " + layer + ")"));
  }
  void add(const std::string& measure, double value, const std::string& unit = "", const Bar& bar = {},
           const std::string& note = "") {
    Json entry = {{"measure", measure}, {"layer", layer_}};
    entry["value"] = std::isfinite(value) ? Json(value) : Json(nullptr);
    if (!unit.empty()) entry["unit"] = unit;
    std::string line = fmt::format("    {:<58} {:>10.4g}{}", measure, value, unit.empty() ? "" : " " + unit);
    if (bar.exists()) {
      entry["bar"] = bar.value;
      entry["holds"] = bar.holds(value);
      line += fmt::format("  [{} {:g}{}]", bar.at_least ? "≥" : "≤", bar.value, bar.holds(value) ? "" : ": missed");
    }
    if (!note.empty()) {
      entry["note"] = note;
      line += "  " + note;
    }
    session_.say(line);
    list_.push_back(std::move(entry));
  }
  void add(const std::string& measure, const Spread& spread, const std::string& unit = "", const Bar& median = {},
           const Bar& p95 = {}) {
    add(measure + ", median", spread.median, unit, median);
    add(measure + ", 95th percentile", spread.p95, unit, p95);
  }
  void add_distances(const std::string& what, const TextureDistance& relative, const TextureDistance* raw) {
    const auto note = [&](double value) { return raw ? fmt::format("({:.4f})", value) : std::string(); };
    add(what + ": coherence", relative.coherence, "×", at_most(as_itself), note(raw ? raw->coherence : 0));
    add(what + ": completeness", relative.completeness, "×", at_most(as_itself), note(raw ? raw->completeness : 0));
    add(what + ": sliced Wasserstein", relative.wasserstein, "×", at_most(as_itself),
        note(raw ? raw->wasserstein : 0));
    add(what + ": colour", relative.color, "×", at_most(as_itself), note(raw ? raw->color : 0));
    add(what + ": autocorrelation", relative.autocorrelation, "×", at_most(as_itself),
        note(raw ? raw->autocorrelation : 0));
  }
  Json take() { return std::move(list_); }

private:
  const Session& session_;
  std::string layer_;
  Json list_ = Json::array();
};

std::string text_of(const Vec3d& v) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x(), v.y(), v.z()); }

/// Small solids pasted each as it is, which alone make a layer sparse: they have one frame each, follow no field and
/// do not tile, so that frames, copies and slices say nothing of them.
bool holds_things(const Layer& layer) { return !layer.simplex.empty(); }

/// What the recipe says of a region's solid that the measures need.
struct SolidFacts {
  std::string type;
  std::vector<Vec3d> core; ///< the stroke of depth 1
};
SolidFacts facts_of(const std::string& recipe, std::int32_t region) {
  SolidFacts facts;
  const Json document = Json::parse(recipe, nullptr, false);
  if (!document.is_object() || !document.contains("solids") || !document["solids"].is_array()) return facts;
  for (const Json& solid : document["solids"]) {
    if (!solid.is_object() || solid.value("region", 0) != region) continue;
    facts.type = solid.value("type", "");
    if (!solid.contains("depth") || !solid["depth"].is_array()) continue;
    for (const Json& place : solid["depth"]) {
      if (!place.is_object() || !place.contains("stroke") || place.value("value", 0.0) != 1.0) continue;
      for (const Json& p : place["stroke"])
        if (p.is_array() && p.size() == 3) facts.core.emplace_back(p[0], p[1], p[2]);
      return facts;
    }
  }
  return facts;
}

/// The axes that a type of Takayama 2008 (§3) imposes; all where the type is not known.
std::array<bool, 3> imposed_axes(const std::string& type) {
  if (type == "0") return {false, false, false};
  if (type == "1-a") return {false, false, true};
  if (type == "1-b") return {false, true, false};
  return {true, true, true};
}

void add_coverage(const Root& root, const Session& session, Figures& figures) {
  figures.section("", "coverage");
  const CoverageMeasure c = coverage_measure(
      root, {.points = 1'000'000, .seed = session.seed.value_or(1), .region = -1}, session.progress("coverage"));
  const double points = std::max<double>(1, static_cast<double>(c.points));
  figures.add("points that more than 1/255 shines through", 100.0 * static_cast<double>(c.thin) / points, "%",
              at_most(0),
              c.thin > 0 ? "worst " + fmt::format("{:.4f} at ", c.least_coverage) + text_of(c.worst) : "");
  figures.add("points that more than 2 % shines through", 100.0 * static_cast<double>(c.holes) / points, "%",
              at_most(0));
  figures.add("masked look-ups per point, median", c.median_layers);
  figures.add("masked look-ups per point, 99th percentile", c.p99_layers, "", at_most(25));
  figures.add("masked look-ups per point, most", c.most_layers);
  figures.add("exemplar reads per point, median", c.median_reads);
  figures.add("exemplar reads per point, 99th percentile", c.p99_reads);
}

void add_things(const Root& root, const Layer& layer, const Session& session, Figures& figures) {
  const auto m = thing_measure(root, layer, {.seed = session.seed.value_or(1)}, session.progress("things"));
  if (!m) return;
  figures.section(layer.name, "things");
  const std::size_t inside = m->things - m->cut_by_skin;
  figures.add("things that are whole", 100 * m->whole_share(), "%", at_least(95),
              fmt::format("{} of {}", m->whole, inside) +
                  (m->whole < inside ? fmt::format(": {} sliced, {} hidden, {} bent; the first near {}", m->sliced,
                                                   m->hidden, m->bent, text_of(m->first_broken))
                                     : ""));
  figures.add("missing part of a thing", m->missing);
  figures.add("missing part of the worst thing", m->worst);
  figures.add("things cut by the skin", static_cast<double>(m->cut_by_skin));
}

void add_fast(const Root& root, const Layer& layer, const SolidFacts& facts, const Session& session,
              Figures& figures) {
  const Model& model = root.model();
  figures.section(layer.name, "pastes");
  const MaskUse use = mask_use(model.mesh, layer);
  figures.add("pastes", static_cast<double>(layer.patch.size()));
  if (use.patches > 0) {
    figures.add("used share of a mask (on kept look-ups), median", use.median_on_tets, "", at_least(0.7));
    figures.add("seen share of a mask, median", use.median_seen);
    figures.add("seen share of a mask, 5th percentile", use.p5_seen);
  }
  if (holds_things(layer)) {
    add_things(root, layer, session, figures);
    return;
  }
  if (const auto d = distortion_measure(model, layer)) {
    figures.section(layer.name, "maps against the fields, away from singular places");
    const std::array<bool, 3> imposed = imposed_axes(facts.type);
    for (int k = 0; k < 3; ++k) {
      const std::string axis(1, "RST"[k]);
      if (imposed[k]) figures.add("angle of axis " + axis, d->axis_angle[k], "°");
      figures.add("scale along " + axis, {std::exp2(d->axis_scale[k].median), std::exp2(d->axis_scale[k].p95)}, "×");
    }
    figures.add("angle between texture axes off 90°", d->angle, "°");
    if (imposed == std::array{true, true, true}) figures.add("‖J·[R S T] − I‖", d->departure);
    figures.add("symmetric Dirichlet energy (1: isometric)", d->symmetric_dirichlet);
    figures.add("change of volume", {std::exp2(d->volume.median), std::exp2(d->volume.p95)}, "×");
    figures.add("inverted look-ups away from singular places", static_cast<double>(d->inverted_regular), "",
                at_most(0), d->inverted_regular > 0 ? "the first near " + text_of(d->first_inverted) : "");
    figures.add("inverted look-ups in all", static_cast<double>(d->inverted), "", {},
                fmt::format("of {}", layer.lookup.size()));
    figures.add("volume that shows inverted look-ups", 100 * d->inverted_seen_share, "%");
    figures.add("volume with a singular frame", 100 * d->singular_share, "%");
  }
  figures.section(layer.name, "copies");
  // Three sections through the middle of the region.
  Box box;
  for (const TetId t : all_ids<TetId>(model.mesh.tet_count()))
    if (layer.region < 0 || model.mesh.region[t] == layer.region)
      for (const VertexId v : model.mesh.corner[t]) box.add(model.mesh.position[v]);
  const double pitch = box.extent().maxCoeff() / 200;
  std::vector<Slice> sections;
  for (int axis = 0; axis < 3; ++axis)
    sections.push_back(model_slice(root, framed_grid(box, Vec3d::Unit(axis), box.center()[axis], pitch),
                                   {.region = layer.region, .footprint = 0, .sources = true}));
  const CoherentRegions regions = coherent_regions(model, sections, pitch * pitch);
  figures.add("coherent regions in three sections", static_cast<double>(regions.regions));
  figures.add("area of the region that a point lies in", regions.typical_area, "widths²");
  figures.add("area of the largest region", regions.largest_area, "widths²");
  const SourceUse sources = source_use(model, layer);
  figures.add("entropy of the uses of the exemplar's cells (1: even)", sources.entropy);
  figures.add("cells never used", 100 * sources.never_used, "%");
  figures.add("uses of the most used cells (99th percentile)", sources.most_used, "× mean");
}

void add_slow(const Root& root, const Layer& layer, const SolidFacts& facts, const Session& session,
              Figures& figures) {
  if (root.model().field.scale.empty()) return;
  figures.section(layer.name, "things of the exemplar");
  if (const auto rule = object_rule_of(layer.exemplar.front())) {
    if (const auto o = object_measure(root, layer, *rule, {}, session.progress("objects"))) {
      figures.add(
          "whole things", 100 * o->whole_share(), "%", at_least(99),
          fmt::format("of {}: {} too small, {} too large, {} misshapen{}; sRGB ({:.0f}, {:.0f}, {:.0f}) ± {:.0f}",
                      o->objects, o->too_small, o->too_large, o->misshapen,
                      o->whole < o->objects ? " (the first near " + text_of(o->first_broken) + ")" : "",
                      255 * rule->color[0], 255 * rule->color[1], 255 * rule->color[2], 255 * rule->tolerance));
      figures.add("median volume of things", o->median_volume, "× the exemplar's");
    }
  } else {
    session.say("    the exemplar shows no things of one colour and about one size");
  }

  SliceMetricOptions options;
  options.window.seed = session.seed.value_or(1);
  std::array<SliceMetric, 4> metric;
  std::vector<Slice> windows;
  for (std::size_t k = 0; k < slice_classes.size(); ++k) {
    session.stop_if_asked();
    WindowSets sets = windows_of(root, layer, slice_classes[k], options.window,
                                 session.progress(std::string("slices ") + class_names[k]));
    metric[k] = slice_metric(sets, options);
    windows.insert(windows.end(), std::make_move_iterator(sets.model.begin()),
                   std::make_move_iterator(sets.model.end()));
  }
  figures.section(layer.name, "seams");
  const SeamMeasure seams = seam_measure(windows);
  figures.add("pixels where patches mix", 100 * seams.border_share, "%");
  figures.add("99th percentile of the gradient across borders ÷ interiors", seams.border_gradient_p99, "×",
              at_most(1.1));
  figures.add("mean gradient where patches mix ÷ interiors", seams.band_gradient, "×", at_least(0.9));
  figures.add("variance where patches mix ÷ interiors", seams.band_variance, "×", at_least(0.9));

  figures.section(layer.name, "slices against the exemplar (1: as one half of it to the other)");
  for (std::size_t k = 0; k < slice_classes.size(); ++k) {
    if (metric[k].distance.patches == 0 || metric[k].relative.patches == 0) continue;
    figures.add_distances(class_names[k], metric[k].relative, &metric[k].distance);
  }
  if (facts.core.empty()) return;
  session.stop_if_asked();
  if (const auto near = near_axis_measure(root, layer, facts.core, options)) {
    figures.section(layer.name, fmt::format("within {:.3g} mm of the core ÷ elsewhere", near->reach));
    figures.add_distances("near the core", near->ratio, nullptr);
  }
}

} // namespace

Json quality_of(ModelFile file, const Session& session) {
  const std::string recipe = std::move(file.recipe);
  const Root root(std::move(file.model), {.mips = false});
  Figures figures(session);
  add_coverage(root, session, figures);
  for (const auto part : {0, 1})
    for (const Layer& layer : root.model().layer) {
      session.stop_if_asked();
      // Nothing is to be measured of what one colour fills.
      if (layer.domain != Domain::solid || layer.width != 3 || layer.exemplar.front().texel_count() < 2) continue;
      const SolidFacts facts = facts_of(recipe, std::max(layer.region, 0));
      if (part == 0) {
        add_fast(root, layer, facts, session, figures);
      } else {
        if (!holds_things(layer)) add_slow(root, layer, facts, session, figures);
      }
    }
  return figures.take();
}

} // namespace pith::cli
