// Frames: Takayama 2008, §5.2.2, scale after §5.2.7.
//
// Departures: vertex vectors are orthogonalised per tet, where the gradient is known, after averaging; where a second
// field gives T (types 2-c and 2-d, which the paper leaves out) its gradient is orthogonalised to the first's.
#include "volume/field/frames.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/field/axis_field.h"
#include "volume/field/scale_hint.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pith {
namespace {

constexpr double stroke_margin = 0.01;     ///< of the region's diagonal: how far outside a stroke still counts
constexpr float smallest_agreement = 0.5f; ///< of an axis at a tet's corners, for it to count
constexpr int samples_per_scale_stroke = 20;

Box bounds_of_region(const TetMesh& mesh, std::int32_t region) {
  Box box;
  for (const TetId t : all_ids<TetId>(mesh.tet_count()))
    if (mesh.region[t] == region)
      for (const VertexId v : mesh.corner[t]) box.add(mesh.position[v]);
  return box;
}

void check(const FrameInput& in) {
  for (const DepthField* field : {in.depth, in.along, in.around})
    if (field && (field->value.size() != in.mesh.vertex_count() || field->gradient.size() != in.mesh.tet_count()))
      throw InvalidInput(in.where, "a depth field is of another mesh", "make depth and frames on one mesh");
  if (in.along && !in.depth)
    throw InvalidInput(in.where + "/along", "is given without \"depth\"", "give both, or strokes alone");
  if (in.around && !in.along)
    throw InvalidInput(in.where + "/around", "is given without \"along\"", "give all three fields");
  if (in.along && !in.stroke.empty())
    throw InvalidInput(in.where + "/orientation", "and \"along\" both give the T axis", "keep one of them");
  if (!(in.scale >= 0) || !std::isfinite(in.scale))
    throw InvalidInput(in.where + "/scale", "is " + std::to_string(in.scale),
                       "give millimetres per texture width, above 0");
  if (in.scale == 0 && !in.depth)
    throw InvalidInput(in.where + "/scale", "is missing: there is no depth that it could follow",
                       "give millimetres per texture width");
}

/// 1/|∇d|, or the scale that is given.
class Scale {
public:
  Scale(const FrameInput& in, const FrameOptions& options, double extent) : in_(in) {
    smallest_ = options.smallest_scale > 0 ? options.smallest_scale : 0.01 * extent;
    largest_ = options.largest_scale > 0 ? options.largest_scale : extent;
    if (!(smallest_ <= largest_))
      throw InvalidInput(in.where + "/frame",
                         "its smallest scale, " + std::to_string(smallest_) + " mm, exceeds the largest, " +
                             std::to_string(largest_) + " mm",
                         "swap them or leave one at 0");
  }
  double at(TetId t) const {
    if (in_.scale > 0) return in_.scale;
    const double rise = in_.depth->gradient[t].norm();
    return rise > 0 ? std::clamp(1 / rise, smallest_, largest_) : largest_;
  }

private:
  const FrameInput& in_;
  double smallest_, largest_;
};

/// The logarithm of the local factor at every vertex; empty without constraints.
PerVertex<Vec3d> local_scale(const FrameInput& in, double margin) {
  if (in.local_scale.empty()) return {};
  std::vector<FieldConstraint> constraints;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < in.local_scale.size(); ++i) {
    const ScaleConstraint& one = in.local_scale[i];
    const std::string name = in.where + "/local_scale/" + std::to_string(i);
    if (!(one.factor > 0) || !std::isfinite(one.factor))
      throw InvalidInput(name + "/factor", "is " + std::to_string(one.factor),
                         "give a number above 0; 1 leaves the scale as it is");
    for (const Vec3d& p : one.stroke)
      if (!p.allFinite()) throw InvalidInput(name, "a point is not finite", "give finite coordinates");
    const double length = length_of(one.stroke), value = std::log(one.factor);
    const std::size_t before = constraints.size();
    for (const LocatedSample& held : located_samples(in.mesh, in.locator, in.region, one.stroke,
                                                     length > 0 ? length / samples_per_scale_stroke : 1, margin))
      constraints.push_back({held.location.tet, held.location.barycentric, Vec3d(value, 0, 0)});
    if (constraints.size() == before)
      throw InvalidInput(
          name, "touches no place of region " + std::to_string(in.region),
          scale_hint(in.mesh, one.stroke, "put it on or inside the region, in the mesh's millimetres"));
    low = std::min(low, value), high = std::max(high, value);
  }
  PerVertex<Vec3d> factor;
  if (low == high) { // nothing to interpolate
    factor.assign(in.mesh.vertex_count(), Vec3d(low, 0, 0));
    return factor;
  }
  factor = smooth_vectors(in.mesh, in.region, constraints);
  for (Vec3d& f : factor) f.x() = std::clamp(f.x(), low, high);
  return factor;
}

