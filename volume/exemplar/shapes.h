#pragma once
// The outsides of things that pith makes itself: closed surfaces in millimetres, centred near the origin, the same
// every time. The long axis, where there is one, is z.
#include "volume/exemplar/implicit_surface.h"

namespace pith {

/// The names that named_shape knows: kiwi and those of implicit shapes.
std::vector<std::string> shape_names();

/// A surface of about so many triangles (within 6 %; fewer than 1,000 may be a fifth off). Errors: InvalidInput for
/// an unknown name or a count below 100 or above 1,000,000.
///
/// carrot      a root, 156 mm long, 38 mm thick at the crown; the tip is at −z
/// tree        a piece of trunk, 300 mm long, about 116 mm thick, with a branch towards +x; ends round, to be cut off
/// watermelon  250 × 250 × 300 mm
/// tube        a rod with an S-shaped axis, 110 mm long, 28 mm thick
/// strata      a block, 120 × 80 × 70 mm; layers lie across z
/// cake        a slice of a round cake: 52 degrees, 90 mm long, 62 mm high; the rim is at +x, z is up
/// mineral     a three-sided crystal, 96 mm long, about 34 mm thick, with a pointed end at +z
/// fruit       a peach, 76 × 74 × 70 mm; the stem's end is at +z, the seam towards +x
/// wall        a curved wall, 36 mm thick and 100 mm high, 100 degrees of a ring of radius 95 mm about z
/// citrus      an orange or lemon, 72 × 72 × 80 mm, with a knob at −z; the axis is z
TriMesh named_shape(const std::string& name, int triangles);

/// The function behind a shape; not for "kiwi", which has none. Errors: InvalidInput for an unknown name.
ImplicitShape implicit_shape(const std::string& name);

} // namespace pith
