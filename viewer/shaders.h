#pragma once
// The one shader: every layer, inside and on the boundary, composed per fragment as composite() and material_at() do.

namespace pith {

extern const char* const surface_vertex_shader;
extern const char* const surface_fragment_shader;
extern const char* const depth_fragment_shader; ///< nothing but depth, for the occlusion

} // namespace pith
