// What the lines of a program print, as the comments of slicers say.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "toolpath/program.h"

namespace understudy::toolpath {

/// Feature types by line of the file. Read are `;TYPE:` of PrusaSlicer, SuperSlicer, OrcaSlicer, ideaMaker
/// and Cura, `; FEATURE:` of BambuStudio, `; feature` of Simplify3D, and `; 'Perimeter Path'` of KISSlicer.
/// Each holds until the next.
class FeatureTypes {
 public:
  FeatureTypes() = default;
  explicit FeatureTypes(std::string_view text);

  /// As the slicer writes it; empty where no comment says it.
  std::string_view at(int line) const;
  /// Each type, and the first line from which on it holds; neighbours differ.
  const std::vector<std::pair<int, std::string>>& changes() const { return from_; }
  /// The first line from which on something of the part is printed; 0: no comment says it.
  int first_of_part() const;

 private:
  std::vector<std::pair<int, std::string>> from_;  // first line, type
};

/// Skirts, brims, purge lines and towers: what is printed beside the part and thrown away.
bool is_beside_part(std::string_view type);

/// [m] of printed path by type, without what no comment says. `start_W` [m]: the tip before the first step.
std::map<std::string, double> feature_lengths(const Program& program, const FeatureTypes& types,
                                              const Vec3& start_W);

}  // namespace understudy::toolpath
