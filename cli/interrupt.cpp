// Ctrl-C without a signal handler: the signals are blocked in all threads, and one thread waits for them.
#include "cli/command.h"

#include <atomic>
#include <csignal>
#include <ctime>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace pith::cli {
namespace {

constexpr int exit_cancelled = 130; ///< as shells report a program that Ctrl-C ended
constexpr int patience_seconds = 20;

sigset_t watched_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

} // namespace

struct Interrupt::Watcher {
  std::atomic<bool> asked{false}, over{false};
  std::thread thread;

  void watch() {
    const sigset_t set = watched_signals();
    const timespec tick{0, 50'000'000};
    int waited = 0;
    while (!over) {
      const bool signalled = sigtimedwait(&set, nullptr, &tick) > 0;
      if (asked && (signalled || ++waited > patience_seconds * 20)) ::_exit(exit_cancelled);
      if (signalled) asked = true;
    }
  }
};

Interrupt::Interrupt() : watcher_(std::make_unique<Watcher>()) {
  const sigset_t set = watched_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  try {
    watcher_->thread = std::thread([watcher = watcher_.get()] { watcher->watch(); });
  } catch (const std::system_error&) { // no thread to be had: Ctrl-C then ends the program at once
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  }
}

Interrupt::~Interrupt() {
  // Wakes the watcher by a signal of its own, sooner than the next tick would.
  if (!watcher_->thread.joinable()) return;
  const bool asked = watcher_->asked.exchange(false);
  watcher_->over = true;
  pthread_kill(watcher_->thread.native_handle(), SIGTERM);
  watcher_->thread.join();
  watcher_->asked = asked;
}

bool Interrupt::asked() const { return watcher_->asked; }

} // namespace pith::cli
