// Where a record's commands wanted the axes at each time: the queue that lies under every port, fed again.
#pragma once

#include "machine/record/recorded_motion.h"
#include "machine/setpoint_queue.h"

namespace understudy::machine {

class CommandedPath {
 public:
  /// The axes rest at home when the record begins, as every print does. `motion` must outlive this. Throws
  /// InputError for a machine whose home cannot be reached.
  CommandedPath(const RecordedMotion& motion, const MachineDescription& machine);

  /// At a time of the record's clock, none before the last one asked for.
  const SetpointQueue::Target& at(double time);

 private:
  void run_to(double time);
  void apply(const RecordedCommand& command);

  const RecordedMotion& motion_;
  SetpointQueue queue_;
  double now_;
  std::size_t next_ = 0;
};

}  // namespace understudy::machine
