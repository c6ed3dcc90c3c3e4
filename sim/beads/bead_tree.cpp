#include "sim/beads/bead_tree.h"

#include <bit>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "sim/beads/bead_shape.h"

namespace understudy::sim {
namespace {

constexpr double kLeaf = 1e-3;      // [m]
constexpr double kPiece = 1.25e-3;  // [m], longest stretch of a bead in one leaf
constexpr double kRounding = 1e-9;  // [m], added to boxes: more than that of the distances compared to them
constexpr int kFirstLevels = 3;     // the root begins with 64 mm
// Bits 10 in turn, so that the origin lies well inside a cell at every level and a print about it needs no
// higher root.
constexpr std::uint32_t kOrigin = 0x2aaaaaaa;

std::uint32_t cell_of(double x) {
  return kOrigin + static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(x / kLeaf)));
}

float below(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float above(double x) { return -below(-x); }

// Upper half of a float that is not above x, and back.
std::uint16_t half_below(double x) {
  const auto bits = std::bit_cast<std::uint32_t>(below(x));
  const bool negative = bits >> 31 != 0, cut = (bits & 0xffff) != 0;
  return static_cast<std::uint16_t>((bits >> 16) + (negative && cut ? 1 : 0));
}
std::uint16_t half_above(double x) {
  const std::uint16_t down = half_below(-x);
  return static_cast<std::uint16_t>(down ^ 0x8000U);
}
double from_half(std::uint16_t half) {
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(half) << 16));
}

std::uint64_t bit_of(int slot) { return std::uint64_t{1} << slot; }

// In steps small enough that hardly anything is held without use.
template <typename T>
T& insert(std::vector<T>& items, std::size_t at, T item) {
  if (items.size() == items.capacity()) items.reserve(items.size() + 1 + items.size() / 8);
  return *items.insert(items.begin() + static_cast<std::ptrdiff_t>(at), std::move(item));
}

int slot_of(const std::array<std::uint32_t, 3>& leaf_cell, int level) {
  const int shift = 2 * (level - 1);
  return static_cast<int>((leaf_cell[0] >> shift & 3) | (leaf_cell[1] >> shift & 3) << 2 |
                          (leaf_cell[2] >> shift & 3) << 4);
}

}  // namespace

Vec3 BeadTree::middle_of(const Cell& leaf_cell) {
  Vec3 middle;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto cell = static_cast<std::int32_t>(leaf_cell[i] - kOrigin);
    middle[static_cast<Eigen::Index>(i)] = (cell + 0.5) * kLeaf;
  }
  return middle;
}

std::uint64_t BeadTree::slots_within(const Bounds& region, double overhang, const Cell& cell, int level) {
  // Bits of the slots whose x, y or z is one of four chosen: slot = x + 4 y + 16 z.
  static constexpr std::array<std::uint64_t, 3> kEvery{0x1111111111111111, 0x000f000f000f000f, 0xffff};
  const double size = kLeaf * static_cast<double>(std::uint64_t{1} << 2 * (level - 1));
  std::uint64_t slots = ~std::uint64_t{0};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double corner =
        kLeaf * static_cast<double>(static_cast<std::int64_t>(std::uint64_t{cell[i]} << 2 * level) -
                                    std::int64_t{kOrigin});
    const auto first =
        static_cast<int>(std::clamp(std::floor((region.lower[k] - overhang - corner) / size), 0.0, 4.0));
    const auto last =
        static_cast<int>(std::clamp(std::floor((region.upper[k] + overhang - corner) / size), -1.0, 3.0));
    std::uint64_t chosen = 0;
    for (int s = first; s <= last; ++s) chosen |= kEvery[i] << (s << 2 * i);
    slots &= chosen;
  }
  return slots;
}

BeadTree::Box BeadTree::box_of(const WideBox& box) {
  const Vec3 lower(box.lower[0], box.lower[1], box.lower[2]), upper(box.upper[0], box.upper[1], box.upper[2]);
  return {0.5 * (lower + upper), 0.5 * (upper - lower)};
}

BeadTree::Box BeadTree::box_of(const SmallBox& box, const Cell& leaf_cell) {
  const Vec3 lower(from_half(box.lower[0]), from_half(box.lower[1]), from_half(box.lower[2]));
  const Vec3 upper(from_half(box.upper[0]), from_half(box.upper[1]), from_half(box.upper[2]));
  return {middle_of(leaf_cell) + 0.5 * (lower + upper), 0.5 * (upper - lower)};
}

