// Figures of the gap along a path, weighted by length.
#pragma once

#include <limits>

#include "sim/deposition/deposition.h"

namespace understudy::sim {

class GapSums {
 public:
  /// The accepted band [m].
  GapSums(double low, double high) : low_(low), high_(high) {}

  /// The gap goes linearly from one to the other over `length` [m].
  void add(double from, double to, double length, double time, int line);
  void fill(DepositionSummary& summary) const;

 private:
  double low_, high_;
  double length_ = 0, below_ = 0, in_band_ = 0;
  double surface_length_ = 0, moment_ = 0;
  double min_ = std::numeric_limits<double>::infinity(), max_ = -min_;
  double min_time_ = 0;
  int min_line_ = 0;
};

}  // namespace understudy::sim
