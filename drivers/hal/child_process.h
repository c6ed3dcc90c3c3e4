// Private to drivers/hal: a program of LinuxCNC's that runs beside us, spoken to through pipes.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

#include "core/file/descriptor.h"

namespace understudy::drivers {

struct ChildStreams {
  bool input = false;   ///< we write to it; else it reads nothing
  bool output = false;  ///< we read what it prints; else that goes to `log`
  int log = -1;         ///< descriptor for what it prints, standard error always; -1: nowhere
  int inherited = -1;   ///< a further descriptor that it gets, as number 3
};

/// In a process group of its own, so that Ctrl-C on the terminal reaches us alone.
class ChildProcess {
 public:
  /// `dies_with_us`: gets SIGTERM when the thread that made it ends, by whatever cause. Throws MachineError
  /// where no process can be made; a program that is not there ends with status 127.
  ChildProcess(const std::vector<std::string>& words, const std::string& folder, const ChildStreams& streams,
               bool dies_with_us);
  ~ChildProcess() { end(std::chrono::milliseconds(0)); }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  Descriptor input, output;  ///< ours; not blocking
  bool running();
  int status() const { return status_; }  ///< of waitpid(), once it has ended
  /// Waits that long, then asks its group by SIGTERM, a second later kills it. False: it did not end by
  /// itself.
  bool end(std::chrono::milliseconds patience);

 private:
  bool ended_within(std::chrono::milliseconds time);

  pid_t pid_ = -1;
  int status_ = 0;
};

/// Before other work of the computer, where we may ask for that (root, or a limit of `nice`).
void prefer_this_thread();

/// What the program prints, as far as it ends within the time; empty where it does not, or fails.
std::string answer_of(const std::vector<std::string>& words, std::chrono::milliseconds time);

}  // namespace understudy::drivers
