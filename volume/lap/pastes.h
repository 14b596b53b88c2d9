#pragma once
// A fill in the making: the pastes so far, what each simplex shows, and the layer that comes of them.
#include "volume/lap/coverage.h"
#include "volume/lap/grow.h"
#include "volume/layer/layer.h"
#include "volume/layer/sample.h"

namespace pith {

/// One paste that was grown but not yet committed.
struct Paste {
  Patch patch;
  Growth growth;
  float share_used = 0;             ///< of the mask's alpha, the part that lies on the clump
  std::uint32_t inverted = 0;       ///< of the simplices on which it can be seen: those that it shows in mirror image
  std::vector<std::uint32_t> shown; ///< clump simplices (local numbers) on which it can be seen
  std::vector<float> let_through;   ///< for each of them, its samples' 1 − alpha, one after the other
};

/// Pastes in order, newest beneath (see lap.h). Reading is safe from many threads between two commits.
class Pastes {
public:
  /// `keep_hidden`: keep look-ups also where older pastes hide them, so that seams can be moved afterwards.
  Pastes(const Simplices& mesh, Coverage coverage, std::vector<Mask> masks, bool keep_hidden = false);

  const Coverage& coverage() const { return coverage_; }
  const std::vector<Mask>& masks() const { return masks_; }
  const std::vector<MaskGrid>& grids() const { return grids_; } ///< of the masks
  std::size_t count() const { return patch_.size(); }

  /// Finds where a grown paste can be seen, and its used share. Reads the coverage as it is now.
  void look(Paste& paste) const;

  /// Puts the paste beneath all earlier ones.
  void commit(const Paste& paste);

  /// Alpha and coordinates of the pastes that show at a sample, uppermost first: visit(patch, coordinates, alpha)
  /// until it returns false.
  template <class Visit>
  void visit(std::uint32_t simplex, const std::array<float, 4>& barycentric, const Visit& see) const {
    std::array<std::uint32_t, 256> row;
    std::size_t rows = 0;
    for (std::uint32_t node = newest_[simplex]; node != none && rows < row.size(); node = older_[node])
      row[rows++] = node;
    while (rows-- > 0) {
      const Lookup& lookup = lookup_[row[rows]];
      std::array<float, 4> w{};
      for (int i = 0; i < mesh_.corners; ++i)
        for (int k = 0; k <= axes_; ++k)
          w[k] += barycentric[i] * corner_[std::size_t(lookup.corner[i]) * (axes_ + 1) + k];
      const Patch& patch = patch_[lookup.patch];
      const float alpha = w[axes_] > 0 ? w[axes_] * grids_[patch.mask].alpha(lanes_at(w.data())) : 0.0f;
      if (alpha > 0 && !see(patch, w, alpha)) return;
    }
  }

  /// The layer: compressed rows, the first paste uppermost. Leaves this object empty.
  Layer take_layer();

private:
  static constexpr std::uint32_t none = 0xffffffffu;
  const Simplices& mesh_;
  Coverage coverage_;
  std::vector<Mask> masks_;
  std::vector<MaskGrid> grids_;
  std::vector<double> mask_volume_;
  int axes_;
  bool keep_hidden_;
  std::vector<Patch> patch_;
  LargeArray<float> corner_;
  std::vector<Lookup> lookup_;        ///< in order of commit
  std::vector<std::uint32_t> newest_; ///< per simplex, its latest look-up
  std::vector<std::uint32_t> older_;  ///< per look-up, the one before it on the same simplex
};

} // namespace pith
