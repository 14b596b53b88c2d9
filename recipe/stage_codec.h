#pragma once
// How each stage's result is archived in the cache (archive.h).
#include "recipe/archive.h"
#include "volume/cut/piece.h"
#include "volume/field/frames.h"
#include "volume/lap/lap.h"
#include "volume/lap/scatter.h"
#include "volume/layer/layer.h"
#include "volume/mesh/tetrahedralize.h"

#include <concepts>

namespace pith {

template <class Item, class T>
concept MaybeConst = std::same_as<std::remove_const_t<Item>, T>;

template <class Archive, class Item>
requires MaybeConst<Item, TetMesh>
void transfer(Archive& archive, Item& mesh) {
  transfer_list(archive, mesh.position);
  transfer_list(archive, mesh.corner);
  transfer_list(archive, mesh.neighbor);
  transfer_list(archive, mesh.region);
}

template <class Archive, class Item>
requires MaybeConst<Item, TriMesh>
void transfer(Archive& archive, Item& mesh) {
  transfer_list(archive, mesh.position);
  transfer_list(archive, mesh.corner);
  transfer_list(archive, mesh.part);
}

/// The surface that was meshed is not kept: nothing after this stage needs it.
template <class Archive, class Item>
requires MaybeConst<Item, TetrahedralizeResult>
void transfer(Archive& archive, Item& result) {
  transfer(archive, result.mesh);
  transfer_list(archive, result.input);
  transfer(archive, result.method);
  transfer(archive, result.surface_moved);
  transfer(archive, result.note);
}

template <class Archive, class Item>
requires MaybeConst<Item, DepthField>
void transfer(Archive& archive, Item& depth) {
  transfer_list(archive, depth.value);
  transfer_list(archive, depth.gradient);
  transfer(archive, depth.centers);
  transfer(archive, depth.extrema);
}

template <class Archive, class Item>
requires MaybeConst<Item, FrameField>
void transfer(Archive& archive, Item& frames) {
  transfer_list(archive, frames.axes);
  transfer_list(archive, frames.scale);
  transfer_list(archive, frames.singular);
}

template <class Archive, class Item>
requires MaybeConst<Item, Channel>
void transfer(Archive& archive, Item& channel) {
  transfer(archive, channel.name);
  transfer(archive, channel.semantic);
  transfer(archive, channel.components);
  transfer(archive, channel.srgb);
  transfer(archive, channel.low);
  transfer(archive, channel.high);
}

template <class Archive, class Item>
requires MaybeConst<Item, Exemplar>
void transfer(Archive& archive, Item& exemplar) {
  transfer(archive, exemplar.name);
  transfer(archive, exemplar.axes);
  transfer(archive, exemplar.size);
  transfer(archive, exemplar.wrap);
  transfer_list(archive, exemplar.channel);
  transfer_list(archive, exemplar.texel);
  transfer_list(archive, exemplar.gaussian);
  transfer_list(archive, exemplar.inverse);
}

template <class Archive, class Item>
requires MaybeConst<Item, Mask>
void transfer(Archive& archive, Item& mask) {
  transfer(archive, mask.axes);
  transfer(archive, mask.size);
  transfer(archive, mask.open);
  transfer_list(archive, mask.alpha);
}

template <class Archive, class Item>
requires MaybeConst<Item, AxisMap>
void transfer(Archive& archive, Item& map) {
  transfer(archive, map.scale);
  transfer(archive, map.offset);
}

template <class Archive, class Item>
requires MaybeConst<Item, Patch>
void transfer(Archive& archive, Item& patch) {
  transfer(archive, patch.exemplar);
  transfer(archive, patch.mask);
  transfer(archive, patch.frame);
  transfer(archive, patch.key);
}

template <class Archive, class Item>
requires MaybeConst<Item, Lookup>
void transfer(Archive& archive, Item& lookup) {
  transfer(archive, lookup.patch);
  transfer(archive, lookup.corner);
}

template <class Archive, class Item>
requires MaybeConst<Item, Layer>
void transfer(Archive& archive, Item& layer) {
  transfer(archive, layer.name);
  transfer(archive, layer.domain);
  transfer(archive, layer.region);
  transfer(archive, layer.width);
  transfer(archive, layer.blend.select);
  transfer(archive, layer.blend.grace);
  transfer(archive, layer.blend.mix);
  transfer(archive, layer.blend.mean_over);
  transfer(archive, layer.blend.correlation);
  transfer_list(archive, layer.exemplar);
  transfer_list(archive, layer.mask);
  transfer_list(archive, layer.patch);
  transfer_list(archive, layer.corner);
  transfer(archive, layer.evaluation);
  transfer_list(archive, layer.begin);
  transfer_list(archive, layer.simplex);
  transfer_list(archive, layer.lookup);
}

template <class Archive, class Item>
requires MaybeConst<Item, LapStatistics>
void transfer(Archive& archive, Item& statistics) {
  transfer(archive, statistics.pastes);
  transfer(archive, statistics.rounds);
  transfer(archive, statistics.lookups);
  transfer(archive, statistics.inverted);
  transfer(archive, statistics.warp_iterations);
  transfer(archive, statistics.median_share_used);
}

template <class Archive, class Item>
requires MaybeConst<Item, LapResult>
void transfer(Archive& archive, Item& result) {
  transfer(archive, result.layer);
  transfer(archive, result.statistics);
}

template <class Archive, class Item>
requires MaybeConst<Item, Box>
void transfer(Archive& archive, Item& box) {
  transfer(archive, box.low);
  transfer(archive, box.high);
}

template <class Archive, class Item>
requires MaybeConst<Item, Occupancy>
void transfer(Archive& archive, Item& occupancy) {
  transfer_list(archive, occupancy.cell);
  transfer(archive, occupancy.bounds);
}

template <class Archive, class Item>
requires MaybeConst<Item, Thing>
void transfer(Archive& archive, Item& thing) {
  transfer(archive, thing.exemplar);
  transfer(archive, thing.mask);
  transfer(archive, thing.frame);
  transfer(archive, thing.solid);
  transfer(archive, thing.volume);
  transfer(archive, thing.any);
  transfer(archive, thing.half);
}

template <class Archive, class Item>
requires MaybeConst<Item, PastedThing>
void transfer(Archive& archive, Item& pasted) {
  transfer(archive, pasted.key);
  transfer(archive, pasted.box.center);
  transfer(archive, pasted.box.axes);
  transfer(archive, pasted.box.half);
  transfer_list(archive, pasted.tet);
  transfer_list(archive, pasted.corner);
  transfer_list(archive, pasted.coordinate);
}

template <class Archive, class Item>
requires MaybeConst<Item, ScatterResult>
void transfer(Archive& archive, Item& result) {
  transfer_list(archive, result.pasted);
  transfer(archive, result.wanted);
}

template <class Archive, class Item>
requires MaybeConst<Item, CutTet>
void transfer(Archive& archive, Item& tet) {
  transfer(archive, tet.corner);
  transfer(archive, tet.root);
  for (auto& tag : tet.face) transfer(archive, tag.code);
}

template <class Archive, class Item>
requires MaybeConst<Item, Piece>
void transfer(Archive& archive, Item& piece) {
  transfer_list(archive, piece.cut);
  transfer(archive, piece.placement.rotation);
  transfer(archive, piece.placement.translation);
}

template <class Archive, class Item>
requires MaybeConst<Item, AddedVertex>
void transfer(Archive& archive, Item& vertex) {
  transfer(archive, vertex.a);
  transfer(archive, vertex.b);
  transfer(archive, vertex.cut);
}

template <class Archive, class Item>
requires MaybeConst<Item, SectionNormal>
void transfer(Archive& archive, Item& normal) {
  transfer(archive, normal.vertex);
  transfer(archive, normal.cut);
  transfer(archive, normal.normal);
}

template <class Archive, class Item>
requires MaybeConst<Item, Pieces>
void transfer(Archive& archive, Item& pieces) {
  transfer(archive, pieces.root_vertex_count);
  transfer_list(archive, pieces.label);
  transfer_list(archive, pieces.piece);
  transfer_list(archive, pieces.added);
  transfer_list(archive, pieces.added_position);
  transfer_list(archive, pieces.added_normal);
  transfer_list(archive, pieces.on_section);
  transfer(archive, pieces.cut_count);
}

} // namespace pith
