// Signed distance to a stroke with straight continuations, and the choice of its nodes.
#include "volume/cut/divider.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pith {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double cross(const Vec2d& a, const Vec2d& b) { return a.x() * b.y() - a.y() * b.x(); }
Vec2d right_of(const Vec2d& direction) { return {direction.y(), -direction.x()}; }

std::string text_of(const Vec2d& p) { return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ")"; }

double distance_to_chord(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
  const Vec2d along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

/// Indices of the points that Douglas and Peucker keep, ascending, ends included.
std::vector<std::size_t> corners_of(const std::vector<Vec2d>& points, double tolerance) {
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double farthest = tolerance;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i)
      if (const double d = distance_to_chord(points[i], points[first], points[last]); d > farthest) {
        farthest = d;
        at = i;
      }
    if (at == first) continue;
    kept[at] = true;
    open.emplace_back(first, at);
    open.emplace_back(at, last);
  }
  std::vector<std::size_t> corners;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) corners.push_back(i);
  return corners;
}

} // namespace

StrokeNodes stroke_nodes(std::span<const Vec2d> points, std::size_t most, const std::string& where) {
  Vec2d low = Vec2d::Constant(infinity), high = Vec2d::Constant(-infinity);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw InvalidInput(where, "point " + std::to_string(i) + " is not finite", "give finite screen coordinates");
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  const double extent = points.empty() ? 0 : (high - low).norm();
  std::vector<Vec2d> drawn;
  for (const Vec2d& p : points)
    if (drawn.empty() || (p - drawn.back()).norm() > 1e-9 * extent) drawn.push_back(p);
  if (drawn.size() < 2)
    throw InvalidInput(where, std::to_string(points.size()) + " points, all at one place", "draw a longer stroke");

  StrokeNodes result;
  std::vector<double> arc = {0}; // length up to each point
  for (std::size_t i = 1; i < drawn.size(); ++i) arc.push_back(arc.back() + (drawn[i] - drawn[i - 1]).norm());
  result.length = arc.back();
  const auto point_at = [&](double s) {
    const auto above = std::upper_bound(arc.begin() + 1, arc.end() - 1, s) - arc.begin();
    const double t = (s - arc[above - 1]) / (arc[above] - arc[above - 1]);
    return Vec2d(drawn[above - 1] + t * (drawn[above] - drawn[above - 1]));
  };

  result.straight = corners_of(drawn, 1e-9 * result.length).size() == 2;
  const std::size_t half = most / 2;
  double tolerance = result.length / 500;
  std::vector<std::size_t> corner = corners_of(drawn, tolerance);
  while (corner.size() > half) corner = corners_of(drawn, tolerance *= 1.5);

  const double spacing = result.length / static_cast<double>(half);
  result.node.push_back(drawn.front());
  for (std::size_t k = 1; k < corner.size(); ++k) {
    const double from = arc[corner[k - 1]], to = arc[corner[k]];
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / spacing - 1e-9)));
    for (int i = 1; i < steps; ++i) result.node.push_back(point_at(from + (to - from) * i / steps));
    result.node.push_back(drawn[corner[k]]);
  }
  // A hand jitters at the ends: the direction is taken over a twentieth of the stroke.
  const auto outward = [&](const Vec2d& end, double s) { return Vec2d((end - point_at(s)).normalized()); };
  result.start_direction = outward(drawn.front(), 0.05 * result.length);
  result.end_direction = outward(drawn.back(), 0.95 * result.length);
  if (!result.start_direction.allFinite() || result.start_direction.isZero(0) || !result.end_direction.allFinite() ||
      result.end_direction.isZero(0))
    throw InvalidInput(where, "an end of the stroke turns back onto itself", "draw the ends straight");
  return result;
}

StrokeNodes loop_nodes(std::span<const Vec2d> points, std::size_t most, const std::string& where) {
  std::vector<Vec2d> drawn(points.begin(), points.end());
  while (drawn.size() > 1 && drawn.back() == drawn.front()) drawn.pop_back();
  double area = 0, length = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const Vec2d& next = drawn[(i + 1) % drawn.size()];
    area += 0.5 * cross(drawn[i] - drawn[0], next - drawn[0]);
    length += (next - drawn[i]).norm();
    if (!drawn[i].allFinite()) throw InvalidInput(where, "a number is not finite", "give finite numbers");
  }
  if (!(std::abs(area) > 1e-9 * length * length))
    throw InvalidInput(where, "the loop encloses no area", "draw it around something");
  if (area < 0) std::reverse(drawn.begin(), drawn.end());

  // Two open strokes: from the first point to the one farthest from it, and back.
  const auto far = std::max_element(drawn.begin(), drawn.end(), [&](const Vec2d& a, const Vec2d& b) {
    return (a - drawn[0]).squaredNorm() < (b - drawn[0]).squaredNorm();
  });
  const std::vector<Vec2d> there(drawn.begin(), far + 1);
  std::vector<Vec2d> back(far, drawn.end());
  back.push_back(drawn[0]);
  StrokeNodes result;
  result.closed = true;
  for (const auto* half : std::array<const std::vector<Vec2d>*, 2>{&there, &back}) {
    const StrokeNodes nodes = stroke_nodes(*half, most / 2, where);
    result.node.insert(result.node.end(), nodes.node.begin(), nodes.node.end() - 1);
    result.length += nodes.length;
  }
  return result;
}

