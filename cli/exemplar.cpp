// pith exemplar NAME -o FILE.exemplar: writes a solid texture that pith makes itself.
#include "cli/command.h"
#include "volume/base/error.h"
#include "volume/exemplar/procedural.h"
#include "volume/io/exemplar_io.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace pith::cli {
namespace {

struct ExemplarOptions {
  std::string name;
  std::filesystem::path output;
  int resolution = ProceduralOptions().resolution;
};

std::string joined(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : ", ") + word;
  return result;
}

void run(const ExemplarOptions& options, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<std::string> names = procedural_names();
  if (std::find(names.begin(), names.end(), options.name) == names.end())
    throw InvalidInput("exemplar \"" + options.name + "\"", "no generator makes it", "known names: " + joined(names));
  check_output(options.output, {"exemplar", "npy"});
  const Exemplar exemplar = procedural_exemplar(
      options.name, {.resolution = options.resolution, .seed = session.seed.value_or(ProceduralOptions().seed)});
  session.stop_if_asked();
  write_exemplar(options.output, exemplar);
  session.say(fmt::format("{}: {}, {} texels", options.output.string(), options.name, exemplar.texel_count()));
  session.print({{"output", options.output.string()},
                 {"name", options.name},
                 {"texels", exemplar.texel_count()},
                 {"bytes", std::filesystem::file_size(options.output)},
                 {"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()}});
}

} // namespace

Verb exemplar_verb(CLI::App& program) {
  auto options = std::make_shared<ExemplarOptions>();
  CLI::App* app = program.add_subcommand("exemplar", "make a solid texture: " + joined(procedural_names()));
  app->add_option("name", options->name, joined(procedural_names()))->required();
  app->add_option("-o,--output", options->output, "FILE.exemplar, or .npy for bare texels")->required();
  app->add_option("--resolution", options->resolution, "texels along each axis")
      ->check(CLI::Range(16, 512))
      ->capture_default_str();
  return {app, [options](const Session& session) { run(*options, session); }};
}

} // namespace pith::cli
