// The report's data of a rehearsal that still runs, or of a print: what is known by now, in the form of the
// finished report.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "rehearsal/observers/thinned_series.h"
#include "rehearsal/run_listener.h"

namespace understudy::report {

/// May be read while the run adds to it.
class LiveRecord : public rehearsal::RunListener {
 public:
  static constexpr std::size_t kCapacity = 4000;
  /// Keeps at most `capacity` points: when they are full, every other one goes.
  explicit LiveRecord(std::size_t capacity = kCapacity);

  void begins(const rehearsal::Record& described) override;
  void moved(const rehearsal::TracePoint& newest) override;
  /// In place of begins(), of a machine whose true tip nobody knows: gap and errors of what moved() tells do
  /// not count. `note`: what comes after, for people.
  void begins_motion(const rehearsal::Record& described, const std::string& note);
  void progress(double share, const std::string& what);

  /// "understudy.report/1" with the key `live` (docs/report-data.md); one line.
  std::string json() const;
  /// The key `live` alone.
  std::string progress_json() const;
  /// The page of a finished report, drawn from json(); it asks its server for what comes.
  std::string page() const;

 private:
  /// What is known by now begins anew.
  void start(const rehearsal::Record& described, bool motion_alone, const std::string& note);
  nlohmann::ordered_json live_value() const;

  mutable std::mutex mutex_;
  std::size_t capacity_;
  rehearsal::Record described_;
  bool motion_alone_ = false;
  std::string note_;
  rehearsal::ThinnedSeries<rehearsal::TracePoint> trace_;
  double share_ = 0;
  std::string what_ = "reading";
};

}  // namespace understudy::report
