// TetGen in a process of its own (H. Si, TetGen, a Delaunay-based quality tetrahedral mesh generator, ACM TOMS 2015).
// On bad input TetGen throws an int while it unwinds, aborts in an assertion, or exits; here that ends this process
// and nothing else.
#include "protocol.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <limits>
#include <new>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <tetgen.h>
#include <unistd.h>
#include <vector>

namespace {

using namespace pith::tetgen_protocol;

bool read_whole(void* to, std::size_t bytes) {
  char* at = static_cast<char*>(to);
  while (bytes > 0) {
    const ssize_t got = ::read(STDIN_FILENO, at, bytes);
    if (got <= 0) return false;
    at += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

bool write_whole(int file, const void* from, std::size_t bytes) {
  const char* at = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t put = ::write(file, at, bytes);
    if (put <= 0) return false;
    at += put;
    bytes -= static_cast<std::size_t>(put);
  }
  return true;
}

/// Hands the triangles to TetGen; it frees what it is given.
void fill(tetgenio& in, const std::vector<double>& points, const std::vector<std::uint32_t>& triangles) {
  in.firstnumber = 0;
  in.numberofpoints = static_cast<int>(points.size() / 3);
  in.pointlist = new REAL[points.size()];
  std::copy(points.begin(), points.end(), in.pointlist);
  in.numberoffacets = static_cast<int>(triangles.size() / 3);
  in.facetlist = new tetgenio::facet[triangles.size() / 3];
  for (int f = 0; f < in.numberoffacets; ++f) {
    tetgenio::facet& facet = in.facetlist[f];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    for (int i = 0; i < 3; ++i)
      facet.polygonlist->vertexlist[i] = static_cast<int>(triangles[3 * static_cast<std::size_t>(f) + i]);
  }
}

/// Where tets shall be finer. TetGen asks a plain function about each tet, so what that needs has to be reachable
/// from anywhere in this program.
struct Core {
  std::vector<std::array<double, 6>> segment;
  double edge = 0, growth = 0;
} core;

double distance_to_core(const std::array<double, 3>& x) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::array<double, 6>& s : core.segment) {
    double along = 0, squared = 0;
    for (int k = 0; k < 3; ++k)
      along += (x[k] - s[k]) * (s[k + 3] - s[k]), squared += (s[k + 3] - s[k]) * (s[k + 3] - s[k]);
    along = squared > 0 ? std::clamp(along / squared, 0.0, 1.0) : 0;
    double distance = 0;
    for (int k = 0; k < 3; ++k) distance += std::pow(s[k] + along * (s[k + 3] - s[k]) - x[k], 2);
    nearest = std::min(nearest, distance);
  }
  return std::sqrt(nearest);
}

/// Whether a tet is larger than one on which an edge of the length asked for there would be regular.
bool too_large_for_core(double* a, double* b, double* c, double* d, double*, double) {
  std::array<double, 3> center, u, v, w;
  for (int k = 0; k < 3; ++k) {
    center[k] = (a[k] + b[k] + c[k] + d[k]) / 4;
    u[k] = b[k] - a[k], v[k] = c[k] - a[k], w[k] = d[k] - a[k];
  }
  const double volume = std::abs(u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
                                 u[2] * (v[0] * w[1] - v[1] * w[0])) /
                        6;
  const double edge = core.edge + core.growth * distance_to_core(center);
  return volume > edge * edge * edge / (6 * std::sqrt(2.0));
}

int run() {
  Problem problem;
  if (!read_whole(&problem, sizeof problem) || problem.mark != problem_mark) return bad_problem;
  std::vector<double> points(3 * problem.points);
  std::vector<std::uint32_t> triangles(3 * problem.triangles);
  core.segment.resize(problem.core_segments);
  core.edge = problem.core_edge;
  core.growth = problem.core_growth;
  if (!read_whole(points.data(), points.size() * sizeof(double)) ||
      !read_whole(triangles.data(), triangles.size() * sizeof(std::uint32_t)) ||
      !read_whole(core.segment.data(), core.segment.size() * sizeof core.segment[0]))
    return bad_problem;

  // TetGen reports on standard output: the result's way is moved aside first.
  const int result_file = ::dup(STDOUT_FILENO);
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (result_file < 0 || nowhere < 0 || ::dup2(nowhere, STDOUT_FILENO) < 0) return cannot_write;

  // -p: a piecewise linear complex; -Y: its triangles stay as they are; -q, -a: refine the inside; -Q: quietly.
  tetgenbehavior behavior;
  std::string switches = "pYQ";
  if (problem.radius_edge > 0) switches += "q1.4";
  if (problem.max_volume > 0) switches += "a1";
  if (!behavior.parse_commandline(switches.data())) return bad_problem;
  if (problem.radius_edge > 0) behavior.minratio = problem.radius_edge;
  if (problem.max_volume > 0) behavior.maxvolume = problem.max_volume;

  // Neither structure is freed: the process is about to end, and TetGen's destructors are slow on large meshes.
  auto* in = new tetgenio;
  auto* out = new tetgenio;
  fill(*in, points, triangles);
  if (!core.segment.empty()) in->tetunsuitable = too_large_for_core;
  try {
    tetrahedralize(&behavior, in, out);
  } catch (const std::bad_alloc&) {
    return no_memory;
  } catch (...) {
    return tetgen_refused;
  }

  if (out->numberofpoints < in->numberofpoints || out->numberofcorners != 4 ||
      !std::equal(points.begin(), points.end(), out->pointlist))
    return boundary_changed;
  Result result;
  result.points = static_cast<std::uint64_t>(out->numberofpoints - in->numberofpoints);
  result.tets = static_cast<std::uint64_t>(out->numberoftetrahedra);
  static_assert(sizeof(int) == sizeof(std::uint32_t) && sizeof(REAL) == sizeof(double));
  const bool written = write_whole(result_file, &result, sizeof result) &&
                       write_whole(result_file, out->pointlist + points.size(), 24 * result.points) &&
                       write_whole(result_file, out->tetrahedronlist, 16 * result.tets);
  return written ? done : cannot_write;
}

} // namespace

int main() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL); // never outlive pith
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core); // a crash is an answer here, not something to keep
  int code = no_memory;
  try {
    code = run();
  } catch (const std::bad_alloc&) {
  }
  std::_Exit(code);
}
