// Skin-to-skin tets: an inner edge of such a tet is split at its middle, and with it every tet around the edge, which
// keeps the mesh conforming (bisection, as in Rivara 1984); a tet all of whose edges lie on the boundary gets a
// vertex at its barycentre. Boundary edges are never split, so boundary facets keep their corners and what is known
// of them.
#include "volume/mesh/refine.h"

#include <algorithm>
#include <array>
#include <map>

namespace pith {

namespace {

using Triple = std::array<std::uint32_t, 3>;

Triple sorted(const std::array<VertexId, 3>& corner) {
  Triple t{corner[0], corner[1], corner[2]};
  std::sort(t.begin(), t.end());
  return t;
}

double volume_of(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return (b - a).cross(c - a).dot(d - a) / 6;
}

/// Inscribed radius over circumscribed radius, times 3: 1 for a regular tet, 0 for a flat one, negative when
/// inverted.
double quality(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d u = b - a, v = c - a, w = d - a;
  const double volume = volume_of(a, b, c, d);
  const double area = 0.5 * (u.cross(v).norm() + v.cross(w).norm() + w.cross(u).norm() + (c - b).cross(d - b).norm());
  const Vec3d center = u.squaredNorm() * v.cross(w) + v.squaredNorm() * w.cross(u) + w.squaredNorm() * u.cross(v);
  const double circumscribed = center.norm() / (12 * std::abs(volume));
  return volume == 0 ? 0 : 3 * (3 * volume / area) / circumscribed;
}

class Refiner {
public:
  Refiner(const TetMesh& mesh, const RefineOptions& options) : options_(options), around_(mesh.vertex_count()) {
    result_.mesh = mesh;
    const Boundary boundary = boundary_of(mesh);
    on_boundary_.assign(mesh.vertex_count(), 0);
    for (const auto& corner : boundary.corner) {
      for (VertexId v : corner) on_boundary_[v] = 1;
      for (int i = 0; i < 3; ++i) boundary_edge_.push_back(edge(corner[i], corner[(i + 1) % 3]));
    }
    std::sort(boundary_edge_.begin(), boundary_edge_.end());
    boundary_edge_.erase(std::unique(boundary_edge_.begin(), boundary_edge_.end()), boundary_edge_.end());
    for (TetId t : all_ids<TetId>(mesh.tet_count()))
      for (VertexId v : mesh.corner[t]) around_[v].push_back(t);
  }

  RefineResult run(const TetMesh& before, const Indexed<FacetId, TriangleId>& input) {
    for (const auto& stroke : options_.stroke) move_onto(stroke);
    if (options_.split_skin_tets) split_skin_tets();
    connect(result_.mesh);
    if (!input.empty()) carry_input(before, input);
    return std::move(result_);
  }

private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  static Edge edge(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }
  bool on_boundary(Edge e) const { return std::binary_search(boundary_edge_.begin(), boundary_edge_.end(), e); }
  const Vec3d& at(std::uint32_t v) const { return result_.mesh.position[VertexId(v)]; }

  bool is_skin_tet(TetId t) const {
    const auto& c = result_.mesh.corner[t];
    return std::all_of(c.begin(), c.end(), [&](VertexId v) { return on_boundary_[v] != 0; });
  }

  void split_skin_tets() {
    // Splitting adds inner vertices only, so the list never grows; a tet may already be split when its turn comes.
    std::vector<TetId> skin;
    for (TetId t : all_ids<TetId>(result_.mesh.tet_count()))
      if (is_skin_tet(t)) skin.push_back(t);
    result_.skin_tets = skin.size();
    for (TetId t : skin) {
      if (!is_skin_tet(t)) continue;
      Edge longest{};
      double length = -1;
      const auto& c = result_.mesh.corner[t];
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j)
          if (const Edge e = edge(c[i], c[j]); !on_boundary(e))
            if (const double l = (at(e.first) - at(e.second)).squaredNorm(); l > length) length = l, longest = e;
      if (length >= 0) {
        split_edge(longest);
      } else {
        split_inside(t);
      }
      ++result_.split;
    }
  }

  VertexId add_vertex(const Vec3d& position) {
    result_.mesh.position.push_back(position);
    around_.emplace_back();
    on_boundary_.push_back(0);
    return VertexId(result_.mesh.position.size() - 1);
  }

