#pragma once
// A model: the root mesh and the layers on it. Plain data; Root makes it ready to be asked for its material.
#include "volume/layer/layer.h"
#include "volume/mesh/boundary.h"
#include "volume/mesh/locate.h"

#include <memory>
#include <span>

namespace pith {

/// What was computed on the root before the layers; kept for tools that show or reuse it. Any may be empty.
struct Fields {
  PerVertex<float> depth;        ///< 0 at the outermost, 1 at the innermost part of each region
  PerTet<Mat3d> axes;            ///< columns: the unit axes R, S, T of the texture (S along depth)
  PerTet<float> scale;           ///< mm per texture width
  PerTet<std::uint8_t> singular; ///< 1 where the frame is not determined
};

struct Model {
  std::string name;
  TetMesh mesh; ///< the root: fixed once filling starts
  Boundary boundary;
  Fields field;
  std::vector<Layer> layer; ///< bottom first
};

/// Throws InvalidInput when anything does not fit together.
void validate(const Model& model);

/// Where material is asked for.
struct MaterialPoint {
  Vec3d position = Vec3d::Zero(); ///< in rest space, mm
  std::int32_t region = -1;       ///< the side: which region, for points on an interface; −1: any
  FacetId facet{}; ///< on the skin: the root facet, so that skin layers count; none inside or on a section
  TetId hint{};    ///< a root tet near the point: speed only
};

/// What is there.
struct Material {
  std::array<float, max_components> value{}; ///< decoded, in the order of Root::channels(); directions in rest space
  float coverage = 0;             ///< accumulated alpha of the masked look-ups, 1 where nothing shines through
  std::uint16_t lookups_read = 0; ///< exemplar reads that it took
  TetId tet;                      ///< the owner
};

struct RootOptions {
  bool mips = true; ///< build coarser levels of the exemplars for footprints above 0
};

/// A checked, immutable model with what is needed to evaluate it fast: point location, decoding tables, mips.
/// Safe to share between threads.
class Root {
public:
  /// Throws InvalidInput when the model is not valid.
  explicit Root(Model model, const RootOptions& options = {});
  ~Root();
  Root(Root&&) noexcept;
  Root& operator=(Root&&) noexcept;

  const Model& model() const;
  const Locator& locator() const;
  /// The channels of all layers, colour first; layers that share a channel name share its components.
  const std::vector<Channel>& channels() const;
  int component_count() const;
  /// First component of a channel by name; −1 when there is none.
  int component_of(const std::string& channel) const;

  struct Tables;
  const Tables& tables() const { return *tables_; }

private:
  std::unique_ptr<const Tables> tables_;
};

/// The material at a point: a function of (position, side) and of nothing else (docs/design.md, idea 2). Layers are
/// composed from the top; skin layers count only when `facet` is given.
/// `footprint` (mm): 0 is the bit-exact value at the point; larger ones filter over about that width.
/// Cost: 0.1–0.4 µs with a hint on a lapped model.
Material material_at(const Root& root, const MaterialPoint& point, double footprint = 0);

/// The same at many points, bit for bit: result[i] belongs to points[i]. Faster where hints are good but neighbours
/// in the list lie far from one another: what a point needs is asked of the memory while those before it are worked
/// on. On the calling thread alone.
void materials_at(const Root& root, std::span<const MaterialPoint> points, std::span<Material> result,
                  double footprint = 0);

/// The same at a point whose owner is already known (a Location from Root::locator()).
Material material_at(const Root& root, const MaterialPoint& point, const Location& location, double footprint = 0);

} // namespace pith
