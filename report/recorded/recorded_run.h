// What the results of a rehearsal say of their own making.
#pragma once

#include <filesystem>
#include <string>

namespace understudy::report {

/// From a summary.json: `provenance` and the verdict. Sums are SHA-256, hexadecimal.
struct RecordedRun {
  std::string command, version, machine_sha256, program_sha256, inputs_sha256;
  std::string fixture_sha256;  ///< empty: without a fixture
  bool go = false;
};

/// Throws InputError where a file of the folder is not the one that its manifest names.
void check_as_written(const std::filesystem::path& folder, const std::string& name);

/// Throws InputError where the folder has no summary.json of a rehearsal.
RecordedRun read_recorded_run(const std::filesystem::path& folder);

}  // namespace understudy::report
