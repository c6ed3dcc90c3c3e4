// Private to box.h: the words of the programs that make the box.
#pragma once

#include <string>
#include <vector>

#include "calibration/plugin/process_limits.h"

namespace understudy::calibration {

constexpr const char* kBubblewrap = "/usr/bin/bwrap";

/// bubblewrap with what is the same for every command: no network, own processes, a read-only file system but
/// for /tmp and /dev/shm in memory, an empty /run. No word needs quoting.
std::vector<std::string> namespace_words(const ProcessLimits& limits);

/// What else is shown and hidden: the entries of the real /tmp that `command`, the current folder or our
/// environment name are shown, read-only; folders and files of the home folder that hold secrets are empty.
std::vector<std::string> sight_words(const std::string& command);

/// prlimit with the limits that the kernel keeps for one process, none above our own. Empty where it is not
/// installed.
std::vector<std::string> limit_words(const ProcessLimits& limits);

}  // namespace understudy::calibration
