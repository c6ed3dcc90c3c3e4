#pragma once

#include <sys/types.h>

#include <cstddef>

namespace understudy::calibration {

struct ProcessUsage {
  int tasks = 0;           ///< processes and threads; counting stops at 10 000
  double cpu_time = 0;     ///< [s], with that of children that have ended
  std::size_t memory = 0;  ///< [bytes], resident; what two processes share counts for each
};

/// Of a process and all that descend from it now. What lost its parent to the system's first process is not
/// seen; within a box there is none (box.h). Zero where there is no such process.
ProcessUsage usage_of(pid_t process);

}  // namespace understudy::calibration
