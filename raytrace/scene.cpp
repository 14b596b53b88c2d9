// The door to Embree 3. Its answers are made independent of its tree: all hits within rounding of the nearest are
// gathered by a filter, recomputed in double in the piece's rest space, and the nearest, or the lowest id among
// equals, is taken. Triangles are tested watertight; boxes conservatively.
#include "raytrace/scene.h"

#include "raytrace/scene_surface.h"
#include "volume/base/error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <embree3/rtcore.h>
#include <new>

namespace pith {

namespace {

/// A hit as Embree reported it, in single precision.
struct Candidate {
  float distance;
  std::uint32_t surface, triangle;
  float u, v;
  bool operator<(const Candidate& other) const {
    return std::tie(distance, surface, triangle) < std::tie(other.distance, other.surface, other.triangle);
  }
};

/// A candidate recomputed in double.
struct Crossing {
  std::uint32_t surface, triangle;
  double distance, u, v;
  Vec3d place, rest; ///< in rest space, where its relief stands and where its material lies
};

/// Weights u, v, 1 − u − v brought into [0, 1].
void clamp_to_triangle(double& u, double& v) {
  u = std::clamp(u, 0.0, 1.0);
  v = std::clamp(v, 0.0, 1.0);
  if (const double sum = u + v; sum > 1) {
    u /= sum;
    v /= sum;
  }
}

/// The context of one query: Embree hands its address to the filter.
struct Query {
  RTCIntersectContext context; // first: the filter's pointer to it is a pointer to the query
  float slack;                 ///< mm
  float nearest = std::numeric_limits<float>::infinity();
  int count = 0;
  std::array<Candidate, 16> candidate; ///< the first ones, ascending
};

float reach_of(float distance, float slack) { return distance * (1 + 4e-6f) + slack; }

/// Keeps every hit that may turn out to be the nearest. The ray goes on to just beyond this one, so that its
/// near-ties are reported whatever order the tree visits them in.
void gather(const RTCFilterFunctionNArguments* arguments) {
  Query& query = *reinterpret_cast<Query*>(arguments->context);
  RTCRay& ray = *reinterpret_cast<RTCRay*>(arguments->ray);
  const RTCHit& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
  const Candidate found{ray.tfar, hit.geomID, hit.primID, hit.u, hit.v};
  if (found.distance < query.nearest) {
    query.nearest = found.distance;
    while (query.count > 0 && query.candidate[query.count - 1].distance > reach_of(query.nearest, query.slack))
      --query.count;
  }
  int at = query.count;
  while (at > 0 && found < query.candidate[at - 1]) --at;
  if (at < static_cast<int>(query.candidate.size())) {
    query.count = std::min<int>(query.count + 1, query.candidate.size());
    for (int i = query.count - 1; i > at; --i) query.candidate[i] = query.candidate[i - 1];
    query.candidate[at] = found;
  }
  ray.tfar = reach_of(query.nearest, query.slack);
}

[[noreturn]] void fail(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (error == RTC_ERROR_UNSUPPORTED_CPU)
    throw InvalidInput("this computer", "its processor lacks the instructions (AVX2) that pictures are computed with",
                       "render on a newer one");
  throw SolverFailure("Embree cannot hold the scene: its error " + std::to_string(error));
}

void require_look(const SurfaceLook& look, const char* where) {
  if (!(look.roughness >= 0 && look.roughness <= 1))
    throw InvalidInput(std::string(where) + ".roughness", "it is " + std::to_string(look.roughness), "give 0 to 1");
  if (!(look.index >= 1 && look.index <= 4))
    throw InvalidInput(std::string(where) + ".index", "it is " + std::to_string(look.index), "give 1 to 4");
}

} // namespace

struct Scene::Parts {
  const Root* root = nullptr;
  SceneOptions options;
  std::vector<VisibleSurface> surface;
  PerFacet<std::array<Vec3f, 3>> skin_normal;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Vec3d center = Vec3d::Zero(); ///< Embree's coordinates are relative to it, so that singles suffice
  Box bounds;
  double ground_height = 0;
  double slack = 0;     ///< mm: the rounding of single-precision coordinates
  double tie = 0;       ///< mm: hits in double that lie closer together are at the same place
  double clearance = 0; ///< mm: from a surface to where rays that leave it start
  std::size_t triangles = 0;
  std::vector<Vec3d> points;
  std::vector<SectionSample> section_samples;
  double section_area = 0;
  int color = -1, roughness = -1;

