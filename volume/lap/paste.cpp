// Takayama, Okabe, Ijiri, Igarashi: Lapped Solid Textures (SIGGRAPH 2008), §4 (manual pasting) and §5.2.5 (warping).
//
// A departure: a paste of a fill grows while samples of the next tet lie under the mask, and what is missed is
// covered by another paste. A single thing must be whole, also where it is smaller than a tet. So its tets are found
// by an exact enough, conservative test of the mask's cells against each tet.
#include "volume/lap/paste.h"

#include "volume/base/error.h"
#include "volume/base/random.h"
#include "volume/lap/warp.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pith {

bool PlacedBox::meets(const PlacedBox& other, double gap) const {
  const Vec3d between = other.center - center;
  const double reach = half.norm() + other.half.norm() + gap;
  if (between.squaredNorm() > reach * reach) return false;
  const auto apart = [&](const Vec3d& direction) {
    const double length = direction.norm();
    if (length < 1e-9) return false;
    double sum = gap * length;
    for (int a = 0; a < 3; ++a)
      sum +=
          half[a] * std::abs(axes.col(a).dot(direction)) + other.half[a] * std::abs(other.axes.col(a).dot(direction));
    return std::abs(between.dot(direction)) > sum;
  };
  for (int a = 0; a < 3; ++a)
    if (apart(axes.col(a)) || apart(other.axes.col(a))) return false;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      if (apart(axes.col(a).cross(other.axes.col(b)))) return false;
  return true;
}

namespace {

/// The mean of the frames around a vertex of tet `from`, by volume.
Mat3d mean_around(const PasteGround& ground, VertexId v, TetId from) {
  const TetMesh& mesh = ground.mesh;
  std::vector<TetId> around{from};
  Mat3d sum = Mat3d::Zero();
  double volume = 0;
  for (std::size_t k = 0; k < around.size(); ++k) {
    const TetId t = around[k];
    const double size = signed_volume(mesh, t);
    sum += size * ground.axes[t];
    volume += size;
    for (int j = 0; j < 4; ++j) {
      const TetId next = mesh.neighbor[t][j];
      if (mesh.corner[t][j] == v || !next.exists() || mesh.region[next] != ground.region) continue;
      if (std::find(around.begin(), around.end(), next) == around.end()) around.push_back(next);
    }
  }
  return sum / volume;
}

/// The same for all vertices of the region.
PerVertex<Mat3d> means_around_all(const PasteGround& ground) {
  const TetMesh& mesh = ground.mesh;
  PerVertex<Mat3d> mean(mesh.vertex_count(), Mat3d::Zero());
  PerVertex<double> volume(mesh.vertex_count(), 0.0);
  for (const TetId t : all_ids<TetId>(mesh.tet_count())) {
    if (mesh.region[t] != ground.region) continue;
    const double size = signed_volume(mesh, t);
    const Mat3d share = size * ground.axes[t];
    for (const VertexId v : mesh.corner[t]) mean[v] += share, volume[v] += size;
  }
  for (const VertexId v : all_ids<VertexId>(mesh.vertex_count()))
    if (volume[v] > 0) mean[v] /= volume[v];
  return mean;
}

/// The frame at a point, from the tets around its owner's corners: frames are constant on each tet, and things much
/// smaller than a tet would otherwise all turn alike. The owner's own frame where those around it disagree.
Mat3d frame_at(const PasteGround& ground, const Location& at, const PerVertex<Mat3d>& means) {
  if (ground.axes.empty()) return Mat3d::Identity();
  Mat3d sum = Mat3d::Zero();
  for (int i = 0; i < 4; ++i) {
    const VertexId v = ground.mesh.corner[at.tet][i];
    sum += at.barycentric[i] * (means.empty() ? mean_around(ground, v, at.tet) : means[v]);
  }
  Vec3d s = sum.col(1), t = sum.col(2);
  if (s.norm() < 0.5) return ground.axes[at.tet];
  s.normalize();
  t -= t.dot(s) * s;
  if (t.norm() < 0.5) return ground.axes[at.tet];
  t.normalize();
  Mat3d frame;
  frame.col(0) = s.cross(t);
  frame.col(1) = s;
  frame.col(2) = t;
  return frame;
}

} // namespace

struct Paster::Work {
  std::vector<std::uint32_t> stamp; ///< per tet: the search that last saw it
  std::uint32_t search = 0;
  std::vector<TetId> found;
  PerVertex<Mat3d> means;               ///< of the frames around each vertex; empty: found when asked for
  std::unique_ptr<Simplices> simplices; ///< for warping; made when first needed
};

