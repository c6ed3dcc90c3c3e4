// A step of the machine's own (play that changes sides), told from a bead or an edge: readings in a row that
// agree on it, and it is too small for a bead. Nothing here allocates.
#pragma once

#include <cmath>

namespace understudy::control {

struct LastingStepOptions {
  double step_max = 0;  ///< [m]
  double gate = 0;      ///< standard deviations that the readings may scatter
  int samples = 0;      ///< in a row
};

class LastingStep {
 public:
  explicit LastingStep(const LastingStepOptions& options) : options_(options) {}

  void clear() {
    readings_ = 0;
    sum_ = squares_ = 0;
  }

  /// A reading that is off by `off` [m], with `variance` [m^2]. True: enough of them agree on mean().
  bool add(double off, double variance) {
    if (std::abs(off) > options_.step_max || off * sum_ < 0) clear();
    if (std::abs(off) > options_.step_max) return false;
    ++readings_;
    sum_ += off;
    squares_ += off * off;
    if (readings_ < options_.samples) return false;
    const double scatter = squares_ / readings_ - mean() * mean();
    if (scatter <= options_.gate * options_.gate * variance) return true;
    clear();
    return false;
  }

  double mean() const { return sum_ / readings_; }  ///< [m], of the step

 private:
  LastingStepOptions options_;
  int readings_ = 0;
  double sum_ = 0, squares_ = 0;
};

}  // namespace understudy::control
