// The three streams that a process begins with.
#pragma once

namespace understudy {

/// Opens those that are closed on /dev/null: a file that is opened later must not become the standard output.
void keep_standard_streams();

}  // namespace understudy
