#include "raytrace/render.h"

#include "raytrace/path.h"
#include "volume/base/error.h"

#include <Eigen/Geometry>
#include <chrono>

namespace pith {

namespace {
constexpr int tile = 16;             ///< pixels along each side
constexpr int samples_per_pass = 16; ///< between two looks at the clock

void require_options(const RenderOptions& o, const View& view) {
  const auto refuse = [](const char* where, double value, const char* mend) {
    throw InvalidInput(where, "it is " + std::to_string(value), mend);
  };
  if (o.width < 1 || o.width > 65536) refuse("width", o.width, "give 1 to 65536 pixels");
  if (o.height < 1 || o.height > 65536) refuse("height", o.height, "give 1 to 65536 pixels");
  if (o.samples < 1) refuse("samples", o.samples, "give 1 or more");
  if (o.first_sample < 0) refuse("first_sample", o.first_sample, "give 0 or more");
  if (o.max_depth < 1) refuse("max_depth", o.max_depth, "give 1 or more");
  if (!(o.time_limit >= 0)) refuse("time_limit", o.time_limit, "give seconds, 0 for none");
  if (!o.background.color.allFinite()) refuse("background.color", o.background.color.sum(), "give three numbers");
  if (!view.eye.allFinite() || !view.target.allFinite() || !(view.forward().norm() > 0.5) ||
      !(view.right().norm() > 0.5))
    throw InvalidInput("view", "it has no direction",
                       "give an eye apart from the target, and an up that is not along the view");
  if (!(view.vertical_angle < 3.1)) refuse("view.vertical_angle", view.vertical_angle, "give radians below 3.1");
  if (view.orthographic() && !(view.height > 0)) refuse("view.height", view.height, "give mm above 0");
}

void add(FilmPixel& pixel, const CameraSample& sample) {
  for (int c = 0; c < 3; ++c) {
    pixel.color[c] += sample.radiance[c];
    pixel.square[c] += sample.radiance[c] * sample.radiance[c];
    pixel.albedo[c] += static_cast<float>(sample.albedo[c]);
  }
  pixel.alpha += sample.alpha;
  ++pixel.samples;
  if (sample.seen <= 0) return;
  ++pixel.hits;
  for (int c = 0; c < 3; ++c) {
    pixel.normal[c] += static_cast<float>(sample.first.smooth[c]);
    pixel.position[c] += sample.first.position[c];
  }
  pixel.depth += sample.first.distance;
  if (pixel.piece == FilmPixel::none && !sample.first.is_ground()) pixel.piece = sample.first.piece;
}
} // namespace

Film render(const Scene& scene, const View& view, const Lights& lights, const RenderOptions& options,
            const Progress& progress) {
  require_options(options, view);
  validate(lights);
  const ThreadLimit limit(options.threads);
  const PathTracer tracer(scene, view, lights, options);
  Film film(options.width, options.height);
  const int across = (options.width + tile - 1) / tile, down = (options.height + tile - 1) / tile;
  const std::size_t tiles = std::size_t(across) * down;
  const int passes = (options.samples + samples_per_pass - 1) / samples_per_pass;
  const auto start = std::chrono::steady_clock::now();
  SharedProgress finished(progress, tiles * passes);
  report(progress, 0);

  for (int done = 0; done < options.samples; done += samples_per_pass) {
    const int end = std::min(options.samples, done + samples_per_pass);
    const auto one_tile = [&](std::size_t begin, std::size_t) {
      const int x0 = static_cast<int>(begin % across) * tile, y0 = static_cast<int>(begin / across) * tile;
      for (int y = y0; y < std::min(y0 + tile, options.height); ++y)
        for (int x = x0; x < std::min(x0 + tile, options.width); ++x) {
          const std::uint64_t number = std::uint64_t(y) * options.width + x;
          FilmPixel& pixel = film.at(x, y);
          for (int s = done; s < end; ++s)
            add(pixel, tracer.sample(number, x, y, static_cast<std::uint32_t>(options.first_sample + s)));
        }
      finished.add();
    };
    try {
      parallel_blocks(tiles, 1, one_tile);
    } catch (const Cancelled&) { // tiles under way have been finished: every pixel is whole
      if (!options.keep_when_cancelled || done == 0) throw;
      return film;
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (options.time_limit > 0 && elapsed.count() >= options.time_limit) break;
  }
  if (!options.keep_when_cancelled) report(progress, 1);
  return film;
}

} // namespace pith
