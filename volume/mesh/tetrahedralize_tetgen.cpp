// Starts the helper program, hands it the surface, waits for the tets. Both pass through memory files, which have no
// name and vanish with the last process that holds them.
#include "volume/mesh/tetrahedralize_tetgen.h"

#include "volume/base/error.h"
#include "volume/mesh/tetgen_helper/protocol.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

extern char** environ;

namespace pith::tetgen {
namespace {

namespace protocol = tetgen_protocol;

[[noreturn]] void fail(const std::string& doing) {
  throw IoFailure("pith-tetgen", doing + ": " + std::generic_category().message(errno) + "; free memory");
}

/// An open file, closed with its owner.
class File {
public:
  explicit File(int descriptor) : descriptor_(descriptor) {
    if (descriptor_ < 0) fail("no file to talk to the helper");
  }
  ~File() { close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  operator int() const { return descriptor_; }
  void close() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }

private:
  int descriptor_;
};

void write_whole(int file, const void* from, std::size_t bytes) {
  const char* at = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t put = ::write(file, at, bytes);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) fail("the surface cannot be handed over");
    at += put;
    bytes -= static_cast<std::size_t>(put);
  }
}

std::filesystem::path helper_path(const Settings& settings) {
  std::filesystem::path path = settings.helper;
  if (path.empty()) {
    std::error_code error;
    path = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "pith-tetgen";
  }
  if (::access(path.c_str(), X_OK) != 0)
    throw IoFailure(path.string(), "the helper program that runs TetGen is missing; install it beside pith");
  return path;
}

/// A started helper; killed and collected with its owner unless it has ended.
class Process {
public:
  Process(const std::filesystem::path& program, int in, int out, int messages) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, messages, STDERR_FILENO);
    std::string name = program.string();
    char* arguments[] = {name.data(), nullptr};
    const int error = ::posix_spawn(&id_, name.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0)
      throw IoFailure(name, "cannot be started: " + std::generic_category().message(error) +
                                "; free memory, or install pith again");
  }
  ~Process() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// The wait status; −1 when nobody can tell.
  int wait() {
    int status = -1;
    while (::waitpid(id_, &status, 0) < 0)
      if (errno != EINTR) {
        status = -1;
        break;
      }
    id_ = -1;
    return status;
  }

private:
  pid_t id_ = -1;
};

std::string first_line(std::string text) {
  text.resize(std::min(text.find('\n'), text.size()));
  if (text.size() > 160) text.resize(160);
  return text;
}

std::string failure_of(int status, const std::string& messages) {
  std::string text;
  if (status != -1 && WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const char* name = signal == SIGSEGV   ? "SIGSEGV"
                       : signal == SIGABRT ? "SIGABRT"
                       : signal == SIGKILL ? "SIGKILL"
                                           : "";
    text = "TetGen crashed with signal " + std::to_string(signal) + (*name ? std::string(" (") + name + ")" : "");
  } else if (status != -1 && WIFEXITED(status) && WEXITSTATUS(status) != protocol::done) {
    switch (WEXITSTATUS(status)) {
    case protocol::tetgen_refused:
      text = "TetGen refused the surface";
      break;
    case protocol::boundary_changed:
      text = "TetGen changed the surface";
      break;
    case protocol::no_memory:
      text = "TetGen ran out of memory";
      break;
    case protocol::bad_problem:
      text = "pith-tetgen did not understand the problem (another version of pith?)";
      break;
    case protocol::cannot_write:
      text = "pith-tetgen could not hand its result over";
      break;
    default:
      text = "TetGen gave up with code " + std::to_string(WEXITSTATUS(status));
    }
  }
  if (!text.empty() && !messages.empty()) text += ": " + first_line(messages);
  return text;
}

/// Takes the helper's messages until it ends. Returns false when the time limit has passed.
bool wait_for_end(int messages_file, std::string& messages, double time_limit, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (seconds > time_limit) return false;
    report(progress, seconds / (seconds + 5)); // nobody knows how long TetGen will take: it only ever approaches 1
    pollfd waiting = {messages_file, POLLIN, 0};
    const int left = static_cast<int>(std::min(50.0, 1000 * (time_limit - seconds))) + 1;
    if (::poll(&waiting, 1, left) <= 0) continue;
    char text[256];
    const ssize_t got = ::read(messages_file, text, sizeof text);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return true; // its end of the pipe is closed
    if (messages.size() < 4096) messages.append(text, static_cast<std::size_t>(got));
  }
}

