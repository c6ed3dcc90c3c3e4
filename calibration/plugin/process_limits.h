// What a program of strangers may use, and the words for what it used up.
#pragma once

#include <cstddef>
#include <string>

#include "calibration/plugin/process_usage.h"

namespace understudy::calibration {

struct ProcessLimits {
  double time = 10;                       ///< [s], from start to end of the program
  double cores = 4;                       ///< CPU time of all its processes together, in multiples of `time`
  std::size_t memory = 4'000'000'000;     ///< [bytes] that all its processes together hold at one time
  int processes = 256;                    ///< and threads, at one time
  std::size_t output = 1'048'576;         ///< [bytes] of standard output
  std::size_t error_output = 65'536;      ///< [bytes] of standard error
  std::size_t file = 256'000'000;         ///< [bytes] of each file that it writes
  std::size_t own_folders = 500'000'000;  ///< [bytes] of each folder that it may write to in the box
  int open_files = 1024;                  ///< of each of its processes

  double cpu_time() const { return cores * time; }  ///< [s]
};

/// Which limit of time, memory or processes is exceeded, as one line; empty where none is.
std::string exceeded(const ProcessUsage& usage, const ProcessLimits& limits);

/// How a program ended, as one line, from its status as waitpid() tells it, not 0, and its standard error.
/// Where the program said that it met a limit, the limit is named.
std::string told_ending(int status, const std::string& error_output, const ProcessLimits& limits);

/// The first line of `text` that says something, printable and cut to `length` characters.
std::string brief(const std::string& text, std::size_t length = 120);

/// The same of a program's standard error; of a Python traceback, its last line.
std::string last_words(const std::string& error_output);

}  // namespace understudy::calibration
