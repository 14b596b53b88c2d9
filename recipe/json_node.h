#pragma once
// A place in a JSON document, read strictly: every wrong type, missing or unknown key and number out of range becomes
// an InvalidInput that names the place. Only this module's parsers include it.
#include "volume/base/types.h"

#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pith {

/// Which numbers are allowed; `words` says so in messages ("positive"), `mend` what to give instead.
struct NumberRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above_low = false; ///< low itself is not allowed
  const char* words = "finite";
  const char* mend = "give a number";
};

namespace range {
inline constexpr NumberRange any{};
/// Products of coordinates must stay within what doubles hold.
inline constexpr NumberRange coordinate{-1e12, 1e12, false, "between -1e12 and 1e12", "give millimetres"};
inline constexpr NumberRange positive_mm{0, std::numeric_limits<double>::infinity(), true, "positive",
                                         "give millimetres"};
inline constexpr NumberRange mm{0, std::numeric_limits<double>::infinity(), false, "0 or more", "give millimetres"};
inline constexpr NumberRange positive{0, std::numeric_limits<double>::infinity(), true, "positive",
                                      "give a number above 0"};
inline constexpr NumberRange fraction{0, 1, false, "between 0 and 1", "give a fraction"};
} // namespace range

/// Parses text into a JSON value; refuses repeated keys. Errors: InvalidInput with line and column.
nlohmann::json json_of(const std::string& text, const std::string& file);

/// The text as UTF-8 without control characters: what is neither becomes '_'. For names that come from files.
std::string plain_text(const std::string& text);

/// One value of a document and where it stands. Refers to the document: keep that alive.
class JsonNode {
public:
  JsonNode(const nlohmann::json& value, std::string file, std::string path = "")
      : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

  /// "kiwi.json: /solids/0"
  std::string where() const;
  [[noreturn]] void fail(const std::string& what, const std::string& mend) const;

  /// Refuses anything but an object whose keys are all among `known`.
  const JsonNode& object(std::initializer_list<const char*> known) const;
  bool has(const char* key) const;
  JsonNode at(const char* key) const;                  ///< required
  std::optional<JsonNode> find(const char* key) const; ///< optional
  bool is_object() const { return value_->is_object(); }
  bool is_array() const { return value_->is_array(); }

  double number(const NumberRange& range = range::any) const;
  std::int64_t whole(std::int64_t low, std::int64_t high, const char* mend) const;
  std::uint64_t seed() const;
  bool boolean() const;
  std::string text() const;                                           ///< not empty
  std::size_t choice(std::initializer_list<const char*> names) const; ///< index of the name that stands here
  Vec3d vector3() const;
  Vec2d vector2() const;
  std::vector<JsonNode> items(std::size_t at_least, const char* mend) const;
  std::vector<Vec3d> points(std::size_t at_least, const char* mend) const;

  /// Overwrites `into` when the key is there.
  void optional_number(const char* key, double& into, const NumberRange& range) const;
  void optional_seed(const char* key, std::uint64_t& into) const;
  void optional_whole(const char* key, int& into, std::int64_t low, std::int64_t high, const char* mend) const;

private:
  std::string shown() const;
  const nlohmann::json* value_;
  std::string file_, path_;
};

} // namespace pith
