// Swept parts with bends, by name, for tests of the line and of the layers across it.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/parts/swept_part.h"

namespace understudy::toolpath {

struct Bent {
  const char* name;
  std::vector<Vec2> outline;
  std::vector<SweptPiece> pieces;
};

inline std::vector<Bent> bent_parts() {
  return {{"circle", circle_mm(6), one_bend()},
          {"rectangle", rectangle_mm(16, 10), one_bend()},
          {"s", circle_mm(6), s_bend()},
          {"two_planes", circle_mm(6), bends_in_two_planes()}};
}

inline std::string name_of_part(const testing::TestParamInfo<Bent>& each) { return each.param.name; }

}  // namespace understudy::toolpath
