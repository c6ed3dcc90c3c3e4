// Bytes as a scenario, beside the files that it may name.
#include "regression/scenario_file.h"
#include "tests/fuzz/reader.h"

namespace understudy::fuzz {
namespace {

void check_expectation(const regression::Expectation& expectation) {
  require(!expectation.metric.empty(), "an expectation without metric");
  require(regression::metric_is_text(expectation.metric) != !expectation.unit.empty(),
          "a unit of a word, or a number without one");
  for (const auto& bound : {expectation.min, expectation.max})
    if (bound) require_finite(*bound, "bound");
  require(expectation.min || expectation.max || expectation.equals, "an expectation without a bound");
  require_finite(std::vector{expectation.within_min, expectation.within_max, expectation.tolerance}, "range");
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("scenario.yaml");
  for (const char* neighbour : {"p.gcode", "part.stl", "m.yaml", "pattern.csv"}) {
    const fuzz::InputFile file(neighbour);
    if (!std::filesystem::exists(file.path())) file.fill("");
  }
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  regression::Scenario scenario;
  if (!fuzz::accepts(size, file, [&] { scenario = regression::load_scenario(file); })) return 0;
  fuzz::require(!scenario.expect.empty(), "a scenario that expects nothing");
  for (const auto& expectation : scenario.expect) fuzz::check_expectation(expectation);
  if (scenario.machines) {
    fuzz::require(scenario.machines->count() >= 1 && scenario.machines->count() <= 1'000'000,
                  "a range of seeds");
    for (const auto& expectation : scenario.machines->expect) fuzz::check_expectation(expectation);
  }
  for (const auto& fault : scenario.faults)
    fuzz::require_finite(std::vector{fault.event.time, fault.event.duration, fault.event.amount}, "fault");
  for (const double place : scenario.dialect.place_mm) fuzz::require_finite(place, "place_mm");
  return 0;
}
