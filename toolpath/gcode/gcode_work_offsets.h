// G54 to G59.3: tables of origins that a program fills by G10 and chooses from.
#pragma once

#include <array>

#include "core/frames.h"
#include "toolpath/gcode/words/gcode_block.h"

namespace understudy::toolpath {

/// Nine origins, P1 (G54) to P9 (G59.3), all at the machine's origin until the program sets them.
class WorkOffsets {
 public:
  /// [m], of the system in use.
  const Vec3& active() const { return tables_[active_]; }
  /// G54 to G59.3, if the line has one.
  void select(const Block& block);
  /// G10 L2 (X Y Z are the origin) and L20 (the present `reading` [m] is called X Y Z from now on), P1 to P9
  /// or P0, the one in use. Throws InputError with place.
  void set(Block& block, double unit, bool relative, const Vec3& reading);

 private:
  std::array<Vec3, 9> tables_{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                              Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::size_t active_ = 0;
};

}  // namespace understudy::toolpath
