// Interrupts of work that ends under control: a machine brakes before its program ends.
#pragma once

namespace understudy {

/// While it lives, SIGINT, SIGTERM and SIGHUP set the flag of core/interrupt.h and are counted; nothing ends
/// the process before the fourth. One at a time; after watch_for_interrupt().
class CountedInterrupts {
 public:
  CountedInterrupts();
  ~CountedInterrupts();
  CountedInterrupts(const CountedInterrupts&) = delete;
  CountedInterrupts& operator=(const CountedInterrupts&) = delete;

  static int count();
};

}  // namespace understudy
