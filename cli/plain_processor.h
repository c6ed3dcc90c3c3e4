// The same bytes on every processor: with UNDERSTUDY_SIMD=scalar no library uses instructions that only some
// have.
#pragma once

namespace understudy::cli {

/// The C library and Mesa choose their instructions by the environment, the C library before main: where
/// UNDERSTUDY_SIMD=scalar asks for it, sets the environment and starts the program anew, once. Throws
/// MachineError where it cannot be started.
void restart_on_plain_instructions(char** argv);

}  // namespace understudy::cli
