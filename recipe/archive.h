#pragma once
// How a stage's result becomes bytes in the cache, and back. Native byte order and layout: entries are read only by
// the very build that wrote them (code_version() is part of every key).
#include "volume/base/types.h"

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace pith {

/// Writes. `archive(value)` appends; a class says how it is written by a function `transfer(archive, value)` that
/// serves both directions.
class ArchiveWriter {
public:
  static constexpr bool reading = false;
  explicit ArchiveWriter(std::string& bytes) : bytes_(bytes) {}

  void raw(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }

private:
  std::string& bytes_;
};

/// Adds up what would be written.
class ArchiveCounter {
public:
  static constexpr bool reading = false;
  void raw(const void*, std::size_t size) { bytes += size; }
  std::size_t bytes = 0;
};

/// Reads; throws DamagedArchive when the bytes end too early.
struct DamagedArchive : std::runtime_error {
  DamagedArchive() : std::runtime_error("damaged cache entry") {}
};
class ArchiveReader {
public:
  static constexpr bool reading = true;
  explicit ArchiveReader(std::string_view bytes) : bytes_(bytes) {}

  void raw(void* data, std::size_t size) {
    if (size > bytes_.size()) throw DamagedArchive();
    std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  std::size_t left() const { return bytes_.size(); }

private:
  std::string_view bytes_;
};

template <class T>
inline constexpr bool archived_raw =
    std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, Vec3d> || std::is_same_v<T, Vec3f> ||
    std::is_same_v<T, Mat3d> || std::is_same_v<T, VertexId> || std::is_same_v<T, TetId> ||
    std::is_same_v<T, TriangleId> || std::is_same_v<T, FacetId> || std::is_same_v<T, CutId>;

template <class T>
struct IsRawArray : std::false_type {};
template <class T, std::size_t n>
struct IsRawArray<std::array<T, n>> : std::bool_constant<archived_raw<T> || IsRawArray<T>::value> {};

/// `Item` is T or const T. Numbers, ids, vectors and arrays of them go as they lie in memory.
template <class Archive, class Item>
requires(archived_raw<std::remove_const_t<Item>> ||
         IsRawArray<std::remove_const_t<Item>>::value) void transfer(Archive& archive, Item& item) {
  archive.raw(&item, sizeof item);
}

template <class Archive, class Text>
requires std::is_same_v<std::remove_const_t<Text>, std::string>
void transfer(Archive& archive, Text& text) {
  std::uint64_t size = text.size();
  archive.raw(&size, sizeof size);
  if constexpr (Archive::reading) {
    if (size > archive.left()) throw DamagedArchive();
    text.resize(size);
  }
  archive.raw(text.data(), size);
}

/// A vector of anything, and Indexed vectors.
template <class Archive, class List>
void transfer_list(Archive& archive, List& list) {
  using T = typename std::remove_const_t<List>::value_type;
  std::uint64_t size = list.size();
  archive.raw(&size, sizeof size);
  if constexpr (archived_raw<T> || IsRawArray<T>::value) {
    if constexpr (Archive::reading) {
      if (size > archive.left() / sizeof(T)) throw DamagedArchive();
      list.resize(size);
    }
    archive.raw(list.data(), size * sizeof(T));
  } else {
    if constexpr (Archive::reading) {
      if (size > archive.left()) throw DamagedArchive();
      list.resize(size);
    }
    for (auto& item : list) transfer(archive, item);
  }
}

} // namespace pith
