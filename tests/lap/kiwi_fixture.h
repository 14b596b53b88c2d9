#pragma once
// A kiwi filled as a recipe would fill it, at a size for tests: about the paper's tets, 64³ texels.
#include "volume/exemplar/kiwi_surface.h"
#include "volume/exemplar/procedural.h"
#include "volume/field/frames.h"
#include "volume/lap/lap.h"
#include "volume/layer/model.h"
#include "volume/mesh/refine.h"
#include "volume/mesh/tetrahedralize.h"

namespace pith::testing {

struct KiwiSolid {
  TetMesh mesh;
  Boundary boundary;
  DepthField depth;
  FrameField frames;
  Exemplar exemplar;

  LapInput input() const {
    return {.mesh = mesh,
            .boundary = boundary,
            .axes = frames.axes,
            .scale = frames.scale,
            .coordinate = {{{}, depth.value, {}}},
            .singular = frames.singular};
  }
};

inline KiwiSolid kiwi_solid(int triangles = 1426, double interior_edge = 7.5) {
  KiwiSolid k;
  const std::vector<Vec3d> axis{{0, 0, -20}, {0, 0, 20}};
  TetrahedralizeResult tets = tetrahedralize(kiwi_surface(triangles), "kiwi", {.interior_edge = interior_edge});
  k.mesh = refine(tets.mesh, tets.input, {.stroke = {axis}}).mesh;
  k.boundary = boundary_of(k.mesh);
  k.depth = depth_field(k.mesh, k.boundary, 0,
                        {{.value = 0, .skin = true, .triangles = {}, .stroke = {}},
                         {.value = 1, .skin = false, .triangles = {}, .stroke = axis}},
                        "kiwi");
  const Locator locator(k.mesh, k.boundary);
  k.frames = frames_from_depth(k.mesh, locator, 0, k.depth, {{axis}}, "kiwi");
  k.exemplar = procedural_exemplar("kiwi", {.resolution = 64});
  return k;
}

inline Root root_of(const KiwiSolid& k, Layer layer) {
  Model model;
  model.name = "kiwi";
  model.mesh = k.mesh;
  model.boundary = k.boundary;
  model.layer.push_back(std::move(layer));
  return Root(std::move(model), {.mips = false});
}

} // namespace pith::testing
