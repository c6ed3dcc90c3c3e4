// Files are read whole, and results appear under their final name only when they are whole: written beside
// it, then renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace understudy {

constexpr std::size_t kFileMax = 1'000'000'000;  ///< [bytes], of any file that is read (docs/limits.md)

/// Replaces `path` with `content` in one step; a link's target where it is a link. A device or a pipe gets
/// the content as it is. Throws InputError where `path` cannot be written at all (its folder is missing, may
/// not be written, or it is a folder), MachineError where writing fails (a full disk).
void write_file(const std::filesystem::path& path, const std::string& content);

/// Throws InputError where write_file() could not put a file there: to be asked before long work.
void check_writable(const std::filesystem::path& path);

/// Whole file or pipe as bytes; waits for a pipe until an interrupt. Throws InputError naming the path where
/// it cannot be read to its end, is a folder or a device, or is larger than `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::size_t limit = kFileMax);

}  // namespace understudy
