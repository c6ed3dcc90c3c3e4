// How high and how wide each line of a program is meant to be, as the comments of slicers say.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace understudy::toolpath {

/// What a comment tells of the lines after it; 0: it is not told.
struct ToldBead {
  double height = 0;  ///< [m], of the layer
  double width = 0;   ///< [m], of the line

  /// [m^2], of a bead with round sides; 0 where one of both is not told, or it is higher than wide.
  double area() const;
};

/// By line of the file. Read are `;HEIGHT:` and `;WIDTH:` of PrusaSlicer, SuperSlicer and OrcaSlicer,
/// `; LAYER_HEIGHT:` and `; LINE_WIDTH:` of BambuStudio. Each holds until the next; both end with a feature
/// that is laid on no layer: bridges and overhangs, whose height is the strand's, and ironing.
class ToldBeads {
 public:
  ToldBeads() = default;
  explicit ToldBeads(std::string_view text);

  ToldBead at(int line) const;
  bool empty() const { return from_.empty(); }
  /// The program prints supports, over which a line may lie higher than it is told to be thick.
  bool supports() const { return supports_; }

 private:
  std::vector<std::pair<int, ToldBead>> from_;  // first line
  bool supports_ = false;
};

}  // namespace understudy::toolpath
