#include "calibration/estimators/estimator.h"
#include "core/error.h"

namespace understudy::calibration {
namespace {

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

}  // namespace

ChainCalibration Estimator::calibrate_chain(const ChainProblem& problem, const Options&) const {
  ChainCalibration result;
  result.status = Status::unsupported;
  result.message = "this estimator calibrates hexapods only";
  result.parameters = problem.nominal;
  result.used.assign(problem.samples.size(), true);
  return result;
}

const std::vector<EstimatorEntry>& estimators() {
  static const std::vector<EstimatorEntry> table{
      {"ik_residual", "sum of squares of the strut lengths' residuals (Zhuang 1998; Song 2015, eq 6)", false,
       make_ik_residual},
      {"whitened", "the same with every pose weighed by its measurement's covariance", false, make_whitened},
      {"maximum_likelihood", "errors of the measured poses about the machine's forward kinematics", true,
       make_maximum_likelihood},
      {"robust", "maximum likelihood after a least-trimmed-squares search for outlying poses", true,
       make_robust},
      {"with_deviation", "maximum likelihood of the 42 parameters and dev", false, make_with_deviation},
      {"with_play", "maximum likelihood of the 42 parameters and the play of each strut", false,
       make_with_play},
  };
  return table;
}

std::vector<std::string> estimator_names(MachineKind kind) {
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : estimators())
    if (kind == MachineKind::hexapod || entry.chains) names.push_back(entry.name);
  return names;
}

std::unique_ptr<Estimator> make_estimator(const std::string& name, MachineKind kind) {
  for (const EstimatorEntry& entry : estimators()) {
    if (entry.name != name) continue;
    if (kind == MachineKind::hexapod || entry.chains) return entry.make();
    throw InputError("--estimator: " + name + " calibrates hexapods; an open chain has " +
                     joined(estimator_names(kind), " and "));
  }
  const std::vector<std::string> names = estimator_names(kind);
  const std::string nearest = nearest_word(name, names);
  std::string message = "--estimator: no estimator is called \"" + name + "\"";
  if (!nearest.empty()) message += ", did you mean " + nearest + "?";
  throw InputError(message + " (known: " + joined(names, " ") + ")");
}

}  // namespace understudy::calibration