void BeadTree::add(const Bead& bead) {
  if (size() >= kPieceFlag - 1) throw InputError("more than 2147483647 beads");
  const auto index = static_cast<std::uint32_t>(size());
  records_.push_back({bead, kNone});
  const BeadCore core = core_of(bead);
  const double length = 2 * core.half_along.norm();
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / kPiece)));
  const Vec3 disc = core.disc_radius * (1 - core.up.array().square()).max(0).sqrt().matrix();
  const Vec3 half = core.half_along.cwiseAbs() / pieces + core.half_side.cwiseAbs() + disc +
                    Vec3::Constant(core.radius + kRounding);
  for (int i = 0; i < pieces; ++i) {
    const Vec3 middle = core.middle + ((2 * i + 1.0) / pieces - 1) * core.half_along;
    std::uint32_t entry = index;
    if (i > 0) {
      entry = static_cast<std::uint32_t>(pieces_.size()) | kPieceFlag;
      pieces_.push_back({index, kNone});
    }
    enter({cell_of(middle.x()), cell_of(middle.y()), cell_of(middle.z())}, {middle - half, middle + half},
          entry);
  }
}

std::uint32_t& BeadTree::next_of(std::uint32_t entry) {
  return entry & kPieceFlag ? pieces_[entry & ~kPieceFlag].next : records_[entry].next;
}

// The root above the first bead's cell, then as many levels up as the others need.
void BeadTree::widen_to(const Cell& leaf_cell, const Bounds& bounds) {
  const auto at_root = [&] {
    const int shift = 2 * root_level_;
    return Cell{leaf_cell[0] >> shift, leaf_cell[1] >> shift, leaf_cell[2] >> shift};
  };
  if (root_level_ == 0) {
    root_level_ = kFirstLevels;
    root_cell_ = at_root();
    root_.box = {{below(bounds.lower.x()), below(bounds.lower.y()), below(bounds.lower.z())},
                 {above(bounds.upper.x()), above(bounds.upper.y()), above(bounds.upper.z())}};
  }
  while (at_root() != root_cell_) {
    const int slot =
        static_cast<int>((root_cell_[0] & 3) | (root_cell_[1] & 3) << 2 | (root_cell_[2] & 3) << 4);
    Node higher{root_.box, root_.overhang, bit_of(slot), {}, {}};
    higher.nodes.push_back(std::move(root_));
    root_ = std::move(higher);
    ++root_level_;
    for (std::uint32_t& c : root_cell_) c >>= 2;
  }
}

void BeadTree::enter(const Cell& leaf_cell, const Bounds& bounds, std::uint32_t entry) {
  widen_to(leaf_cell, bounds);
  WideBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    box.lower[i] = below(bounds.lower[static_cast<Eigen::Index>(i)]);
    box.upper[i] = above(bounds.upper[static_cast<Eigen::Index>(i)]);
  }
  const Vec3 middle = middle_of(leaf_cell);
  const float overhang =
      above((bounds.upper - middle).cwiseMax(middle - bounds.lower).maxCoeff() - 0.5 * kLeaf);
  Node* node = &root_;
  for (int level = root_level_;; --level) {
    node->overhang = std::max(node->overhang, overhang);
    for (std::size_t i = 0; i < 3; ++i) {
      node->box.lower[i] = std::min(node->box.lower[i], box.lower[i]);
      node->box.upper[i] = std::max(node->box.upper[i], box.upper[i]);
    }
    if (level == 1) break;
    const int slot = slot_of(leaf_cell, level);
    const std::size_t at = place_of(node->taken, slot);
    if (!(node->taken & bit_of(slot))) insert(node->nodes, at, Node{box, 0, 0, {}, {}});
    node->taken |= bit_of(slot);
    node = &node->nodes[at];
  }

  SmallBox small;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    small.lower[i] = half_below(bounds.lower[k] - middle[k]);
    small.upper[i] = half_above(bounds.upper[k] - middle[k]);
  }
  const int slot = slot_of(leaf_cell, 1);
  const std::size_t at = place_of(node->taken, slot);
  if (!(node->taken & bit_of(slot))) insert(node->leaves, at, Leaf{small, kNone});
  node->taken |= bit_of(slot);
  Leaf& leaf = node->leaves[at];
  for (std::size_t i = 0; i < 3; ++i) {
    if (from_half(small.lower[i]) < from_half(leaf.box.lower[i])) leaf.box.lower[i] = small.lower[i];
    if (from_half(small.upper[i]) > from_half(leaf.box.upper[i])) leaf.box.upper[i] = small.upper[i];
  }
  next_of(entry) = leaf.head;
  leaf.head = entry;
}

std::size_t BeadTree::bytes_below(const Node& node) {
  std::size_t sum = node.leaves.capacity() * sizeof(Leaf) + node.nodes.capacity() * sizeof(Node);
  for (const Node& child : node.nodes) sum += bytes_below(child);
  return sum;
}

std::size_t BeadTree::bytes() const {
  return sizeof(*this) + records_.bytes() + pieces_.bytes() + bytes_below(root_);
}

}  // namespace understudy::sim
