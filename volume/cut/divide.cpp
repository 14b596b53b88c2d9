// Regions parted by a level set. Vertices near it are moved onto it first, as in Labelle, Shewchuk: Isosurface
// stuffing, 2007, §3 ("warping"), then the mesh is cut like any other (cut.h), and its two halves are put together
// again as one mesh of more regions.
//
// Departures: only inner vertices move, along the level set's gradient and only where their tets keep their quality,
// for the mesh is not a lattice; a boundary vertex stays, so that the surface is the one that was given.
#include "volume/cut/divide.h"

#include "volume/base/error.h"
#include "volume/cut/cut.h"
#include "volume/mesh/orientation.h"
#include "volume/mesh/region_measure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace pith {
namespace {

/// A moved vertex may make its worst tet worse than this part of what it was only while it stays above `good_angle`.
constexpr double quality_kept = 0.5;
constexpr double good_angle = 0.2; // radians, 11.5°
/// For what the moves leave: new vertices keep this fraction away from the ends of their edges.
constexpr double least_fraction = 1e-3;

class RegionDivision {
public:
  RegionDivision(const TetMesh& mesh, const LevelSet& level_set, const DivideOptions& options,
                 const std::string& where)
      : level_set_(level_set), options_(options), where_(where), mesh_(mesh), boundary_(boundary_of(mesh)) {}

  DivideResult run(const Indexed<FacetId, TriangleId>& input) {
    select();
    evaluate();
    if (options_.snap > 0) move_near_vertices();
    cut_all();
    DivideResult result;
    result.tets_cut = tets_cut_;
    result.moved = moved_;
    assemble(input, result);
    return result;
  }

private:
  std::string regions_text() const {
    std::string text;
    for (const std::int32_t region : regions_) text += (text.empty() ? "" : ", ") + std::to_string(region);
    return text;
  }

  void select() {
    if (!(options_.snap >= 0 && options_.snap <= 0.4))
      throw InvalidInput(where_, "the snap is " + std::to_string(options_.snap) + " of an edge", "give 0 to 0.4");
    regions_.insert(mesh_.region.begin(), mesh_.region.end());
    for (const std::int32_t region : options_.only)
      if (!regions_.contains(region))
        throw InvalidInput(where_ + "/only", "there is no region " + std::to_string(region),
                           "the regions here are " + regions_text());
    wanted_ = options_.only.empty() ? regions_ : std::set(options_.only.begin(), options_.only.end());
    chosen_tet_.resize(mesh_.tet_count());
    for (const TetId t : all_ids<TetId>(mesh_.tet_count())) chosen_tet_[t] = wanted_.contains(mesh_.region[t]);
  }

  /// φ at the vertices of the regions to divide. All others count as on the level set: an edge is cut only where it
  /// has both ends on those regions, and whatever tet has that edge is subdivided with it.
  void evaluate() {
    value_.assign(mesh_.vertex_count(), 0);
    PerVertex<std::uint8_t> chosen(mesh_.vertex_count(), 0);
    for (const TetId t : all_ids<TetId>(mesh_.tet_count()))
      if (chosen_tet_[t])
        for (const VertexId v : mesh_.corner[t]) chosen[v] = 1;
    std::vector<VertexId> vertex;
    std::vector<Vec3d> place;
    for (const VertexId v : all_ids<VertexId>(mesh_.vertex_count()))
      if (chosen[v]) vertex.push_back(v), place.push_back(mesh_.position[v]);
    std::vector<double> there(place.size());
    level_set_.values(place, there);
    for (std::size_t i = 0; i < vertex.size(); ++i) {
      if (!std::isfinite(there[i]))
        throw InvalidInput(where_, "the level set is not finite at vertex " + std::to_string(vertex[i]),
                           "give a shape that is finite all over the solid");
      value_[vertex[i]] = there[i];
      low_ = std::min(low_, there[i]);
      high_ = std::max(high_, there[i]);
    }
  }

