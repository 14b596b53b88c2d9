#pragma once
// What cuts: scalar functions of space whose zero set is the section. Below zero is the left half, above the right.
#include "volume/base/types.h"
#include "volume/base/view.h"
#include "volume/mesh/tri_mesh.h"

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace pith {

/// A scalar function of a point, in world space (where pieces stand), mm-like units near its zero set.
class LevelSet {
public:
  virtual ~LevelSet() = default;
  virtual double value(const Vec3d& x) const = 0;
  /// Direction of increase at x, any length; used for section normals.
  virtual Vec3d gradient(const Vec3d& x) const = 0;
  /// −1 or +1 when φ certainly has that strict sign all through the closed ball; 0 where it may change or is not
  /// known. Cuts pass over what lies in balls of one sign.
  virtual int side_of_ball(const Vec3d& /*center*/, double /*radius*/) const { return 0; }
  /// Many values at once, in parallel; result[i] belongs to points[i] and equals value(points[i]) bit for bit.
  virtual void values(std::span<const Vec3d> points, std::span<double> result) const;
  /// True where the function is linear, so that one linear step along an edge finds its zero.
  virtual bool linear() const { return false; }
};

/// Smooth hills and valleys on a plane, as between the layers of a rock: random plane waves (a Gaussian random
/// field), softly bounded, so that no point is farther than `amplitude` from the plane. Planes of equal normal and
/// waves run alongside one another at any offset and never meet.
struct Waves {
  double amplitude = 0;   ///< mm; 0: flat
  double length = 10;     ///< mm from hill to hill, about
  std::uint64_t seed = 1; ///< which waves
};
/// normal · x = offset (+ waves); `normal` need not have unit length. Right (positive) is where the normal points.
struct PlaneCut {
  Vec3d normal{0, 0, 1};
  double offset = 0;
  Waves waves = {};
};
/// Outside of the sphere is positive.
struct SphereCut {
  Vec3d center{0, 0, 0};
  double radius = 1;
};
/// A freeform stroke drawn on the screen, extruded along the view (Takayama 2008, §5.1.1). Points are screen
/// coordinates (View). Seen along the direction of drawing, the left of the stroke is negative. Beyond its ends the
/// stroke goes on straight, in the direction of its last twentieth; if the two continuations meet, they end there.
///
/// φ(x) = s · (d + clamp(r − d, ±w)), where d is the signed distance to the stroke on the screen, r a thin-plate
/// spline through at most 36 nodes of the stroke (0 there, ±offset beside them), w 1/144 of the stroke's length, and
/// s the millimetres per screen unit at the depth of x. So the section is smooth where the spline follows the stroke,
/// and farther than w from the stroke the sign of φ is that of d, whatever the spline does. Away from the stroke r
/// fades out. A straight stroke is a plane. In perspective, points behind the eye are taken as just before it: the
/// cut goes on there in the direction of sight.
///
/// A closed stroke is a loop: its last point joins its first, and what it encloses, whichever way it is drawn, is
/// negative: punched out along the view or, between the sight distances `from` and `to`, scooped out.
struct StrokeCut {
  std::vector<Vec2d> point;
  View view;
  bool closed = false;
  double from = -std::numeric_limits<double>::infinity(); ///< closed: mm from the eye along the direction of sight
  double to = std::numeric_limits<double>::infinity();
};
/// Inside of the box is negative; its edges have the lengths `size` and are turned by `angle` about `axis`.
struct BoxCut {
  Vec3d center{0, 0, 0};
  Vec3d size{1, 1, 1}; ///< mm
  Vec3d axis{0, 0, 1};
  double angle = 0; ///< radians
};
/// Inside of the cylinder (an apple corer) is negative. It ends flat at both points, or goes on for ever.
struct CylinderCut {
  Vec3d from{0, 0, 0}, to{0, 0, 1};
  double radius = 1; ///< mm
  bool endless = false;
};
/// A smooth surface through points, at right angles to normals of any length, which point to the positive side:
/// radial basis functions through the points (0) and through one on each side of them. At most 2,000 points.
struct SheetCut {
  std::vector<Vec3d> point, normal;
};

/// What a recipe can cut or divide with.
using LevelSetShape = std::variant<PlaneCut, SphereCut, StrokeCut, BoxCut, CylinderCut, SheetCut>;

/// Throws InvalidInput (`where` names the field in the message) when the shape is degenerate: a zero normal, waves of
/// no length or of negative amplitude, a radius that is not positive, a stroke of fewer than two distinct points, one
/// that crosses itself or its continuations, a loop of no area, a view without direction, edges that are not
/// positive, a cylinder of no length, a point of a sheet given twice or without normal, numbers that are not finite.
/// Cost: a stroke ~0.3 ms (the spline), a sheet O(n³) in its points (500: 60 ms), the others none.
std::unique_ptr<LevelSet> level_set_of(const PlaneCut& plane, const std::string& where = "plane");
std::unique_ptr<LevelSet> level_set_of(const SphereCut& sphere, const std::string& where = "sphere");
std::unique_ptr<LevelSet> level_set_of(const StrokeCut& stroke, const std::string& where = "stroke");
std::unique_ptr<LevelSet> level_set_of(const BoxCut& box, const std::string& where = "box");
std::unique_ptr<LevelSet> level_set_of(const CylinderCut& cylinder, const std::string& where = "cylinder");
std::unique_ptr<LevelSet> level_set_of(const SheetCut& sheet, const std::string& where = "sheet");
/// The same for any shape; `where` is the step that holds it: "/plane", "/sphere" … is added.
std::unique_ptr<LevelSet> level_set_of(const LevelSetShape& shape, const std::string& where);

/// The signed distance to a surface mesh: closed, left is inside; open, right is where its triangles' normals point,
/// and beyond the rim it goes on along the rim's tangent planes. It should be oriented and not cross itself. Errors:
/// InvalidInput when it has no triangles or names vertices that it has not. Cost: O(n log n), a value O(log n).
std::unique_ptr<LevelSet> level_set_of(const TriMesh& surface, const std::string& where = "surface");

/// Negative where all parts are: the largest of their values. Precondition: there is one.
std::unique_ptr<LevelSet> shared_by(std::vector<std::unique_ptr<LevelSet>> parts);

} // namespace pith
