// How much memory a computation may take, so that it can be refused before it begins, and giving it back.
#pragma once

#include <cstdint>

namespace understudy {

/// [bytes] that this process can still get without swapping: what the system has free, the process' own limit
/// (ulimit -v) and that of its control group, whichever is least. 0 where the system does not tell.
std::uint64_t available_memory();

/// [bytes] of addresses that this process has mapped, used or not. 0 where the system does not tell.
std::uint64_t mapped_memory();

/// To the system, what was freed. A stage that has ended leaves hundreds of megabytes in small pieces, and
/// the allocator keeps those of one thread from the others.
void return_free_memory();

}  // namespace understudy