  /// A copy of tet t with corner `from` replaced by `to`.
  void add_tet(TetId t, VertexId from, VertexId to) {
    TetMesh& mesh = result_.mesh;
    auto corner = mesh.corner[t];
    std::replace(corner.begin(), corner.end(), from, to);
    const TetId added(mesh.corner.size());
    mesh.corner.push_back(corner);
    mesh.region.push_back(mesh.region[t]);
    for (VertexId v : corner) around_[v].push_back(added);
  }

  /// Replaces a corner of tet t in place.
  void replace_corner(TetId t, VertexId from, VertexId to) {
    auto& corner = result_.mesh.corner[t];
    std::replace(corner.begin(), corner.end(), from, to);
    std::erase(around_[from], t);
    around_[to].push_back(t);
  }

  void split_edge(Edge e) {
    const VertexId a(e.first), b(e.second), middle = add_vertex(0.5 * (at(e.first) + at(e.second)));
    std::vector<TetId> both;
    for (TetId t : around_[a]) {
      const auto& c = result_.mesh.corner[t];
      if (std::find(c.begin(), c.end(), b) != c.end()) both.push_back(t);
    }
    for (TetId t : both) {
      add_tet(t, a, middle);
      replace_corner(t, b, middle);
    }
  }

  void split_inside(TetId t) {
    const auto corner = result_.mesh.corner[t];
    const VertexId middle = add_vertex(0.25 * (at(corner[0]) + at(corner[1]) + at(corner[2]) + at(corner[3])));
    for (int i = 1; i < 4; ++i) add_tet(t, corner[i], middle);
    replace_corner(t, corner[0], middle);
  }

  /// Moves, at about every edge length along the stroke, the nearest inner vertex onto it.
  void move_onto(const std::vector<Vec3d>& stroke) {
    for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
      const Vec3d a = stroke[i], b = stroke[i + 1];
      const double length = (b - a).norm();
      for (std::uint32_t v = 0; length > 0 && v < around_.size(); ++v) {
        if (on_boundary_[v] || around_[v].empty()) continue;
        const double along = std::clamp((at(v) - a).dot(b - a) / (length * length), 0.0, 1.0);
        const Vec3d goal = a + along * (b - a);
        // Within half of its shortest edge: one vertex in every ball around the stroke goes there, not a crowd.
        double shortest = std::numeric_limits<double>::infinity();
        for (TetId t : around_[v])
          for (VertexId other : result_.mesh.corner[t])
            if (other != v) shortest = std::min(shortest, (at(other) - at(v)).norm());
        const double distance = (goal - at(v)).norm();
        if (distance > 0 && distance < 0.5 * shortest && keeps_quality(v, goal)) {
          result_.mesh.position[VertexId(v)] = goal;
          ++result_.moved;
        }
      }
    }
  }

  bool keeps_quality(std::uint32_t v, const Vec3d& goal) const {
    double before = 1, after = 1;
    for (TetId t : around_[v]) {
      std::array<Vec3d, 4> p;
      for (int i = 0; i < 4; ++i) p[i] = at(result_.mesh.corner[t][i]);
      before = std::min(before, quality(p[0], p[1], p[2], p[3]));
      for (int i = 0; i < 4; ++i)
        if (result_.mesh.corner[t][i] == v) p[i] = goal;
      after = std::min(after, quality(p[0], p[1], p[2], p[3]));
    }
    return after > options_.smallest_quality_kept * before && after > 0.01;
  }

  void carry_input(const TetMesh& before, const Indexed<FacetId, TriangleId>& input) {
    const Boundary old_boundary = boundary_of(before), boundary = boundary_of(result_.mesh);
    // An interface facet appears once for each side; both come from one triangle.
    std::map<Triple, TriangleId> triangle_of;
    for (FacetId f : all_ids<FacetId>(old_boundary.facet_count()))
      triangle_of[sorted(old_boundary.corner[f])] = input[f];
    result_.input.reserve(boundary.facet_count());
    for (FacetId f : all_ids<FacetId>(boundary.facet_count()))
      result_.input.push_back(triangle_of.at(sorted(boundary.corner[f])));
  }

  const RefineOptions& options_;
  RefineResult result_;
  std::vector<std::vector<TetId>> around_; ///< per vertex
  std::vector<std::uint8_t> on_boundary_;
  std::vector<Edge> boundary_edge_; ///< ascending
};

} // namespace

RefineResult refine(const TetMesh& mesh, const Indexed<FacetId, TriangleId>& input, const RefineOptions& options) {
  return Refiner(mesh, options).run(mesh, input);
}

} // namespace pith
