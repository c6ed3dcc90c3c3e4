#include "report/study/faulted_prints_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace understudy::report {
namespace {

using studies::FaultedPrint;
using studies::FaultedPrints;
using studies::PrintAnswer;
using testing::HasSubstr;
using testing::Not;

FaultedPrints sample() {
  FaultedPrints prints;
  prints.seed = 5;
  prints.prints = 2;
  FaultedPrint good;
  good.fault = "none";
  good.answer = PrintAnswer::good_go;
  good.command = "understudy rehearse out/programs/print-000.gcode";
  FaultedPrint silent;
  silent.number = 1;
  silent.fault = "stall";
  silent.answer = PrintAnswer::silent;
  silent.truth.flaws = 1U << static_cast<unsigned>(studies::Flaw::too_high);
  silent.truth.tip_max = 12e-6;
  silent.command = "understudy rehearse out/programs/print-001.gcode --fault '{fault: stall}'";
  FaultedPrint refused;
  refused.number = 2;
  refused.fault = "stall";
  refused.why = "it said \"no\"";
  prints.runs = {good, silent, refused};
  return prints;
}

TEST(FaultedPrintsReport, TheTableCountsByFaultAndTellsHowToRepeatASilentOne) {
  const std::string table = faulted_prints_table(sample());
  EXPECT_THAT(table, testing::ContainsRegex("none +1 +1 +0 +0 +0 +0 +0\n"));
  EXPECT_THAT(table, testing::ContainsRegex("stall +2 +0 +1 +0 +0 +0 +1\n"));
  EXPECT_THAT(table, testing::ContainsRegex("all +3 +1 +1 +0 +0 +0 +1\n"));
  EXPECT_THAT(table, HasSubstr("go on a spoilt part (too high): run 1\n  understudy rehearse out/programs/"
                               "print-001.gcode --fault '{fault: stall}'\n"));
  EXPECT_THAT(table, Not(HasSubstr("print-000")));
  EXPECT_THAT(table, Not(HasSubstr("left out")));
}

TEST(FaultedPrintsReport, NamesTheMachinesThatAreLeftOut) {
  FaultedPrints prints = sample();
  prints.left_out = {"tilted-nozzle"};
  EXPECT_THAT(faulted_prints_table(prints), HasSubstr("left out: tilted-nozzle: none of what is drawn"));
  EXPECT_EQ(nlohmann::json::parse(faulted_prints_json(prints)).at("left_out").at(0), "tilted-nozzle");
}

TEST(FaultedPrintsReport, JsonHasEveryRunWithItsCommand) {
  const auto json = nlohmann::json::parse(faulted_prints_json(sample()));
  EXPECT_EQ(json.at("schema"), "understudy.faulted-prints/1");
  EXPECT_EQ(json.at("seed"), 5);
  EXPECT_EQ(json.at("faults").at(1).at("go, spoilt"), 1);
  EXPECT_EQ(json.at("runs").at(1).at("flaws"), "too high");
  EXPECT_EQ(json.at("runs").at(1).at("tip_max_um"), 12);
  EXPECT_EQ(json.at("runs").at(2).at("why"), "it said \"no\"");
}

TEST(FaultedPrintsReport, CsvQuotesWhatHoldsCommas) {
  const std::string csv = faulted_prints_csv(sample());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  EXPECT_THAT(csv, HasSubstr("\"it said \"\"no\"\"\""));
  EXPECT_THAT(csv, HasSubstr("\"too high\",12.000,"));
}

}  // namespace
}  // namespace understudy::report
