#pragma once
// Inside volume/io: zips of texts and .npy arrays, written with fixed times, read with their CRCs checked.
#include "volume/base/error.h"
#include "volume/base/large_array.h"
#include "volume/io/npy.h"

#include <cstring>
#include <deque>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pith {

/// The shape of n rows of a type that holds nothing but T: n, n × columns, or n × 3 × 3 for matrices.
template <class T, class Row>
std::vector<std::size_t> row_shape(std::size_t n) {
  constexpr std::size_t columns = sizeof(Row) / sizeof(T);
  if constexpr (columns == 1) return {n};
  if constexpr (columns == 9) return {n, 3, 3};
  return {n, columns};
}

/// How an entry lies in the zip. Deflating random-looking numbers costs 50 ms for each MB and saves little, so only
/// what is mostly repetition is packed.
enum class Packing { stored, deflated };

/// Gathers entries; nothing is written before `write`. Array data is not copied: it must live until then.
class ZipWriter {
public:
  void add_text(const std::string& name, std::string text);
  /// `name` without ".npy".
  template <class T>
  void add_array(const std::string& name, std::span<const T> values, std::vector<std::size_t> shape,
                 Packing packing = Packing::stored) {
    add_bytes(name + ".npy", npy_header_bytes(NpyTypeOf<T>::type, shape), std::as_bytes(values), packing);
  }
  /// One row per element of a vector, of a type that holds nothing but T.
  template <class T, class Rows>
  void add_rows(const std::string& name, const Rows& row, Packing packing = Packing::stored) {
    using Row = typename Rows::value_type;
    static_assert(sizeof(Row) % sizeof(T) == 0);
    add_array<T>(name, {reinterpret_cast<const T*>(row.data()), row.size() * (sizeof(Row) / sizeof(T))},
                 row_shape<T, Row>(row.size()), packing);
  }
  /// Bytes of all entries before packing.
  std::size_t total_bytes() const;
  /// The file appears whole or not at all. IoFailure.
  void write(const std::filesystem::path& path) const;

private:
  struct Entry {
    std::string name, head;
    std::span<const std::byte> data;
    Packing packing;
  };
  void add_bytes(const std::string& name, std::string head, std::span<const std::byte> data, Packing packing);
  std::vector<Entry> entry_;
};

/// Opens a zip. All errors that the content of the file can cause are InvalidInput with its path and `mend`.
class ZipReader {
public:
  /// `kind` stands in messages: ".pith file". IoFailure when the file cannot be opened.
  ZipReader(const std::filesystem::path& path, std::string kind, std::string mend);
  ~ZipReader();

  bool has(const std::string& name) const;
  /// The file's size on disk.
  std::size_t file_bytes() const { return file_bytes_; }
  std::string text(const std::string& name) const;
  [[noreturn]] void fail(const std::string& what) const;

  /// An array of T, checked against `shape`; `any` there matches every length. `name` without ".npy".
  static constexpr std::size_t any = ~std::size_t(0);
  template <class T>
  LargeArray<T> array(const std::string& name, std::vector<std::size_t> shape) const {
    std::string first;
    const NpyHeader header = open_array(name, NpyTypeOf<T>::type, shape, first);
    LargeArray<T> values(header.value_count());
    read_numbers(name, header, first, std::as_writable_bytes(std::span(values)));
    return values;
  }
  /// The same, put into rows of a type that holds nothing but T: array<std::array<VertexId, 4>>, Vec3d ...
  template <class T, class Rows>
  void rows(const std::string& name, Rows& row) const {
    using Row = typename Rows::value_type;
    static_assert(sizeof(Row) % sizeof(T) == 0);
    const std::vector<std::size_t> shape = row_shape<T, Row>(any);
    std::string first;
    const NpyHeader header = open_array(name, NpyTypeOf<T>::type, shape, first);
    row.resize(header.shape[0]);
    read_numbers(name, header, first, {reinterpret_cast<std::byte*>(row.data()), row.size() * sizeof(Row)});
  }

private:
  struct Handle;
  NpyHeader open_array(const std::string& name, NpyType type, const std::vector<std::size_t>& shape,
                       std::string& first) const;
  void read_numbers(const std::string& name, const NpyHeader& header, std::string& first,
                    std::span<std::byte> into) const;
  std::size_t size_of(const std::string& name) const;
  void open(const std::string& name) const;
  std::size_t read(const std::string& name, void* into, std::size_t bytes) const;
  void close_at_end(const std::string& name) const;

  std::string path_, kind_, mend_;
  std::size_t file_bytes_ = 0;
  std::unique_ptr<Handle> handle_;
};

} // namespace pith
