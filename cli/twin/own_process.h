// This program once more, as a process of its own.
#pragma once

#include <string>
#include <vector>

namespace understudy::cli {

/// Runs this program with `words` to its end; its standard output is dropped, its standard error is ours.
/// Empty when it ended with status 0, else one phrase that says how it ended. An interrupt ends it and throws
/// Interrupted.
std::string run_own_process(const std::vector<std::string>& words);

/// From now on this process gets SIGTERM when the thread that started it ends, as when its process is killed.
void end_with_parent();

}  // namespace understudy::cli
