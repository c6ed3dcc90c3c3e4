// Figures of the gap along a path, weighted by length.
#pragma once

#include <limits>

#include "sim/deposition/deposition.h"

namespace understudy::sim {

class GapSums {
 public:
  /// The gap goes linearly from one to the other over `length` [m], where that band is good.
  void add(double from, double to, const GapBand& band, double length, double time, int line);
  void fill(DepositionSummary& summary) const;

 private:
  double length_ = 0, below_ = 0, in_band_ = 0;
  double surface_length_ = 0, moment_ = 0;
  double min_ = std::numeric_limits<double>::infinity(), max_ = -min_;
  double min_time_ = 0;
  int min_line_ = 0;
  double margin_ = std::numeric_limits<double>::infinity();  // [m], least of gap minus lower end of its band
  LowestGap lowest_;
};

}  // namespace understudy::sim
