// What a rehearsal sets up before it runs: twin, controller and program of a request.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "control/gap_control_word.h"
#include "control/print.h"
#include "rehearsal/findings/finding.h"
#include "rehearsal/request/request.h"
#include "rehearsal/run_twin.h"
#include "toolpath/inspection/feature_types.h"
#include "toolpath/inspection/told_beads.h"

namespace understudy::rehearsal {

/// What the program is wrong in itself, and where it is run without what is wrong.
struct Mended {
  std::vector<Finding> findings;
  std::vector<std::pair<int, int>> passed_over;  // lines
  std::map<std::string, std::string> facts;      // that the slicer's comments state
  toolpath::FeatureTypes features;               // likewise
  int start_block_end = 0;                       // start_block.h
  toolpath::ToldBeads beads;                     // likewise
};

using control::gap_control_of;

/// Reads all files of the request. Throws InputError for what cannot be rehearsed; what can be left out of
/// the program is told in `mended`.
TwinSetup prepare(const RehearsalRequest& request, Mended& mended);

/// Of the machine; moves that it cannot make are left out of the program.
std::vector<Finding> check_limits(const RehearsalRequest& request, TwinSetup& setup, Mended& mended);

}  // namespace understudy::rehearsal
