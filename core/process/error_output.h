// The standard error of a process that runs this program: passed on, but for its last word.
#pragma once

#include <string>
#include <string_view>

namespace understudy {

/// Progress and remarks go on as they come. A line "understudy: why" is kept until a further one comes: the
/// last of them says why a process failed, and belongs into the error of whoever started it.
class ErrorOutput {
 public:
  /// What of `bytes` goes on now.
  std::string take(std::string_view bytes);
  /// What is kept, at the end: of a process that did not fail, it goes on too.
  std::string rest();
  /// "why"; empty: it did not say.
  std::string reason() const;

 private:
  std::string line_;  ///< that may yet become one that is kept, or is one
  std::string kept_;
  bool passing_ = false;  ///< within a line that is not kept
};

}  // namespace understudy