Paster::Paster(const PasteGround& ground, const Thing& thing, bool many)
    : ground_(ground), thing_(thing), work_(std::make_unique<Work>()) {
  work_->stamp.assign(ground.mesh.tet_count(), 0);
  if (many && !ground.axes.empty()) work_->means = means_around_all(ground);
}
Paster::~Paster() = default;

namespace {

/// Rest space → the mask's cube, for a thing in its box.
struct Pose {
  Pose(const Thing& thing, const PlacedBox& box) : box(box), middle(thing.solid.center()) {
    int longest = 0;
    for (int a = 1; a < 3; ++a)
      if (box.half[a] > box.half[longest]) longest = a;
    width = 2 * box.half[longest] / thing.solid.extent()[longest];
  }
  Vec3d operator()(const Vec3d& x) const { return middle + box.axes.transpose() * (x - box.center) / width; }
  std::array<Vec3d, 4> corners(const TetMesh& mesh, TetId t) const {
    std::array<Vec3d, 4> u;
    for (int i = 0; i < 4; ++i) u[i] = (*this)(mesh.position[mesh.corner[t][i]]);
    return u;
  }
  const PlacedBox& box;
  Vec3d middle;
  double width; ///< mm of the whole cube
};

bool overlaps(const std::array<Vec3d, 4>& u, const Box& bounds, double more = 0) {
  for (int a = 0; a < 3; ++a) {
    const double low = std::min({u[0][a], u[1][a], u[2][a], u[3][a]}),
                 high = std::max({u[0][a], u[1][a], u[2][a], u[3][a]});
    if (high < bounds.low[a] - more || low > bounds.high[a] + more) return false;
  }
  return true;
}

/// Breadth first over tets of the region whose image overlaps `bounds`: found[0] is `from`.
template <class Work>
void collect(const PasteGround& ground, const Pose& pose, TetId from, const Box& bounds, double more, Work& work) {
  const TetMesh& mesh = ground.mesh;
  ++work.search;
  work.found.assign(1, from);
  work.stamp[from] = work.search;
  for (std::size_t k = 0; k < work.found.size(); ++k)
    for (const TetId next : mesh.neighbor[work.found[k]]) {
      if (!next.exists() || mesh.region[next] != ground.region || work.stamp[next] == work.search) continue;
      work.stamp[next] = work.search;
      if (overlaps(pose.corners(mesh, next), bounds, more)) work.found.push_back(next);
    }
}

/// The clump's coordinates after warping: each frame's axes, turned as the thing is in the frame where it lies.
std::vector<Vec3d> warped(const PasteGround& ground, const Simplices& mesh, const std::vector<TetId>& tets,
                          const Pose& pose, const Location& at, std::vector<std::array<std::uint32_t, 4>>& corner) {
  constexpr float little_confidence = 0.02f;
  constexpr double smallest_trace = 1.9; // frames that turn by more than 1.1 radians do not count
  Clump clump;
  std::vector<std::uint32_t> vertices;
  for (const TetId t : tets)
    for (const VertexId v : ground.mesh.corner[t]) vertices.push_back(v);
  clump.vertex = vertices;
  std::sort(clump.vertex.begin(), clump.vertex.end());
  clump.vertex.erase(std::unique(clump.vertex.begin(), clump.vertex.end()), clump.vertex.end());
  for (const std::uint32_t v : vertices)
    clump.corner.push_back(static_cast<std::uint32_t>(std::lower_bound(clump.vertex.begin(), clump.vertex.end(), v) -
                                                      clump.vertex.begin()));
  for (const std::uint32_t v : clump.vertex) {
    const Vec3d u = pose(ground.mesh.position[VertexId(v)]);
    for (int a = 0; a < 3; ++a) clump.coordinate.push_back(u[a]);
  }
  const Mat3d own = ground.axes[at.tet];
  const Mat3d turn = own.transpose() * pose.box.axes;
  std::vector<Vec3d> target;
  std::vector<double> weight;
  for (const TetId t : tets) {
    const bool follows = (ground.axes[t].transpose() * own).trace() >= smallest_trace;
    const Mat3d axes = follows ? Mat3d(ground.axes[t] * turn) : pose.box.axes;
    const double width = pose.width * (follows ? ground.scale[t] / ground.scale[at.tet] : 1.0f);
    for (int a = 0; a < 3; ++a) target.push_back(axes.col(a) / width);
    clump.simplex.push_back(t);
    clump.confidence.push_back(follows ? 1.0f : little_confidence);
    weight.push_back(mesh.measure[t] * clump.confidence.back());
  }
  std::array<float, 4> barycentric;
  for (int i = 0; i < 4; ++i) barycentric[i] = static_cast<float>(at.barycentric[i]);
  warp(mesh, clump, target, weight, {true, true, true}, {pose.middle[0], pose.middle[1], pose.middle[2]},
       barycentric);
  corner.resize(tets.size());
  for (std::size_t k = 0; k < tets.size(); ++k)
    for (int i = 0; i < 4; ++i) corner[k][i] = clump.corner[4 * k + i];
  std::vector<Vec3d> coordinate(clump.vertex.size());
  for (std::size_t v = 0; v < coordinate.size(); ++v)
    coordinate[v] = Vec3d(clump.coordinate[3 * v], clump.coordinate[3 * v + 1], clump.coordinate[3 * v + 2]);
  return coordinate;
}

} // namespace

