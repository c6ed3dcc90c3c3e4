#pragma once

#include <memory>
#include <string>

#include "calibration/estimators/estimator.h"
#include "calibration/plugin/child_process.h"

namespace understudy::calibration {

/// An external command as an estimator of any machine: it is started anew for every problem (exchange.h). It
/// gives no covariance. Status `no_answer` where it gives nothing, nonsense, or a machine that cannot reach
/// the measured poses. Throws as run_process().
std::unique_ptr<Estimator> make_plugin_estimator(const std::string& command,
                                                 const ProcessLimits& limits = {});

}  // namespace understudy::calibration
