#include "report/page/live_record.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "report/json_text.h"
#include "report/page/report_data.h"
#include "report/page/report_html.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;

Json live_value(double share, const std::string& what) {
  return {{"share", stable_number(share, "share")}, {"what", what}};
}

}  // namespace

LiveRecord::LiveRecord(std::size_t capacity) : trace_(capacity) { described_.title = "rehearsal"; }

void LiveRecord::begins(const rehearsal::Record& described) {
  const std::scoped_lock lock(mutex_);
  described_ = described;
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
  {
    const std::scoped_lock lock(mutex_);
    record = described_;
    record.trace = trace_.points();
    live = live_value(share_, what_);
  }
  Json report = report_data(record, {});
  report["live"] = std::move(live);
  return to_text(report, -1);
}

std::string LiveRecord::progress_json() const {
  const std::scoped_lock lock(mutex_);
  return to_text(live_value(share_, what_), -1);
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
