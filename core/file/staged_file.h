// A file that is written whole before it takes its name.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "core/file/descriptor.h"
#include "core/partial_results.h"

namespace understudy {

/// Takes the next piece of a file.
using AppendPiece = std::function<void(std::string_view)>;
/// Hands the pieces of a file over, one after the other.
using MadeContent = std::function<void(const AppendPiece&)>;

/// The constructor writes `content` beside `path`, commit() gives it that name in one step; without commit
/// nothing stays. Two of them can so be written before the first appears. A link stays a link, its target
/// is replaced. A device or a pipe gets the content by commit(). What a killed process left of an earlier
/// attempt is removed. Throws MachineError where writing fails: check_writable() (core/file/output_file.h)
/// tells beforehand what is the user's mistake.
class StagedFile {
 public:
  StagedFile(const std::filesystem::path& path, const std::string& content);
  StagedFile(const std::filesystem::path& path, const MadeContent& make);
  void commit();

 private:
  std::filesystem::path path_, target_, part_;
  std::string as_it_is_;  ///< for what is no regular file
  Descriptor file_;       ///< locked: whoever removes leftovers sees that we live
  std::optional<PartialResult> partial_;
};

/// To an open file; false: errno tells why not.
bool write_all(int file, std::string_view content);

/// The file that `path` leads to where it is a link to one, or to none that exists.
std::filesystem::path behind_links(const std::filesystem::path& path);

/// Throws MachineError with the text of `error` (an errno).
[[noreturn]] void failed_to_write(const std::filesystem::path& path, int error);

/// The same, before any work: InputError, unless the disk is at fault (full, over quota, broken).
[[noreturn]] void cannot_write(const std::filesystem::path& path, int error);

}  // namespace understudy
