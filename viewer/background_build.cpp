#include "viewer/background_build.h"

#include "volume/base/error.h"

namespace pith {

BackgroundBuild::BackgroundBuild(BuildOptions options) : builder_(std::move(options)), thread_([this] { work(); }) {}

BackgroundBuild::~BackgroundBuild() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = cancel_ = true;
    next_.reset();
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundBuild::start(std::uint64_t ticket, Recipe recipe, std::filesystem::path folder) {
  {
    const std::lock_guard lock(mutex_);
    next_ = Job{ticket, std::move(recipe), std::move(folder)};
    cancel_ = running_;
    done_.reset();
    status_ = {};
  }
  changed_.notify_all();
}

void BackgroundBuild::cancel() {
  const std::lock_guard lock(mutex_);
  if (next_) {
    done_ = Outcome{next_->ticket, {}, {}, true};
    next_.reset();
  }
  cancel_ = running_;
}

bool BackgroundBuild::busy() const {
  const std::lock_guard lock(mutex_);
  return running_ || next_.has_value();
}

BackgroundBuild::Status BackgroundBuild::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::optional<BackgroundBuild::Outcome> BackgroundBuild::take() {
  const std::lock_guard lock(mutex_);
  std::optional<Outcome> outcome = std::move(done_);
  done_.reset();
  return outcome;
}

void BackgroundBuild::wait() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !running_ && !next_; });
}

void BackgroundBuild::work() {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stop_ || next_; });
      if (stop_) return;
      job = std::move(*next_);
      next_.reset();
      running_ = true;
      cancel_ = false;
    }
    Outcome outcome;
    outcome.ticket = job.ticket;
    try {
      outcome.result = builder_.build(job.recipe, job.folder, [&](const std::string& stage, double fraction) {
        const std::lock_guard lock(mutex_);
        status_ = {stage, fraction};
        return !cancel_;
      });
    } catch (const Cancelled&) {
      outcome.cancelled = true;
    } catch (const std::exception& error) { // whatever a stage throws becomes a message, never the program's end
      outcome.error = error.what();
    }
    {
      const std::lock_guard lock(mutex_);
      running_ = false;
      if (!next_) done_ = std::move(outcome); // else it was overtaken
    }
    changed_.notify_all();
  }
}

} // namespace pith
