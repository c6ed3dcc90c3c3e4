#include "studies/calibration/estimator_study.h"

#include <algorithm>
#include <cmath>

#include "calibration/bound.h"
#include "core/quantile.h"

namespace understudy::studies {
namespace {

using namespace calibration;

struct Tally {
  std::unique_ptr<Estimator> estimator;
  std::vector<double> errors;
  double squares = 0, squares_of_set = 0;
  double excess = 0;  // sum over sets of mean squared error / bound^2
  std::size_t count_of_set = 0;
  int runs = 0, failures = 0, sets = 0;
};

class StudyRun {
 public:
  StudyRun(const StudySetting& setting, const StudyPlan& plan, const std::vector<std::string>& names)
      : setting_(setting), plan_(plan), tallies_(names.size()) {
    Random machine(setting.seed, "study machine");
    truth_.geometry = perturbed(setting.nominal, setting.parameter_sigma, machine);
    Random held_out(setting.seed, "study held-out poses");
    held_out_ = random_reachable_poses(*setting.mechanism, setting.region, setting.held_out, held_out);
    for (std::size_t n = 0; n < names.size(); ++n) tallies_[n].estimator = make_estimator(names[n]);
  }

  Study run(const std::vector<std::string>& names) {
    Study study;
    for (int set = 0; set < plan_.sets; ++set) run_set(set, study);
    std::sort(study.bounds.begin(), study.bounds.end());
    std::vector<double> uncalibrated;
    add_errors({setting_.nominal, {}}, uncalibrated);
    study.uncalibrated_median = quantile(uncalibrated, 0.5);
    for (std::size_t n = 0; n < names.size(); ++n) study.results.push_back(result(names[n], tallies_[n]));
    return study;
  }

 private:
  std::vector<Pose> choose(Random& random) const {
    if (plan_.choice == PoseChoice::random)
      return random_reachable_poses(*setting_.mechanism, setting_.region, plan_.poses, random);
    const auto candidates =
        random_reachable_poses(*setting_.mechanism, setting_.region, setting_.candidates, random);
    const DesignSetting design{{setting_.nominal, {}}, setting_.noise.covariance(), {}};
    std::vector<Pose> poses;
    for (const std::size_t j : d_optimal(design, candidates, plan_.poses, random))
      poses.push_back(candidates[j]);
    return poses;
  }

  void run_set(int set, Study& study) {
    const std::string name = std::to_string(plan_.poses) + "/" + std::to_string(set);
    Random poses(setting_.seed, "study poses " + name), noise(setting_.seed, "study noise " + name);
    std::vector<PoseSample> exact;
    for (const Pose& X_BT : choose(poses)) {
      PoseSample sample;
      if (true_sample(truth_, setting_.nominal, X_BT, setting_.noise, {}, sample)) exact.push_back(sample);
    }
    const ParameterMatrix covariance = parameter_bound(truth_, exact, {});
    if (covariance.size() == 0) return;
    const double bound = tip_uncertainty(truth_, covariance, {}, held_out_).rms;
    study.bounds.push_back(bound);
    for (Tally& tally : tallies_) tally.squares_of_set = 0, tally.count_of_set = 0;
    for (int draw = 0; draw < plan_.draws; ++draw) run_draw(exact, noise);
    for (Tally& tally : tallies_) {
      if (tally.count_of_set == 0) continue;
      tally.excess += tally.squares_of_set / static_cast<double>(tally.count_of_set) / (bound * bound);
      ++tally.sets;
    }
  }

  void run_draw(const std::vector<PoseSample>& exact, Random& noise) {
    Problem problem{{setting_.nominal, {}}, {}};
    for (const PoseSample& sample : exact) problem.samples.push_back(measured(sample, noise));
    for (Tally& tally : tallies_) {
      ++tally.runs;
      const Calibration found = tally.estimator->calibrate(problem);
      if (!found.ok()) {
        ++tally.failures;
        continue;
      }
      const std::size_t before = tally.errors.size();
      add_errors(found.parameters, tally.errors);
      for (std::size_t n = before; n < tally.errors.size(); ++n) {
        const double square = tally.errors[n] * tally.errors[n];
        tally.squares += square;
        tally.squares_of_set += square;
        ++tally.count_of_set;
      }
    }
  }

  void add_errors(const HexapodParameters& model, std::vector<double>& errors) const {
    Twist error;
    for (const Pose& X_BT : held_out_)
      if (driven_error(truth_, model, X_BT, error)) errors.push_back(error.head<3>().norm());
  }

  static StudyResult result(const std::string& name, Tally& tally) {
    StudyResult out;
    out.estimator = name;
    out.runs = tally.runs;
    out.failures = tally.failures;
    if (!tally.errors.empty()) out.rms = std::sqrt(tally.squares / static_cast<double>(tally.errors.size()));
    if (tally.sets > 0) out.efficiency = tally.sets / tally.excess;
    out.p95 = quantile(tally.errors, 0.95);
    out.median = quantile(tally.errors, 0.5);
    return out;
  }

  const StudySetting& setting_;
  const StudyPlan& plan_;
  HexapodParameters truth_;
  std::vector<Pose> held_out_;
  std::vector<Tally> tallies_;
};

}  // namespace

Study run_study(const StudySetting& setting, const StudyPlan& plan, const std::vector<std::string>& names) {
  return StudyRun(setting, plan, names).run(names);
}

}  // namespace understudy::studies