/// The result, checked against its own length and the count of points.
void take_result(int file, Outcome& outcome) {
  struct stat facts {};
  if (::fstat(file, &facts) != 0) fail("the tets cannot be read");
  const auto bytes = static_cast<std::size_t>(facts.st_size);
  protocol::Result result;
  if (bytes < sizeof result) {
    outcome.failure = "TetGen gave no tets";
    return;
  }
  void* view = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file, 0);
  if (view == MAP_FAILED) fail("the tets cannot be read");
  const char* at = static_cast<const char*>(view);
  std::memcpy(&result, at, sizeof result);
  const bool whole = result.mark == protocol::result_mark && result.points <= bytes / 24 &&
                     result.tets <= bytes / 16 && bytes == sizeof result + 24 * result.points + 16 * result.tets;
  if (!whole)
    outcome.failure = "TetGen's result is cut short";
  else if (result.tets == 0)
    outcome.failure = "TetGen gave no tets";
  if (outcome.failure.empty()) {
    at += sizeof result;
    const std::size_t given = outcome.position.size();
    outcome.position.resize(given + result.points);
    if (result.points > 0) std::memcpy(outcome.position[VertexId(given)].data(), at, 24 * result.points);
    at += 24 * result.points;
    outcome.corner.resize(result.tets);
    static_assert(sizeof(outcome.corner[TetId(0u)]) == 16 && sizeof(Vec3d) == 24);
    std::memcpy(outcome.corner.data()->data(), at, 16 * result.tets);
    for (const auto& corner : outcome.corner)
      for (const VertexId v : corner)
        if (v.value >= outcome.position.size()) outcome.failure = "TetGen named a vertex that is not there";
  }
  ::munmap(view, bytes);
}

} // namespace

Outcome run(const TriMesh& surface, const Settings& settings, const Progress& progress,
            const std::function<bool()>& meanwhile) {
  const std::filesystem::path helper = helper_path(settings);
  File in(::memfd_create("pith-tetgen-problem", MFD_CLOEXEC)), out(::memfd_create("pith-tetgen-result", MFD_CLOEXEC));
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail("no pipe to the helper");
  File messages(ends[0]), messages_of_helper(ends[1]);

  protocol::Problem problem;
  problem.points = surface.vertex_count();
  problem.triangles = surface.triangle_count();
  problem.max_volume = settings.max_volume;
  problem.radius_edge = settings.radius_edge;
  if (settings.max_volume > 0) problem.core_segments = settings.core.size();
  problem.core_edge = settings.core_edge;
  problem.core_growth = settings.core_growth;
  static_assert(sizeof(surface.corner[TriangleId(0u)]) == 12);
  write_whole(in, &problem, sizeof problem);
  write_whole(in, surface.position.data(), 24 * surface.vertex_count());
  write_whole(in, surface.corner.data(), 12 * surface.triangle_count());
  static_assert(sizeof(settings.core[0]) == 48);
  write_whole(in, settings.core.data(), 48 * problem.core_segments);
  if (::lseek(in, 0, SEEK_SET) != 0) fail("the surface cannot be handed over");

  Process process(helper, in, out, messages_of_helper);
  messages_of_helper.close();
  Outcome outcome;
  if (meanwhile && !meanwhile()) {
    outcome.failure = "stopped";
    outcome.stopped = true;
    return outcome;
  }
  std::string said;
  if (!wait_for_end(messages, said, settings.time_limit, progress)) {
    outcome.failure = "TetGen did not end within " + std::to_string(static_cast<long>(settings.time_limit)) + " s";
    return outcome;
  }
  outcome.failure = failure_of(process.wait(), said);
  if (!outcome.failure.empty()) return outcome;
  outcome.position.assign(surface.position.begin(), surface.position.end());
  take_result(out, outcome);
  return outcome;
}

} // namespace pith::tetgen
