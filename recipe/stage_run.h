#pragma once
// The stages of one build: results from memory, from disk or computed, and a report of each (private to the recipe
// module).
#include "recipe/build.h"
#include "recipe/stage_codec.h"
#include "volume/base/error.h"

#include <algorithm>
#include <chrono>

namespace pith {

/// One build: fetches results from the caches, computes what is missing, keeps the books.
class StageRun {
public:
  StageRun(const BuildOptions& options, MemoryCache& memory, DiskCache& disk, const BuildProgress& progress)
      : options_(options), memory_(memory), disk_(disk), progress_(progress) {}

  KeyMaker key(const char* stage) const {
    KeyMaker maker(options_.code);
    maker.add(stage);
    return maker;
  }

  /// Announces a stage; reports come in the order of these calls, whichever way the results are fetched.
  void announce(const std::string& name, const Key& key) { reports_.push_back({name, key.text(), 0, true}); }

  /// The result of a stage from memory, from disk, or computed.
  template <class T, class Compute>
  std::shared_ptr<const T> result(const std::string& name, const Key& key, bool on_disk, const Compute& compute) {
    tell(name, 0);
    const auto start = std::chrono::steady_clock::now();
    bool cached = true;
    std::shared_ptr<const T> value = memory_.load<T>(key);
    if (!value && on_disk) value = from_disk<T>(key);
    if (!value) {
      cached = false;
      const double inner_before = inner_seconds_;
      value = std::make_shared<const T>(
          compute([&](double fraction) { return !progress_ || progress_(name, fraction); }));
      finish(name, start, inner_seconds_ - inner_before, cached);
      remember(key, value, on_disk);
    } else {
      finish(name, start, 0, cached);
    }
    tell(name, 1);
    return value;
  }

  std::vector<StageReport> reports() const { return reports_; }

private:
  void tell(const std::string& name, double fraction) {
    if (progress_ && !progress_(name, fraction)) throw Cancelled();
  }

  void finish(const std::string& name, std::chrono::steady_clock::time_point start, double inner, bool cached) {
    const double all = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto report =
        std::find_if(reports_.begin(), reports_.end(), [&](const StageReport& r) { return r.name == name; });
    report->seconds = all - inner;
    report->cached = cached;
    inner_seconds_ += all - inner; // stages that were fetched while this one ran count for themselves
  }

  template <class T>
  std::shared_ptr<const T> from_disk(const Key& key) {
    const std::optional<std::string> bytes = disk_.load(key);
    if (!bytes) return nullptr;
    try {
      auto value = std::make_shared<T>();
      ArchiveReader reader(*bytes);
      transfer(reader, *value);
      if (reader.left() != 0) throw DamagedArchive();
      std::shared_ptr<const T> result = std::move(value);
      memory_.store(key, result, bytes->size());
      return result;
    } catch (const DamagedArchive&) {
      disk_.remove(key);
      return nullptr;
    }
  }

  template <class T>
  void remember(const Key& key, const std::shared_ptr<const T>& value, bool on_disk) {
    ArchiveCounter counter;
    transfer(counter, *value);
    memory_.store(key, value, counter.bytes);
    if (!on_disk || !disk_.on()) return;
    std::string bytes;
    bytes.reserve(counter.bytes);
    ArchiveWriter writer(bytes);
    transfer(writer, *value);
    disk_.store(key, bytes);
  }

  const BuildOptions& options_;
  MemoryCache& memory_;
  DiskCache& disk_;
  const BuildProgress& progress_;
  std::vector<StageReport> reports_;
  double inner_seconds_ = 0;
};

} // namespace pith
