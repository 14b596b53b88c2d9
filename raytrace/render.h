#pragma once
// Pictures of a scene by path tracing its opaque surfaces.
#include "raytrace/film.h"
#include "raytrace/light.h"
#include "raytrace/scene.h"
#include "volume/base/parallel.h"
#include "volume/base/view.h"

namespace pith {

/// What the camera sees behind everything.
struct Background {
  enum class Kind {
    backdrop, ///< the ground goes on for ever: the colour of the lit, empty ground; the sky where there is no ground
    sky,      ///< the environment itself
    color,    ///< `color`
    transparent ///< nothing: alpha 0; the ground catches shadows only as far as it has not faded
  };
  Kind kind = Kind::backdrop;
  Vec3d color{1, 1, 1}; ///< linear
};

struct RenderOptions {
  int width = 800, height = 600; ///< pixels
  int samples = 64;              ///< per pixel
  int first_sample = 0;          ///< continues a film: samples first_sample … first_sample + samples − 1
  std::uint64_t seed = 1;
  int threads = 0;                  ///< 0: all cores
  double time_limit = 0;            ///< seconds after which no further pass over the picture starts; 0: none
  bool keep_when_cancelled = false; ///< an end asked for after the first pass gives the film so far
  int max_depth = 3;                ///< surfaces on a path: 1 direct light only, 2 one bounce …
  Background background;
};

/// Renders. The same bytes for any number of threads; each sample is a function of (seed, pixel, sample) alone. A
/// time limit ends after a whole pass (FilmPixel::samples says how many). Errors: InvalidInput when an option is out
/// of range; Cancelled when `progress` says so (with keep_when_cancelled only before the first pass is finished:
/// later the film is returned, in which some tiles have the samples of one pass more).
Film render(const Scene& scene, const View& view, const Lights& lights, const RenderOptions& options = {},
            const Progress& progress = {});

} // namespace pith
