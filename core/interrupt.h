// Interrupts reach long work as a flag that it polls, so that it can leave nothing half-written.
#pragma once

namespace understudy {

/// SIGINT and SIGTERM set the flag from now on.
void watch_for_interrupt();
bool interrupted();
/// Throws Interrupted when the flag is set.
void stop_if_interrupted();
/// For tests.
void set_interrupted(bool value);

}  // namespace understudy
