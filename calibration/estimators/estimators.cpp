#include "calibration/estimators/estimator.h"
#include "core/error.h"

namespace understudy::calibration {

const std::vector<EstimatorEntry>& estimators() {
  static const std::vector<EstimatorEntry> table{
      {"ik_residual", "sum of squares of the strut lengths' residuals (Zhuang 1998; Song 2015, eq 6)",
       make_ik_residual},
      {"whitened", "the same with every pose weighed by its measurement's covariance", make_whitened},
      {"maximum_likelihood", "errors of the measured poses about the machine's forward kinematics",
       make_maximum_likelihood},
      {"robust", "maximum likelihood after a least-trimmed-squares search for outlying poses", make_robust},
      {"with_deviation", "maximum likelihood of the 42 parameters and dev", make_with_deviation},
      {"with_play", "maximum likelihood of the 42 parameters and the play of each strut", make_with_play},
  };
  return table;
}

std::unique_ptr<Estimator> make_estimator(const std::string& name) {
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : estimators()) {
    if (entry.name == name) return entry.make();
    names.push_back(entry.name);
  }
  const std::string nearest = nearest_word(name, names);
  std::string message = "--estimator: no estimator is called \"" + name + "\"";
  if (!nearest.empty()) message += ", did you mean " + nearest + "?";
  message += " (known:";
  for (const std::string& known : names) message += " " + known;
  throw InputError(message + ")");
}

}  // namespace understudy::calibration
