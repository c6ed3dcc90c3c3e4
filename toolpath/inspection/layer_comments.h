// Where slicers' comments say that layers begin.
#pragma once

#include <string_view>
#include <vector>

namespace understudy::toolpath {

/// Comments as PrusaSlicer and its kin (;LAYER_CHANGE), BambuStudio (; CHANGE_LAYER), Cura and ideaMaker
/// (;LAYER:3), Simplify3D (; layer 3, Z = 0.6) and Kiri:Moto (;; --- layer 3) write them.
class LayerComments {
 public:
  LayerComments() = default;
  explicit LayerComments(std::string_view text);

  bool empty() const { return lines_.empty(); }
  /// Of the layer that a line of the program belongs to, from 1; 0: before the first.
  int at(int line) const;
  /// The line at which the first layer begins, whose number is 0 or 1, or below, of a raft; 0: the comments
  /// begin with a later one, or there are none.
  int first() const;

 private:
  std::vector<int> lines_;  // ascending
  int first_number_ = 0;
};

}  // namespace understudy::toolpath
