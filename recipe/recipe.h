#pragma once
// The document: what somebody wrote down to make a model. A recipe names inputs, constraints, strokes, cuts and
// moves; it never holds a number that depends on the mesh (tets, facets, patches, pieces): places are rest points and
// input triangles. docs/recipe.md describes the JSON that stands for it.
#include "volume/cut/level_set.h"
#include "volume/exemplar/tile.h"
#include "volume/field/depth.h"
#include "volume/field/frames.h"
#include "volume/lap/lap.h"
#include "volume/lap/scatter.h"
#include "volume/mesh/tetrahedralize.h"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pith {

/// The closed surface that is filled.
struct SurfaceSource {
  std::string file;      ///< relative to the recipe's folder; empty: `shape`
  double scale = 1;      ///< multiplies the coordinates; 1000 for a file in metres
  std::string shape;     ///< a name of shape_names(): a surface that pith makes itself
  int triangles = 20000; ///< of a shape, about
};

/// Where a solid texture comes from: a file, or a generator by name. Exactly one of `file` and `procedural` is set.
struct ExemplarSource {
  std::string file;                ///< relative to the recipe's folder
  std::optional<TileOptions> tile; ///< of a file: makes it repeat
  std::string procedural;          ///< a name of procedural_names()
  int resolution = 128;            ///< of a procedural exemplar, texels along each axis
  std::uint64_t seed = 1;          ///< of a procedural exemplar
};

/// A turn by an angle (radians) about an axis of any length above 0.
struct Turn {
  Vec3d axis{0, 0, 1};
  double angle = 0;
  Mat3d rotation() const { return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(); }
};

/// What a thing is cut from: an exemplar with a channel "alpha", or any exemplar under a mask.
struct ThingSource {
  ExemplarSource exemplar;
  std::optional<SplotchOptions> mask;
};

/// One thing pasted by hand.
struct PasteStep {
  ThingSource thing;
  Turn turn;
  PasteOptions options; ///< all but the rotation, which is turn's
};

/// Many things placed by a rule.
struct ScatterStep {
  ThingSource thing;
  Turn turn;
  ScatterOptions options; ///< all but the rotation, which is turn's
};

/// What one region is made of.
struct Solid {
  enum class Kind {
    plain, ///< one colour all the way through
    lapped ///< a lapped solid texture of `fill.type`
  };
  Kind kind = Kind::lapped;
  std::int32_t region = 0;    ///< one per closed shell of the surface, 0, 1, 2 … from the outside in; then divides'
  Vec3d color{0.5, 0.5, 0.5}; ///< plain: linear Rec.709

  // Which of these a type takes: traits_of(fill.type).
  std::vector<DepthConstraint> depth;  ///< S follows its gradient; coordinate 1 where the texture varies along it
  std::vector<DepthConstraint> along;  ///< types 2-c and 2-d: coordinate 2, from 0 to 1
  std::vector<DepthConstraint> around; ///< type 2-d: coordinate 0, from 0 to 1
  DepthOptions depth_options;          ///< of all three
  std::vector<AxisStroke> orientation; ///< T follows them
  double scale = 0;                    ///< mm per texture width (types 0, 1-a, 2-a); 0: none is given
  std::vector<ScaleConstraint> local_scale;
  FrameOptions frame;
  ExemplarSource exemplar;
  LapOptions fill; ///< type, seed, mask (splotch) and limits

  std::vector<ScatterStep> scatter; ///< on top of all that; each keeps clear of those before it and of all pastes
  std::vector<PasteStep> pastes;    ///< on top of the scattered ones; later ones over earlier ones
};

/// Which side of a cut stays.
enum class Keep { both, left, right };

/// Where a piece stood when a cut was made.
struct PiecePlacement {
  Vec3d piece = Vec3d::Zero(); ///< a rest point in the piece
  Rigid placement;
};

