// The format is NumPy's own description, NEP 1 (versions 1.0, 2.0) and its extension 3.0: the magic "\x93NUMPY", two
// version bytes, the length of the header (2 bytes in 1.0, 4 after), a Python dictionary in text, then the numbers.
#include "volume/io/npy.h"

#include "volume/base/error.h"
#include "volume/io/atomic_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

namespace pith {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr const char* mend = "save it again with numpy.save";

std::size_t product(std::span<const std::size_t> shape) {
  std::size_t count = 1;
  for (const std::size_t n : shape) count *= n;
  return count;
}

/// The small part of Python's literals that a header is made of: one dictionary of strings, a flag and a tuple.
class HeaderText {
public:
  HeaderText(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(name_, what, mend); }

  bool take(char c) {
    while (!text_.empty() && (text_[0] == ' ' || text_[0] == '\n' || text_[0] == '\t')) text_.remove_prefix(1);
    if (text_.empty() || text_[0] != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!take(c)) fail(std::string("the array's header has no '") + c + "' where one belongs");
  }
  std::string_view quoted() {
    const char quote = take('\'') ? '\'' : '"';
    if (quote == '"') expect('"');
    const std::size_t end = text_.find(quote);
    if (end == text_.npos) fail("the array's header ends inside a word");
    const std::string_view word = text_.substr(0, end);
    text_.remove_prefix(end + 1);
    return word;
  }
  bool flag() {
    take(' ');
    for (const bool value : {true, false}) {
      const std::string_view word = value ? "True" : "False";
      if (text_.starts_with(word)) {
        text_.remove_prefix(word.size());
        return value;
      }
    }
    fail("the array's header has no True or False where one belongs");
  }
  std::vector<std::size_t> tuple() {
    std::vector<std::size_t> value;
    expect('(');
    while (!take(')')) {
      if (value.size() == 8) fail("the array has more than 8 axes");
      take(' ');
      std::size_t number = 0;
      const auto [next, error] = std::from_chars(text_.data(), text_.data() + text_.size(), number);
      if (error != std::errc()) fail("the array's shape is not made of whole numbers");
      text_.remove_prefix(static_cast<std::size_t>(next - text_.data()));
      if (!text_.empty() && text_[0] == 'L') text_.remove_prefix(1); // Python 2
      value.push_back(number);
      if (!take(',')) {
        expect(')');
        break;
      }
    }
    return value;
  }

private:
  std::string_view text_;
  const std::string& name_;
};

void set_type(NpyHeader& header, std::string_view descr, const HeaderText& text) {
  const std::string quoted = "'" + std::string(descr) + "'";
  if (descr.size() != 3 || std::string_view("<>|=").find(descr[0]) == std::string_view::npos)
    text.fail("its numbers are of type " + quoted + ", where float32, float64, uint8, int32 and the like are read");
  constexpr std::array<std::pair<std::string_view, NpyType>, 7> known = {{{"f4", NpyType::f4},
                                                                          {"f8", NpyType::f8},
                                                                          {"u1", NpyType::u1},
                                                                          {"u4", NpyType::u4},
                                                                          {"u8", NpyType::u8},
                                                                          {"i4", NpyType::i4},
                                                                          {"i8", NpyType::i8}}};
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const auto& entry) { return entry.first == descr.substr(1); });
  if (found == known.end())
    text.fail("its numbers are of type " + quoted + ", where float32, float64, uint8, int32 and the like are read");
  header.type = found->second;
  header.swapped = descr[0] == '>' && bytes_of(header.type) > 1;
}

void swap_bytes(std::vector<std::byte>& data, std::size_t width) {
  for (std::size_t i = 0; i + width <= data.size(); i += width) std::reverse(&data[i], &data[i] + width);
}

template <class T>
void append_as_double(const NpyArray& array, std::vector<double>& values) {
  T number;
  for (std::size_t i = 0; i < array.data.size(); i += sizeof(T)) {
    std::memcpy(&number, &array.data[i], sizeof(T));
    values.push_back(static_cast<double>(number));
  }
}

} // namespace

std::size_t bytes_of(NpyType type) {
  switch (type) {
  case NpyType::u1:
    return 1;
  case NpyType::f4:
  case NpyType::u4:
  case NpyType::i4:
    return 4;
  case NpyType::f8:
  case NpyType::u8:
  case NpyType::i8:
    return 8;
  }
  return 0;
}

std::string name_of(NpyType type) {
  switch (type) {
  case NpyType::f4:
    return "float32";
  case NpyType::f8:
    return "float64";
  case NpyType::u1:
    return "uint8";
  case NpyType::u4:
    return "uint32";
  case NpyType::u8:
    return "uint64";
  case NpyType::i4:
    return "int32";
  case NpyType::i8:
    return "int64";
  }
  return {};
}

std::size_t NpyHeader::value_count() const { return product(shape); }
std::size_t NpyArray::value_count() const { return product(shape); }

std::string npy_header_bytes(NpyType type, std::span<const std::size_t> shape) {
  constexpr std::array<const char*, 7> descr = {"<f4", "<f8", "|u1", "<u4", "<u8", "<i4", "<i8"};
  std::string text = std::string("{'descr': '") + descr[std::size_t(type)] + "', 'fortran_order': False, 'shape': (";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += std::to_string(shape[i]);
    if (i + 1 < shape.size()) text += ", ";
  }
  text += shape.size() == 1 ? ",), }" : "), }";
  // The numbers begin at a multiple of 64.
  const std::size_t before = magic.size() + 4;
  text.append((64 - (before + text.size() + 1) % 64) % 64, ' ');
  text += '\n';
  std::string header(magic);
  header += '\x01';
  header += '\0';
  header += static_cast<char>(text.size() & 0xff);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

