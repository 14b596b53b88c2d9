#include "volume/layer/model.h"

#include "volume/base/error.h"
#include "volume/layer/composite.h"
#include "volume/layer/tables.h"

#include <algorithm>

namespace pith {

void validate(const Model& model) {
  validate(model.mesh);
  if (model.mesh.tet_count() == 0) throw InvalidInput("model '" + model.name + "'", "has no tets", "make it anew");
  const Boundary& b = model.boundary;
  const std::size_t tets = model.mesh.tet_count(), facets = b.facet_count();
  const auto refuse = [&](const std::string& what) {
    throw InvalidInput("model '" + model.name + "'", what, "make it anew");
  };
  if (b.facet_of_tet.size() != tets || b.opposite.size() != facets || b.corner.size() != facets ||
      b.behind.size() != facets || (!b.input.empty() && b.input.size() != facets))
    refuse("has a boundary that does not fit its mesh");
  for (TetId t : b.tet)
    if (t >= tets) refuse("has a boundary facet of a tet that does not exist");
  const Fields& f = model.field;
  if ((!f.depth.empty() && f.depth.size() != model.mesh.vertex_count()) ||
      (!f.axes.empty() && f.axes.size() != tets) || (!f.scale.empty() && f.scale.size() != tets) ||
      (!f.singular.empty() && f.singular.size() != tets))
    refuse("has fields that do not fit its mesh");
  for (const Layer& layer : model.layer) validate(layer, layer.domain == Domain::solid ? tets : facets);
}

namespace {

/// The union of the layers' channels, colour first, in order of appearance.
std::vector<Channel> channels_of(const Model& model) {
  std::vector<Channel> channels;
  const auto collect = [&](bool color) {
    for (const Layer& layer : model.layer)
      for (const Channel& c : layer.exemplar.front().channel) {
        if ((c.semantic == Semantic::color && c.name == "color") != color) continue;
        const auto same = std::find_if(channels.begin(), channels.end(), [&](auto& k) { return k.name == c.name; });
        if (same == channels.end()) {
          channels.push_back(c);
        } else if (same->components != c.components || same->semantic != c.semantic) {
          throw InvalidInput("layer '" + layer.name + "'",
                             "gives channel '" + c.name + "' another meaning than a layer below it",
                             "rename one of the channels");
        }
      }
  };
  collect(true);
  collect(false);
  return channels;
}

} // namespace

Root::Tables::Tables(Model given, const RootOptions& options)
    : model(std::move(given)), locator(model.mesh, model.boundary), channels(channels_of(model)) {
  std::vector<int> first; // component of each channel
  for (const Channel& c : channels) {
    first.push_back(components);
    components += c.components;
  }
  if (components > max_components)
    throw InvalidInput("model '" + model.name + "'", "has " + std::to_string(components) + " components",
                       "use at most " + std::to_string(max_components) + " over all channels");
  for (const Layer& l : model.layer) {
    LayerEntry entry{LayerReader(l, options.mips), {}, {}};
    if (!l.simplex.empty()) {
      const std::size_t simplices = l.domain == Domain::solid ? model.mesh.tet_count() : model.boundary.facet_count();
      entry.dense_begin.resize(simplices + 1);
      for (std::size_t row = 0, simplex = 0; simplex <= simplices; ++simplex) {
        entry.dense_begin[simplex] = l.begin[row];
        if (row < l.simplex.size() && l.simplex[row] == simplex) ++row;
      }
    }
    for (const Channel& c : l.exemplar.front().channel) {
      const std::size_t at =
          std::find_if(channels.begin(), channels.end(), [&](auto& k) { return k.name == c.name; }) -
          channels.begin();
      for (int k = 0; k < c.components; ++k) entry.component.push_back(first[at] + k);
    }
    layers.push_back(std::move(entry));
  }
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (channels[i].semantic == Semantic::direction || channels[i].semantic == Semantic::normal)
      directions.push_back(first[i]);
}

Root::Root(Model model, const RootOptions& options) {
  validate(model);
  tables_ = std::make_unique<const Tables>(std::move(model), options);
}
Root::~Root() = default;
Root::Root(Root&&) noexcept = default;
Root& Root::operator=(Root&&) noexcept = default;

const Model& Root::model() const { return tables_->model; }
const Locator& Root::locator() const { return tables_->locator; }
const std::vector<Channel>& Root::channels() const { return tables_->channels; }
int Root::component_count() const { return tables_->components; }

int Root::component_of(const std::string& name) const {
  int component = 0;
  for (const Channel& c : tables_->channels) {
    if (c.name == name) return component;
    component += c.components;
  }
  return -1;
}

} // namespace pith
