// A result appears under its final name only when it is whole: written beside it, then renamed.
#pragma once

#include <filesystem>
#include <string>

namespace understudy {

/// Replaces `path` with `content` in one step; a link's target where it is a link. A device or a pipe gets
/// the content as it is. Throws InputError where `path` cannot be written at all (its folder is missing, may
/// not be written, or it is a folder), MachineError where writing fails (a full disk).
void write_file(const std::filesystem::path& path, const std::string& content);

/// Throws InputError where write_file() could not put a file there: to be asked before long work.
void check_writable(const std::filesystem::path& path);

}  // namespace understudy
