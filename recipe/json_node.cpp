#include "recipe/json_node.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace pith {
namespace {

using nlohmann::json;

/// Number of single letters to insert, delete or change between two words (Levenshtein).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row[b.size()];
}

/// What to do about an unknown word: the nearest known one, or all of them.
std::string suggestion(const std::string& word, std::initializer_list<const char*> known, const char* kind) {
  const char* best = nullptr;
  std::size_t least = 1 + word.size() / 3 + 1;
  for (const char* candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) least = distance, best = candidate;
  }
  if (best) return std::string("did you mean \"") + best + "\"?";
  std::string all;
  for (const char* candidate : known) all += (all.empty() ? "" : ", ") + std::string(candidate);
  return std::string("known ") + kind + ": " + all;
}

const char* type_words(const json& value) {
  switch (value.type()) {
  case json::value_t::null:
    return "null";
  case json::value_t::object:
    return "an object";
  case json::value_t::array:
    return "a list";
  case json::value_t::string:
    return "a text";
  case json::value_t::boolean:
    return "true or false";
  default:
    return "a number";
  }
}

/// Line and column (from 1) of a byte in a text.
std::string line_and_column(const std::string& text, std::size_t byte) {
  std::size_t line = 1, column = 1;
  for (std::size_t i = 0; i < std::min(byte, text.size()); ++i) {
    if (text[i] == '\n')
      ++line, column = 1;
    else
      ++column;
  }
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// JSON pointers write ~ and / inside keys as ~0 and ~1 (RFC 6901); control characters would break the one line.
std::string escaped(const std::string& key) {
  std::string result;
  for (const char c : key.substr(0, 60)) {
    if (c == '~')
      result += "~0";
    else if (c == '/')
      result += "~1";
    else
      result += static_cast<unsigned char>(c) < 32 ? '?' : c;
  }
  return result;
}

} // namespace

json json_of(const std::string& text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InvalidInput(file, "is empty", "write a JSON object (docs/recipe.md)");
  constexpr int deepest = 64;
  std::vector<std::set<std::string>> open_keys;
  const auto refuse_repeated_keys = [&](int depth, json::parse_event_t event, json& parsed) {
    if (depth > deepest) throw InvalidInput(file, "is nested more than 64 deep", "give a recipe (docs/recipe.md)");
    if (event == json::parse_event_t::object_start) open_keys.emplace_back();
    if (event == json::parse_event_t::object_end) open_keys.pop_back();
    if (event == json::parse_event_t::key && !open_keys.back().insert(parsed.get<std::string>()).second)
      throw InvalidInput(file, "key \"" + escaped(parsed.get<std::string>()) + "\" appears twice in one object",
                         "keep one of them");
    return true;
  };
  try {
    return json::parse(text, refuse_repeated_keys);
  } catch (const json::parse_error& error) {
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
    const bool ended = byte >= text.size();
    throw InvalidInput(
        file, "is not JSON: " + std::string(ended ? "it ends too early, at " : "") + line_and_column(text, byte),
        ended ? "the file seems truncated" : "mend the text there (a comma, a quote, a bracket?)");
  } catch (const json::out_of_range&) {
    throw InvalidInput(file, "holds a number too large for a double", "give finite numbers");
  }
}

std::string plain_text(const std::string& text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const unsigned first = byte(i), second = byte(i + 1);
    std::size_t length = first < 0x80                    ? 1
                         : first >= 0xc2 && first < 0xe0 ? 2
                         : first >= 0xe0 && first < 0xf0 ? 3
                         : first >= 0xf0 && first < 0xf5 ? 4
                                                         : 0;
    for (std::size_t k = 1; k < length; ++k)
      if ((byte(i + k) & 0xc0u) != 0x80u) length = 0;
    // Longer forms than needed, surrogates, and what lies beyond Unicode (RFC 3629).
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) || (first == 0xf0 && second < 0x90) ||
        (first == 0xf4 && second > 0x8f))
      length = 0;
    if (length == 1 && (first < 32 || first == 127)) length = 0;
    if (length == 0)
      result += '_';
    else
      result += text.substr(i, length);
    i += std::max<std::size_t>(1, length);
  }
  return result;
}

std::string JsonNode::where() const { return path_.empty() ? file_ : file_ + ": " + path_; }

void JsonNode::fail(const std::string& what, const std::string& mend) const {
  throw InvalidInput(where(), what, mend);
}

std::string JsonNode::shown() const {
  if (value_->is_number() || value_->is_string()) {
    const std::string text = value_->dump(-1, ' ', true);
    return text.size() <= 40 ? text : text.substr(0, 37) + "...";
  }
  return type_words(*value_);
}

