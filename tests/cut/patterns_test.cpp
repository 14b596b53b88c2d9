// All sign patterns in all vertex orders: on one tet, and on two tets that share a face.
#include "tests/cut/piece_checks.h"
#include "volume/base/random.h"
#include "volume/cut/patterns.h"

namespace pith {
namespace {

std::array<int, 5> states_of(int code) {
  std::array<int, 5> state{};
  for (int& s : state) {
    s = code % 3;
    code /= 3;
  }
  return state;
}

double area_of(const Pieces& pieces, const TetMesh& root, std::uint32_t piece, FaceTag tag) {
  double area = 0;
  for (const CutTet& tet : pieces.piece[piece].cut)
    for (int i = 0; i < 4; ++i) {
      if (tet.face[i] != tag) continue;
      std::array<Vec3d, 3> p;
      for (int k = 0; k < 3; ++k) p[k] = pieces.position(root, tet.corner[facet_corners[i][k]]);
      area += 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
    }
  return area;
}

TEST(Patterns, EveryPermutationIsEvenAndBringsTheStatesIntoOrder) {
  std::array<int, 5> cases{};
  for (int code = 0; code < 81; ++code) {
    const Pattern& pattern = patterns[code];
    const auto state = states_of(code);
    ++cases[static_cast<int>(pattern.split)];
    std::array<int, 4> in_order;
    int inversions = 0;
    for (int k = 0; k < 4; ++k) {
      in_order[k] = state[pattern.corner[k]];
      for (int j = k + 1; j < 4; ++j) inversions += pattern.corner[k] > pattern.corner[j];
    }
    EXPECT_EQ(inversions % 2, 0) << code;
    const SplitEdges& edges = split_edges[static_cast<int>(pattern.split)];
    int crossing = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) crossing += in_order[i] + in_order[j] == 2 && in_order[i] != in_order[j];
    EXPECT_EQ(edges.count, crossing) << code;
    for (int e = 0; e < edges.count; ++e)
      EXPECT_EQ(in_order[edges.corner[e][0]] + in_order[edges.corner[e][1]], 2) << code;
  }
  EXPECT_EQ(cases, (std::array<int, 5>{31, 8, 6, 24, 12}));
}

TEST(Patterns, AllPatternsInAllVertexOrdersOnOneTet) {
  const std::array<Vec3d, 4> place = {Vec3d(0, 0, 0), Vec3d(1.1, 0.1, -0.2), Vec3d(0.3, 0.9, 0.1),
                                      Vec3d(0.2, 0.3, 1.3)};
  std::array<int, 4> order = {0, 1, 2, 3};
  int cut_ones = 0;
  do {
    TetMesh root;
    root.position.resize(4);
    for (int i = 0; i < 4; ++i) root.position[VertexId(order[i])] = place[i];
    root.corner = {{VertexId(order[0]), VertexId(order[1]), VertexId(order[2]), VertexId(order[3])}};
    root.region = {0};
    connect(root);
    const Boundary boundary = boundary_of(root);
    for (int code = 0; code < 81; ++code) {
      SCOPED_TRACE("pattern " + std::to_string(code));
      const auto state = states_of(code);
      std::vector<double> value(4);
      Random random(7, code, order[0], order[1], order[2]);
      for (int i = 0; i < 4; ++i) value[order[i]] = (state[i] - 1) * random.uniform(0.2, 1.0);
      const Pattern& pattern = patterns[code];

      Pieces pieces = whole_piece(root);
      if (!pattern.has_below || !pattern.has_above) {
        EXPECT_NE(refusal([&] { cut_by_values(pieces, root, boundary, value); }), "");
        EXPECT_TRUE(same_bits(pieces, whole_piece(root)));
        continue;
      }
      ++cut_ones;
      const CutResult result = cut_by_values(pieces, root, boundary, value);
      EXPECT_EQ(result.tets_cut, 1u);
      ASSERT_EQ(pieces.piece.size(), 2u);
      const auto expected = tets_made(pattern);
      EXPECT_EQ(pieces.piece[0].cut.size(), std::size_t(expected[0]));
      EXPECT_EQ(pieces.piece[1].cut.size(), std::size_t(expected[1]));
      EXPECT_EQ(pieces.added.size(), std::size_t(split_edges[static_cast<int>(pattern.split)].count));
      check_pieces(pieces, root, boundary);
      check_sections_match(pieces, CutId(0));
      for (const FacetId f : all_ids<FacetId>(4)) {
        const auto& c = boundary.corner[f];
        const double whole =
            0.5 * (root.position[c[1]] - root.position[c[0]]).cross(root.position[c[2]] - root.position[c[0]]).norm();
        EXPECT_NEAR(area_of(pieces, root, 0, FaceTag::skin(f)) + area_of(pieces, root, 1, FaceTag::skin(f)), whole,
                    1e-14);
      }
      // The left half has the corners below, the right half those above.
      for (int side = 0; side < 2; ++side)
        for (const CutTet& tet : pieces.piece[side].cut)
          for (const VertexId v : tet.corner) {
            if (v < 4) {
              EXPECT_TRUE(side == 0 ? value[v] <= 0 : value[v] >= 0);
            }
          }
      for (std::size_t i = 0; i < pieces.added.size(); ++i) { // linear interpolation is zero at new vertices
        const AddedVertex& vertex = pieces.added[i];
        const Vec3d &a = root.position[vertex.a], &b = root.position[vertex.b];
        const double t = (pieces.added_position[i] - a).norm() / (b - a).norm();
        EXPECT_NEAR(value[vertex.a] + t * (value[vertex.b] - value[vertex.a]), 0, 1e-14);
        EXPECT_LT(vertex.a, vertex.b);
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(cut_ones, 50 * 24);
}

TEST(Patterns, TwoTetsSplitTheirSharedFaceAlike) {
  const std::array<Vec3d, 5> place = {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0.3, 0.3, 0.9),
                                      Vec3d(0.2, 0.4, -0.8)};
  std::array<int, 5> order = {0, 1, 2, 3, 4};
  std::size_t split = 0;
  do {
    TetMesh root;
    root.position.resize(5);
    for (int i = 0; i < 5; ++i) root.position[VertexId(order[i])] = place[i];
    root.corner = {{VertexId(order[0]), VertexId(order[1]), VertexId(order[2]), VertexId(order[3])},
                   {VertexId(order[0]), VertexId(order[2]), VertexId(order[1]), VertexId(order[4])}};
    root.region = {0, 0};
    connect(root);
    const Boundary boundary = boundary_of(root);
    for (int code = 0; code < 243; ++code) {
      SCOPED_TRACE("states " + std::to_string(code));
      const auto state = states_of(code);
      std::vector<double> value(5);
      for (int i = 0; i < 5; ++i) value[order[i]] = (state[i] - 1) * (0.3 + 0.1 * i);
      Pieces pieces = whole_piece(root);
      if (refusal([&] { cut_by_values(pieces, root, boundary, value); }) != "") {
        EXPECT_TRUE(*std::min_element(value.begin(), value.end()) >= 0 ||
                    *std::max_element(value.begin(), value.end()) <= 0);
        continue;
      }
      ++split;
      ASSERT_EQ(pieces.piece.size(), 2u);
      check_pieces(pieces, root, boundary, false); // two tets may touch in an edge only
      check_sections_match(pieces, CutId(0));
    }
    if (HasFatalFailure() || HasNonfatalFailure()) return;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(split, 120u * (243 - 32 - 32 + 1));
}

} // namespace
} // namespace pith
