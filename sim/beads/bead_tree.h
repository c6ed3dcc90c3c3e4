// Where beads lie: a sparse tree of grids, each cell cut into 4 x 4 x 4 smaller ones down to 1 mm.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/frames.h"
#include "sim/beads/bead.h"

namespace understudy::sim {

/// Grows at its end without moving or over-allocating what is there.
template <typename T>
class ChunkedArray {
 public:
  void push_back(const T& item) {
    if (size_ % kChunk == 0) chunks_.push_back(std::make_unique<T[]>(kChunk));
    (*this)[size_++] = item;
  }
  T& operator[](std::size_t i) { return chunks_[i / kChunk][i % kChunk]; }
  const T& operator[](std::size_t i) const { return chunks_[i / kChunk][i % kChunk]; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const {
    return chunks_.size() * kChunk * sizeof(T) + chunks_.capacity() * sizeof(chunks_[0]);
  }

 private:
  static constexpr std::size_t kChunk = 256;
  std::vector<std::unique_ptr<T[]>> chunks_;
  std::size_t size_ = 0;
};

/// A bead is entered by its middle, a long one in pieces. Cells know the tight box around the whole of what
/// was entered in them, so a bead may reach out of its cell. Reading is safe from many threads.
class BeadTree {
 public:
  struct Box {
    Vec3 centre, half;  ///< [m], in W
  };

  void add(const Bead& bead);  ///< one that check() in bead_shape.h lets pass
  std::size_t size() const { return records_.size(); }
  const Bead& bead(std::size_t index) const { return records_[index].bead; }
  std::size_t bytes() const;

  struct Bounds {
    Vec3 lower, upper;  ///< [m], in W
  };

  /// Visits all beads of boxes whose `bound(box)` is not above `limit()`, nearest boxes first; a long bead
  /// perhaps more than once. The limit may fall meanwhile. `region()` holds all that can be within the limit:
  /// beads that lie wholly outside may be passed over before their box is looked at.
  template <typename Region, typename Bound, typename Limit, typename Visit>
  void search(const Region& region, const Bound& bound, const Limit& limit, const Visit& visit) const {
    if (size() > 0)
      descend(root_, root_cell_, root_level_,
              Search<Region, Bound, Limit, Visit>{region, bound, limit, visit});
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  static constexpr std::uint32_t kPieceFlag = 0x80000000;

  using Cell = std::array<std::uint32_t, 3>;  // of its level's grid
  struct Record {
    Bead bead;
    std::uint32_t next;  // entered in the same leaf before
  };
  struct Piece {  // of a bead that is entered more than once
    std::uint32_t bead, next;
  };
  struct WideBox {
    std::array<float, 3> lower, upper;
  };
  // About the cell's middle, in the upper halves of floats, rounded outwards.
  struct SmallBox {
    std::array<std::uint16_t, 3> lower, upper;
  };
  struct Leaf {
    SmallBox box;
    std::uint32_t head;
  };
  struct Node {
    WideBox box;
    float overhang = 0;       // [m], how far what was entered below reaches out of its leaf's cell
    std::uint64_t taken = 0;  // a bit a cell that exists; children stand in the order of the bits
    std::vector<Node> nodes;
    std::vector<Leaf> leaves;  // of the lowest nodes
  };
  template <typename Region, typename Bound, typename Limit, typename Visit>
  struct Search {
    const Region& region;
    const Bound& bound;
    const Limit& limit;
    const Visit& visit;
  };

  void enter(const Cell& leaf_cell, const Bounds& bounds, std::uint32_t entry);
  void widen_to(const Cell& leaf_cell, const Bounds& bounds);
  std::uint32_t& next_of(std::uint32_t entry);
  static std::size_t bytes_below(const Node& node);

  static Vec3 middle_of(const Cell& leaf_cell);
  static Box box_of(const WideBox& box);
  static Box box_of(const SmallBox& box, const Cell& leaf_cell);
  static Cell child_cell(const Cell& cell, int slot) {
    const auto s = static_cast<std::uint32_t>(slot);
    return {cell[0] << 2 | (s & 3), cell[1] << 2 | (s >> 2 & 3), cell[2] << 2 | s >> 4};
  }

  /// The cells of a node whose contents can reach into the region.
  static std::uint64_t slots_within(const Bounds& region, double overhang, const Cell& cell, int level);
  static std::size_t place_of(std::uint64_t taken, int slot) {
    return static_cast<std::size_t>(std::popcount(taken & ((std::uint64_t{1} << slot) - 1)));
  }

  template <typename Of>
  void descend(const Node& node, const Cell& cell, int level, const Of& search) const;
  template <typename Of>
  void visit_leaf(const Leaf& leaf, const Of& search) const;

  ChunkedArray<Record> records_;
  ChunkedArray<Piece> pieces_;
  Node root_{};
  Cell root_cell_{};
  int root_level_ = 0;  // 1: children are leaves
};

template <typename Of>
void BeadTree::descend(const Node& node, const Cell& cell, int level, const Of& search) const {
  struct Child {
    double bound;
    std::size_t index;
    int slot;
  };
  std::array<Child, 64> near;
  std::size_t count = 0;
  const std::uint64_t within = slots_within(search.region(), static_cast<double>(node.overhang), cell, level);
  for (std::uint64_t rest = node.taken & within; rest != 0; rest &= rest - 1) {
    const int slot = std::countr_zero(rest);
    const std::size_t i = place_of(node.taken, slot);
    const double bound = search.bound(level == 1 ? box_of(node.leaves[i].box, child_cell(cell, slot))
                                                 : box_of(node.nodes[i].box));
    if (bound <= search.limit()) near[count++] = {bound, i, slot};
  }
  std::sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Child& a, const Child& b) {
              return a.bound < b.bound || (a.bound == b.bound && a.slot < b.slot);
            });
  for (std::size_t k = 0; k < count && near[k].bound <= search.limit(); ++k) {
    const std::size_t i = near[k].index;
    if (level == 1)
      visit_leaf(node.leaves[i], search);
    else
      descend(node.nodes[i], child_cell(cell, near[k].slot), level - 1, search);
  }
}

template <typename Of>
void BeadTree::visit_leaf(const Leaf& leaf, const Of& search) const {
  for (std::uint32_t entry = leaf.head; entry != kNone;) {
    if (entry & kPieceFlag) {
      const Piece& piece = pieces_[entry & ~kPieceFlag];
      search.visit(std::size_t{piece.bead}, records_[piece.bead].bead);
      entry = piece.next;
    } else {
      const Record& record = records_[entry];
      search.visit(std::size_t{entry}, record.bead);
      entry = record.next;
    }
  }
}

}  // namespace understudy::sim
