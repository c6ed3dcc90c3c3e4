// A result appears under its final name only when it is whole: written beside it, then renamed.
#pragma once

#include <filesystem>
#include <string>

#include "core/file/staged_file.h"

namespace understudy {

/// Replaces `path` with `content` in one step; a link's target where it is a link. A device or a pipe gets
/// the content as it is. Throws MachineError where that fails: a full disk, or a folder that is gone.
void write_file(const std::filesystem::path& path, const std::string& content);
/// The same of a content that is made piece by piece, so that it need not fit into memory.
void write_file(const std::filesystem::path& path, const MadeContent& make);

/// Throws InputError where write_file() could not put a file there (its folder is missing or may not be
/// written, or it is a folder): every command asks before its work.
void check_writable(const std::filesystem::path& path);

}  // namespace understudy
