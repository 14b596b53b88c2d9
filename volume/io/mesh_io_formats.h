#pragma once
// Inside volume/io: one reader per mesh format over a file in memory, and the cursor that the text formats share.
#include "volume/base/error.h"
#include "volume/mesh/tri_mesh.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

namespace pith::mesh_format {

// Each takes the whole file and the name for messages. They throw InvalidInput; indices come out in range.
TriMesh read_obj(std::string_view text, const std::string& name);
TriMesh read_off(std::string_view text, const std::string& name);
TriMesh read_ply(std::string_view bytes, const std::string& name);
TriMesh read_stl(std::string_view bytes, const std::string& name);

// Each returns the whole file.
std::string obj_text(const TriMesh& mesh);
std::string off_text(const TriMesh& mesh);
std::string ply_bytes(const TriMesh& mesh);
std::string stl_bytes(const TriMesh& mesh);

/// Walks over text, counts lines, and reads numbers alike in every locale.
class TextCursor {
public:
  TextCursor(std::string_view text, const std::string& name)
      : at_(text.data()), end_(at_ + text.size()), name_(name) {}

  [[noreturn]] void fail(const std::string& what, const std::string& mend = "export the mesh again") const {
    throw InvalidInput(name_ + ", line " + std::to_string(line_), what, mend);
  }

  bool at_end() const { return at_ == end_; }
  bool at_line_end() const { return at_ == end_ || *at_ == '\n' || *at_ == '\r'; }
  bool at_space() const { return at_ != end_ && (*at_ == ' ' || *at_ == '\t'); }
  bool at(char c) const { return at_ != end_ && *at_ == c; }
  std::size_t line() const { return line_; }

  /// Spaces and tabs; a backslash at the end of a line continues it.
  void skip_spaces() {
    for (;;) {
      while (at_ != end_ && (*at_ == ' ' || *at_ == '\t')) ++at_;
      if (at_ == end_ || *at_ != '\\') return;
      const char* next = at_ + 1;
      if (next != end_ && *next == '\r') ++next;
      if (next == end_ || *next != '\n') return;
      at_ = next + 1;
      ++line_;
    }
  }
  /// The rest of the line and its end: "\n", "\r\n" or "\r".
  void skip_line() {
    while (!at_line_end()) ++at_;
    if (at_ == end_) return;
    if (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
    ++at_;
    ++line_;
  }
  /// Spaces, empty lines and comments that start with '#'.
  void skip_blank() {
    for (;;) {
      while (at_ != end_ && (*at_ == ' ' || *at_ == '\t')) ++at_;
      if (at_ == end_ || (*at_ != '#' && !at_line_end())) return;
      skip_line();
    }
  }
  /// The word at the cursor, up to white space; empty at the end of the line.
  std::string_view word() {
    skip_spaces();
    const char* first = at_;
    while (!at_line_end() && *at_ != ' ' && *at_ != '\t') ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }
  /// Passes over what follows the cursor without a space.
  void skip_attached() {
    while (!at_line_end() && *at_ != ' ' && *at_ != '\t') ++at_;
  }
  /// What is left of the line, without the spaces around it.
  std::string_view rest_of_line() {
    skip_spaces();
    const char* first = at_;
    while (!at_line_end()) ++at_;
    const char* last = at_;
    while (last != first && (last[-1] == ' ' || last[-1] == '\t')) --last;
    return {first, static_cast<std::size_t>(last - first)};
  }
  bool take(char c) {
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  /// A finite number on this line.
  double number(const char* what) {
    skip_spaces();
    if (at_ != end_ && *at_ == '+') ++at_;
    double value = 0;
    const auto [next, error] = std::from_chars(at_, end_, value);
    if (error == std::errc::result_out_of_range) { // too small is zero, too large is not finite
      const std::string_view digits(at_, static_cast<std::size_t>(next - at_));
      if (digits.find("e-") == digits.npos && digits.find("E-") == digits.npos)
        fail(std::string(what) + " is not finite");
      value = 0;
    } else if (error != std::errc()) {
      fail("there is no number where " + std::string(what) + " belongs");
    }
    if (!std::isfinite(value)) fail(std::string(what) + " is not finite");
    at_ = next;
    return value;
  }
  /// An integer on this line.
  std::int64_t integer(const char* what) {
    skip_spaces();
    if (at_ != end_ && *at_ == '+') ++at_;
    std::int64_t value = 0;
    const auto [next, error] = std::from_chars(at_, end_, value);
    if (error != std::errc()) fail("there is no whole number where " + std::string(what) + " belongs");
    at_ = next;
    return value;
  }

private:
  const char* at_;
  const char* end_;
  std::size_t line_ = 1;
  std::string name_;
};

/// Some editors put a mark of three bytes before UTF-8 text.
inline std::string_view without_byte_order_mark(std::string_view text) {
  return text.substr(0, 3) == "\xef\xbb\xbf" ? text.substr(3) : text;
}

/// Throws InvalidInput where a text format holds bytes that no text has near its beginning.
inline void refuse_binary(std::string_view text, const std::string& name, const char* kind) {
  for (const char c : text.substr(0, 65536)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 32 && byte != '\t' && byte != '\n' && byte != '\r' && byte != '\f' && byte != '\v')
      throw InvalidInput(name, "holds binary data, not text",
                         std::string("this is not ") + kind + ": check its extension, or export the mesh again");
  }
}

/// Reads a number stored little- or big-endian; the caller has checked that it lies in the file.
template <class T>
T stored(const char* at, bool big_endian) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// Appends the triangles of a polygon as a fan around its first corner.
inline void add_fan(TriMesh& mesh, const std::vector<VertexId>& polygon) {
  for (std::size_t i = 2; i < polygon.size(); ++i) mesh.corner.push_back({polygon[0], polygon[i - 1], polygon[i]});
}

} // namespace pith::mesh_format