  /// Vertices that an edge's zero comes close to, with how close: the nearest first.
  std::vector<std::pair<double, VertexId>> near_vertices() const {
    PerVertex<double> nearest(mesh_.vertex_count(), 1);
    for (const TetId t : all_ids<TetId>(mesh_.tet_count())) {
      if (!chosen_tet_[t]) continue;
      const auto& corner = mesh_.corner[t];
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
          const double a = value_[corner[i]], b = value_[corner[j]];
          if (!(a * b < 0)) continue;
          nearest[corner[i]] = std::min(nearest[corner[i]], std::abs(a) / (std::abs(a) + std::abs(b)));
        }
    }
    std::vector<std::pair<double, VertexId>> result;
    for (const VertexId v : all_ids<VertexId>(mesh_.vertex_count()))
      if (nearest[v] < options_.snap) result.emplace_back(nearest[v], v);
    std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : a.second.value < b.second.value;
    });
    return result;
  }

  void move_near_vertices() {
    const VertexTets around = tets_around_vertices(mesh_);
    PerVertex<std::uint8_t> fixed(mesh_.vertex_count(), 0);
    for (const auto& corner : boundary_.corner)
      for (const VertexId v : corner) fixed[v] = 1;
    for (const auto& [fraction, v] : near_vertices()) {
      double shortest = std::numeric_limits<double>::infinity();
      for (const TetId t : around[v])
        for (const VertexId other : mesh_.corner[t])
          if (other != v) shortest = std::min(shortest, (mesh_.position[other] - mesh_.position[v]).norm());
      if (!fixed[v] && move_onto_zero(v, around[v], shortest)) continue;
      const double slope = level_set_.gradient(mesh_.position[v]).norm();
      if (std::abs(value_[v]) <= 0.25 * options_.snap * shortest * slope) value_[v] = 0;
    }
  }

  /// Newton's steps along the gradient; then the vertex is on the level set, or where it was.
  bool move_onto_zero(VertexId v, std::span<const TetId> tets, double shortest) {
    const Vec3d from = mesh_.position[v];
    Vec3d x = from;
    double distance = std::numeric_limits<double>::infinity();
    for (int step = 0; step < 8 && distance > 1e-12 * shortest; ++step) {
      const Vec3d gradient = level_set_.gradient(x);
      const double square = gradient.squaredNorm(), value = level_set_.value(x);
      if (!(square > 0) || !std::isfinite(value)) return false;
      distance = std::abs(value) / std::sqrt(square);
      x -= value / square * gradient;
    }
    if (!x.allFinite() || distance > 1e-6 * shortest || (x - from).norm() > shortest) return false;
    const double before = worst_angle(tets);
    mesh_.position[v] = x;
    const double after = worst_angle(tets);
    if (after < std::min(good_angle, quality_kept * before) || !(after > 0)) {
      mesh_.position[v] = from;
      return false;
    }
    value_[v] = 0;
    ++moved_;
    return true;
  }

  /// The smallest dihedral angle among tets; 0 when one is turned over or flat.
  double worst_angle(std::span<const TetId> tets) const {
    double worst = 4;
    for (const TetId t : tets) {
      std::array<Vec3d, 4> p;
      for (int i = 0; i < 4; ++i) p[i] = mesh_.position[mesh_.corner[t][i]];
      if (orientation(p[0], p[1], p[2], p[3]) <= 0 || !(signed_volume(mesh_, t) > 0)) return 0;
      worst = std::min(worst, smallest_dihedral(p));
    }
    return worst;
  }

  void cut_all() {
    bool below = false, above = false;
    for (const TetId t : all_ids<TetId>(mesh_.tet_count()))
      for (const VertexId v : mesh_.corner[t]) {
        below |= chosen_tet_[t] && value_[v] < 0;
        above |= chosen_tet_[t] && value_[v] > 0;
      }
    if (!below || !above) refuse_miss();
    pieces_ = whole_piece(mesh_);
    try {
      tets_cut_ = cut_by_values(pieces_, mesh_, boundary_, value_, &level_set_,
                                {.only = {}, .snap = least_fraction, .manifold = false})
                      .tets_cut;
    } catch (const InvalidInput&) { // it only touches the regions
      refuse_miss();
    }
  }

  [[noreturn]] void refuse_miss() const {
    const std::string range = "the level set runs from " + std::to_string(low_) + " to " + std::to_string(high_);
    if (options_.only.empty())
      throw InvalidInput(where_, "divides no region: " + range + " over the solid, all on one side",
                         "move it so that it passes through the solid");
    throw InvalidInput(where_,
                       "misses region " + std::to_string(*wanted_.begin()) + ": " + range +
                           " over the regions to divide, all on one side",
                       "move it, or name another region in \"only\"");
  }

  /// One tet of the divided mesh.
  struct Part {
    std::array<VertexId, 4> corner;
    TetId root;
    bool right;
    std::array<FacetId, 4> facet; ///< of the mesh before
  };

  /// On which side a tet that was not subdivided lies: what its farthest corner says, or its middle where all are on.
  bool whole_on_right(TetId t) const {
    double farthest = 0;
    for (const VertexId v : mesh_.corner[t])
      if (std::abs(value_[v]) > std::abs(farthest)) farthest = value_[v];
    return (farthest != 0 ? farthest : level_set_.value(barycenter(mesh_, t))) > 0;
  }

  /// All tets in the order of those they come from.
  std::vector<Part> parts() const {
    std::vector<Part> result;
    result.reserve(mesh_.tet_count() + 4 * tets_cut_);
    for (const TetId t : all_ids<TetId>(mesh_.tet_count()))
      if (pieces_.label[t] != Pieces::was_cut)
        result.push_back({mesh_.corner[t], t, whole_on_right(t), boundary_.facet_of_tet[t]});
    for (std::size_t p = 0; p < pieces_.piece.size(); ++p)
      for (const CutTet& tet : pieces_.piece[p].cut) {
        const bool whole = tet.corner == mesh_.corner[tet.root];
        Part& part = result.emplace_back(Part{tet.corner, tet.root, whole ? whole_on_right(tet.root) : p == 1, {}});
        for (int i = 0; i < 4; ++i) part.facet[i] = tet.face[i].facet();
      }
    std::stable_sort(result.begin(), result.end(), [](const Part& a, const Part& b) { return a.root < b.root; });
    return result;
  }

  void assemble(const Indexed<FacetId, TriangleId>& input, DivideResult& result) {
    const std::vector<Part> part = parts();
    std::map<std::int32_t, std::array<std::size_t, 2>> sides;
    for (const Part& one : part)
      if (chosen_tet_[one.root]) ++sides[mesh_.region[one.root]][one.right];
    std::map<std::int32_t, std::int32_t> right_of;
    std::int32_t next = *regions_.rbegin() + 1;
    for (const auto& [region, count] : sides) {
      if (count[0] > 0 && count[1] > 0) {
        result.split.push_back({region, next});
        right_of[region] = next++;
      } else if (!options_.only.empty()) {
        throw InvalidInput(where_, "misses region " + std::to_string(region),
                           "move it, or leave this region out of \"only\"");
      }
    }
    if (result.split.empty()) refuse_miss();

    TetMesh& divided = result.mesh;
    divided.position = mesh_.position;
    divided.position.insert(divided.position.end(), pieces_.added_position.begin(), pieces_.added_position.end());
    divided.corner.reserve(part.size());
    divided.region.reserve(part.size());
    for (const Part& one : part) {
      const std::int32_t region = mesh_.region[one.root];
      const auto right = right_of.find(region);
      divided.corner.push_back(one.corner);
      divided.region.push_back(one.right && right != right_of.end() ? right->second : region);
    }
    connect(divided);
    if (input.empty()) return;
    const Boundary boundary = boundary_of(divided);
    result.input.resize(boundary.facet_count());
    for (const FacetId f : all_ids<FacetId>(boundary.facet_count()))
      if (const FacetId before = part[boundary.tet[f]].facet[boundary.opposite[f]]; before.exists())
        result.input[f] = input[before];
  }

  const LevelSet& level_set_;
  const DivideOptions& options_;
  const std::string& where_;
  TetMesh mesh_; ///< as given, with vertices moved
  Boundary boundary_;
  std::set<std::int32_t> regions_, wanted_;
  PerTet<std::uint8_t> chosen_tet_;
  PerVertex<double> value_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
  std::size_t moved_ = 0, tets_cut_ = 0;
  Pieces pieces_;
};

} // namespace

DivideResult divide(const TetMesh& mesh, const Indexed<FacetId, TriangleId>& input, const LevelSet& level_set,
                    const DivideOptions& options, const std::string& where) {
  if (mesh.tet_count() == 0) throw InvalidInput(where, "the mesh has no tets", "give a mesh of a solid");
  return RegionDivision(mesh, level_set, options, where).run(input);
}

} // namespace pith
