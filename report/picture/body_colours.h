// One colour for one kind of body, in pictures and in files for viewers.
#pragma once

#include <array>
#include <string>

namespace understudy::report {

/// Red, green, blue in linear light, 0 to 1.
using LinearColour = std::array<float, 3>;

inline constexpr LinearColour kMetal{0.55f, 0.58f, 0.62f}, kStrut{0.25f, 0.42f, 0.62f},
    kBrass{0.80f, 0.60f, 0.22f}, kPart{0.86f, 0.88f, 0.84f}, kTable{0.90f, 0.90f, 0.91f},
    kPath{0.85f, 0.25f, 0.10f}, kHeater{0.45f, 0.20f, 0.18f}, kFilament{0.90f, 0.45f, 0.15f};

/// Of a machine's body, by its name.
inline LinearColour colour_of_body(const std::string& body) {
  if (body.find("strut") != std::string::npos) return kStrut;
  if (body == "nozzle") return kBrass;
  if (body == "heater block") return kHeater;
  return kMetal;
}

}  // namespace understudy::report
