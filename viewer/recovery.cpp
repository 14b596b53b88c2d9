#include "viewer/recovery.h"

#include "volume/base/error.h"
#include "volume/io/atomic_file.h"

#include <algorithm>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

namespace pith {
namespace fs = std::filesystem;

struct RecoveryFile::Parts {
  fs::path folder, path, lock_path;
  int lock = -1;
};

namespace {

/// A lock that goes with the process, on a file beside the recovery file (that one is replaced at every edit).
int locked(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor);
    return -1;
  }
  return descriptor;
}

} // namespace

RecoveryFile::RecoveryFile(fs::path folder) : parts_(std::make_unique<Parts>()) {
  parts_->folder = std::move(folder);
}

RecoveryFile::~RecoveryFile() {
  forget();
  if (parts_->lock < 0) return;
  std::error_code ignored;
  fs::remove(parts_->lock_path, ignored);
  ::close(parts_->lock);
}

void RecoveryFile::keep(const fs::path& file, const fs::path& folder, const std::string& recipe) {
  if (parts_->folder.empty()) return;
  std::error_code failed;
  fs::create_directories(parts_->folder, failed);
  for (int i = 0; parts_->lock < 0 && i < 1000; ++i) {
    const std::string name = "window-" + std::to_string(::getpid()) + "-" + std::to_string(i);
    if (fs::exists(parts_->folder / (name + ".json"), failed)) continue;
    parts_->path = parts_->folder / (name + ".json");
    parts_->lock_path = parts_->folder / (name + ".lock");
    parts_->lock = locked(parts_->lock_path);
    if (parts_->lock < 0 && errno != EWOULDBLOCK) return;
  }
  try {
    write_file(
        parts_->path,
        nlohmann::ordered_json{{"file", file.string()}, {"folder", folder.string()}, {"recipe", recipe}}.dump());
  } catch (const IoFailure&) { // a full disk must not stop the work itself
  }
}

void RecoveryFile::forget() {
  std::error_code ignored;
  if (!parts_->path.empty()) fs::remove(parts_->path, ignored);
}

std::vector<Recovered> recoverable(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, Recovered>> found;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    if (entry.path().extension() != ".json") continue;
    fs::path lock_path = entry.path();
    const int lock = locked(lock_path.replace_extension(".lock"));
    if (lock < 0) continue; // somebody is working on it
    ::close(lock);
    try {
      const auto json = nlohmann::json::parse(file_content(entry.path()));
      found.push_back({entry.last_write_time(),
                       {entry.path(), json.at("file").get<std::string>(), json.at("folder").get<std::string>(),
                        json.at("recipe").get<std::string>()}});
    } catch (const std::exception&) {
    }
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Recovered> result;
  for (auto& [time, one] : found) result.push_back(std::move(one));
  return result;
}

} // namespace pith
