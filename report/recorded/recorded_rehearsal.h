// A rehearsal's folder of results, read back.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "regression/metrics.h"
#include "rehearsal/findings/finding_groups.h"
#include "rehearsal/findings/verdict.h"
#include "rehearsal/record.h"
#include "report/recorded/recorded_run.h"

namespace understudy::report {

struct RecordedRehearsal {
  std::filesystem::path folder;
  RecordedRun run;
  rehearsal::Grade grade = rehearsal::Grade::no_go;
  /// What the result was made from, by name: versions, SHA-256 of files, seed, engine. Whoever knows the
  /// words of `run.command` may add its options.
  std::map<std::string, std::string> inputs;
  std::vector<rehearsal::FindingGroup> findings;
  regression::Metrics figures;               ///< of the summary, without verdict, findings and inputs
  std::vector<rehearsal::TracePoint> trace;  ///< as read_recorded_trace(); empty: nothing was simulated
};

/// Throws InputError, with the file, where the folder is none of a rehearsal, of another version, or not
/// whole: a file that is missing, was cut off or is not the one that the manifest names.
RecordedRehearsal read_recorded_rehearsal(const std::filesystem::path& folder);

}  // namespace understudy::report
