#pragma once
// Where results of stages are kept: in memory for this process, and in a folder for the next ones.
#include "recipe/key.h"

#include <any>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <optional>

namespace pith {

/// A folder of checked entries under a byte budget. Safe under kill and under several processes at once: entries are
/// written beside and renamed, carry a hash of their bytes, and one that is damaged counts as absent and is removed.
/// Nothing here is an error: a folder that cannot be written or read behaves like an empty one.
class DiskCache {
public:
  /// An empty folder name turns it off.
  DiskCache(std::filesystem::path folder, std::uint64_t budget_bytes);
  bool on() const { return !folder_.empty(); }

  std::optional<std::string> load(const Key& key) const; ///< also marks the entry as recently used
  bool holds(const Key& key) const;                      ///< without reading it
  void store(const Key& key, std::string_view bytes) const;
  void remove(const Key& key) const;

private:
  void evict() const;
  std::filesystem::path entry(const Key& key) const;
  std::filesystem::path folder_;
  std::uint64_t budget_;
};

/// $XDG_CACHE_HOME/pith, or ~/.cache/pith; empty when neither is known.
std::filesystem::path default_cache_folder();

/// Results in memory, least recently used first out.
class MemoryCache {
public:
  explicit MemoryCache(std::uint64_t budget_bytes) : budget_(budget_bytes) {}

  template <class T>
  std::shared_ptr<const T> load(const Key& key) {
    const auto found = entries_.find(key);
    if (found == entries_.end()) return nullptr;
    order_.splice(order_.end(), order_, found->second.place);
    const auto* value = std::any_cast<std::shared_ptr<const T>>(&found->second.value);
    return value ? *value : nullptr;
  }
  template <class T>
  void store(const Key& key, std::shared_ptr<const T> value, std::uint64_t bytes) {
    insert(key, std::any(std::move(value)), bytes);
  }
  bool holds(const Key& key) const { return entries_.count(key) > 0; }

private:
  void insert(const Key& key, std::any value, std::uint64_t bytes);
  struct Entry {
    std::any value;
    std::uint64_t bytes = 0;
    std::list<Key>::iterator place;
  };
  std::map<Key, Entry> entries_;
  std::list<Key> order_; ///< least recently used first
  std::uint64_t budget_, used_ = 0;
};

} // namespace pith