  Parts() = default;
  Parts(const Parts&) = delete;
  ~Parts() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void build_tree();
  void measure_sections();
  double ground_distance(const SceneRay& ray) const;
  RTCRay single_ray(const SceneRay& ray) const;
  Crossing crossing_of(const SceneRay& ray, const Candidate& candidate) const;
  Hit hit_of(const Crossing& crossing) const;
};

Scene::Scene(const Root& root, const Pieces& pieces, const SceneOptions& options) {
  require_look(options.skin, "skin");
  require_look(options.section, "section");
  if (!options.up.allFinite() || !(options.up.norm() > 0))
    throw InvalidInput("up", "it has no direction", "give a vector that is not zero");
  const GroundOptions& ground = options.ground;
  if (!(ground.fade_begin > 0 && ground.fade_end > ground.fade_begin))
    throw InvalidInput("ground.fade_end", "it is not beyond fade_begin", "give two ascending numbers");

  auto parts = std::make_unique<Parts>();
  parts->root = &root;
  parts->options = options;
  parts->options.up.normalize();
  parts->skin_normal = facet_corner_normals(root.model().mesh, root.model().boundary, options.crease);
  parts->surface = visible_surfaces(root, pieces, parts->skin_normal, options.displacement);
  double lowest = std::numeric_limits<double>::infinity();
  for (const VisibleSurface& surface : parts->surface) {
    for (const auto& triangle : surface.triangle)
      for (const std::uint32_t row : triangle.corner) {
        const Vec3d at = surface.placement(surface.position[row]);
        parts->bounds.add(at);
        parts->points.push_back(at);
        lowest = std::min(lowest, at.dot(parts->options.up));
      }
    parts->triangles += surface.triangle.size();
  }
  if (parts->triangles == 0) throw InvalidInput("pieces", "there is no surface to see", "keep at least one piece");
  if (!parts->bounds.low.allFinite() || !parts->bounds.high.allFinite())
    throw InvalidInput("pieces", "a placed point is not finite", "mend the placements");
  parts->center = parts->bounds.center();
  parts->slack = 1e-6 * parts->bounds.diagonal();
  parts->tie = 1e-11 * (parts->bounds.diagonal() + parts->center.norm());
  parts->clearance = 1e-5 * parts->bounds.diagonal();
  parts->ground_height = std::isfinite(ground.height) ? ground.height : lowest;
  parts->color = root.component_of("color");
  if (parts->color < 0)
    for (int component = 0; const Channel& channel : root.channels()) {
      if (channel.semantic == Semantic::color && parts->color < 0) parts->color = component;
      component += channel.components;
    }
  parts->roughness = root.component_of("roughness");
  parts->measure_sections();
  parts->build_tree();
  parts_ = std::move(parts);
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

void Scene::Parts::measure_sections() {
  std::vector<SectionSample> all;
  for (const VisibleSurface& s : surface)
    for (const auto& t : s.triangle) {
      if (!t.tag.is_section()) continue;
      const Vec3d &a = s.position[t.corner[0]], &b = s.position[t.corner[1]], &c = s.position[t.corner[2]];
      const Vec3d area = 0.5 * (b - a).cross(c - a);
      section_area += area.norm();
      all.push_back({s.placement((a + b + c) / 3), s.placement.rotation * area});
    }
  // Runs of triangles are taken together at the place of their middle one.
  const std::size_t run = 1 + all.size() / 1000;
  for (std::size_t i = 0; i < all.size(); i += run) {
    const std::size_t end = std::min(all.size(), i + run);
    SectionSample sample{all[(i + end) / 2].position, Vec3d::Zero()};
    for (std::size_t j = i; j < end; ++j) sample.area += all[j].area;
    section_samples.push_back(sample);
  }
}

void Scene::Parts::build_tree() {
#if defined(__x86_64__)
  device = rtcNewDevice("isa=avx2,verbose=0"); // fixed: another instruction set rounds differently
#else
  device = rtcNewDevice("verbose=0");
#endif
  if (!device) fail(nullptr);
  scene = rtcNewScene(device);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  for (std::uint32_t s = 0; s < surface.size(); ++s) {
    const VisibleSurface& from = surface[s];
    if (from.triangle.empty()) continue;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), from.position.size()));
    std::uint32_t* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), from.triangle.size()));
    if (!vertex || !index) {
      rtcReleaseGeometry(geometry);
      fail(device);
    }
    for (std::size_t v = 0; v < from.position.size(); ++v) {
      const Vec3d at = from.placement(from.position[v]) - center;
      for (int k = 0; k < 3; ++k) vertex[3 * v + k] = static_cast<float>(at[k]);
    }
    for (std::size_t t = 0; t < from.triangle.size(); ++t)
      for (int k = 0; k < 3; ++k) index[3 * t + k] = from.triangle[t].corner[k];
    rtcSetGeometryIntersectFilterFunction(geometry, gather);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, s);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) fail(device);
}

