#include "volume/io/atomic_file.h"

#include "volume/base/error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pith {

namespace {

constexpr int attempts = 1000; // names tried beside the file; others belong to writers that were killed, or run now

} // namespace

std::string reason_and_mend(int error_number) {
  const auto mend = [&] {
    switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "free some space, or write to another disk";
    case EFBIG:
      return "raise the limit on file sizes, or write to another disk";
    case EACCES:
    case EPERM:
    case EROFS:
      return "change its permissions, or choose another place";
    case ENOENT:
    case ENOTDIR:
    case ENAMETOOLONG:
    case ELOOP:
      return "check the path";
    case EISDIR:
      return "name a file";
    case EMFILE:
    case ENFILE:
      return "close other programs, or raise the limit on open files";
    case ENOMEM:
      return "free memory";
    default:
      return "check the disk and the path";
    }
  };
  return std::string(std::strerror(error_number)) + "; " + mend();
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  const auto status = std::filesystem::status(path_, error);
  if (std::filesystem::is_directory(status)) throw IoFailure(path_.string(), "is a folder; name a file");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw IoFailure(path_.string(), "is not an ordinary file; name one");
  if (std::filesystem::is_symlink(std::filesystem::symlink_status(path_, error))) {
    const auto target = std::filesystem::weakly_canonical(path_, error);
    if (!error) path_ = target;
  }
  if (path_.filename().empty()) throw IoFailure(path_.string(), "names no file; give one");

  const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
#ifdef O_TMPFILE
  if (::access("/proc/self/fd", X_OK) == 0)
    descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor_ >= 0) return;
#endif
  make_beside([&] {
    descriptor_ = ::open(beside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return descriptor_ >= 0;
  });
}

/// Tries names until `make` succeeds with the one in beside_.
template <class Make>
void AtomicFile::make_beside(const Make& make) {
  for (int i = 0; i < attempts; ++i) {
    const std::string name =
        "." + path_.stem().string() + "." + std::to_string(::getpid()) + "-" + std::to_string(i) + ".part";
    beside_ = path_.parent_path() / (name + path_.extension().string());
    if (make()) return;
    if (errno != EEXIST) break;
  }
  const int reason = errno;
  beside_.clear();
  throw IoFailure(path_.string(), "cannot be written: " + reason_and_mend(reason));
}

const std::filesystem::path& AtomicFile::beside() {
  if (beside_.empty()) {
    const std::string unnamed = "/proc/self/fd/" + std::to_string(descriptor_);
    make_beside(
        [&] { return ::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, beside_.c_str(), AT_SYMLINK_FOLLOW) == 0; });
  }
  return beside_;
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (!beside_.empty()) ::unlink(beside_.c_str());
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  const char* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor_, at, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      throw IoFailure(path_.string(), "cannot be written: " + reason_and_mend(written < 0 ? errno : ENOSPC));
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::commit() {
  beside();
  const int closed = ::close(descriptor_);
  const int reason = errno;
  descriptor_ = -1;
  if (closed != 0) {
    ::unlink(beside_.c_str());
    throw IoFailure(path_.string(), "cannot be written: " + reason_and_mend(reason));
  }
  if (std::rename(beside_.c_str(), path_.c_str()) != 0) {
    const int refused = errno;
    ::unlink(beside_.c_str());
    throw IoFailure(path_.string(), "cannot be put in place: " + reason_and_mend(refused));
  }
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

std::string file_content(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw IoFailure(path.string(), "cannot be opened: " + reason_and_mend(errno));
  std::string content;
  struct stat about {};
  if (::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode)) content.reserve(std::size_t(about.st_size) + 1);
  std::size_t filled = 0;
  for (;;) {
    content.resize(std::max(filled + 65536, content.capacity()));
    const ssize_t got = ::read(descriptor, content.data() + filled, content.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      const int reason = errno;
      ::close(descriptor);
      throw IoFailure(path.string(), "cannot be read: " + reason_and_mend(reason));
    }
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  ::close(descriptor);
  content.resize(filled);
  return content;
}

} // namespace pith
