#pragma once
// Closed surfaces from functions of space: how pith makes the outsides of things.
#include "volume/mesh/tri_mesh.h"

#include <functional>

namespace pith {

struct ImplicitShape {
  /// Negative inside, positive outside, 0 on the surface; any scale, continuous, with a gradient on the surface.
  std::function<double(const Vec3d&)> value;
  Vec3d low, high; ///< a box with the surface strictly inside, mm
};

/// The zero set as a closed surface of near-uniform triangles, facing outwards: about `triangles` of them (within
/// 6 %; fewer than 1,000 may be a fifth off). Vertices lie on the zero set to a thousandth of an edge. Features
/// thinner than about two edges are lost. Errors: InvalidInput below 100 or above 1,000,000 triangles, or when
/// nothing of the box is inside. Deterministic; 20,000 triangles take about a second.
TriMesh implicit_surface(const ImplicitShape& shape, int triangles, const std::string& where);

/// A smooth union and a smooth intersection of two such functions, whose blend is `width` wide (mm where they are
/// distances). Quilez's polynomial form.
double smooth_union(double a, double b, double width);
double smooth_intersection(double a, double b, double width);

} // namespace pith
