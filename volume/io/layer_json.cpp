#include "volume/io/layer_json.h"

#include "volume/base/error.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace pith {

using nlohmann::json;

namespace {

constexpr std::int64_t most = 0x7fffffff;

template <class Enum, std::size_t n>
using Names = std::array<std::pair<Enum, const char*>, n>;

constexpr Names<Wrap, 3> wrap_names = {{{Wrap::clamp, "clamp"}, {Wrap::repeat, "repeat"}, {Wrap::mirror, "mirror"}}};
constexpr Names<Semantic, 5> semantic_names = {{{Semantic::color, "color"},
                                                {Semantic::scalar, "scalar"},
                                                {Semantic::height, "height"},
                                                {Semantic::direction, "direction"},
                                                {Semantic::normal, "normal"}}};
constexpr Names<Domain, 2> domain_names = {{{Domain::solid, "solid"}, {Domain::skin, "skin"}}};
constexpr Names<Blend::Select, 3> select_names = {
    {{Blend::Select::none, "none"}, {Blend::Select::max, "max"}, {Blend::Select::min, "min"}}};
constexpr Names<Blend::Mix, 4> mix_names = {{{Blend::Mix::over, "over"},
                                             {Blend::Mix::weighted, "weighted"},
                                             {Blend::Mix::linear, "linear"},
                                             {Blend::Mix::histogram, "histogram"}}};

template <class Enum, std::size_t n>
std::string name_in(const Names<Enum, n>& names, Enum value) {
  for (const auto& [known, name] : names)
    if (known == value) return name;
  return names[0].second;
}

template <class Enum, std::size_t n>
Enum value_in(const Names<Enum, n>& names, const json& name, const char* key, const std::string& where) {
  if (name.is_string())
    for (const auto& [value, known] : names)
      if (name.get_ref<const std::string&>() == known) return value;
  refuse_json(where, std::string("has an unknown value of ") + key);
}

json json_of(const AxisMap& map) { return {{"scale", map.scale}, {"offset", map.offset}}; }

AxisMap axis_map_of(const json& value, const std::string& where) {
  AxisMap map;
  for (const auto& [key, numbers] : {std::pair{"scale", &map.scale}, {"offset", &map.offset}}) {
    const json& row = list(value, key, 4, where);
    for (int i = 0; i < 4; ++i) {
      if (!row[i].is_number()) refuse_json(where, std::string("has no four numbers in ") + key);
      (*numbers)[i] = static_cast<float>(row[i].get<double>());
    }
  }
  return map;
}

template <std::size_t n>
std::array<int, n> sizes_of(const json& value, const std::string& where) {
  std::array<int, n> size;
  const json& row = list(value, "size", n, where);
  for (std::size_t i = 0; i < n; ++i) {
    if (!row[i].is_number_integer() || row[i].get<double>() < 1 || row[i].get<double>() > 65536)
      refuse_json(where, "has a size that is not between 1 and 65536");
    size[i] = row[i].get<int>();
  }
  return size;
}

} // namespace

void refuse_json(const std::string& where, const std::string& what) {
  throw InvalidInput(where, what, "make the file again");
}

const json& member(const json& value, const char* key, const std::string& where) {
  if (!value.is_object()) refuse_json(where, std::string("has no object around ") + key);
  const auto found = value.find(key);
  if (found == value.end()) refuse_json(where, std::string("has no ") + key);
  return *found;
}

std::int64_t integer(const json& value, const char* key, std::int64_t low, std::int64_t high,
                     const std::string& where) {
  const json& entry = member(value, key, where);
  const bool in_range =
      entry.is_number_unsigned()
          ? entry.get<std::uint64_t>() <= std::uint64_t(std::max<std::int64_t>(high, 0)) &&
                std::int64_t(entry.get<std::uint64_t>()) >= low
          : entry.is_number_integer() && entry.get<std::int64_t>() >= low && entry.get<std::int64_t>() <= high;
  if (!in_range)
    refuse_json(where, std::string("has a ") + key + " that is not a whole number from " + std::to_string(low) +
                           " to " + std::to_string(high));
  return entry.get<std::int64_t>();
}

std::string text(const json& value, const char* key, const std::string& where) {
  const json& entry = member(value, key, where);
  if (!entry.is_string()) refuse_json(where, std::string("has a ") + key + " that is not a text");
  return entry.get<std::string>();
}

bool flag(const json& value, const char* key, const std::string& where) {
  const json& entry = member(value, key, where);
  if (!entry.is_boolean()) refuse_json(where, std::string("has a ") + key + " that is not true or false");
  return entry.get<bool>();
}

double number(const json& value, const char* key, const std::string& where) {
  const json& entry = member(value, key, where);
  if (!entry.is_number() || !std::isfinite(entry.get<double>()))
    refuse_json(where, std::string("has a ") + key + " that is not a number");
  return entry.get<double>();
}

