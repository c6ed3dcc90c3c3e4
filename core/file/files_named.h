// Files by a name in which * and ? stand for other characters.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace understudy {

/// The files of that name in `folder`, in order of their names; none where there is none. `name` may lead on
/// into other folders; `folder` itself is taken as it is.
std::vector<std::filesystem::path> files_named(const std::filesystem::path& folder, const std::string& name);

}  // namespace understudy