double Scene::Parts::ground_distance(const SceneRay& ray) const {
  if (!options.ground.on) return std::numeric_limits<double>::infinity();
  const double fall = -ray.direction.dot(options.up);
  const double above = ray.origin.dot(options.up) - ground_height;
  // Seen from above only. A start on the plane counts as above it.
  if (!(fall > 0) || above <= slack) return std::numeric_limits<double>::infinity();
  return above / fall;
}

RTCRay Scene::Parts::single_ray(const SceneRay& ray) const {
  const Vec3d origin = ray.origin - center;
  RTCRay single{};
  single.org_x = static_cast<float>(origin.x());
  single.org_y = static_cast<float>(origin.y());
  single.org_z = static_cast<float>(origin.z());
  single.dir_x = static_cast<float>(ray.direction.x());
  single.dir_y = static_cast<float>(ray.direction.y());
  single.dir_z = static_cast<float>(ray.direction.z());
  single.tnear = 0;
  single.tfar = static_cast<float>(ray.to);
  single.mask = ~0u;
  return single;
}

Hit Scene::nearest(const SceneRay& ray) const {
  const Parts& parts = *parts_;
  if (!ray.origin.allFinite() || !ray.direction.allFinite()) return {};
  // A distant eye is moved up to the pieces first: single precision is spent on them alone.
  const double skipped = std::max(0.0, (parts.center - ray.origin).norm() - 2 * parts.bounds.diagonal());
  const SceneRay close{ray.origin + skipped * ray.direction, ray.direction, ray.to - skipped};
  Query query;
  rtcInitIntersectContext(&query.context);
  query.slack = static_cast<float>(parts.slack);
  RTCRayHit single{};
  single.ray = parts.single_ray(close);
  single.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  if (close.to > 0) rtcIntersect1(parts.scene, &query.context, &single);

  // The nearest in double; among those at the same place the lowest.
  std::array<Crossing, 16> crossing;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < query.count; ++i) {
    crossing[i] = parts.crossing_of(ray, query.candidate[i]);
    least = std::min(least, crossing[i].distance);
  }
  const double reach = least + parts.tie + 1e-14 * std::abs(least);
  const Crossing* best = nullptr;
  for (int i = 0; i < query.count; ++i)
    if (const Crossing& c = crossing[i]; c.distance <= reach)
      if (!best || std::tie(c.surface, c.triangle) < std::tie(best->surface, best->triangle)) best = &c;
  Hit hit;
  const double ground = parts.ground_distance(ray);
  if (std::isfinite(ground) && ground <= ray.to && (!best || ground < best->distance)) {
    hit.piece = Hit::ground;
    hit.distance = ground;
    hit.position = hit.rest = ray.origin + ground * ray.direction;
    hit.normal = hit.smooth = parts.options.up;
    hit.lifted = hit.position + parts.clearance * hit.normal;
  } else if (best) {
    hit = parts.hit_of(*best);
  }
  return hit;
}

/// Möller–Trumbore in double, in rest space: the rest point does not suffer from the placement.
Crossing Scene::Parts::crossing_of(const SceneRay& ray, const Candidate& candidate) const {
  const VisibleSurface& from = surface[candidate.surface];
  const auto& triangle = from.triangle[candidate.triangle];
  const Vec3d origin = from.placement.inverse(ray.origin);
  const Vec3d direction = from.placement.rotation.transpose() * ray.direction;
  const Vec3d& a = from.position[triangle.corner[0]];
  const Vec3d ab = from.position[triangle.corner[1]] - a, ac = from.position[triangle.corner[2]] - a;
  const Vec3d p = direction.cross(ac);
  const double determinant = ab.dot(p);
  double u = candidate.u, v = candidate.v;
  if (determinant * determinant > 1e-18 * ab.squaredNorm() * ac.squaredNorm()) {
    const Vec3d s = origin - a, q = s.cross(ab);
    u = s.dot(p) / determinant;
    v = direction.dot(q) / determinant;
  }
  clamp_to_triangle(u, v); // single precision may have found it a hair outside
  const Vec3d place = a + u * ab + v * ac;
  Vec3d rest = place;
  if (!from.rest.empty()) {
    const Vec3d& first = from.rest[triangle.corner[0]];
    rest = first + u * (from.rest[triangle.corner[1]] - first) + v * (from.rest[triangle.corner[2]] - first);
  }
  return {candidate.surface, candidate.triangle, (place - origin).dot(direction), u, v, place, rest};
}

