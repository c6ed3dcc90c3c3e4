// Where a program asked for the tool, along the program that it was rewritten to.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "toolpath/program.h"

namespace understudy::toolpath {

/// A place of the original: a step, counted from 0, and the share of its way.
struct AskedPlace {
  std::size_t step = 0;
  double fraction = 0;
};

class RewrittenPath {
 public:
  /// `original` starts at `X_WT_home`; `text` is what rewrite_gcode() wrote of it, `rewritten` that text as
  /// read. Both programs are of one reading, homing included. Throws InputError where the two do not belong
  /// together.
  RewrittenPath(const Program& original, const Program& rewritten, const std::string& text,
                const Pose& X_WT_home);

  /// Of a step of the rewritten program.
  AskedPlace place(std::size_t step, double fraction) const;
  /// X_WT that the original asks for there: the tip exactly, the orientation on the shortest arc.
  Pose asked(const AskedPlace& place) const;
  /// The same for a tool that the rewritten program has at `X_WT` while it runs its line.
  Pose asked(int line, const Pose& X_WT) const;
  /// Line of the original that a line of the rewritten program comes from.
  int original_line(int line) const;

 private:
  struct Part {
    std::size_t first = 0, count = 0;  ///< steps of the original on this line
    double from = 0, to = 1;           ///< of the line's way
  };
  void match(const Program& original, const Program& rewritten);
  double length(std::size_t step) const;

  std::vector<Pose> begin_, end_;  ///< of the original's steps
  std::vector<Pose> rewritten_begin_, rewritten_end_;
  std::vector<Part> parts_;                  ///< one a step of the rewritten program
  std::multimap<int, std::size_t> by_line_;  ///< its moving steps
  std::vector<int> original_lines_;          ///< by line of the rewritten program, from 1
  std::string file_;
};

}  // namespace understudy::toolpath
