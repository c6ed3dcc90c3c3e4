// Units of files and messages: millimetres and degrees where the code has metres and radians.
#pragma once

#include <string_view>

#include "core/units.h"

namespace understudy {

struct FileUnit {
  double factor;  ///< times the SI value
  const char* name;
};

/// Of an SI unit as limits name theirs ("m", "rad/s"); anything else stays as it is, without a unit: "1".
inline FileUnit file_unit(std::string_view si) {
  if (si == "m") return {1e3, "mm"};
  if (si == "rad") return {1 / kDegree, "deg"};
  if (si == "m/s") return {1e3, "mm/s"};
  if (si == "m/s^2") return {1e3, "mm/s2"};
  if (si == "rad/s") return {1 / kDegree, "deg/s"};
  if (si == "rad/s^2") return {1 / kDegree, "deg/s2"};
  return {1, "1"};
}

}  // namespace understudy
