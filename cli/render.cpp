// pith render MODEL.pith -o IMAGE.exr|png
#include "cli/command.h"
#include "cli/scene_file.h"
#include "raytrace/framing.h"
#include "recipe/recipe.h"
#include "volume/base/error.h"
#include "volume/io/atomic_file.h"
#include "volume/io/image_io.h"
#include "volume/io/model_io.h"

#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <unistd.h>

namespace pith::cli {
namespace {

struct RenderVerbOptions {
  std::filesystem::path model, output, scene, view;
  std::string size = "800x600", direction;
  int samples = 64;
  double time = 0, exposure = 0;
  bool transparent = false;
  DisplaceOptions displacement;
};

/// Errors before long work: InvalidInput where the picture cannot fit into the memory of this computer.
void require_memory(int width, int height) {
  // The film, and beside it the picture, its layers and what is encoded of them.
  constexpr double each = sizeof(FilmPixel) + 2.5 * sizeof(float) * 16;
  const double needed = each * width * height;
  const double there = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
  if (there > 0 && needed > there)
    throw InvalidInput("--size",
                       fmt::format("{} × {} pixels need {:.1f} GB of memory, and this computer has {:.1f} GB", width,
                                   height, needed / 1e9, there / 1e9),
                       fmt::format("give {:.0f} million pixels or fewer", std::floor(there / each / 1e6)));
}

Lights lights_of(const SceneFile& scene, const Scene& ready, const View& view) {
  const Box& bounds = ready.bounds();
  if (scene.default_lights) return default_lights(view, bounds.center(), 0.5 * bounds.diagonal(), ready.options().up);
  Lights lights;
  lights.environment.scale = 0; // lamps alone, unless an environment is named
  if (scene.environment) lights.environment = *scene.environment;
  lights.area = scene.lights;
  return lights;
}

void write_picture(const RenderVerbOptions& options, const Film& film, const ToneOptions& tone) {
  const Image color = color_of(film);
  const std::string extension = extension_of(options.output);
  if (extension != "exr") {
    Image shown = extension == "hdr" ? color : tone_mapped(color, tone);
    if (shown.channels == 4) { // files of this kind hold colour that is not multiplied by alpha
      for (std::size_t i = 0; i < shown.pixel.size(); i += 4)
        if (const float alpha = shown.pixel[i + 3]; alpha > 0 && alpha < 1)
          for (int c = 0; c < 3; ++c) shown.pixel[i + c] /= alpha;
    }
    write_image(options.output, shown);
    return;
  }
  std::vector<ImageLayer> layers;
  for (FilmLayer& layer : layers_of(film))
    if (layer.name != "color") layers.push_back({std::move(layer.name), std::move(layer.image)});
  write_image(options.output, color, {}, layers);
}

/// Samples that every pixel has.
std::uint32_t least_samples(const Film& film) {
  std::uint32_t least = film.pixel.empty() ? 0 : film.pixel.front().samples;
  for (const FilmPixel& pixel : film.pixel) least = std::min(least, pixel.samples);
  return least;
}

void run(const CLI::App& app, const RenderVerbOptions& options, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  check_output(options.output, {"png", "exr", "jpg", "hdr", "tif"});
  const auto [width, height] = size_of("--size", options.size, 1, 32768);
  require_memory(width, height);
  SceneFile scene_file;
  if (!options.scene.empty())
    scene_file =
        parse_scene(file_content(options.scene), options.scene.filename().string(), options.scene.parent_path());
  if (!options.direction.empty()) {
    const std::vector<double> d = numbers_of("--direction", options.direction, 3);
    scene_file.direction = {d[0], d[1], d[2]};
    scene_file.view.reset();
  }
  if (!options.view.empty())
    scene_file.view = parse_view(file_content(options.view), options.view.filename().string());
  if (app.count("--exposure") > 0) scene_file.tone.exposure = options.exposure;
  if (options.transparent) scene_file.background.kind = Background::Kind::transparent;

  ModelFile file = read_model(options.model);
  if (!scene_file.view && options.direction.empty() && !file.recipe.empty())
    scene_file.view = parse_recipe(file.recipe, options.model.filename().string() + " (recipe)").view;
  const Pieces pieces = std::move(file.pieces);
  const Root root(std::move(file.model));
  scene_file.scene.displacement = options.displacement;
  const Scene scene(root, pieces, scene_file.scene);
  FramingOptions framing{.direction = scene_file.direction, .aspect = static_cast<double>(width) / height};
  if (scene_file.vertical_angle) framing.vertical_angle = *scene_file.vertical_angle;
  const View view = scene_file.view ? *scene_file.view : framed_view(scene, framing);
  const double share = section_share(scene, view);
  constexpr double well_seen = 0.2; // two halves that face one another show 0.3 and more where nothing hides them
  if (!scene_file.view && framing.direction.isZero() && share < well_seen)
    session.say(
        "note: the sections are mostly hidden in every view; spread the halves further (cut --spread), keep one "
        "of them (--keep), or lay them down with \"moves\" in the recipe");

  RenderOptions render_options;
  render_options.width = width;
  render_options.height = height;
  render_options.samples = options.samples;
  // With a time and no number of samples, time alone says when it is enough.
  if (options.time > 0 && app.count("--spp") == 0) render_options.samples = 1 << 20;
  render_options.time_limit = options.time;
  render_options.threads = session.threads;
  if (session.seed) render_options.seed = *session.seed;
  render_options.background = scene_file.background;
  const auto begin = std::chrono::steady_clock::now();
  render_options.keep_when_cancelled = true;
  const Progress progress = session.progress(
      "render", fmt::format("rendering {} × {} pixels, {}", width, height,
                            render_options.samples < 1 << 20 ? fmt::format("{} samples each", render_options.samples)
                                                             : fmt::format("for {} s", options.time)));
  const Film film = render(scene, view, lights_of(scene_file, scene, view), render_options, progress);
  const double rendering = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::uint32_t samples = least_samples(film);
  write_picture(options, film, scene_file.tone);
  if (session.cancelled())
    throw std::runtime_error(fmt::format("{}: cancelled after {} samples per pixel; the picture shows these",
                                         options.output.string(), samples));
  session.say(fmt::format("{}: {} × {} pixels, {} samples each, {:.2f} s", options.output.string(), width, height,
                          samples, rendering));
  session.print({{"output", options.output.string()},
                 {"width", width},
                 {"height", height},
                 {"samples", samples},
                 {"triangles", scene.triangle_count()},
                 {"section_share", share},
                 {"rendering_seconds", rendering},
                 {"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()},
                 {"view",
                  {{"eye", {view.eye.x(), view.eye.y(), view.eye.z()}},
                   {"target", {view.target.x(), view.target.y(), view.target.z()}},
                   {"up", {view.up.x(), view.up.y(), view.up.z()}},
                   {"vertical_angle", view.vertical_angle},
                   {"height", view.height}}}});
}

} // namespace

Verb render_verb(CLI::App& program) {
  auto options = std::make_shared<RenderVerbOptions>();
  CLI::App* app = program.add_subcommand(
      "render", "path-trace a picture of a model; Ctrl-C keeps the picture of the passes that are finished");
  app->add_option("model", options->model, "MODEL.pith")->required();
  app->add_option("-o,--output", options->output,
                  "IMAGE.png, .exr (with albedo, normal, depth ...), .jpg, .hdr or .tif")
      ->required();
  app->add_option("--size", options->size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  app->add_option("--spp", options->samples, "samples per pixel; with --time alone: as many as it allows")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  app->add_option("--time", options->time,
                  "seconds after which no further pass of 16 samples starts (default: no limit)")
      ->check(CLI::PositiveNumber);
  app->add_option("--scene", options->scene,
                  "light, ground, background and view: SCENE.json (default: a soft studio light)");
  app->add_option("--view", options->view,
                  "where to look from, VIEW.json; otherwise the recipe's, or one that shows all");
  app->add_option("--direction", options->direction,
                  "x,y,z: look from there, framed to show all (default: where the sections are seen best)");
  app->add_option("--exposure", options->exposure, "stops")->capture_default_str();
  app->add_flag("--transparent", options->transparent, "no background: alpha");
  add_displacement_options(*app, options->displacement);
  return {app, [app, options](const Session& session) { run(*app, *options, session); }};
}

} // namespace pith::cli
