#pragma once
// Arrays in NumPy's .npy format (versions 1.0 to 3.0): points, samples, and the arrays inside a .pith file.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pith {

/// The types of numbers that are read and written; all little-endian in memory (big-endian files are swapped).
enum class NpyType : std::uint8_t { f4, f8, u1, u4, u8, i4, i8 };

std::size_t bytes_of(NpyType type);
/// "float32", "uint8" ...: NumPy's names.
std::string name_of(NpyType type);

template <class T>
struct NpyTypeOf;
template <>
struct NpyTypeOf<float> {
  static constexpr NpyType type = NpyType::f4;
};
template <>
struct NpyTypeOf<double> {
  static constexpr NpyType type = NpyType::f8;
};
template <>
struct NpyTypeOf<std::uint8_t> {
  static constexpr NpyType type = NpyType::u1;
};
template <>
struct NpyTypeOf<std::uint32_t> {
  static constexpr NpyType type = NpyType::u4;
};
template <>
struct NpyTypeOf<std::uint64_t> {
  static constexpr NpyType type = NpyType::u8;
};
template <>
struct NpyTypeOf<std::int32_t> {
  static constexpr NpyType type = NpyType::i4;
};
template <>
struct NpyTypeOf<std::int64_t> {
  static constexpr NpyType type = NpyType::i8;
};

/// What the header of an array says. C order: the last axis is the fastest.
struct NpyHeader {
  NpyType type = NpyType::f4;
  std::vector<std::size_t> shape;
  bool swapped = false;       ///< stored big-endian
  std::size_t data_begin = 0; ///< bytes before the numbers

  std::size_t value_count() const; ///< product of the shape
};

/// The bytes before the numbers of a C-order array (format 1.0, padded to 64 bytes as NumPy does).
std::string npy_header_bytes(NpyType type, std::span<const std::size_t> shape);

/// Reads a header from the first bytes of an array that is `total_bytes` long. Errors: InvalidInput, with `name`,
/// when it is not an .npy array, is of another type (complex, text, objects), in Fortran order, or longer or shorter
/// than its shape says.
NpyHeader npy_header_of(std::string_view first_bytes, std::size_t total_bytes, const std::string& name);

/// An array of any of the types.
struct NpyArray {
  NpyType type = NpyType::f4;
  std::vector<std::size_t> shape;
  std::vector<std::byte> data;

  std::size_t value_count() const;
  /// Rows of an n × `columns` array; InvalidInput, naming `name`, when it has another shape.
  std::size_t rows(std::size_t columns, const std::string& name) const;
  /// The numbers, converted where they have another type.
  std::vector<double> as_double() const;
};

/// Copies `values` (as many as the shape says) into an array.
template <class T>
NpyArray npy_array(std::span<const T> values, std::vector<std::size_t> shape) {
  const auto bytes = std::as_bytes(values);
  return {NpyTypeOf<T>::type, std::move(shape), {bytes.begin(), bytes.end()}};
}

/// Errors as npy_header_of, and IoFailure when the file cannot be opened.
NpyArray read_npy(const std::filesystem::path& path);
NpyArray npy_from_bytes(std::string_view bytes, const std::string& name);

/// The file appears whole or not at all.
void write_npy(const std::filesystem::path& path, const NpyArray& array);
std::string npy_bytes(const NpyArray& array);

/// Writes numbers without a copy of them: `write_npy<float>(path, values, {n, 4})`.
void write_npy(const std::filesystem::path& path, NpyType type, std::span<const std::size_t> shape,
               std::span<const std::byte> data);
template <class T>
void write_npy(const std::filesystem::path& path, std::span<const T> values, const std::vector<std::size_t>& shape) {
  write_npy(path, NpyTypeOf<T>::type, shape, std::as_bytes(values));
}

} // namespace pith
