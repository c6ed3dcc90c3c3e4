// For how long this process has been running, its loading included.
#pragma once

namespace understudy {

/// [s], in steps of the kernel's clock tick (10 ms); 0 where the kernel does not tell.
double process_age();

}  // namespace understudy