/// Fills axes and singular of a region tet by tet: frame(t, axes) returns whether it is determined.
template <class Frame>
void for_each_tet(const FrameInput& in, FrameField& field, const Frame& frame) {
  parallel_for(in.mesh.tet_count(), 1024, [&](std::size_t i) {
    const TetId t(i);
    if (in.mesh.region[t] == in.region) field.singular[t] = !frame(t, field.axes[t]);
  });
}

/// S along depth, T along `across`, which is perpendicular to it: R × S = T.
Mat3d frame_of(const Vec3d& s, const Vec3d& across) {
  const Vec3d t = across.squaredNorm() > 0.5 ? across : perpendicular_to(s);
  const Vec3d r = s.cross(t).normalized();
  Mat3d frame;
  frame << r, s, r.cross(s);
  return frame;
}

/// Whether a field rises by enough over the region to have a direction.
struct Steep {
  double extent, vanishing_rise;
  bool operator()(const Vec3d& gradient) const { return gradient.norm() * extent >= vanishing_rise; }
};

/// Type 1-a.
void follow_strokes(const FrameInput& in, const AxisFieldOptions& axis_options, FrameField& field) {
  const AxisField axis =
      axis_field(in.mesh, in.locator, in.region, in.stroke, {}, in.where + "/orientation", axis_options);
  field.smoothing = axis.smoothing;
  for_each_tet(in, field, [&](TetId t, Mat3d& axes) {
    const Vec3d along = axis.direction[t].squaredNorm() > 0.5 ? axis.direction[t] : Vec3d::UnitZ();
    axes = frame_of(perpendicular_to(along), along);
    return axis.agreement[t] >= smallest_agreement;
  });
}

/// Types 2-a and 2-b. Where depth is level, S is some direction across the axis.
void follow_depth_and_strokes(const FrameInput& in, const FrameOptions& options, const Steep& steep,
                              AxisFieldOptions axis_options, FrameField& field) {
  axis_options.smoothing.depth = in.depth->value;
  axis_options.smoothing.layer_width = options.layer_width;
  PerTet<Vec3d> s(in.mesh.tet_count(), Vec3d::UnitX());
  parallel_for(in.mesh.tet_count(), 1024, [&](std::size_t i) {
    const Vec3d& gradient = in.depth->gradient[TetId(i)];
    const double rise = gradient.norm();
    if (rise > 0) s[TetId(i)] = gradient / rise;
  });
  const AxisField axis =
      axis_field(in.mesh, in.locator, in.region, in.stroke, s, in.where + "/orientation", axis_options);
  field.smoothing = axis.smoothing;
  for_each_tet(in, field, [&](TetId t, Mat3d& axes) {
    axes = frame_of(s[t], axis.direction[t]);
    return steep(in.depth->gradient[t]) && axis.sine[t] >= options.singular_sine &&
           axis.agreement[t] >= smallest_agreement;
  });
}

/// Types 2-c and 2-d.
void follow_fields(const FrameInput& in, const FrameOptions& options, const Steep& steep, FrameField& field) {
  const auto unit = [](const Vec3d& v) { return v.norm() > 0 ? Vec3d(v / v.norm()) : Vec3d(Vec3d::UnitX()); };
  double right_handed = 0; // by volume: the whole map may be a mirror image, but not a part of it
  if (in.around)
    for (const TetId t : all_ids<TetId>(in.mesh.tet_count()))
      if (in.mesh.region[t] == in.region) {
        const double handed =
            in.around->gradient[t].dot(in.depth->gradient[t].cross(in.along->gradient[t])) > 0 ? 1 : -1;
        right_handed += handed * signed_volume(in.mesh, t);
      }
  for_each_tet(in, field, [&](TetId t, Mat3d& axes) {
    const Vec3d s = unit(in.depth->gradient[t]), along = unit(in.along->gradient[t]);
    const Vec3d across = along - along.dot(s) * s;
    const double sine = across.norm();
    axes = frame_of(s, sine > 1e-9 ? Vec3d(across / sine) : Vec3d(Vec3d::Zero()));
    bool determined = steep(in.depth->gradient[t]) && steep(in.along->gradient[t]) && sine >= options.singular_sine;
    if (in.around) {
      const double height = unit(in.around->gradient[t]).dot(axes.col(0)) * (right_handed >= 0 ? 1 : -1);
      determined &= steep(in.around->gradient[t]) && height >= options.singular_sine;
    }
    return determined;
  });
}

} // namespace

