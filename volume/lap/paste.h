#pragma once
// Pasting one thing by hand: at a place, with a size and a rotation (Takayama, Okabe, Ijiri, Igarashi 2008, §4
// "manual pasting"). Pastes become sparse layers on top of a fill: whole, because each holds every tet that it
// touches.
#include "volume/lap/thing.h"
#include "volume/layer/layer.h"
#include "volume/mesh/locate.h"

#include <memory>
#include <span>
#include <string>

namespace pith {

/// How a pasted thing meets the frames around it.
enum class Follow : std::uint8_t {
  rigid, ///< keeps its shape: one affine map
  warped ///< bends with the frames and grows with their scale, as the pieces of a fill do (§5.2.5)
};

struct PasteOptions {
  Vec3d place = Vec3d::Zero();        ///< rest point; the middle of the thing goes there
  double size = 1;                    ///< mm: the longest side of the box around the thing
  Mat3d rotation = Mat3d::Identity(); ///< of the thing, before its axes 0, 1, 2 are laid along R, S, T
  bool in_frame = true;               ///< along the local frame; false: along the axes of rest space
  Follow follow = Follow::rigid;
  bool clip = true; ///< may reach out of the region, where nothing of it is seen; false: it must lie wholly inside
};

/// What is pasted on. Spans are over all tets of the mesh; both may be empty where no frames exist (a plain solid):
/// then R, S, T are the axes of rest space, and nothing can be warped.
struct PasteGround {
  const TetMesh& mesh;
  const Locator& locator;
  std::int32_t region = 0;
  std::span<const Mat3d> axes;
  std::span<const float> scale;
};

/// The box around a pasted thing, where it was put (before any warp).
struct PlacedBox {
  Vec3d center = Vec3d::Zero();
  Mat3d axes = Mat3d::Identity(); ///< columns
  Vec3d half = Vec3d::Zero();     ///< mm

  /// Whether the boxes come closer than `gap` along one of the fifteen axes of the separating axis test (Gottschalk,
  /// Lin, Manocha: OBBTree, 1996): with gap 0, exactly whether they meet.
  bool meets(const PlacedBox& other, double gap = 0) const;
};

/// One thing, pasted: the tets that it touches, ascending, and its coordinates there.
struct PastedThing {
  std::uint64_t key = 0; ///< hash of its place
  PlacedBox box;
  std::vector<std::uint32_t> tet;
  std::vector<std::array<std::uint32_t, 4>> corner; ///< per tet: rows of `coordinate`
  std::vector<std::array<float, 3>> coordinate;     ///< in the mask's unit cube
};

/// Pastes things of one kind; keeps memory from paste to paste. Not to be shared between threads.
class Paster {
public:
  /// `many`: prepares the frames at all vertices, O(tets), so that each box costs little.
  Paster(const PasteGround& ground, const Thing& thing, bool many = false);
  ~Paster();

  /// Where a thing would lie whose middle is at a location. O(tets around the tet's corners), or O(1) after `many`.
  PlacedBox box(const Location& at, const PasteOptions& options) const;
  /// Whether all of it that is at least half opaque lies in the region. O(tets that it touches).
  bool whole(const Location& at, const PlacedBox& box);
  PastedThing pasted(const Location& at, const PlacedBox& box, const PasteOptions& options);

private:
  struct Work;
  const PasteGround& ground_;
  const Thing& thing_;
  std::unique_ptr<Work> work_;
};

/// Pastes one thing. Errors: InvalidInput, at `where`, when the size is not positive, the rotation is none, the place
/// lies outside the region, the thing would not lie wholly inside though `clip` is off, or it should be warped where
/// there are no frames.
PastedThing paste(const PasteGround& ground, const Thing& thing, const PasteOptions& options,
                  const std::string& where);

/// Things of one kind that were pasted; refers to both.
struct PastedKind {
  const Thing* thing;
  std::span<const PastedThing> pasted;
};

/// The sparse layer of things: later kinds, and later things of a kind, lie on top. All kinds must have the same
/// channels; each kind's exemplar and mask is stored once. A kind without things is left out; with none at all the
/// layer has no exemplar and must not be used.
Layer layer_of(std::span<const PastedKind> kinds, std::int32_t region, const std::string& name);

} // namespace pith
