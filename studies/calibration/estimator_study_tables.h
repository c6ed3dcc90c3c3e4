// The tables of docs/reference.md#calibration-figures, regenerated: 42 parameters off by 0.5 mm, tilt to 20
// and yaw to 15 deg, poses measured to 20 um and 0.2 mrad, tip error at 60 poses held out.
#pragma once

#include <functional>
#include <string>

#include "studies/calibration/estimator_study.h"

namespace understudy::studies {

struct TableSize {
  int machines = 8, sets = 8, draws = 12;
};

/// Figures are medians over machines, the reference's of one machine beside them in brackets. `line` gets
/// each line of text as soon as it is known, without its end; machines have the seeds 1, 2, ....
void study_tables(const StudySetting& setting, const TableSize& size,
                  const std::function<void(const std::string&)>& line);

}  // namespace understudy::studies
