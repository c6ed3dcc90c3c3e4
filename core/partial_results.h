// Files and folders that are not whole yet: whoever ends the process takes them away.
#pragma once

#include <filesystem>
#include <functional>

namespace understudy {

/// Takes the file or folder away when it is destroyed, or when the process is ended by an interrupt that the
/// work did not answer. One that was renamed meanwhile stays.
class PartialResult {
 public:
  explicit PartialResult(std::filesystem::path path);
  ~PartialResult();
  PartialResult(const PartialResult&) = delete;
  PartialResult& operator=(const PartialResult&) = delete;
  /// It has become a result, or shall stay.
  void keep();
  /// The same, and `last` is done before an interrupt may end the process. It must not begin or end partial
  /// results itself.
  void keep_after(const std::function<void()>& last);

 private:
  std::filesystem::path path_;
  bool keep_ = false;
};

/// Of the whole process, at its end; no other can begin or be kept after that.
void remove_partial_results();

}  // namespace understudy
