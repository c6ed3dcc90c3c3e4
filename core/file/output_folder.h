// A folder of results that appears whole, and replaces only what an earlier run wrote.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/file/descriptor.h"
#include "core/partial_results.h"

namespace understudy {

/// Names and SHA-256 of a result's files, as `sha256sum` writes and checks them.
constexpr const char* kManifest = "manifest.sha256";

/// Filled under the name TARGET.part, beside TARGET, and renamed by commit(). Destruction without commit
/// takes that folder away. Of an older result, commit() removes the files that its manifest names, and
/// nothing else. Throws InputError, before any work, where TARGET
/// - is a file, or cannot be made,
/// - holds a file that no manifest names or that was changed since: a user's own,
/// - is being written by another run.
class OutputFolder {
 public:
  explicit OutputFolder(std::filesystem::path target);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return working_; }
  /// Throws MachineError where the result cannot be put in its place, and says where it lies instead.
  void commit();

 private:
  void lock();
  void begin();

  std::filesystem::path target_, working_;
  Descriptor lock_;  ///< of the working folder
  std::optional<PartialResult> partial_;
};

/// Why `folder` is not as a run left it: a file that is missing, was changed or came into it, or no manifest
/// at all. Empty: it is. Throws InputError where it cannot be read.
std::string why_not_as_written(const std::filesystem::path& folder);

/// Whether the file `name` in `folder` has the content that the manifest there gives it; true where no
/// manifest names it.
bool is_as_written(const std::filesystem::path& folder, const std::string& name);

/// Throws InputError where an OutputFolder could not replace `target`: to be asked of many before long work.
void check_replaceable(const std::filesystem::path& target);

}  // namespace understudy
