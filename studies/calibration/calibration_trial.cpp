#include "studies/calibration/calibration_trial.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/quantile.h"

namespace understudy::studies {

const char* to_string(Disturbance d) {
  switch (d) {
    case Disturbance::none:
      return "none";
    case Disturbance::outliers:
      return "outliers";
    case Disturbance::boards:
      return "boards";
    case Disturbance::play:
      return "play";
    case Disturbance::deviation:
      return "deviation";
    case Disturbance::drift:
      return "drift";
  }
  return "?";
}

const std::vector<Disturbance>& all_disturbances() {
  static const std::vector<Disturbance> all{Disturbance::none, Disturbance::outliers,  Disturbance::boards,
                                            Disturbance::play, Disturbance::deviation, Disturbance::drift};
  return all;
}

const std::vector<std::string>& bundle_names() {
  static const std::vector<std::string> names{"bundle", "bundle_with_play"};
  return names;
}

Disturbance disturbance_named(const std::string& word) {
  std::vector<std::string> known;
  for (const Disturbance d : all_disturbances()) {
    if (word == to_string(d)) return d;
    known.emplace_back(to_string(d));
  }
  const std::string nearest = nearest_word(word, known);
  throw InputError(fmt::format("--disturbances: '{}' is not known{} (known: {})", word,
                               nearest.empty() ? "" : ", did you mean " + nearest + "?",
                               fmt::join(known, " ")));
}

void judge(const std::vector<double>& uncalibrated, Answer& answer) {
  if (answer.errors.size() < uncalibrated.size()) {
    answer.failure = fmt::format("the answer is no machine: {} of {} poses held out are out of its reach",
                                 uncalibrated.size() - answer.errors.size(), uncalibrated.size());
  } else if (quantile(answer.errors, 0.5) > quantile(uncalibrated, 0.5)) {
    answer.failure = "the answer is worse than the machine before calibration";
  }
  if (!answer.ok()) answer.errors.clear();
}

std::string failure_of(const calibration::Estimation& found) {
  if (found.ok()) return {};
  // A plug-in's words are all there is.
  return found.status == calibration::Status::no_answer ? found.message
                                                        : calibration::to_string(found.status);
}

}  // namespace understudy::studies
