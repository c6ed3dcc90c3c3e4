// A progress line on a terminal; nothing at all in a pipe.
#pragma once

#include <string>

namespace understudy::cli {

class ProgressLine {
 public:
  /// Shows nothing anywhere unless `wanted`.
  explicit ProgressLine(bool wanted = true);
  ~ProgressLine();
  void show(double share, const std::string& what);

 private:
  bool terminal_;
  int last_percent_ = -1;
  std::string last_what_;
};

}  // namespace understudy::cli
