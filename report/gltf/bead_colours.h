// What the colour of a bead says in files for viewers: as on the page of a rehearsal
// (web/report/src/colours.ts).
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "report/page/recorded_replay.h"

namespace understudy::report {

enum class BeadColour { gap, width, plain };

/// "gap", "width", "plain". Throws InputError naming the three for another word.
BeadColour bead_colour_of(const std::string& word);

class BeadColours {
 public:
  /// Throws InputError for the gap on a machine that accepts none in particular.
  BeadColours(const RecordedReplay& replay, BeadColour what);

  /// Red, green, blue in linear light and 255 for opaque.
  std::array<std::uint8_t, 4> at(const sim::BeadSection& section) const;
  /// The key to the colours, in words.
  const std::string& legend() const { return legend_; }

 private:
  double gap_at(double time) const;

  const RecordedReplay& replay_;
  BeadColour what_;
  double widest_ = 0;  ///< [m], where the scale ends
  std::string legend_;
};

}  // namespace understudy::report
