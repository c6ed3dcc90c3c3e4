// Results appear under their final name only when they are whole: written beside it, then renamed.
#pragma once

#include <filesystem>
#include <string>

namespace understudy {

/// Replaces `path` with `content` in one step. Throws InputError naming the path when it cannot be written.
void write_file(const std::filesystem::path& path, const std::string& content);

/// Whole file as bytes. Throws InputError naming the path.
std::string read_file(const std::filesystem::path& path);

/// A folder of results that is filled under a temporary name beside `target` and renamed by commit().
/// Destruction without commit removes the temporary folder. An older result under `target` is replaced
/// only by commit(); a `target` that exists but does not look like our result (no `marker` file inside and
/// not empty) is refused with InputError, so that no foreign folder is ever deleted.
class OutputFolder {
 public:
  OutputFolder(std::filesystem::path target, std::string marker);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return working_; }
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path working_;
  std::string marker_;
  bool committed_ = false;
};

}  // namespace understudy
