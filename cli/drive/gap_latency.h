// How long the gap loop takes, by a port record: from the middle of an exposure to the next setpoints queued.
#pragma once

#include <string>

namespace understudy::cli {

/// One line, a histogram; empty for a record without frames. Times are of the port's clock; after an
/// approach's last frame the motion that follows counts too.
std::string gap_latency_line(const std::string& record);

}  // namespace understudy::cli
