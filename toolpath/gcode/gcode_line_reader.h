// A G-code program line by line, as it comes.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "toolpath/gcode/gcode_state.h"

namespace understudy::toolpath {

/// What parse_gcode() reads a text with. `file`, `options` and `steps` must outlive it.
class GcodeLineReader {
 public:
  /// Throws InputError for options that contradict each other.
  GcodeLineReader(const std::string& file, const GcodeOptions& options, std::vector<Step>& steps);
  ~GcodeLineReader();

  /// One line without its end; appends its steps. Throws InputError as parse_gcode() does; an unknown word is
  /// told by finish().
  void read(std::string_view line, int number);
  /// The same for a program that is not there as a whole: an unknown word is told at once, and a line that
  /// throws has done nothing.
  void read_or_undo(std::string_view line, int number);
  /// As if that line had not been read.
  void undo();
  /// Throws InputError for words that were unknown.
  void finish();

  const GcodeState& state() const;  ///< after the last line
  const Letters& letters() const;   ///< of the dialect
  /// The last line moves the tool to a place that its own words say: no homing, no macro.
  bool said_place() const;

 private:
  class Lines;
  std::unique_ptr<Lines> lines_;
};

}  // namespace understudy::toolpath
