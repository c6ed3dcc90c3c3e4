// Files that are named in a stranger's file.
#pragma once

#include <filesystem>

namespace understudy {

/// The environment variable that lets files name files outside their own folder, where its value is 1.
constexpr const char* kAllowOutside = "UNDERSTUDY_ALLOW_OUTSIDE";

/// Whether `path`, its links followed, lies in `folder` or below it, or the user allows what does not.
bool may_be_named_from(const std::filesystem::path& folder, const std::filesystem::path& path);

}  // namespace understudy
