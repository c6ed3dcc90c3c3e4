// Counts every allocation of this test program's own code: operator new, and malloc as Eigen calls it.
#pragma once

namespace understudy {

/// Since the program started.
long allocations();

}  // namespace understudy
