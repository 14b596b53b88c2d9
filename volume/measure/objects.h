#pragma once
// Are the things that an exemplar holds (seeds, nuts, stones) whole in the solid, or halved where patches meet?
#include "volume/base/parallel.h"
#include "volume/layer/model.h"

#include <optional>

namespace pith {

/// What belongs to an object: colours within `tolerance` (Euclidean, sRGB-encoded components 0 … 1) of `color`.
struct ObjectRule {
  Vec3f color = Vec3f::Zero(); ///< sRGB-encoded, 0 … 1
  float tolerance = 0.15f;
};

/// A connected region (six neighbours) that a rule picks, in texture widths.
struct FoundObject {
  double volume = 0;              ///< texture widths³
  std::array<double, 3> spread{}; ///< square roots of the eigenvalues of its covariance, ascending
  Vec3d center = Vec3d::Zero();   ///< exemplar coordinates, or rest space
  bool clipped = false;           ///< touches where the exemplar or the solid ends, or never ends itself
};

/// All regions of an exemplar volume that the rule picks, sampled at `resolution`³ points; regions run on across
/// faces that repeat. In order of their first sample, the first axis fastest.
std::vector<FoundObject> exemplar_objects(const Exemplar& exemplar, const ObjectRule& rule, int resolution = 128);

/// Looks for a rule that picks things: one of the extreme colours (darkest, lightest, reddest, greenest, bluest,
/// yellowest) whose regions are at least three, together at most a fifth of the volume, and all of about one size.
/// None when there is no such colour. Works on at most 64³ texels; ~0.1 s.
std::optional<ObjectRule> object_rule_of(const Exemplar& exemplar);

struct ObjectOptions {
  std::size_t voxels = 4'000'000; ///< of the box around the region, about
  double volume_tolerance = 0.35; ///< a whole object's volume may leave the range of the exemplar's by that part
  double shape_tolerance = 0.35;  ///< the same for each of its three spreads
  double crumb = 0.05;            ///< smaller than this part of the exemplar's median: not counted
};

struct ObjectMeasure {
  std::size_t exemplar_objects = 0;                        ///< that the exemplar holds (not clipped, no crumbs)
  std::size_t objects = 0;                                 ///< in the solid, not clipped by its boundary, no crumbs
  std::size_t whole = 0;                                   ///< of those, with volume and shape of the exemplar's
  std::size_t too_small = 0, too_large = 0, misshapen = 0; ///< the others: halved; grown together; bent
  std::size_t clipped = 0;                                 ///< cut by the boundary of the solid
  double median_volume = 0;                                ///< of the solid's objects over that of the exemplar's
  double spacing = 0;                                      ///< mm between samples
  Vec3d first_broken = Vec3d::Zero();                      ///< centre of the lowest-numbered object that is not whole
  double whole_share() const { return objects > 0 ? double(whole) / double(objects) : 1; }
};

/// Counts objects in a layer's region. Volumes are measured in the scale field of the model. In parallel; ~1 s for 4
/// million voxels. None when the exemplar holds no unclipped object, or the model has no scale field. The samples of
/// the exemplar are as far apart, in texture widths, as those of the solid in its median scale.
std::optional<ObjectMeasure> object_measure(const Root& root, const Layer& layer, const ObjectRule& rule,
                                            const ObjectOptions& options = {}, const Progress& progress = {});

} // namespace pith
