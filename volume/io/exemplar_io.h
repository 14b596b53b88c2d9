#pragma once
// Exemplars from and to files. NAME.exemplar is a zip of texel.npy (uint8; axes slowest first, channels last: z, y,
// x, c) and exemplar.json (name, wrap per axis, channels), so that np.load("kiwi.exemplar")["texel"] shows it.
#include "volume/layer/exemplar.h"

#include <filesystem>

namespace pith {

/// By extension: `.exemplar`, or `.npy` for bare texels (uint8, y × x × c or z × y × x × c with 1 to 12 components:
/// 3 make an sRGB colour, 4 a colour and alpha, others one scalar channel; clamped along all axes), or an image: a
/// 2D exemplar, or, of a TIFF of several pages, a volume whose slices across the third axis they are (grey becomes a
/// colour; clamped along all axes, see volume/exemplar/tile.h).
/// Errors: IoFailure when it cannot be opened; InvalidInput when it is foreign, truncated, damaged or inconsistent.
Exemplar read_exemplar(const std::filesystem::path& path);

/// By extension, `.exemplar` or `.npy` (texels only). The file appears whole or not at all; the same exemplar gives
/// the same bytes. A Gaussian twin is not stored: make_gaussian_twin makes it again.
void write_exemplar(const std::filesystem::path& path, const Exemplar& exemplar);

} // namespace pith
