#include "report/page/live_record.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "report/json_text.h"
#include "report/page/report_data.h"
#include "report/page/report_html.h"

namespace understudy::report {
using Json = nlohmann::ordered_json;

namespace {

/// What nobody knows of a machine that only says where its axes are.
constexpr const char* kTruth[] = {"gap_mm", "tip_error_um", "orientation_error_mrad"};

}  // namespace

LiveRecord::LiveRecord(std::size_t capacity) : capacity_(capacity), trace_(capacity) {
  described_.title = "rehearsal";
}

Json LiveRecord::live_value() const {
  Json live{{"share", stable_number(share_, "share")}, {"what", what_}};
  if (!note_.empty()) live["note"] = note_;
  return live;
}

void LiveRecord::begins(const rehearsal::Record& described) { start(described, false, ""); }

void LiveRecord::begins_motion(const rehearsal::Record& described, const std::string& note) {
  start(described, true, note);
}

void LiveRecord::start(const rehearsal::Record& described, bool motion_alone, const std::string& note) {
  const std::scoped_lock lock(mutex_);
  described_ = described;
  motion_alone_ = motion_alone;
  note_ = note;
  trace_ = rehearsal::ThinnedSeries<rehearsal::TracePoint>(capacity_);
  described_.go =
      std::none_of(described_.findings.begin(), described_.findings.end(),
                   [](const auto& finding) { return finding.severity == rehearsal::Severity::error; });
}

void LiveRecord::moved(const rehearsal::TracePoint& newest) {
  const std::scoped_lock lock(mutex_);
  trace_.add(newest);
}

void LiveRecord::progress(double share, const std::string& what) {
  const std::scoped_lock lock(mutex_);
  share_ = share;
  what_ = what;
}

std::string LiveRecord::json() const {
  rehearsal::Record record;
  Json live;
  bool motion_alone = false;
  {
    const std::scoped_lock lock(mutex_);
    record = described_;
    record.trace = trace_.points();
    live = live_value();
    motion_alone = motion_alone_;
  }
  Json report = report_data(record);
  report["pictures"] = Json::array();
  if (motion_alone && report.contains("trace"))
    for (const char* column : kTruth) report["trace"]["columns"].erase(column);
  report["live"] = std::move(live);
  return to_text(report, -1);
}

std::string LiveRecord::progress_json() const {
  const std::scoped_lock lock(mutex_);
  return to_text(live_value(), -1);
}

std::string LiveRecord::page() const {
  std::string title;
  {
    const std::scoped_lock lock(mutex_);
    title = described_.title;
  }
  return live_html(title, json());
}

}  // namespace understudy::report