const JsonNode& JsonNode::object(std::initializer_list<const char*> known) const {
  if (!value_->is_object()) fail("is " + shown() + ", must be an object", "write { ... }");
  for (const auto& entry : value_->items()) {
    const bool listed = std::any_of(known.begin(), known.end(), [&](const char* k) { return entry.key() == k; });
    if (!listed)
      throw InvalidInput(file_ + ": " + path_ + "/" + escaped(entry.key()), "is not a known key",
                         suggestion(entry.key(), known, "keys"));
  }
  return *this;
}

bool JsonNode::has(const char* key) const { return value_->contains(key); }

JsonNode JsonNode::at(const char* key) const {
  const auto found = value_->find(key);
  if (found == value_->end()) fail(std::string("lacks \"") + key + "\"", "add it (docs/recipe.md)");
  return {*found, file_, path_ + "/" + key};
}

std::optional<JsonNode> JsonNode::find(const char* key) const {
  if (!has(key)) return std::nullopt;
  return at(key);
}

double JsonNode::number(const NumberRange& range) const {
  if (!value_->is_number()) fail("is " + shown() + ", must be a number", range.mend);
  const double x = value_->get<double>();
  const bool allowed = std::isfinite(x) && x <= range.high && (range.above_low ? x > range.low : x >= range.low);
  if (!allowed) fail("is " + shown() + ", must be " + range.words, range.mend);
  return x;
}

std::int64_t JsonNode::whole(std::int64_t low, std::int64_t high, const char* mend) const {
  if (!value_->is_number()) fail("is " + shown() + ", must be a whole number", mend);
  const double x = value_->get<double>();
  if (x != std::floor(x)) fail("is " + shown() + ", must be a whole number", mend);
  if (x < static_cast<double>(low) || x > static_cast<double>(high))
    fail("is " + shown() + ", must be " + std::to_string(low) + " to " + std::to_string(high), mend);
  return static_cast<std::int64_t>(x);
}

std::uint64_t JsonNode::seed() const {
  if (!value_->is_number_unsigned())
    fail("is " + shown() + ", must be a whole number of 0 or more", "give a seed such as 1");
  return value_->get<std::uint64_t>();
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) fail("is " + shown() + ", must be true or false", "write true or false without quotes");
  return value_->get<bool>();
}

std::string JsonNode::text() const {
  if (!value_->is_string()) fail("is " + shown() + ", must be a text", "write it in quotes");
  std::string text = value_->get<std::string>();
  if (text.empty()) fail("is empty", "write something between the quotes");
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 32) fail("holds a control character", "write plain text on one line");
  return text;
}

std::size_t JsonNode::choice(std::initializer_list<const char*> names) const {
  const std::string given = text();
  const auto found = std::find(names.begin(), names.end(), given);
  if (found == names.end()) fail("is " + shown() + ", which is not known", suggestion(given, names, "values"));
  return static_cast<std::size_t>(found - names.begin());
}

Vec3d JsonNode::vector3() const {
  if (!value_->is_array() || value_->size() != 3) fail("is " + shown() + ", must be [x, y, z]", "give three numbers");
  Vec3d result;
  for (int axis = 0; axis < 3; ++axis)
    result[axis] = JsonNode((*value_)[axis], file_, path_ + "/" + std::to_string(axis)).number(range::coordinate);
  return result;
}

Vec2d JsonNode::vector2() const {
  if (!value_->is_array() || value_->size() != 2) fail("is " + shown() + ", must be [u, v]", "give two numbers");
  Vec2d result;
  for (int axis = 0; axis < 2; ++axis)
    result[axis] = JsonNode((*value_)[axis], file_, path_ + "/" + std::to_string(axis)).number(range::coordinate);
  return result;
}

std::vector<JsonNode> JsonNode::items(std::size_t at_least, const char* mend) const {
  if (!value_->is_array()) fail("is " + shown() + ", must be a list", "write [ ... ]");
  if (value_->size() < at_least)
    fail("has " + std::to_string(value_->size()) + " entries, needs " + std::to_string(at_least) + " or more", mend);
  std::vector<JsonNode> result;
  for (std::size_t i = 0; i < value_->size(); ++i)
    result.emplace_back((*value_)[i], file_, path_ + "/" + std::to_string(i));
  return result;
}

std::vector<Vec3d> JsonNode::points(std::size_t at_least, const char* mend) const {
  std::vector<Vec3d> result;
  for (const JsonNode& point : items(at_least, mend)) result.push_back(point.vector3());
  return result;
}

void JsonNode::optional_number(const char* key, double& into, const NumberRange& range) const {
  if (const auto node = find(key)) into = node->number(range);
}

void JsonNode::optional_seed(const char* key, std::uint64_t& into) const {
  if (const auto node = find(key)) into = node->seed();
}

void JsonNode::optional_whole(const char* key, int& into, std::int64_t low, std::int64_t high,
                              const char* mend) const {
  if (const auto node = find(key)) into = static_cast<int>(node->whole(low, high, mend));
}

} // namespace pith