PlacedBox Paster::box(const Location& at, const PasteOptions& options) const {
  PlacedBox box;
  box.center = options.place;
  box.axes = (options.in_frame ? frame_at(ground_, at, work_->means) : Mat3d::Identity()) * options.rotation;
  const Vec3d extent = thing_.solid.extent();
  box.half = 0.5 * options.size / extent.maxCoeff() * extent;
  return box;
}

bool Paster::whole(const Location& at, const PlacedBox& box) {
  const TetMesh& mesh = ground_.mesh;
  const Pose pose(thing_, box);
  collect(ground_, pose, at.tet, thing_.half.bounds, 0, *work_);
  for (const TetId t : work_->found) {
    for (int i = 0; i < 4; ++i) {
      const TetId next = mesh.neighbor[t][i];
      if (next.exists() && mesh.region[next] == ground_.region) continue;
      const std::array<Vec3d, 4> u = pose.corners(mesh, t);
      const auto& f = facet_corners[i];
      if (thing_.half.meets({u[f[0]], u[f[1]], u[f[2]], u[f[2]]}, 3)) return false;
    }
  }
  return true;
}

PastedThing Paster::pasted(const Location& at, const PlacedBox& box, const PasteOptions& options) {
  const TetMesh& mesh = ground_.mesh;
  const Pose pose(thing_, box);
  PastedThing result;
  result.key = hash_of(std::bit_cast<std::uint64_t>(box.center.x()), std::bit_cast<std::uint64_t>(box.center.y()),
                       std::bit_cast<std::uint64_t>(box.center.z()));
  result.box = box;
  std::vector<TetId>& tets = work_->found;
  std::vector<std::array<std::uint32_t, 4>> corner; // per tet
  std::vector<Vec3d> coordinate;
  if (options.follow == Follow::rigid) {
    collect(ground_, pose, at.tet, thing_.any.bounds, 0, *work_);
    std::sort(tets.begin(), tets.end());
    std::vector<std::uint32_t> vertices;
    for (const TetId t : tets)
      for (const VertexId v : mesh.corner[t]) vertices.push_back(v);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const std::uint32_t v : vertices) coordinate.push_back(pose(mesh.position[VertexId(v)]));
    for (const TetId t : tets) {
      corner.emplace_back();
      for (int i = 0; i < 4; ++i)
        corner.back()[i] = static_cast<std::uint32_t>(
            std::lower_bound(vertices.begin(), vertices.end(), mesh.corner[t][i].value) - vertices.begin());
    }
  } else {
    if (!work_->simplices) work_->simplices = std::make_unique<Simplices>(simplices_of(mesh, ground_.region));
    // A warped thing can reach further than its rigid self: more tets, until its outermost ones stay clear of it.
    for (double more = 0.25; more < 2; more *= 2) {
      collect(ground_, pose, at.tet, thing_.any.bounds, more, *work_);
      coordinate = warped(ground_, *work_->simplices, tets, pose, at, corner);
      bool cut_off = false;
      for (std::size_t k = 0; k < tets.size() && !cut_off; ++k)
        for (int i = 0; i < 4; ++i) {
          const TetId next = mesh.neighbor[tets[k]][i];
          if (!next.exists() || mesh.region[next] != ground_.region) continue;
          if (std::find(tets.begin(), tets.end(), next) != tets.end()) continue;
          const auto& f = facet_corners[i];
          const Vec3d &a = coordinate[corner[k][f[0]]], &b = coordinate[corner[k][f[1]]],
                      &c = coordinate[corner[k][f[2]]];
          cut_off |= thing_.any.meets({a, b, c, c}, 3);
        }
      if (!cut_off) break;
    }
    std::vector<std::uint32_t> order(tets.size());
    for (std::uint32_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return tets[a] < tets[b]; });
    std::vector<TetId> ordered;
    std::vector<std::array<std::uint32_t, 4>> rows;
    for (const std::uint32_t k : order) ordered.push_back(tets[k]), rows.push_back(corner[k]);
    tets.swap(ordered);
    corner.swap(rows);
  }
  constexpr std::uint32_t none = 0xffffffffu;
  std::vector<std::uint32_t> row_of(coordinate.size(), none);
  for (std::size_t k = 0; k < tets.size(); ++k) {
    std::array<Vec3d, 4> u;
    for (int i = 0; i < 4; ++i) u[i] = coordinate[corner[k][i]];
    if (!thing_.any.meets(u)) continue;
    result.tet.push_back(tets[k]);
    result.corner.emplace_back();
    for (int i = 0; i < 4; ++i) {
      std::uint32_t& row = row_of[corner[k][i]];
      if (row == none) {
        row = static_cast<std::uint32_t>(result.coordinate.size());
        result.coordinate.push_back(
            {static_cast<float>(u[i][0]), static_cast<float>(u[i][1]), static_cast<float>(u[i][2])});
      }
      result.corner.back()[i] = row;
    }
  }
  return result;
}

