// One thing that a rehearsal found.
#pragma once

#include <string>

namespace understudy::rehearsal {

enum class Severity { error, warning };

/// kind is one of the contract's words. value and limit in `unit`, the unit of reports (mm, deg, um, mm/s).
struct Finding {
  std::string kind;
  Severity severity = Severity::error;
  int gcode_line = 0;
  double time_s = 0;
  double value = 0;
  double limit = 0;
  std::string unit;
  std::string message;
  int last_line = 0;       ///< of one that spans several lines; 0: it does not
  std::string about = {};  ///< findings of one kind about the same are alike: "strut 3", "nozzle and part"
  int bead_line = 0;       ///< of a contact with a bead: the line that laid it
};

// What findings are about, where advice depends on it.
inline constexpr const char* kPassedOver = "line that is passed over,";
inline constexpr const char* kOtherNozzle = "another nozzle";
inline constexpr const char* kOtherLayer = "other layers";
inline constexpr const char* kOtherFilament = "other filament";
inline constexpr const char* kOtherFlow = "other flow";
inline constexpr const char* kOtherAmount = "other amount of filament";
inline constexpr const char* kRelativeExtrusion = "relative extrusion";
inline constexpr const char* kOtherMaterial = "another material";
inline constexpr const char* kStopped = "the print stopped";
inline constexpr const char* kTooLow = "too low";
inline constexpr const char* kTooHigh = "too high";
inline constexpr const char* kLifted = "lifted";  ///< a bead hangs where the program lays it on something
inline constexpr const char* kNothingBelow = "nothing below";
inline constexpr const char* kCold = "cold";
inline constexpr const char* kUnmeasured = "unmeasured start";
inline constexpr const char* kUncontrolled = "no approach";
inline constexpr const char* kNozzleCold = "cold nozzle";
inline constexpr const char* kNozzleHot = "hot nozzle";
inline constexpr const char* kVoids = "voids";
inline constexpr const char* kOverfilled = "overfilled";
inline constexpr const char* kTip = "tip";
inline constexpr const char* kOrientation = "orientation";

}  // namespace understudy::rehearsal
