// Whether two folders of results hold the same.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace understudy::report {

struct ResultsDifference {
  std::string file;  ///< relative to both folders
  std::string
      details;  ///< one line: the first keys of a JSON file that differ, with both values; or what is missing
};

/// Byte by byte, files of sub-folders too; timing.json and the manifest differ from run to run and do not
/// count. Sorted by name.
std::vector<ResultsDifference> compare_results(const std::filesystem::path& recorded,
                                               const std::filesystem::path& again);

/// The files that compare_results() would look at.
std::vector<std::string> compared_files(const std::filesystem::path& folder);

}  // namespace understudy::report