PastedThing paste(const PasteGround& ground, const Thing& thing, const PasteOptions& options,
                  const std::string& where) {
  if (!(options.size > 0) || !std::isfinite(options.size))
    throw InvalidInput(where + "/size", "is " + std::to_string(options.size) + ", must be positive",
                       "give millimetres");
  const double off = (options.rotation.transpose() * options.rotation - Mat3d::Identity()).norm();
  if (!(off < 1e-6) || options.rotation.determinant() < 0)
    throw InvalidInput(where + "/rotate", "is no rotation", "give an axis and an angle");
  if (options.follow == Follow::warped && (ground.axes.empty() || ground.scale.empty()))
    throw InvalidInput(where + "/follow", "is \"warped\", but the solid has no frames to follow", "use \"rigid\"");
  const TetId owner = options.place.allFinite() ? ground.locator.owner(options.place, ground.region) : TetId();
  if (!owner.exists()) {
    std::string distance;
    if (options.place.allFinite()) {
      const double squared = ground.locator.nearest_facet(options.place, ground.region).squared_distance;
      distance = std::isfinite(squared) ? ", " + std::to_string(std::sqrt(squared)) + " mm from its boundary" : "";
    }
    throw InvalidInput(where + "/place", "lies outside region " + std::to_string(ground.region) + distance,
                       "give a point inside the solid, in rest space");
  }
  const Location at = ground.locator.locate(options.place, ground.region, owner);
  Paster paster(ground, thing);
  const PlacedBox box = paster.box(at, options);
  if (!options.clip && !paster.whole(at, box))
    throw InvalidInput(where, "reaches out of region " + std::to_string(ground.region),
                       "move it inwards, make it smaller, or allow \"clip\"");
  return paster.pasted(at, box, options);
}

Layer layer_of(std::span<const PastedKind> kinds, std::int32_t region, const std::string& name) {
  Layer layer;
  layer.name = name;
  layer.region = region;
  struct Row {
    std::uint32_t tet;
    Lookup lookup;
  };
  std::vector<Row> rows;
  for (const PastedKind& kind : kinds) {
    if (kind.pasted.empty()) continue;
    const std::uint32_t index = static_cast<std::uint32_t>(layer.exemplar.size());
    layer.exemplar.push_back(kind.thing->exemplar);
    layer.mask.push_back(kind.thing->mask);
    for (const PastedThing& thing : kind.pasted) {
      const std::uint32_t first = static_cast<std::uint32_t>(layer.corner_count());
      const std::uint32_t patch = static_cast<std::uint32_t>(layer.patch.size());
      layer.patch.push_back({index, index, kind.thing->frame, thing.key});
      for (const auto& u : thing.coordinate) layer.corner.insert(layer.corner.end(), {u[0], u[1], u[2], 1.0f});
      for (std::size_t k = 0; k < thing.tet.size(); ++k) {
        Row row{thing.tet[k], {patch, thing.corner[k]}};
        for (std::uint32_t& corner : row.lookup.corner) corner += first;
        rows.push_back(row);
      }
    }
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.tet < b.tet; });
  layer.begin.push_back(0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || rows[i].tet != rows[i - 1].tet) {
      if (i > 0) layer.begin.push_back(static_cast<std::uint32_t>(i));
      layer.simplex.push_back(rows[i].tet);
    }
    layer.lookup.push_back(rows[i].lookup);
  }
  if (!rows.empty()) layer.begin.push_back(static_cast<std::uint32_t>(rows.size()));
  return layer;
}

} // namespace pith