Divider::Divider(const StrokeNodes& nodes, const std::string& where) : node_(nodes.node) {
  const int last = static_cast<int>(node_.size()) - 1;
  const auto add_part = [&](int from, int to) {
    const Vec2d along = node_[to] - node_[from];
    part_.push_back({node_[from], along.normalized(), 0, along.norm(), from, to, 0});
  };
  if (!nodes.closed) part_.push_back({node_[0], -nodes.start_direction, -infinity, 0, -1, 0, -1});
  for (int i = 0; i < last; ++i) add_part(i, i + 1);
  if (nodes.closed)
    add_part(last, 0);
  else
    part_.push_back({node_[last], nodes.end_direction, 0, infinity, last, -1, 1});

  // Where two parts cross, as parameters along both.
  const auto crossing = [&](const Part& a, const Part& b) -> std::optional<std::pair<double, double>> {
    const double turn = cross(a.direction, b.direction);
    if (turn == 0) return std::nullopt;
    const Vec2d between = b.from - a.from;
    const double s = cross(between, b.direction) / turn, t = cross(between, a.direction) / turn;
    if (s < a.begin || s > a.end || t < b.begin || t > b.end) return std::nullopt;
    return std::pair(s, t);
  };
  const int parts = static_cast<int>(part_.size());
  for (int i = 0; i + 1 < parts; ++i) {
    const Part &a = part_[i], &b = part_[i + 1];
    if (std::abs(cross(a.direction, b.direction)) < 1e-9 && a.direction.dot(b.direction) < 0)
      throw InvalidInput(where, "it turns back onto itself near " + text_of(b.from), "draw a stroke without folds");
    for (int j = i + 2; j < parts; ++j) {
      const bool ends = i == 0 && j == parts - 1; // continuations, or neighbours in a loop
      const auto at = crossing(a, part_[j]);
      if (!at || ends) continue;
      const std::string place = text_of(a.from + at->first * a.direction);
      if (!nodes.closed && (i == 0 || j == parts - 1))
        throw InvalidInput(where,
                           "the straight continuation of its " + std::string(i == 0 ? "start" : "end") +
                               " crosses it near " + place,
                           "draw the ends outwards, away from the stroke");
      throw InvalidInput(where, "it crosses itself near " + place, "draw a stroke that does not cross itself");
    }
  }
  if (nodes.closed) {
    for (int i = 0; i <= last; ++i)
      normal_.push_back((right_of(part_[(i + last) % parts].direction) + right_of(part_[i].direction)).normalized());
    return;
  }
  if (const auto at = crossing(part_.front(), part_.back())) {
    part_.front().begin = at->first;
    part_.back().end = at->second;
    part_.front().before = part_.back().after = last + 1;
  }

  // At a node the nearer side is told by the mean of the two normals.
  for (int i = 0; i <= last; ++i)
    normal_.push_back((right_of(part_[i].direction) + right_of(part_[i + 1].direction)).normalized());
  normal_.push_back((right_of(part_.back().direction) + right_of(part_.front().direction)).normalized());
}

Divider::Nearest Divider::nearest(const Vec2d& x) const {
  double smallest = infinity, parameter = 0;
  const Part* nearest = nullptr;
  for (const Part& part : part_) {
    const Vec2d to = x - part.from;
    const double t = std::clamp(to.dot(part.direction), part.begin, part.end);
    const double square = (to - t * part.direction).squaredNorm();
    if (square < smallest) {
      smallest = square;
      parameter = t;
      nearest = &part;
    }
  }
  const Part& part = *nearest;
  const Vec2d off = x - part.from - parameter * part.direction;
  const int node = parameter <= part.begin ? part.before : parameter >= part.end ? part.after : -1;
  const Vec2d normal = node >= 0 ? normal_[node] : right_of(part.direction);

  Nearest result;
  result.distance = std::sqrt(smallest);
  result.gradient = result.distance > 0 ? Vec2d(off / result.distance) : normal;
  if (off.dot(normal) < 0) {
    result.distance = -result.distance;
    result.gradient = -result.gradient;
  }
  result.beyond = part.continuation == 0 ? 0 : part.continuation * parameter;
  result.outward = Vec2d::Zero();
  if (result.beyond > 0 && node < 0) result.outward = part.continuation * part.direction;
  return result;
}

} // namespace pith
