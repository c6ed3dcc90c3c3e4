// The libraries that a run uses. A result may depend on their versions: `doctor` prints them, records keep
// them.
#pragma once

#include <map>
#include <string>

namespace understudy {

/// Version by the library's name.
using LibraryVersions = std::map<std::string, std::string>;

/// Of the libraries that core links. Other rooms have functions for theirs.
LibraryVersions library_versions();

/// Of the file that this process has loaded: "0.7.0" for "libyaml-cpp" where that is libyaml-cpp.so.0.7.0, by
/// whatever name it was found. `otherwise` where no such file is loaded, as in a static build.
std::string loaded_version(const std::string& library, const std::string& otherwise);

}  // namespace understudy
