// A file or a pipe, read whole, or a file's beginning.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace understudy {

constexpr std::size_t kFileMax = 1'000'000'000;  ///< [bytes], of any file that is read (docs/limits.md)

/// Whole file or pipe as bytes; waits for a pipe until an interrupt. Throws InputError naming the path where
/// it cannot be read to its end, is a folder or a device, or is larger than `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::size_t limit = kFileMax);

struct FileBeginning {
  std::string content;
  std::size_t left_out = 0;  ///< [bytes] behind it; of a pipe, which does not tell, 0
};
/// At most `most` bytes, of a file of any size. Throws as read_file() does.
FileBeginning read_beginning(const std::filesystem::path& path, std::size_t most);

}  // namespace understudy