/// Geometric and smooth normals, and the start of secondary rays after Hanika, "Hacking the Shadow Terminator", Ray
/// Tracing Gems II, ch. 4, 2021: the point is lifted to the surface that the corner normals suggest.
Hit Scene::Parts::hit_of(const Crossing& crossing) const {
  const VisibleSurface& from = surface[crossing.surface];
  const auto& triangle = from.triangle[crossing.triangle];
  Hit hit;
  hit.piece = from.piece;
  hit.triangle = crossing.triangle;
  hit.distance = crossing.distance;
  hit.rest = crossing.rest;
  hit.position = from.placement(crossing.place);
  hit.tag = triangle.tag;
  hit.root = triangle.root;

  // The skin's normals belong to the root's facets, so that cuts do not change them; those of its relief to itself.
  std::array<Vec3d, 3> corner;
  const std::array<Vec3f, 3>* skin = nullptr;
  if (hit.tag.is_skin() && from.rest.empty()) {
    const Model& model = root->model();
    const auto& facet = model.boundary.corner[hit.tag.facet()];
    for (int i = 0; i < 3; ++i) corner[i] = model.mesh.position[facet[i]];
    skin = &skin_normal[hit.tag.facet()];
  } else {
    for (int i = 0; i < 3; ++i) corner[i] = from.position[triangle.corner[i]];
  }
  const Vec3d ab = corner[1] - corner[0], ac = corner[2] - corner[0], area = ab.cross(ac);
  double u = crossing.u, v = crossing.v;
  if (skin && area.squaredNorm() > 0) {
    const Vec3d s = crossing.place - corner[0];
    u = s.cross(ac).dot(area) / area.squaredNorm();
    v = ab.cross(s).dot(area) / area.squaredNorm();
    clamp_to_triangle(u, v);
  }
  const std::array<double, 3> weight = {1 - u - v, u, v};
  Vec3d smooth = Vec3d::Zero(), lift = Vec3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vec3f& single = skin ? (*skin)[i] : from.normal[from.normal_row[crossing.triangle][i]];
    const Vec3d normal = single.cast<double>();
    smooth += weight[i] * normal;
    lift -= weight[i] * std::min(0.0, (crossing.place - corner[i]).dot(normal)) * normal;
  }
  const double length = smooth.norm(), size = area.norm();
  Vec3d geometric = Vec3d::UnitY();
  if (size > 0) {
    geometric = area / size;
  } else if (length > 0) {
    geometric = smooth / length;
  }
  smooth = length > 1e-6 ? Vec3d(smooth / length) : geometric;
  hit.normal = from.placement.rotation * geometric;
  hit.smooth = from.placement.rotation * smooth;
  hit.lifted = from.placement(crossing.place + lift) + clearance * hit.normal;
  return hit;
}

bool Scene::occluded(const SceneRay& ray) const {
  const Parts& parts = *parts_;
  if (!ray.origin.allFinite() || !ray.direction.allFinite()) return false;
  if (parts.ground_distance(ray) < ray.to) return true;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay single = parts.single_ray(ray);
  rtcOccluded1(parts.scene, &context, &single);
  return single.tfar < 0;
}

SurfaceMaterial Scene::material(const Hit& hit, double footprint) const {
  const Parts& parts = *parts_;
  SurfaceMaterial result;
  if (hit.is_ground()) {
    result.albedo = parts.options.ground.albedo;
    return result;
  }
  const SurfaceLook& look = hit.tag.is_skin() ? parts.options.skin : parts.options.section;
  const Root& root = *parts.root;
  MaterialPoint point;
  point.position = hit.rest;
  point.region = hit.root.exists() ? root.model().mesh.region[hit.root] : -1;
  point.facet = hit.tag.facet();
  point.hint = hit.root;
  const Material material = material_at(root, point, footprint);
  Vec3d color = parts.options.uncovered;
  if (parts.color >= 0) {
    for (int k = 0; k < 3; ++k)
      color[k] += material.coverage * (material.value[parts.color + k] - parts.options.uncovered[k]);
  }
  result.albedo = color.cwiseMax(0.0).cwiseMin(1.0);
  result.roughness =
      parts.roughness >= 0 ? std::clamp(double(material.value[parts.roughness]), 0.0, 1.0) : look.roughness;
  result.index = look.index;
  return result;
}

const Root& Scene::root() const { return *parts_->root; }
const SceneOptions& Scene::options() const { return parts_->options; }
const Box& Scene::bounds() const { return parts_->bounds; }
double Scene::ground_height() const { return parts_->ground_height; }
std::size_t Scene::triangle_count() const { return parts_->triangles; }
const std::vector<Vec3d>& Scene::points() const { return parts_->points; }
const std::vector<Scene::SectionSample>& Scene::section_samples() const { return parts_->section_samples; }
double Scene::section_area() const { return parts_->section_area; }

} // namespace pith
