// Lines that cannot be read, and how a program is read on without them (docs/gcode.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/gcode_salvage.h"
#include "toolpath/gcode/gcode_state.h"

namespace understudy::toolpath {

/// Keeps what is not known after such a line. Told of a program line by line: before(), then check() and
/// note() of its blocks, and after() where it could be read, else pass_over().
class LinesPassedOver {
 public:
  LinesPassedOver(const std::string& file, const Letters& letters) : file_(file), letters_(letters) {}

  void before(const GcodeState& state, std::size_t steps);
  /// Throws InputError for a block that means something else where the tool is not known.
  void check(const Block& block) const;
  void note(const Block& block, const GcodeState& state);
  /// As it was before the line.
  void undo(GcodeState& state, std::vector<Step>& steps) const;
  /// Throws InputError at `place` where the tool is not known.
  void require_place(const Place& place) const;
  void after(int line, const GcodeState& state, std::vector<Step>& steps);
  /// Takes back what the line did, and takes of it what can be read. False: it must not be passed over.
  bool pass_over(std::string_view text, int line, const InputError& error, GcodeState& state,
                 std::vector<Step>& steps);
  void finish(const GcodeState& state);

  const std::vector<PassedOver>& found() const { return found_; }

 private:
  void take(SalvagedLine& words, int line, GcodeState& state);
  void drop_moves(int line, std::vector<Step>& steps);
  void end(int line, const GcodeState& state, std::vector<Step>& steps);

  const std::string& file_;
  const Letters& letters_;
  std::vector<PassedOver> found_;
  std::optional<GcodeState> before_;  // the line that is read
  std::size_t steps_before_ = 0;
  // Of moves that are left out because of one line:
  std::optional<GcodeState> begin_;
  std::size_t first_ = 0;  // of found_
  std::string unknown_;    // letters, as of SalvagedLine
};

}  // namespace understudy::toolpath
