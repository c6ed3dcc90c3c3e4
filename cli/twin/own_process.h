// This program once more, as a process of its own.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace understudy::cli {

struct ProcessEnd {
  int status = 0;    ///< as exit statuses are; 3 when a signal ended it
  std::string text;  ///< why: the last it said of itself, else "the process ended by signal 11"
};

/// Runs this program with `words` to its end; its standard output is dropped, its standard error goes to ours
/// but for why it failed. An interrupt ends it and throws Interrupted.
ProcessEnd run_own_process(const std::vector<std::string>& words);

/// Starts this program with `words`, open files as its standard input and output. Throws MachineError.
pid_t start_own_process(const std::vector<std::string>& words, int input, int output);

/// From now on this process gets SIGTERM when the thread that started it ends, as when its process is killed.
void end_with_parent();

}  // namespace understudy::cli
