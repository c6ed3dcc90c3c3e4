// The command in the background, its output in files.
#pragma once

#include <sys/types.h>

#include <string>

#include "tests/cli/program_run.h"

namespace understudy::cli_test {

class BackgroundRun {
 public:
  /// `words` follow the program's name; a shell splits them. Output goes to "out" and "err" of the folder.
  BackgroundRun(const Folder& folder, const std::string& words);
  ~BackgroundRun();  ///< kills it
  BackgroundRun(const BackgroundRun&) = delete;
  BackgroundRun& operator=(const BackgroundRun&) = delete;

  /// What it has printed once it has ended a line; empty where it does not within a minute.
  std::string first_output() const { return with_line_end(out_); }
  std::string first_error_output() const { return with_line_end(err_); }
  void interrupt() const;
  /// Exit status, or 128 + signal; -1 where it does not end within two minutes.
  int wait();

 private:
  static std::string with_line_end(const std::string& file);

  std::string out_, err_;
  pid_t pid_ = -1;
};

}  // namespace understudy::cli_test
