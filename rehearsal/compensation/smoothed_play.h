// A correction for the play that a motion planner can follow: the means of several predictions, without
// steps.
#pragma once

#include <vector>

#include "rehearsal/compensation/predicted_play.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

class SmoothedPlay {
 public:
  /// `reach` [m] of path on both sides of a place, up to the next sharp corner (30 degrees) or change between
  /// printing and travelling, over which it is averaged with a raised cosine. `original` starts at
  /// `X_WT_home`.
  SmoothedPlay(const toolpath::Program& original, const Pose& X_WT_home, double reach);

  /// Goes half of the way to another prediction, of a program with the correction so far; all of it to the
  /// first.
  void add(PlayAlongPath play);
  /// The shift to be taken off, at a share of a step's way, after the first `predictions`; 0 after none.
  Twist at(std::size_t step, double fraction, std::size_t predictions) const;
  /// Steps that go on smoothly are one run, counted from 0. A travel belongs to the print that it leads to,
  /// and its correction is the one with which that print begins.
  std::size_t run(std::size_t step) const { return leads_to_[run_[step]]; }
  std::size_t runs() const { return runs_.size(); }

 private:
  /// Steps that go on smoothly. [m], along the program's path
  struct Run {
    double begin = 0, end = 0;
    bool prints = false;
  };
  Twist averaged(const PlayAlongPath& play, std::size_t step, double fraction) const;
  Twist at_path(const PlayAlongPath& play, double path) const;

  double reach_;
  std::vector<double> begins_, lengths_;  // [m], of the steps
  std::vector<std::size_t> run_;          // of each step
  std::vector<Run> runs_;
  std::vector<std::size_t> leads_to_;  // of each run: the next that prints, else itself
  std::vector<PlayAlongPath> plays_;
};

}  // namespace understudy::rehearsal
