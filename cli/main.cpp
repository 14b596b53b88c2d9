// pith: one program, one verb per file. Exit codes: 0 done, 1 bad input or failed work (one line on standard error),
// 2 wrong usage, 130 ended by Ctrl-C. With --json an error is also an object on standard output.
#include "cli/command.h"
#include "volume/base/error.h"

#include <CLI/Error.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace {

using namespace pith;
using namespace pith::cli;

enum ExitCode { done = 0, failed = 1, wrong_usage = 2, cancelled = 130 };

/// Messages are one line, whatever a library wrote into them.
void complain(std::string message) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  std::fprintf(stderr, "pith: %s\n", message.c_str());
}

/// The error as an object, for --json: unless the verb has printed its own, which says what is wrong.
void print_error(const Session& session, const char* kind, const std::string& message, int code) {
  if (!session.printed) session.print({{"error", message}, {"kind", kind}, {"exit_code", code}});
  std::fflush(stdout);
}

ProgressLine::Kind progress_kind(const Session& session) {
  if (session.quiet) return ProgressLine::Kind::none;
  if (::isatty(STDERR_FILENO) != 0) return ProgressLine::Kind::bar;
  return session.json ? ProgressLine::Kind::none : ProgressLine::Kind::lines;
}

constexpr const char* no_threads = "the system gives no more threads; free memory, or use fewer (--threads)";

bool is_about_threads(const std::system_error& error) {
  return error.code() == std::errc::resource_unavailable_try_again;
}

/// The last resort: a library that could not start its threads ends the program this way.
[[noreturn]] void end_in_one_line() {
  std::string message = no_threads;
  if (const std::exception_ptr error = std::current_exception()) {
    try {
      std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
      message = "out of memory; use a coarser mesh or a smaller exemplar, or free memory";
    } catch (const std::system_error& other) {
      if (!is_about_threads(other)) message = std::string("failed: ") + other.what();
    } catch (const std::exception& other) {
      message = std::string("failed: ") + other.what();
    } catch (...) {
      message = "failed for an unknown reason; report what you ran";
    }
  }
  complain(message);
  ::_exit(failed);
}

int run(const Verb& verb, Session& session) {
  const Interrupt interrupt;
  ProgressLine progress_line(progress_kind(session));
  const auto end = [&](const char* kind, const std::string& message, int code) {
    progress_line.clear();
    complain(message);
    print_error(session, kind, message, code);
    return code;
  };
  session.interrupt = &interrupt;
  session.progress_line = &progress_line;
  try {
    const ThreadLimit limit(session.threads);
    verb.run(session);
    if (std::fflush(stdout) != 0)
      throw IoFailure("standard output", "cannot be written; free some space, or write elsewhere");
    return done;
  } catch (const CLI::ParseError& error) {
    return end("usage", std::string(error.what()) + " (pith " + verb.app->get_name() + " --help)", wrong_usage);
  } catch (const Cancelled&) {
    return end("cancelled", "cancelled", cancelled);
  } catch (const std::bad_alloc&) {
    return end("memory", "out of memory; use a coarser mesh or a smaller exemplar, or free memory", failed);
  } catch (const InvalidInput& error) {
    return end("input", error.what(), failed);
  } catch (const IoFailure& error) {
    return end("file", error.what(), failed);
  } catch (const SolverFailure& error) {
    return end("solver", error.what(), failed);
  } catch (const std::system_error& error) {
    if (is_about_threads(error)) return end("memory", no_threads, failed);
    return end("other", error.what(), failed);
  } catch (const std::exception& error) {
    return end("other", error.what(), failed);
  }
}

/// The first word that is no option: the verb, or what stands in its place.
std::string first_word(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--threads" || word == "--seed")
      ++i;
    else if (!word.starts_with("-"))
      return word;
  }
  return {};
}

/// Empty, or why there is no such verb.
std::string wrong_verb(const std::string& word, const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  std::string all;
  for (const Verb& verb : verbs) {
    names.push_back(verb.app->get_name());
    all += (all.empty() ? "" : ", ") + names.back();
  }
  if (word.empty() || std::find(names.begin(), names.end(), word) != names.end()) return {};
  const std::string nearest = nearest_name(word, names);
  return "there is no verb '" + word + "'" + (nearest.empty() ? "" : "; did you mean '" + nearest + "'?") +
         (nearest.empty() ? "; there are " : " There are ") + all;
}

constexpr const char* common_options = "Every verb also takes\n"
                                       "  --json                      one JSON object on standard output\n"
                                       "  --quiet                     nothing but errors\n"
                                       "  --threads INT=0             threads to use; 0: all cores\n"
                                       "  --seed UINT                 random seed, in place of the recipe's or the "
                                       "verb's own\n"
                                       "Exit codes: 0 done, 1 bad input or failed work, 2 wrong usage, 130 Ctrl-C.";

} // namespace

int main(int argc, char** argv) {
  std::set_terminate(end_in_one_line);
  std::signal(SIGXFSZ, SIG_IGN); // a file that grows beyond its limit is an error like a full disk
  CLI::App program("pith: solids that are made of something all the way through", "pith");
  program.require_subcommand(1);
  program.fallthrough();
  program.set_version_flag("--version", "pith " PITH_VERSION);
  Session session;
  program.add_flag("--json", session.json, "print one JSON object on standard output");
  program.add_flag("--quiet", session.quiet, "print nothing but errors");
  program.add_option("--threads", session.threads, "threads to use; 0: all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  program.add_option("--seed", session.seed, "random seed, in place of the recipe's or the verb's own");

  std::vector<Verb> verbs;
  for (const auto& verb :
       {make_verb, info_verb, check_verb, cut_verb, sample_verb, render_verb, export_verb, exemplar_verb, shape_verb,
        view_verb})
    verbs.push_back(verb(program));
  refuse_odd_values(program);
  for (const Verb& verb : verbs) refuse_odd_values(*verb.app);
  for (const Verb& verb : verbs) verb.app->footer(common_options);
  const auto refuse_usage = [&](const std::string& message) {
    complain(message);
    session.json = std::find(argv + 1, argv + argc, std::string("--json")) != argv + argc;
    print_error(session, "usage", message, wrong_usage);
    return wrong_usage;
  };
  if (const std::string wrong = wrong_verb(first_word(argc, argv), verbs); !wrong.empty())
    return refuse_usage(wrong + " (pith --help)");
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return program.exit(error); // --help
    const auto used = program.get_subcommands();
    return refuse_usage(std::string(error.what()) + " (pith " + (used.empty() ? "" : used.front()->get_name() + " ") +
                        "--help)");
  }
  const auto chosen = std::find_if(verbs.begin(), verbs.end(), [](const Verb& verb) { return verb.app->parsed(); });
  return run(*chosen, session);
}
