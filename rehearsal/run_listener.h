// Sees a rehearsal's main run while it runs, and changes nothing of it.
#pragma once

#include "rehearsal/record.h"

namespace understudy::rehearsal {

class RunListener {
 public:
  virtual ~RunListener() = default;
  /// Before the run: names, limits and band, and what the check of the limits found. Without curves.
  virtual void begins(const Record& described) = 0;
  /// Each snapshot, in order of time, on the observers' thread.
  virtual void moved(const TracePoint& newest) = 0;
};

}  // namespace understudy::rehearsal