const json& list(const json& value, const char* key, std::size_t count, const std::string& where) {
  const json& entry = member(value, key, where);
  if (!entry.is_array() || (count > 0 && entry.size() != count))
    refuse_json(where, std::string("has a ") + key + " that is not a list" +
                           (count > 0 ? " of " + std::to_string(count) : std::string()));
  return entry;
}

json json_of(const Exemplar& exemplar) {
  json wrap = json::array(), channels = json::array();
  for (const Wrap w : exemplar.wrap) wrap.push_back(name_in(wrap_names, w));
  for (const Channel& channel : exemplar.channel)
    channels.push_back({{"name", channel.name},
                        {"semantic", name_in(semantic_names, channel.semantic)},
                        {"components", channel.components},
                        {"srgb", channel.srgb},
                        {"low", channel.low},
                        {"high", channel.high}});
  return {{"name", exemplar.name},
          {"axes", exemplar.axes},
          {"size", exemplar.size},
          {"wrap", wrap},
          {"channels", channels}};
}

Exemplar exemplar_of(const json& value, const std::string& where) {
  Exemplar exemplar;
  exemplar.name = text(value, "name", where);
  exemplar.axes = static_cast<int>(integer(value, "axes", 2, 4, where));
  exemplar.size = sizes_of<4>(value, where);
  const json& wrap = list(value, "wrap", 4, where);
  for (int i = 0; i < 4; ++i) exemplar.wrap[i] = value_in(wrap_names, wrap[i], "wrap", where);
  for (const json& entry : list(value, "channels", 0, where)) {
    Channel channel;
    channel.name = text(entry, "name", where);
    channel.semantic = value_in(semantic_names, member(entry, "semantic", where), "semantic", where);
    channel.components = static_cast<int>(integer(entry, "components", 1, max_components, where));
    channel.srgb = flag(entry, "srgb", where);
    channel.low = static_cast<float>(number(entry, "low", where));
    channel.high = static_cast<float>(number(entry, "high", where));
    exemplar.channel.push_back(std::move(channel));
  }
  if (exemplar.component_count() < 1 || exemplar.component_count() > max_components)
    refuse_json(where,
                "has an exemplar without, or with more than " + std::to_string(max_components) + ", components");
  return exemplar;
}

json json_of(const Mask& mask) { return {{"axes", mask.axes}, {"size", mask.size}, {"open", mask.open}}; }

Mask mask_of(const json& value, const std::string& where) {
  Mask mask;
  mask.axes = static_cast<int>(integer(value, "axes", 2, 3, where));
  mask.size = sizes_of<3>(value, where);
  const json& open = list(value, "open", 3, where);
  for (int i = 0; i < 3; ++i) {
    if (!open[i].is_boolean()) refuse_json(where, "has a mask whose open is not made of true and false");
    mask.open[i] = open[i].get<bool>();
  }
  return mask;
}

json json_of(const Layer& layer) {
  return {{"name", layer.name},
          {"domain", name_in(domain_names, layer.domain)},
          {"region", layer.region},
          {"width", layer.width},
          {"blend",
           {{"select", name_in(select_names, layer.blend.select)},
            {"grace", layer.blend.grace},
            {"mix", name_in(mix_names, layer.blend.mix)},
            {"mean_over", layer.blend.mean_over},
            {"correlation", layer.blend.correlation}}},
          {"evaluation", json_of(layer.evaluation)},
          {"sparse", !layer.simplex.empty()},
          {"patches", layer.patch.size()},
          {"lookups", layer.lookup.size()},
          {"corners", layer.corner_count()}};
}

Layer layer_of(const json& value, const std::string& where) {
  Layer layer;
  layer.name = text(value, "name", where);
  layer.domain = value_in(domain_names, member(value, "domain", where), "domain", where);
  layer.region = static_cast<std::int32_t>(integer(value, "region", -1, most, where));
  layer.width = static_cast<int>(integer(value, "width", 2, 4, where));
  const json& blend = member(value, "blend", where);
  layer.blend.select = value_in(select_names, member(blend, "select", where), "select", where);
  layer.blend.grace = static_cast<float>(number(blend, "grace", where));
  layer.blend.mix = value_in(mix_names, member(blend, "mix", where), "mix", where);
  if (blend.contains("mean_over")) { // without: none
    const json& over = list(blend, "mean_over", 4, where);
    for (int i = 0; i < 4; ++i) {
      if (!over[i].is_boolean()) refuse_json(where, "has a mean_over that is not made of true and false");
      layer.blend.mean_over[i] = over[i].get<bool>();
    }
    layer.blend.correlation = static_cast<float>(number(blend, "correlation", where));
  }
  layer.evaluation = axis_map_of(member(value, "evaluation", where), where);
  return layer;
}

} // namespace pith
