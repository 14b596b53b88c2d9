#include "recipe/cache.h"

#include "volume/base/error.h"
#include "volume/io/atomic_file.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace pith {
namespace fs = std::filesystem;
namespace {

constexpr char magic[] = "pith stage 1\n";
constexpr std::size_t magic_size = sizeof magic - 1;
constexpr std::size_t header_size = magic_size + 8 + 16; ///< magic, payload bytes, payload key
constexpr char extension[] = ".stage";

} // namespace

fs::path default_cache_folder() {
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder == '/') return fs::path(folder) / "pith";
  if (const char* home = std::getenv("HOME"); home && *home == '/') return fs::path(home) / ".cache" / "pith";
  return {};
}

DiskCache::DiskCache(fs::path folder, std::uint64_t budget_bytes)
    : folder_(std::move(folder)), budget_(budget_bytes) {
  if (folder_.empty()) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_, error)) folder_.clear();
}

fs::path DiskCache::entry(const Key& key) const { return folder_ / (key.text() + extension); }

bool DiskCache::holds(const Key& key) const {
  std::error_code error;
  return on() && fs::is_regular_file(entry(key), error);
}

std::optional<std::string> DiskCache::load(const Key& key) const {
  if (!holds(key)) return std::nullopt;
  try {
    std::string bytes = file_content(entry(key));
    std::uint64_t size = 0;
    Key expected;
    const bool headed = bytes.size() >= header_size && std::memcmp(bytes.data(), magic, magic_size) == 0;
    if (headed) {
      std::memcpy(&size, bytes.data() + magic_size, 8);
      std::memcpy(&expected.high, bytes.data() + magic_size + 8, 8);
      std::memcpy(&expected.low, bytes.data() + magic_size + 16, 8);
    }
    if (!headed || size != bytes.size() - header_size ||
        key_of(std::string_view(bytes).substr(header_size)) != expected) {
      remove(key);
      return std::nullopt;
    }
    std::error_code error;
    fs::last_write_time(entry(key), fs::file_time_type::clock::now(), error);
    bytes.erase(0, header_size);
    return bytes;
  } catch (const IoFailure&) {
    return std::nullopt; // removed by somebody else meanwhile, or not readable
  }
}

void DiskCache::store(const Key& key, std::string_view bytes) const {
  if (!on() || bytes.size() > budget_) return;
  try {
    AtomicFile file(entry(key));
    const std::uint64_t size = bytes.size();
    const Key content = key_of(bytes);
    file.write(magic, magic_size);
    file.write(&size, 8);
    file.write(&content.high, 8);
    file.write(&content.low, 8);
    file.write(bytes);
    file.commit();
  } catch (const IoFailure&) {
    return; // a full or read-only disk: work goes on without the cache
  }
  evict();
}

void DiskCache::remove(const Key& key) const {
  std::error_code error;
  if (on()) fs::remove(entry(key), error);
}

void DiskCache::evict() const {
  struct Found {
    fs::file_time_type time;
    std::string name;
    std::uint64_t bytes;
  };
  std::vector<Found> found;
  std::uint64_t total = 0;
  std::error_code error;
  const auto stale = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    std::error_code gone;
    const std::uint64_t bytes = at->file_size(gone);
    const auto time = at->last_write_time(gone);
    if (gone || !at->is_regular_file(gone)) continue;
    const std::string name = at->path().filename().string();
    if (name.front() == '.') { // what a killed process left behind
      if (time < stale) fs::remove(at->path(), gone);
      continue;
    }
    if (at->path().extension() != extension) continue;
    found.push_back({time, name, bytes});
    total += bytes;
  }
  if (total <= budget_) return;
  std::sort(found.begin(), found.end(),
            [](const Found& a, const Found& b) { return a.time != b.time ? a.time < b.time : a.name < b.name; });
  for (const Found& oldest : found) {
    if (total <= budget_ - budget_ / 10) break;
    fs::remove(folder_ / oldest.name, error);
    total -= oldest.bytes;
  }
}

void MemoryCache::insert(const Key& key, std::any value, std::uint64_t bytes) {
  if (const auto old = entries_.find(key); old != entries_.end()) {
    used_ -= old->second.bytes;
    order_.erase(old->second.place);
    entries_.erase(old);
  }
  if (bytes > budget_) return;
  order_.push_back(key);
  entries_[key] = {std::move(value), bytes, std::prev(order_.end())};
  used_ += bytes;
  while (used_ > budget_) {
    const auto oldest = entries_.find(order_.front());
    used_ -= oldest->second.bytes;
    entries_.erase(oldest);
    order_.pop_front();
  }
}

} // namespace pith
