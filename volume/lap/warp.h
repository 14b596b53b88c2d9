#pragma once
// Texture optimisation: coordinates on a clump whose gradients match the frames' axes in a least squares sense
// (Takayama 2008, §5.2.5, Fig. 12; Praun 2000, §4).
#include "volume/lap/simplices.h"

namespace pith {

/// A clump of simplices with a numbering of its own vertices.
struct Clump {
  std::vector<std::uint32_t> simplex; ///< of the mesh, in order of growth
  std::vector<std::uint32_t> vertex;  ///< of the mesh, in order of growth
  std::vector<std::uint32_t> corner;  ///< simplex.size() · corners local vertex numbers
  std::vector<float> confidence;      ///< per simplex: weight of its equations, 0 … 1
  /// Per simplex, above 0: what the length of a coordinate's gradient counts beside its direction; 1, or empty: as
  /// much, as in the paper.
  std::vector<float> length_weight;
  int axes = 3;                   ///< coordinates per vertex
  std::vector<double> coordinate; ///< vertex.size() · axes
};

struct WarpOptions {
  double tolerance = 1e-3; ///< of the coordinates' gradient residual, relative to the start's right-hand side
  int max_iterations = 400;
};

/// For each axis a with solve[a]: moves coordinate a so that its gradient on every simplex is close to
/// target(simplex, a) (1/mm), in the sum of weight(simplex) · (|across|² + length_weight · |along|²) over both parts
/// of the difference, across the target and along it; then shifts it so that it is `pin[a]` at the point
/// `pin_barycentric` of clump.simplex[0]. Other axes stay. `target` holds axes gradients per clump simplex.
///
/// Where axes spread, as rays from a core do, no map has both their directions and their lengths: least squares of
/// both alike, the paper's, shears the texture, and it is the directions that are seen.
///
/// Conjugate gradient with a diagonal preconditioner, from the coordinates given. Returns the iterations used.
int warp(const Simplices& mesh, Clump& clump, const std::vector<Vec3d>& target, const std::vector<double>& weight,
         const std::array<bool, 3>& solve, const std::array<double, 3>& pin,
         const std::array<float, 4>& pin_barycentric, const WarpOptions& options = {});

} // namespace pith