/// Parts regions of the mesh before anything is put on it: layers that lie on one another. Left of the shape (rest
/// space) a region keeps its number, right of it the numbers after the largest go on, in the order of the regions.
struct DivideStep {
  LevelSetShape shape;
  std::optional<SurfaceSource> surface; ///< in place of `shape`: a surface file; left is inside it
  std::vector<std::int32_t> only;       ///< regions to divide; empty: all that the shape passes through
  double snap = 0.2;                    ///< DivideOptions::snap
};

/// Where a solid's depth (Fields::depth) has a value: peels a layer off. What is nearer to the skin is left.
struct DepthCut {
  std::int32_t region = 0;
  double value = 0.5; ///< between 0 and 1
};

/// One cut. The shape is given in world space, where the pieces stand.
struct CutStep {
  LevelSetShape shape;
  std::optional<SurfaceSource> surface; ///< in place of `shape`: a surface file as a knife; left is inside it
  std::optional<DepthCut> depth;        ///< in place of `shape`
  std::vector<Vec3d> join;              ///< in place of a cut: rest points in pieces that become one again
  Keep keep = Keep::both;
  double spread = 0;                      ///< mm by which the halves are moved apart afterwards
  double snap = 0.01;                     ///< CutOptions::snap
  std::vector<Vec3d> only;                ///< rest points in the pieces to cut; empty: all pieces
  std::vector<PiecePlacement> placements; ///< where pieces stood; those not named stay where earlier steps left them
};

/// Moves one piece: a turn about `about`, then a shift; or all pieces.
struct MoveStep {
  /// `explode`: every piece goes away from the middle of all by this part of its distance from it.
  /// `drop`: every piece sinks or rises until its lowest point is on the plane z = this.
  std::optional<double> explode, drop;
  Vec3d piece = Vec3d::Zero();     ///< a rest point in the piece
  Vec3d translate = Vec3d::Zero(); ///< mm
  Vec3d axis{0, 0, 1};             ///< of the turn, any length above 0
  double angle = 0;                ///< radians
  std::optional<Vec3d> about;      ///< a world point on the axis; none: the piece's centroid where it stands
};

/// A whole recipe. Default options are the library's.
struct Recipe {
  std::string file = "recipe"; ///< what messages call it; not part of the document
  std::string name;
  SurfaceSource surface;
  TetrahedralizeOptions tetrahedralize;
  std::vector<DivideStep> divides; ///< a fold: each works on the regions that the earlier ones left
  std::vector<Solid> solids;       ///< regions without a solid become plain grey
  std::vector<CutStep> cuts;       ///< a fold: each works on what the earlier ones left
  std::vector<MoveStep> moves;     ///< a fold, after all cuts
  std::optional<View> view;        ///< where to look from, for pictures
  std::string scene;               ///< a scene file for pictures, relative to the recipe's folder; may be empty
};

/// Reads JSON text. `file` is what messages call it. Errors: InvalidInput, naming the place as a path into the
/// document
/// ("kiwi.json: /solids/0/depth/1/value: is 2, must be 0 to 1; ..."), for text that is not JSON, unknown or repeated
/// keys, wrong types, missing keys, numbers out of range and constraints that contradict one another.
Recipe parse_recipe(const std::string& text, const std::string& file);

/// Reads a recipe file; messages call it by its file name. Errors: IoFailure when it cannot be read, and the above.
Recipe read_recipe(const std::filesystem::path& path);

/// Reads one cut from JSON text: an entry of "cuts", or a bare stroke ("points" and "view"). Errors as for recipes.
CutStep parse_cut(const std::string& text, const std::string& file);

/// Reads a view from JSON text. Errors as for recipes.
View parse_view(const std::string& text, const std::string& file);

/// The recipe as canonical JSON: fixed order of keys, shortest numbers that read back alike, a line feed at the end.
/// parse_recipe(recipe_text(r)) says the same as r, and writes the same text again.
std::string recipe_text(const Recipe& recipe);

} // namespace pith