NpyHeader npy_header_of(std::string_view first_bytes, std::size_t total_bytes, const std::string& name) {
  if (!first_bytes.starts_with(magic) || first_bytes.size() < 10)
    throw InvalidInput(name, "is not a NumPy array", mend);
  const auto byte = [&](std::size_t i) { return std::size_t(static_cast<unsigned char>(first_bytes[i])); };
  const std::size_t version = byte(6);
  if (version < 1 || version > 3)
    throw InvalidInput(name, "is a NumPy array of format " + std::to_string(version) + ", where 1 to 3 are read",
                       mend);
  std::size_t begin = 10, length = byte(8) | byte(9) << 8;
  if (version > 1) {
    begin = 12;
    if (first_bytes.size() < begin) throw InvalidInput(name, "is cut off inside its header", mend);
    length |= byte(10) << 16 | byte(11) << 24;
  }
  if (length > first_bytes.size() - begin) throw InvalidInput(name, "is cut off inside its header", mend);

  NpyHeader header;
  header.data_begin = begin + length;
  HeaderText text(first_bytes.substr(begin, length), name);
  bool has_type = false, has_shape = false, has_order = false;
  text.expect('{');
  while (!text.take('}')) {
    const std::string_view key = text.quoted();
    text.expect(':');
    if (key == "descr") {
      set_type(header, text.quoted(), text);
      has_type = true;
    } else if (key == "fortran_order") {
      if (text.flag())
        throw InvalidInput(name, "is stored in Fortran order", "save numpy.ascontiguousarray of it instead");
      has_order = true;
    } else if (key == "shape") {
      header.shape = text.tuple();
      has_shape = true;
    } else {
      text.fail("the array's header has an unknown entry '" + std::string(key) + "'");
    }
    if (!text.take(',')) {
      text.expect('}');
      break;
    }
  }
  if (!has_type || !has_shape || !has_order) text.fail("the array's header is incomplete");

  // Checked by division, so that no product overflows.
  const std::size_t bytes = total_bytes - std::min(total_bytes, header.data_begin);
  const bool empty = std::find(header.shape.begin(), header.shape.end(), 0) != header.shape.end();
  std::size_t expected = bytes_of(header.type);
  for (const std::size_t n : header.shape) {
    if (!empty && n > bytes / expected) throw InvalidInput(name, "holds fewer numbers than its shape says", mend);
    expected = empty ? 0 : expected * n;
  }
  if (expected != bytes)
    throw InvalidInput(
        name, "holds " + std::to_string(bytes) + " bytes of numbers where its shape says " + std::to_string(expected),
        mend);
  return header;
}

std::size_t NpyArray::rows(std::size_t columns, const std::string& name) const {
  if (shape.size() == 2 && shape[1] == columns) return shape[0];
  std::string is;
  for (const std::size_t n : shape) is += (is.empty() ? "" : " × ") + std::to_string(n);
  throw InvalidInput(name, "has the shape " + (is.empty() ? "of a single number" : is),
                     "give an array of n × " + std::to_string(columns));
}

std::vector<double> NpyArray::as_double() const {
  std::vector<double> values;
  values.reserve(value_count());
  switch (type) {
  case NpyType::f4:
    append_as_double<float>(*this, values);
    break;
  case NpyType::f8:
    append_as_double<double>(*this, values);
    break;
  case NpyType::u1:
    append_as_double<std::uint8_t>(*this, values);
    break;
  case NpyType::u4:
    append_as_double<std::uint32_t>(*this, values);
    break;
  case NpyType::u8:
    append_as_double<std::uint64_t>(*this, values);
    break;
  case NpyType::i4:
    append_as_double<std::int32_t>(*this, values);
    break;
  case NpyType::i8:
    append_as_double<std::int64_t>(*this, values);
    break;
  }
  return values;
}

NpyArray npy_from_bytes(std::string_view bytes, const std::string& name) {
  const NpyHeader header = npy_header_of(bytes, bytes.size(), name);
  NpyArray array{header.type, header.shape, {}};
  const auto numbers = std::as_bytes(std::span(bytes.substr(header.data_begin)));
  array.data.assign(numbers.begin(), numbers.end());
  if (header.swapped) swap_bytes(array.data, bytes_of(array.type));
  return array;
}

NpyArray read_npy(const std::filesystem::path& path) { return npy_from_bytes(file_content(path), path.string()); }

std::string npy_bytes(const NpyArray& array) {
  std::string bytes = npy_header_bytes(array.type, array.shape);
  bytes.append(reinterpret_cast<const char*>(array.data.data()), array.data.size());
  return bytes;
}

void write_npy(const std::filesystem::path& path, NpyType type, std::span<const std::size_t> shape,
               std::span<const std::byte> data) {
  AtomicFile file(path);
  file.write(npy_header_bytes(type, shape));
  file.write(data.data(), data.size());
  file.commit();
}

void write_npy(const std::filesystem::path& path, const NpyArray& array) {
  write_npy(path, array.type, array.shape, array.data);
}

} // namespace pith
