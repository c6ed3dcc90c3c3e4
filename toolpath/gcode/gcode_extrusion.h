// Whether absolute E, as it is read, may be relative E whose M83 stands in a macro of the printer.
#pragma once

namespace understudy::toolpath {

/// Moves in X or Y with a word of E that is read as absolute.
struct ExtrusionTally {
  int moves = 0;
  int fresh = 0;        ///< that feed more than was ever fed before
  int not_rising = 0;   ///< whose E is that of the move before, or less
  int first_line = 0;   ///< of them
  double by_words = 0;  ///< [m], all words of E above 0 added up: what relative E feeds

  /// Absolute E rises along beads, and falls where filament is drawn back. These words do neither: nearly all
  /// of them feed nothing that an earlier one has not fed.
  bool looks_relative() const;
};

}  // namespace understudy::toolpath
