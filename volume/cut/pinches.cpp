// Pinches: where the below/on/above signs would leave a half that is not manifold. A new vertex never pinches, as the
// tets around its edge are cut alike; so only older vertices that count as on have to be looked at, and an edge
// between two of them shows at both. A half is manifold at a vertex when its link there (what its tets show of a
// small sphere around the vertex) is a disk, or the whole sphere.
//
// Published cutters let pinches be, or double vertices afterwards, which cannot part two sheets that meet along an
// edge inside the half. Here the vertex itself is given back to one side: the section then passes it within the snap,
// and the halves are manifold as tets, not only as surfaces.
#include "volume/cut/classify.h"

#include "volume/base/parallel.h"

#include <algorithm>

namespace pith {
namespace {

/// A point of a link: an old vertex (both the same), or the new vertex of an edge.
using Point = std::uint64_t;
Point point_at(VertexId a, VertexId b) {
  const std::uint64_t low = std::min(a.value, b.value), high = std::max(a.value, b.value);
  return low << 32 | high;
}

/// A link of one half at one vertex, as polygons; small arrays that are used again and again.
class Link {
public:
  void clear() {
    corner_.clear();
    end_.clear();
  }

  /// Adds what the half shows in the triangle abc, seen from outside: the part where states are `keep` or on.
  void add(const std::array<VertexId, 3>& v, const std::array<std::uint8_t, 3>& state, std::uint8_t keep) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if (state[i] == keep || state[i] == state_on) corner_.push_back(point_at(v[i], v[i]));
      if (state[i] + state[j] == 2 && state[i] != state_on) corner_.push_back(point_at(v[i], v[j]));
    }
    end_.push_back(corner_.size());
  }

  /// Nothing at all, a disk, or a sphere.
  bool manifold() {
    if (end_.empty()) return true;
    side_.clear();
    point_ = corner_;
    for (std::size_t cell = 0, begin = 0; cell < end_.size(); begin = end_[cell++])
      for (std::size_t i = begin; i < end_[cell]; ++i) {
        const Point a = corner_[i], b = corner_[i + 1 < end_[cell] ? i + 1 : begin];
        side_.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(cell)});
      }
    std::sort(side_.begin(), side_.end());
    std::sort(point_.begin(), point_.end());
    point_.erase(std::unique(point_.begin(), point_.end()), point_.end());

    parent_.resize(end_.size());
    for (std::size_t cell = 0; cell < end_.size(); ++cell) parent_[cell] = static_cast<std::uint32_t>(cell);
    border_.clear();
    std::size_t edges = 0, parts = end_.size();
    for (std::size_t i = 0; i < side_.size(); ++edges) {
      const bool paired = i + 1 < side_.size() && side_[i].a == side_[i + 1].a && side_[i].b == side_[i + 1].b;
      if (!paired) {
        border_.push_back(side_[i].a);
        border_.push_back(side_[i].b);
        ++i;
        continue;
      }
      const std::uint32_t a = root_of(side_[i].cell), b = root_of(side_[i + 1].cell);
      if (a != b) parent_[a] = b, --parts;
      i += 2;
    }
    if (parts != 1) return false;
    std::sort(border_.begin(), border_.end());
    for (std::size_t i = 0; i < border_.size(); i += 2) { // every point of the border has two of its sides
      if (i + 1 == border_.size() || border_[i] != border_[i + 1]) return false;
      if (i + 2 < border_.size() && border_[i] == border_[i + 2]) return false;
    }
    const auto euler = static_cast<std::ptrdiff_t>(point_.size() + end_.size()) - static_cast<std::ptrdiff_t>(edges);
    return euler == (border_.empty() ? 2 : 1);
  }

private:
  std::uint32_t root_of(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  struct Side {
    Point a, b;
    std::uint32_t cell;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Point> corner_, point_, border_;
  std::vector<std::size_t> end_;
  std::vector<Side> side_;
  std::vector<std::uint32_t> parent_;
};

/// A corner that is on, of a tet of a piece that falls in two.
struct OnCorner {
  std::uint32_t piece;
  VertexId vertex;
  std::uint32_t tet; ///< row of crossed, or crossed.size() + row of touching
  std::uint8_t corner;
  bool operator<(const OnCorner& other) const {
    return std::tie(piece, vertex, tet) < std::tie(other.piece, other.vertex, other.tet);
  }
};

/// Sides whose vertices are looked at, by piece and vertex.
class PinchSearch {
public:
  PinchSearch(const Pieces& pieces, const TetMesh& root, const Sides& sides)
      : pieces_(pieces), root_(root), sides_(sides) {
    for (std::size_t i = 0; i < sides.crossed.size() + sides.touching.size(); ++i) {
      const TetReference& tet = reference(i);
      if (sides.seen[tet.piece] != side_crossed) continue;
      const auto& corner = tet.corner(pieces, root);
      for (int k = 0; k < 4; ++k)
        if (sides.state[corner[k]] == state_on)
          on_.push_back({tet.piece, corner[k], static_cast<std::uint32_t>(i), static_cast<std::uint8_t>(k)});
    }
    std::sort(on_.begin(), on_.end());
    for (std::size_t i = 0; i < on_.size(); ++i)
      if (i == 0 || on_[i].piece != on_[i - 1].piece || on_[i].vertex != on_[i - 1].vertex) begin_.push_back(i);
    begin_.push_back(on_.size());
  }

  /// The vertices at which some half is pinched, ascending.
  std::vector<VertexId> pinched() const {
    const std::size_t count = begin_.size() - 1;
    std::vector<std::uint8_t> bad(count, 0);
    parallel_blocks(count, 64, [&](std::size_t from, std::size_t to) {
      Link link;
      for (std::size_t i = from; i < to; ++i)
        for (const std::uint8_t keep : {state_below, state_above}) bad[i] |= !manifold(i, keep, link);
    });
    std::vector<VertexId> result;
    for (std::size_t i = 0; i < count; ++i)
      if (bad[i]) result.push_back(on_[begin_[i]].vertex);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

private:
  const TetReference& reference(std::size_t i) const {
    return i < sides_.crossed.size() ? sides_.crossed[i] : sides_.touching[i - sides_.crossed.size()];
  }

  bool manifold(std::size_t i, std::uint8_t keep, Link& link) const {
    link.clear();
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      const auto& corner = reference(on_[k].tet).corner(pieces_, root_);
      std::array<VertexId, 3> v;
      std::array<std::uint8_t, 3> state;
      bool kept = false, all_on = true;
      for (int j = 0; j < 3; ++j) {
        v[j] = corner[facet_corners[on_[k].corner][j]];
        state[j] = sides_.state[v[j]];
        kept |= state[j] == keep;
        all_on &= state[j] == state_on;
      }
      if (kept || (all_on && keep == state_below)) link.add(v, state, keep);
    }
    return link.manifold();
  }

  const Pieces& pieces_;
  const TetMesh& root_;
  const Sides& sides_;
  std::vector<OnCorner> on_;
  std::vector<std::size_t> begin_;
};

} // namespace

void part_pinches(const Pieces& pieces, const TetMesh& root, const PieceGroup& group, const GroupField& field,
                  Sides& sides) {
  for (;;) {
    const std::vector<VertexId> pinched = PinchSearch(pieces, root, sides).pinched();
    if (pinched.empty()) return;
    for (const VertexId v : pinched) sides.state[v] = field.value[v] < 0 ? state_below : state_above;
    refile(pieces, root, group, sides);
  }
}

} // namespace pith
