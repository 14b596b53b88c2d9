// pith: one program, one verb per file. Exit codes: 0 done, 1 bad input or failed work (one line on standard error),
// 2 wrong usage, 130 ended by Ctrl-C.
#include "cli/command.h"
#include "volume/base/error.h"

#include <CLI/Error.hpp>
#include <algorithm>
#include <cstdio>
#include <new>
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

int run(const Verb& verb, Session& session) {
  const Interrupt interrupt;
  ProgressLine progress_line(!session.quiet && ::isatty(STDERR_FILENO) != 0);
  session.interrupt = &interrupt;
  session.progress_line = &progress_line;
  try {
    const ThreadLimit limit(session.threads);
    verb.run(session);
    if (std::fflush(stdout) != 0) throw IoFailure("standard output", "cannot be written");
    return done;
  } catch (const CLI::ParseError& error) {
    progress_line.clear();
    complain(std::string(error.what()) + " (pith " + verb.app->get_name() + " --help)");
    return wrong_usage;
  } catch (const Cancelled&) {
    progress_line.clear();
    complain("cancelled");
    return cancelled;
  } catch (const std::bad_alloc&) {
    progress_line.clear();
    complain("out of memory; use a coarser mesh or a smaller exemplar, or free memory");
    return failed;
  } catch (const std::exception& error) {
    progress_line.clear();
    complain(error.what());
    return failed;
  }
}

} // namespace

int main(int argc, char** argv) {
  CLI::App program("pith: solids that are made of something all the way through", "pith");
  program.require_subcommand(1);
  program.fallthrough();
  program.set_version_flag("--version", "pith " PITH_VERSION);
  Session session;
  program.add_flag("--json", session.json, "print one JSON object on standard output");
  program.add_flag("--quiet", session.quiet, "print nothing but errors");
  program.add_option("--threads", session.threads, "threads to use; 0: all cores")->check(CLI::Range(0, 1024));
  program.add_option("--seed", session.seed, "random seed, in place of the recipe's");

  std::vector<Verb> verbs;
  for (const auto& verb :
       {make_verb, info_verb, check_verb, cut_verb, sample_verb, render_verb, export_verb, exemplar_verb, shape_verb})
    verbs.push_back(verb(program));
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return program.exit(error); // --help
    const auto used = program.get_subcommands();
    complain(std::string(error.what()) + " (pith " + (used.empty() ? "" : used.front()->get_name() + " ") +
             "--help)");
    return wrong_usage;
  }
  const auto chosen = std::find_if(verbs.begin(), verbs.end(), [](const Verb& verb) { return verb.app->parsed(); });
  return run(*chosen, session);
}