FrameField frames_of(const FrameInput& in, const FrameOptions& options) {
  check(in);
  const Box box = bounds_of_region(in.mesh, in.region);
  if (box.empty())
    throw InvalidInput(in.where, "the mesh has no region " + std::to_string(in.region),
                       "name a region from 0 on (one per closed shell of the surface)");
  const double extent = box.extent().maxCoeff(), margin = stroke_margin * box.diagonal();
  const Scale scale(in, options, extent);
  const Steep steep{extent, options.vanishing_rise};
  const AxisFieldOptions axis_options{.smoothing = {}, .unsigned_axis = options.unsigned_axis, .margin = margin};

  FrameField field;
  field.axes.assign(in.mesh.tet_count(), Mat3d::Identity());
  field.scale.assign(in.mesh.tet_count(), 0.0f);
  field.singular.assign(in.mesh.tet_count(), 0);
  if (in.along) {
    follow_fields(in, options, steep, field);
  } else if (in.depth && !in.stroke.empty()) {
    follow_depth_and_strokes(in, options, steep, axis_options, field);
  } else if (in.depth) {
    for_each_tet(in, field, [&](TetId t, Mat3d& axes) { // type 1-b
      const Vec3d& gradient = in.depth->gradient[t];
      axes = frame_of(gradient.norm() > 0 ? Vec3d(gradient.normalized()) : Vec3d(Vec3d::UnitY()), Vec3d::Zero());
      return steep(gradient);
    });
  } else if (!in.stroke.empty()) {
    follow_strokes(in, axis_options, field);
  }
  const PerVertex<Vec3d> factor = local_scale(in, margin);
  std::size_t regular = 0;
  for (const TetId t : all_ids<TetId>(in.mesh.tet_count())) {
    if (in.mesh.region[t] != in.region) continue;
    double local = 0;
    if (!factor.empty())
      for (const VertexId v : in.mesh.corner[t]) local += 0.25 * factor[v].x();
    field.scale[t] = static_cast<float>(scale.at(t) * std::exp(local));
    regular += !field.singular[t];
  }
  if (regular > 0) return field;
  if (in.around)
    throw InvalidInput(in.where + "/around", "rises along the same directions as \"depth\" and \"along\" everywhere",
                       "let the three fields rise in three different directions");
  if (in.along)
    throw InvalidInput(in.where + "/along", "rises along \"depth\" everywhere (or one of them is constant)",
                       "let it rise across the direction in which depth rises");
  if (in.depth && in.stroke.empty())
    throw InvalidInput(in.where + "/depth", "is constant", "give the core another depth than the skin");
  if (in.depth)
    throw InvalidInput(in.where + "/orientation",
                       "the strokes run along the depth's gradient everywhere (or the depth is constant)",
                       "draw strokes across the direction in which depth rises");
  throw InvalidInput(in.where + "/orientation", "the strokes cancel one another everywhere",
                     "draw them in one sense, or set frame/axis to \"unsigned\" where the texture has none");
}

FrameField frames_from_depth(const TetMesh& mesh, const Locator& locator, std::int32_t region,
                             const DepthField& depth, const std::vector<AxisStroke>& strokes,
                             const std::string& where, const FrameOptions& options) {
  if (strokes.empty())
    throw InvalidInput(where + "/orientation", "there is no stroke", "draw at least one along the texture's T axis");
  return frames_of(
      {.mesh = mesh, .locator = locator, .region = region, .depth = &depth, .stroke = strokes, .where = where},
      options);
}

SingularSet singular_set(const TetMesh& mesh, std::int32_t region, std::span<const std::uint8_t> singular) {
  SingularSet set;
  double all = 0, without = 0;
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    if (mesh.region[t] != region) continue;
    const double volume = signed_volume(mesh, t);
    all += volume;
    if (!singular[t]) continue;
    ++set.tets;
    without += volume;
  }
  set.share = all > 0 ? without / all : 0;
  return set;
}

} // namespace pith
