#include "calibration/plugin/plugin_estimator.h"

#include <Eigen/Cholesky>

#include <fmt/format.h>

#include "calibration/calibrated.h"
#include "calibration/plugin/exchange.h"

namespace understudy::calibration {
namespace {

const char* const kNoCovariance =
    "the plug-in gives no covariance: the uncertainty that its calibration leaves is not known";

class PluginEstimator final : public Estimator {
 public:
  PluginEstimator(std::string command, const ProcessLimits& limits)
      : command_(std::move(command)), limits_(limits) {}

  Calibration calibrate(const Problem& problem, const Options& options) const override {
    Calibration result = refused(problem, Status::no_answer, {});
    result.message = ask(problem, options.progress, result.parameters);
    if (!result.message.empty()) return result;
    result.pose = add_residuals(problem, {}, result);
    if (result.pose) {
      result.message = fmt::format("the answer is no machine: it cannot reach pose {}", *result.pose + 1);
      return result;
    }
    result.status = Status::ok;
    result.warnings.emplace_back(kNoCovariance);
    const std::string misfit =
        misfit_warning(result.chi_square, result.degrees_of_freedom, "outliers, dev, play");
    if (!misfit.empty()) result.warnings.push_back(misfit);
    return result;
  }

  ChainCalibration calibrate_chain(const ChainProblem& problem, const Options& options) const override {
    ChainCalibration result;
    result.status = Status::no_answer;
    result.parameters = problem.nominal;
    result.used.assign(problem.samples.size(), true);
    result.message = ask(problem, options.progress, result.parameters);
    if (!result.message.empty()) return result;
    result.estimated = chain_parameter_names(problem.nominal.chain);
    for (const ChainSample& sample : problem.samples) {
      const Twist e = pose_error(sample.X_ST, forward(result.parameters, sample.axes));
      result.residuals.push_back(e);
      result.chi_square += e.dot(sample.covariance.llt().solve(e));
    }
    result.degrees_of_freedom =
        6 * static_cast<int>(problem.samples.size()) - independent_parameters(problem.nominal.chain);
    result.status = Status::ok;
    result.warnings.emplace_back(kNoCovariance);
    return result;
  }

 private:
  /// Why there is no answer; empty, and the answer in `parameters`, where there is one.
  template <typename AnyProblem, typename Parameters>
  std::string ask(const AnyProblem& problem, const Progress& progress, Parameters& parameters) const {
    const ProcessRun run = run_process(command_, problem_json(problem), limits_, progress);
    if (!run.ok) return run.failure;
    if (run.output.find_first_not_of(" \t\r\n") != std::string::npos)
      return read_answer(run.output, parameters);
    const std::string words = last_words(run.error_output);
    return "wrote nothing to standard output" +
           (words.empty() ? "" : fmt::format("; standard error: \"{}\"", words));
  }

  std::string command_;
  ProcessLimits limits_;
};

}  // namespace

std::unique_ptr<Estimator> make_plugin_estimator(const std::string& command, const ProcessLimits& limits) {
  return std::make_unique<PluginEstimator>(command, limits);
}

}  // namespace understudy::calibration
