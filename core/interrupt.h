// Interrupts reach long work as a flag that it polls, so that it can leave nothing half-written.
#pragma once

#include <string_view>

namespace understudy {

constexpr std::string_view kInterrupted = "interrupted: nothing unfinished is left";

/// From now on SIGINT, SIGTERM and SIGHUP set the flag. Work that does not answer within a second is ended:
/// partial results (core/partial_results.h) go, and the process dies of the signal. So does a second
/// signal, at once.
void watch_for_interrupt();
bool interrupted();
/// Throws Interrupted when the flag is set.
void stop_if_interrupted();
/// Ends the process as the signal would have done, for whoever waits for it (a shell: 128 + its number).
/// Returns where no signal came.
void die_of_interrupt();
/// For tests.
void set_interrupted(bool value);

}  // namespace understudy
