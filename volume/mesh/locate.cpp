#include "volume/mesh/locate.h"

#include "volume/base/parallel.h"
#include "volume/mesh/orientation.h"

#include <algorithm>

namespace pith {

namespace {

std::vector<std::array<Vec3d, 3>> facets_of(const TetMesh& mesh, const Boundary& boundary) {
  std::vector<std::array<Vec3d, 3>> triangles(boundary.facet_count());
  for (FacetId f : all_ids<FacetId>(boundary.facet_count()))
    for (int i = 0; i < 3; ++i) triangles[f][i] = mesh.position[boundary.corner[f][i]];
  return triangles;
}

/// True when x lies in the closed tet: inside of, or on, the planes of all its facets.
bool closed_contains(const TetMesh& mesh, TetId tet, const Vec3d& x) {
  const auto& corner = mesh.corner[tet];
  for (const auto& f : facet_corners)
    if (orientation(mesh.position[corner[f[0]]], mesh.position[corner[f[1]]], mesh.position[corner[f[2]]], x) > 0)
      return false;
  return true;
}

/// Six times the volumes of the four tets that x makes with the facets, and a bound below which rounding may have
/// changed a sign: the determinants' errors are below 2e-15 of the cube of the largest coordinate difference.
struct Volumes {
  std::array<double, 4> w;
  double uncertain;
};

inline Volumes volumes_of(const TetMesh& mesh, TetId tet, const Vec3d& x) {
  const auto& c = mesh.corner[tet];
  const Vec3d a = mesh.position[c[0]] - x, b = mesh.position[c[1]] - x;
  const Vec3d d = mesh.position[c[2]] - x, e = mesh.position[c[3]] - x;
  const double reach = a.cwiseAbs().cwiseMax(b.cwiseAbs()).cwiseMax(d.cwiseAbs().cwiseMax(e.cwiseAbs())).maxCoeff();
  const Vec3d de = d.cross(e), ab = a.cross(b);
  return {{b.dot(de), -a.dot(de), e.dot(ab), -d.dot(ab)}, 1e-14 * reach * reach * reach};
}

inline std::array<double, 4> normalized(const std::array<double, 4>& w) {
  const double sum = (w[0] + w[1]) + (w[2] + w[3]);
  return {w[0] / sum, w[1] / sum, w[2] / sum, w[3] / sum};
}

/// Into [0, 1], summing to 1.
inline void clamp_to_simplex(std::array<double, 4>& b) {
  double sum = 0;
  for (double& value : b) sum += (value = std::clamp(value, 0.0, 1.0));
  for (double& value : b) value /= sum;
}

} // namespace

std::array<double, 4> barycentric(const TetMesh& mesh, TetId tet, const Vec3d& x) {
  return normalized(volumes_of(mesh, tet, x).w);
}

Locator::Locator(const TetMesh& mesh, const Boundary& boundary)
    : mesh_(mesh), boundary_(boundary), facets_(facets_of(mesh, boundary)), around_(tets_around_vertices(mesh)),
      bounds_(bounds_of(mesh)) {
  for (FacetId f : all_ids<FacetId>(boundary.facet_count())) facet_region_.push_back(mesh.region[boundary.tet[f]]);
  for (std::int32_t region : mesh.region) several_regions_ |= region != mesh.region.front();

  // A uniform grid: for each cell the tets whose boxes touch it, about one tet per cell on average.
  const Vec3d extent = bounds_.extent().cwiseMax(1e-300);
  const double pitch = std::cbrt(extent.prod() / std::max<std::size_t>(1, mesh.tet_count())) * 1.5;
  for (int axis = 0; axis < 3; ++axis) {
    cells_[axis] = static_cast<std::uint32_t>(std::clamp(std::ceil(extent[axis] / pitch), 1.0, 256.0));
    cells_per_mm_[axis] = cells_[axis] / extent[axis];
  }
  const auto cell_range = [&](TetId t) {
    Box box;
    for (VertexId v : mesh_.corner[t]) box.add(mesh_.position[v]);
    std::array<std::array<std::uint32_t, 2>, 3> range;
    for (int axis = 0; axis < 3; ++axis) range[axis] = {coordinate(box.low, axis), coordinate(box.high, axis)};
    return range;
  };
  const auto each_cell = [&](TetId t, auto&& visit) {
    const auto range = cell_range(t);
    for (std::uint32_t z = range[2][0]; z <= range[2][1]; ++z)
      for (std::uint32_t y = range[1][0]; y <= range[1][1]; ++y)
        for (std::uint32_t x = range[0][0]; x <= range[0][1]; ++x) visit((z * cells_[1] + y) * cells_[0] + x);
  };
  cell_begin_.assign(std::size_t(cells_[0]) * cells_[1] * cells_[2] + 1, 0);
  for (TetId t : all_ids<TetId>(mesh.tet_count())) each_cell(t, [&](std::uint32_t cell) { ++cell_begin_[cell + 1]; });
  for (std::size_t i = 1; i < cell_begin_.size(); ++i) cell_begin_[i] += cell_begin_[i - 1];
  cell_tet_.resize(cell_begin_.back());
  std::vector<std::uint32_t> fill(cell_begin_.begin(), cell_begin_.end() - 1);
  for (TetId t : all_ids<TetId>(mesh.tet_count()))
    each_cell(t, [&](std::uint32_t cell) { cell_tet_[fill[cell]++] = t; });
}

std::uint32_t Locator::coordinate(const Vec3d& x, int axis) const {
  const double c = (x[axis] - bounds_.low[axis]) * cells_per_mm_[axis];
  return c <= 0 ? 0 : std::min(cells_[axis] - 1, static_cast<std::uint32_t>(c));
}

std::uint32_t Locator::cell_of(const Vec3d& x) const {
  return (coordinate(x, 2) * cells_[1] + coordinate(x, 1)) * cells_[0] + coordinate(x, 0);
}

// Walks towards x: out of a tet through the facet that separates x from it most clearly. Returns a closed tet that
// contains x, or none when the walk leaves the mesh or takes too long (a mesh need not be convex).
TetId Locator::walk(const Vec3d& x, TetId from, std::array<int, 4>& sign) const {
  TetId tet = from, previous;
  for (int step = 0; step < 128; ++step) {
    const auto& corner = mesh_.corner[tet];
    TetId next;
    bool inside = true;
    for (int k = 0; k < 4; ++k) {
      const int i = (k + step) & 3; // another first facet each step, so that no cycle repeats itself
      const TetId across = mesh_.neighbor[tet][i];
      const auto& f = facet_corners[i];
      if (across.exists() && across == previous) {
        sign[i] = 1; // came through it: exactly the opposite of its sign from behind
        continue;
      }
      sign[i] =
          -orientation(mesh_.position[corner[f[0]]], mesh_.position[corner[f[1]]], mesh_.position[corner[f[2]]], x);
      if (sign[i] < 0) {
        inside = false;
        next = across;
        if (across.exists()) break;
      }
    }
    if (inside) return tet;
    if (!next.exists()) return {};
    previous = tet;
    tet = next;
  }
  return {};
}

// Among all closed tets of the region that contain x the lowest. x lies strictly inside `found`, or on a facet (one
// zero sign), an edge (two) or a corner (three) of it; then the candidates are the tets around that simplex.
TetId Locator::lowest_owner(const Vec3d& x, std::int32_t region, TetId found, const std::array<int, 4>& sign) const {
  const int zeros = std::count(sign.begin(), sign.end(), 0);
  const auto fits = [&](TetId t) { return region < 0 || mesh_.region[t] == region; };
  TetId best = fits(found) ? found : TetId();
  if (zeros == 0) return best;
  const auto consider = [&](TetId t) {
    if (t.exists() && t < best && fits(t) && closed_contains(mesh_, t, x)) best = t;
  };
  if (zeros == 1) {
    for (int i = 0; i < 4; ++i)
      if (sign[i] == 0) consider(mesh_.neighbor[found][i]);
    return best;
  }
  // Any corner of the simplex that holds x will do: all tets around the simplex are around it.
  for (int i = 0; i < 4; ++i)
    if (sign[i] != 0) {
      for (TetId t : around_[mesh_.corner[found][i]]) consider(t);
      break;
    }
  return best;
}

TetId Locator::search_cell(const Vec3d& x, std::int32_t region) const {
  if (!bounds_.contains(x)) return {};
  const std::uint32_t cell = cell_of(x);
  for (std::uint32_t i = cell_begin_[cell]; i < cell_begin_[cell + 1]; ++i) // ascending: the first hit is the lowest
    if ((region < 0 || mesh_.region[cell_tet_[i]] == region) && closed_contains(mesh_, cell_tet_[i], x))
      return cell_tet_[i];
  return {};
}

TetId Locator::owner(const Vec3d& x, std::int32_t region, TetId hint) const {
  if (!bounds_.contains(x)) return {};
  if (!several_regions_ && region >= 0 && mesh_.tet_count() > 0 && mesh_.region[TetId(0)] == region) region = -1;
  if (!hint.exists() || hint >= mesh_.tet_count()) {
    const std::uint32_t cell = cell_of(x);
    if (cell_begin_[cell] == cell_begin_[cell + 1]) return {};
    hint = cell_tet_[(cell_begin_[cell] + cell_begin_[cell + 1]) / 2];
  }
  std::array<int, 4> sign{};
  const TetId found = walk(x, hint, sign);
  if (found.exists()) {
    const TetId best = lowest_owner(x, region, found, sign);
    if (best.exists()) return best;
  }
  return search_cell(x, region);
}

bool Locator::contains(const Vec3d& x, std::int32_t region) const { return owner(x, region, {}).exists(); }

Location Locator::locate(const Vec3d& x, std::int32_t region, TetId hint) const {
  Location location;
  // Most hints are right: x is certainly strictly inside, and then no other tet can own it.
  if (hint < mesh_.tet_count() && (region < 0 || mesh_.region[hint] == region)) {
    const Volumes v = volumes_of(mesh_, hint, x);
    if (std::min({v.w[0], v.w[1], v.w[2], v.w[3]}) > v.uncertain) {
      location = {hint, normalized(v.w), true};
      clamp_to_simplex(location.barycentric);
      return location;
    }
  }
  location.tet = owner(x, region, hint);
  location.inside = location.tet.exists();
  if (location.inside) {
    location.barycentric = barycentric(mesh_, location.tet, x);
  } else {
    const NearestFacet nearest = nearest_facet(x, region);
    if (nearest.facet == std::numeric_limits<std::uint32_t>::max()) return location;
    const FacetId facet(nearest.facet);
    location.tet = boundary_.tet[facet];
    const int opposite = boundary_.opposite[facet];
    for (int i = 0; i < 3; ++i) location.barycentric[facet_corners[opposite][i]] = nearest.barycentric[i];
  }
  clamp_to_simplex(location.barycentric);
  return location;
}

} // namespace pith
