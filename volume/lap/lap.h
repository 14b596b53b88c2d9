#pragma once
// Lapped solid textures: fills a solid by pasting overlapping pieces of a solid exemplar along its frames
// (Takayama, Okabe, Ijiri, Igarashi: Lapped Solid Textures, SIGGRAPH 2008).
#include "volume/base/parallel.h"
#include "volume/layer/layer.h"
#include "volume/layer/mask.h"
#include "volume/mesh/boundary.h"
#include "volume/mesh/tet_mesh.h"

#include <span>
#include <string>

namespace pith {

/// The paper's seven kinds of texture: anisotropy 0–2, variation a (none) … d (three axes). §3.
enum class TextureType { isotropic_0, axial_1a, layered_1b, tensor_2a, tensor_2b, tensor_2c, tensor_2d };

/// Where and along what to paste. Spans are over all tets or vertices of the mesh; only `region` is filled.
struct LapInput {
  const TetMesh& mesh;
  const Boundary& boundary;
  std::int32_t region = 0;
  std::span<const Mat3d> axes;    ///< per tet: columns R, S, T, unit
  std::span<const float> scale;   ///< per tet: mm per texture width
  std::span<const float> depth;   ///< per vertex, 0 … 1 (types that vary with depth)
  std::span<const std::uint8_t> singular; ///< per tet; may be empty
};

struct LapOptions {
  TextureType type = TextureType::tensor_2b;
  std::uint64_t seed = 1;
  SplotchOptions splotch;
  double frame_tolerance = 1.2;    ///< largest angle between a tet's axes and the seed's, radians (§5.2.4)
  int coverage_order = 8;          ///< samples per tet edge in the coverage test: order 8 gives the paper's 165
  int max_rounds = 400;            ///< parallel rounds before the fill is given up
};

struct LapStatistics {
  std::size_t pastes = 0, rounds = 0;
  std::size_t lookups = 0;           ///< after those that nothing can see were dropped
  double median_lookups_per_tet = 0;
  double median_share_used = 0;      ///< of a mask's opaque volume, how much lies inside the model: median over patches
};

struct LapResult {
  Layer layer;
  LapStatistics statistics;
};

/// Fills a region. The result is the same for any number of threads. Errors: InvalidInput when the exemplar does not fit
/// the type or spans have the wrong length; SolverFailure when some tet cannot be covered; Cancelled.
LapResult lap(const LapInput& input, const Exemplar& exemplar, const LapOptions& options = {},
              const Progress& progress = {});

} // namespace pith
