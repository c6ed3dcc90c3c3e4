// A file that only grows, and whose last whole entry outlives the process.
#pragma once

#include <filesystem>
#include <string_view>
#include <thread>

#include "core/file/descriptor.h"

namespace understudy {

/// What append() has written is there whatever ends the process; a thread takes it to the disk once a second,
/// so that a power cut takes no more than that.
class AppendFile {
 public:
  enum class Begin { anew, behind_what_is_there };
  /// Throws InputError where `path` cannot be made, and, `anew`, where it is there already. A pipe or a
  /// device is taken as it is.
  AppendFile(std::filesystem::path path, Begin begin);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  /// Throws MachineError where that fails, as with a full disk.
  void append(std::string_view bytes);

 private:
  void keep_on_disk(const std::stop_token& stop) const;

  std::filesystem::path path_;
  Descriptor file_;
  std::jthread to_disk_;
};

}  // namespace understudy
