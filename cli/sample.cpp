// pith sample MODEL.pith POINTS.npy -o OUT.npy: the material at n points of rest space.
#include "cli/command.h"
#include "volume/base/error.h"
#include "volume/cut/piece.h"
#include "volume/io/model_io.h"
#include "volume/io/npy.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace pith::cli {
namespace {

struct SampleOptions {
  std::filesystem::path model, points, output;
  double footprint = 0;
};

/// What stands in each column: r, g, b, alpha (coverage), then the components of the other channels.
struct Columns {
  std::vector<std::string> name{"r", "g", "b", "alpha"};
  int color = -1;           ///< first component of the colour; −1: the model has none, zeros stand for it
  std::vector<int> further; ///< component of each further column
};

Columns columns_of(const Root& root) {
  Columns columns;
  int component = 0;
  for (const Channel& channel : root.channels()) {
    if (columns.color < 0 && channel.semantic == Semantic::color && channel.components == 3) {
      columns.color = component;
    } else {
      for (int i = 0; i < channel.components; ++i) {
        columns.name.push_back(channel.components == 1 ? channel.name : channel.name + "." + std::to_string(i));
        columns.further.push_back(component + i);
      }
    }
    component += channel.components;
  }
  return columns;
}

void run(const SampleOptions& options, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  check_output(options.output, {"npy"});
  const NpyArray points = read_npy(options.points);
  const std::size_t count = points.rows(3, options.points.filename().string());
  const std::vector<double> coordinate = points.as_double();
  ModelFile file = read_model(options.model);
  const Pieces pieces = std::move(file.pieces);
  const bool whole = pieces.piece.size() == 1 && pieces.cut_count == 0;
  const Root root(std::move(file.model), {.mips = options.footprint > 0});
  const Columns columns = columns_of(root);
  const std::size_t width = columns.name.size();

  // How far a hint reaches: a walk through more tets than that costs more than to look the point up.
  const TetMesh& mesh = root.model().mesh;
  const double near = 3 * std::cbrt(bounds_of(mesh).extent().prod() / static_cast<double>(mesh.tet_count()));

  std::vector<float> value(count * width, std::numeric_limits<float>::quiet_NaN());
  std::atomic<std::size_t> outside{0};
  const Progress progress = session.progress("sample");
  SharedProgress finished(progress, count);
  const auto begin_sampling = std::chrono::steady_clock::now();
  parallel_blocks(count, 4096, [&](std::size_t begin, std::size_t end) {
    TetId last; // the last owner: points of a file are often neighbours
    Vec3d last_at = Vec3d::Constant(std::numeric_limits<double>::infinity());
    std::size_t missed = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d x(coordinate[3 * i], coordinate[3 * i + 1], coordinate[3 * i + 2]);
      const TetId hint = (x - last_at).squaredNorm() < near * near ? last : TetId();
      const Location location = x.allFinite() ? root.locator().locate(x, -1, hint) : Location{};
      if (location.inside) last = location.tet, last_at = x;
      if (!location.inside ||
          (!whole && piece_at(pieces, root.model().mesh, location.tet, x) >= pieces.piece.size())) {
        ++missed;
        continue;
      }
      const Material material = material_at(root, {.position = x, .region = -1, .facet = {}, .hint = location.tet},
                                            location, options.footprint);
      float* row = value.data() + i * width;
      for (int c = 0; c < 3; ++c) row[c] = columns.color < 0 ? 0.0f : material.value[columns.color + c];
      row[3] = material.coverage;
      for (std::size_t c = 0; c < columns.further.size(); ++c) row[4 + c] = material.value[columns.further[c]];
    }
    outside += missed;
    finished.add(end - begin);
  });
  const double sampling = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_sampling).count();
  session.stop_if_asked();
  write_npy<float>(options.output, value, {count, width});

  session.say(fmt::format("{}: {} points, {} outside; {:.3g} points/s", options.output.string(), count,
                          outside.load(), count / std::max(sampling, 1e-9)));
  session.print({{"output", options.output.string()},
                 {"points", count},
                 {"outside", outside.load()},
                 {"channels", columns.name},
                 {"sampling_seconds", sampling},
                 {"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()}});
}

} // namespace

Verb sample_verb(CLI::App& program) {
  auto options = std::make_shared<SampleOptions>();
  CLI::App* app = program.add_subcommand("sample", "the material at points: r, g, b, coverage and further channels");
  app->add_option("model", options->model, "MODEL.pith")->required();
  app->add_option("points", options->points, "n × 3 numbers, rest space, mm: POINTS.npy")->required();
  app->add_option("-o,--output", options->output, "n × channels float32, linear; NaN outside: OUT.npy")->required();
  app->add_option("--footprint", options->footprint, "mm to filter over; 0: the exact value at the point")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  return {app, [options](const Session& session) { run(*options, session); }};
}

} // namespace pith::cli
