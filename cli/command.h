#pragma once
// What all verbs share: common options, the object that --json prints, progress, and Ctrl-C.
#include "volume/base/parallel.h"
#include "volume/cut/displace.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pith::cli {

/// Keeps the order of its keys.
using Json = nlohmann::ordered_json;

/// Ctrl-C and SIGTERM ask for an orderly end: work stops at the next report of progress, files half written are
/// removed. A second one, or work that does not stop within some seconds, ends the program at once.
class Interrupt {
public:
  /// Call before any thread starts: they all inherit that the signals are blocked.
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  bool asked() const;

private:
  struct Watcher;
  std::unique_ptr<Watcher> watcher_;
};

/// Says on standard error how far work has come: on a terminal a line that changes; elsewhere one line for each part
/// of the work that takes longer than a second.
class ProgressLine {
public:
  enum class Kind { none, bar, lines };
  explicit ProgressLine(Kind kind) : kind_(kind) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// `line` is what stands for `what` where whole lines are printed; empty: `what`.
  void show(const std::string& what, double fraction, const std::string& line = "");
  void clear();

private:
  void tell(const std::string& what, const std::string& line, std::int64_t now);

  Kind kind_;
  bool shown_ = false;
  std::int64_t last_ms_ = -1;
  std::map<std::string, std::int64_t> begun_; ///< when each part was first shown; −1: told
};

/// What a verb is run with.
struct Session {
  bool json = false, quiet = false;
  int threads = 0;                   ///< 0: all cores
  std::optional<std::uint64_t> seed; ///< where given, takes the place of the recipe's or the verb's own
  const Interrupt* interrupt = nullptr;
  ProgressLine* progress_line = nullptr;
  mutable bool printed = false; ///< print has printed: an error that follows is no second object

  /// Shows progress under a name and passes Ctrl-C on. `line`: as for ProgressLine::show.
  Progress progress(const std::string& what, const std::string& line = "") const;
  /// A line of ordinary output; nothing under --json or --quiet.
  void say(const std::string& line) const;
  /// The one object of --json; nothing without it.
  void print(const Json& object) const;
  bool cancelled() const { return interrupt && interrupt->asked(); }
  /// Throws Cancelled when Ctrl-C was pressed: for work that reports no progress.
  void stop_if_asked() const;
};

/// A verb adds its subcommand and options to the program; what it returns runs it.
using Run = std::function<void(const Session&)>;
struct Verb {
  CLI::App* app;
  Run run;
};
Verb make_verb(CLI::App& program);
Verb info_verb(CLI::App& program);
Verb check_verb(CLI::App& program);
Verb cut_verb(CLI::App& program);
Verb sample_verb(CLI::App& program);
Verb render_verb(CLI::App& program);
Verb export_verb(CLI::App& program);
Verb exemplar_verb(CLI::App& program);
Verb shape_verb(CLI::App& program);
Verb view_verb(CLI::App& program);

/// Errors early, before long work: IoFailure when the folder of an output file does not exist or is not writable;
/// InvalidInput when its extension is none of `extensions` (empty: any).
void check_output(const std::filesystem::path& path, std::initializer_list<const char*> extensions);

/// `--displacement` and `--displacement-edge`.
void add_displacement_options(CLI::App& app, DisplaceOptions& options);

/// The name among `names` that is spelt most like `word`; empty where none is near.
std::string nearest_name(const std::string& word, const std::vector<std::string>& names);

/// "x,y,z" and the like: `count` finite numbers. Errors: CLI::ValidationError (wrong usage), naming the option.
std::vector<double> numbers_of(const std::string& option, const std::string& text, std::size_t count);

/// "WIDTHxHEIGHT", each from `least` to `most`. Errors: CLI::ValidationError (wrong usage), naming the option.
std::array<int, 2> size_of(const std::string& option, const std::string& text, int least, int most);

/// Refuses, in every option of the verb, an empty value, a number that is not finite, and a sign before a count.
/// Errors of the parser: wrong usage, naming the option.
void refuse_odd_values(CLI::App& verb);

/// The most memory that this process (or a helper that it ran) has held, bytes.
std::uint64_t peak_memory_bytes();
std::uint64_t helper_peak_memory_bytes();

/// ".PLY" → "ply"
std::string extension_of(const std::filesystem::path& path);

} // namespace pith::cli
