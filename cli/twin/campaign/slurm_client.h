// Slurm's own programs: sbatch, squeue, scancel.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace understudy::cli {

struct ProgramAnswer {
  int status = 0;      ///< exit status; 127: there is no such program
  std::string output;  ///< standard output and error
};

/// Runs a program to its end. Throws MachineError where no process can be started.
ProgramAnswer run_program(const std::vector<std::string>& words);

class SlurmClient {
 public:
  /// Throws InputError where the programs are missing, MachineError where the controller does not answer.
  void check() const;
  /// Its job number. Throws MachineError with what sbatch says.
  std::string submit(const std::vector<std::string>& words) const;
  /// How many jobs or tasks are in each state ("RUNNING", "PENDING"); empty when all have left the queue.
  /// Throws MachineError where the controller does not answer for minutes.
  std::map<std::string, int> states(const std::vector<std::string>& jobs) const;
  void cancel(const std::vector<std::string>& jobs) const;
  /// Processors of the cluster; 1 where it does not say.
  int processors() const;
};

}  // namespace understudy::cli
