#pragma once
// Lapped solid textures: fills a solid by pasting overlapping pieces of a solid exemplar along its frames
// (Takayama, Okabe, Ijiri, Igarashi: Lapped Solid Textures, SIGGRAPH 2008).
#include "volume/base/parallel.h"
#include "volume/lap/texture_type.h"
#include "volume/layer/layer.h"
#include "volume/layer/mask.h"
#include "volume/mesh/boundary.h"
#include "volume/mesh/tet_mesh.h"

#include <span>
#include <string>

namespace pith {

/// Where and along what to paste. Spans are over all tets or vertices of the mesh; only `region` is filled.
struct LapInput {
  const TetMesh& mesh;
  const Boundary& boundary;
  std::int32_t region = 0;
  std::span<const Mat3d> axes;  ///< per tet: columns R, S, T, unit; may be empty for types 0 and 2-d
  std::span<const float> scale; ///< per tet: mm per texture width; may be empty for type 2-d
  /// Per vertex, 0 … 1: the scalar fields that are texture coordinates R, S, T where the type imposes them
  /// (TextureTraits::imposed): depth is coordinate 1. Others are not read.
  std::array<std::span<const float>, 3> coordinate{};
  std::span<const std::uint8_t> singular{}; ///< per tet; may be empty
  bool unsigned_axis = false;               ///< the strokes' axis has no sign: the texture is alike along T and −T
  std::string where = "fill";               ///< what messages call the solid: its entry in the recipe
};

struct LapOptions {
  TextureType type = TextureType::tensor_2b;
  std::uint64_t seed = 1;
  SplotchOptions splotch{};
  int mask_variants = 3;        ///< splotches of different outline for each part
  double frame_tolerance = 0.8; ///< largest angle between a tet's axes and the seed's, radians (§5.2.4)
  double scale_tolerance = 1.5; ///< largest ratio of their scales, where these are given (types 0, 1-a, 2-a)
  /// What the lengths of a piece's axes count beside their directions when it is warped, 0 … 1 (1: as much, as in the
  /// paper). Rays that spread from a core stay rays below 1; what lies across them is stretched instead. Where frames
  /// turn by more from tet to tet than the mesh resolves, lengths count in full.
  double length_weight = 0.3;
  double sample_spacing = 0.03; ///< of the coverage test, in texture widths
  int coverage_order = 12; ///< most samples per tet edge in that test; order 8 gives the paper's 165 points, between
                           ///< which coarse tets keep holes
  bool align = true;       ///< choose each paste's phase so that it continues what is already there; false: at random
  /// For exemplars with a structure that shows when it breaks (bricks, cells): phases are searched more finely and
  /// pieces are cut along seams that follow the structure (seam_cut.h). Takes several times as long, and each piece
  /// has a mask of its own.
  bool structured = false;
  /// Where pieces mix, keep mean and variance (Blend::mean_over); false: as the paper, which loses contrast there.
  bool preserve_variance = true;
  int max_attempts = 24; ///< pastes on one tet before the fill is given up; a third of them keep to all rules
};

struct LapStatistics {
  std::size_t pastes = 0, rounds = 0;
  std::size_t lookups = 0; ///< only those that can be seen are kept
  /// Of them, those that show the exemplar in mirror image: where nothing else covered a tet, at last a piece that
  /// reaches across a singular axis, beyond which depth falls again.
  std::size_t inverted = 0;
  std::size_t warp_iterations = 0;
  double median_share_used = 0; ///< of a mask's alpha, the part that lies on tets of its clump: median over pastes
};

struct LapResult {
  Layer layer;
  LapStatistics statistics;
};

/// Fills a region. The result is the same for any number of threads. Errors: InvalidInput when the exemplar does not
/// fit the type (it must repeat along the axes that are not imposed) or spans have the wrong length; SolverFailure
/// when some tet cannot be covered; Cancelled. Departures from the paper: new pastes go beneath the older ones, so
/// that a look-up that nothing can see is never made (the picture is as the paper's with the order reversed); the
/// fill runs in parallel rounds. Pieces end at singular axes instead of folding over them (grow.h). Type 2-c pastes
/// sheets that do not end along T; type 2-d, where nothing repeats, is a single paste that is exact on every tet.
LapResult lap(const LapInput& input, const Exemplar& exemplar, const LapOptions& options = {},
              const Progress& progress = {});

} // namespace pith
