// What a long study has answered so far, line by line in a file, so that one that was killed goes on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace understudy {

/// Answers by item, some numbers each; NaN: none. A file of another study (its first line says which) begins
/// anew, and a last line that was cut off does not count. Item 0 is always run again: an answer that is no
/// longer the same tells that an input has changed, and none of the others counts. Without a path nothing is
/// kept.
class RunJournal {
 public:
  using Answer = std::vector<double>;
  /// `study`: one line that tells it from others. Throws InputError when the file cannot be written.
  RunJournal(std::filesystem::path path, std::string study);

  /// The answer of item 0, run again. True: what the file holds of the other items stands.
  bool confirm(const Answer& answer);
  std::optional<Answer> find(std::size_t item) const;
  /// From any thread; written at once. Throws MachineError where that fails, as with a full disk.
  void add(std::size_t item, const Answer& answer);
  /// The study is complete.
  void remove();

 private:
  void begin();

  std::filesystem::path path_;
  std::string study_;
  std::map<std::size_t, std::string> lines_;
  mutable std::mutex mutex_;
  std::ofstream file_;
};

}  // namespace understudy
