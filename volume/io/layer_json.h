#pragma once
// Inside volume/io: what exemplars, masks and layers are, without their arrays, as JSON. Reading throws InvalidInput
// with the place (`where`: a file) and what does not fit.
#include "volume/layer/layer.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace pith {

nlohmann::json json_of(const Exemplar& exemplar);
nlohmann::json json_of(const Mask& mask);
/// Counts besides what the layer is, so that a summary needs no arrays; not its exemplars and masks.
nlohmann::json json_of(const Layer& layer);

Exemplar exemplar_of(const nlohmann::json& json, const std::string& where);
Mask mask_of(const nlohmann::json& json, const std::string& where);
Layer layer_of(const nlohmann::json& json, const std::string& where);

/// Members of a JSON object, checked: each throws InvalidInput that names `key` when it is missing, of another type
/// or out of range.
const nlohmann::json& member(const nlohmann::json& json, const char* key, const std::string& where);
std::int64_t integer(const nlohmann::json& json, const char* key, std::int64_t low, std::int64_t high,
                     const std::string& where);
std::string text(const nlohmann::json& json, const char* key, const std::string& where);
bool flag(const nlohmann::json& json, const char* key, const std::string& where);
double number(const nlohmann::json& json, const char* key, const std::string& where);
/// An array of `count` entries (any number where 0).
const nlohmann::json& list(const nlohmann::json& json, const char* key, std::size_t count, const std::string& where);

[[noreturn]] void refuse_json(const std::string& where, const std::string& what);

} // namespace pith
