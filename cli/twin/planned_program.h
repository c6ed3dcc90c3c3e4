// Programs of scenarios that name a part and a planner in place of a file.
#pragma once

#include <string>
#include <vector>

#include "regression/scenario.h"

namespace understudy::cli {

/// Writes to `output` what `understudy plan WORDS --machine M -o NAME` makes of the scenario's `plan`. A word
/// that is a file beside the scenario stands for that file. Throws InputError that begins with the scenario's
/// file; Interrupted passes through.
void write_planned(const regression::Scenario& scenario, const std::filesystem::path& output);

/// Options of a planner, long names without dashes, sorted. Throws InputError, which names the nearest one,
/// for a word that is no planner.
std::vector<std::string> planner_options(const std::string& planner);

/// The path of the file `word` beside the scenario; `word` itself where there is none.
std::string file_beside(const regression::Scenario& scenario, const std::string& word);

/// SHA-256 of what the scenario's plan or command is made from: its words, the files and parts that they
/// name, and of a command all machines and materials, and what a scenario that it names depends on. Empty
/// without either, and where a file cannot be read.
std::string sources_sha256(const regression::Scenario& scenario);

}  // namespace understudy::cli
