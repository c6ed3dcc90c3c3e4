#include "studies/faults/faulted_prints.h"

#include <fstream>
#include <map>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "report/study/faulted_prints_report.h"
#include "studies/faults/print_pool.h"
#include "tests/temporary_folder.h"

namespace understudy::studies {
namespace {

using testing::HasSubstr;

FaultedPrintsRequest small(const TemporaryFolder& folder, int runs, std::uint64_t seed = 1) {
  FaultedPrintsRequest request;
  request.runs = runs;
  request.seed = seed;
  request.folder = folder.path();
  request.named = "out";
  return request;
}

std::string figures(const FaultedPrints& prints) { return report::faulted_prints_csv(prints); }

TEST(FaultedPrints, AGoOnASpoiltPartIsSilentWhateverElseIsSaid) {
  PrintTruth good, spoilt;
  spoilt.flaws = 1;
  EXPECT_EQ(answer_of(true, false, good), PrintAnswer::good_go);
  EXPECT_EQ(answer_of(true, false, spoilt), PrintAnswer::silent);
  EXPECT_EQ(answer_of(true, true, spoilt), PrintAnswer::silent);
  EXPECT_EQ(answer_of(false, true, spoilt), PrintAnswer::named);
  EXPECT_EQ(answer_of(false, false, spoilt), PrintAnswer::spoilt_no);
  EXPECT_EQ(answer_of(false, false, good), PrintAnswer::cautious);
  FaultedPrints prints;
  prints.runs.resize(2);
  EXPECT_TRUE(prints.good());
  prints.runs[1].answer = PrintAnswer::silent;
  EXPECT_FALSE(prints.good());
}

// What is drawn is printed with an upright tool, more or less; this nozzle leans by 45 degrees.
TEST(FaultedPrints, AMachineThatCanPrintNothingThatIsDrawnIsKnown) {
  EXPECT_FALSE(can_print_any("tilted-nozzle", 1));
  EXPECT_TRUE(can_print_any("hexapod", 1));
}

TEST(ExtendedFaultedPrints, OfABlockEveryFaultHasOneRunAndNoneHasTwo) {
  const TemporaryFolder one, other;
  const FaultedPrints prints = run_faulted_prints(small(one, 18));
  std::map<std::string, int> runs;
  for (const FaultCounts& counts : prints.by_fault()) runs[counts.fault] = counts.runs;
  EXPECT_EQ(runs.size(), 17u);
  EXPECT_EQ(runs["none"], 2);
  for (const auto& [fault, count] : runs)
    if (fault != "none") {
      EXPECT_EQ(count, 1) << fault;
    }
  for (const FaultedPrint& run : prints.runs) {
    EXPECT_NE(run.answer, PrintAnswer::not_run) << run.why << ' ' << run.command;
    EXPECT_THAT(run.command, HasSubstr("understudy rehearse out/programs/print-00"));
    EXPECT_TRUE(std::filesystem::exists(one / run.program));
  }
  // The same on two threads, and the first runs are the same whatever comes after them.
  FaultedPrintsRequest again = small(other, 4);
  again.threads = 2;
  const std::string all = figures(prints), few = figures(run_faulted_prints(again));
  EXPECT_EQ(all.substr(0, few.size()), few);
}

TEST(ExtendedFaultedPrints, AKilledStudyGoesOn) {
  const TemporaryFolder folder;
  FaultedPrintsRequest request = small(folder, 4);
  request.journal = folder / "journal";
  int calls = 0;
  EXPECT_THROW(run_faulted_prints(request,
                                  [&](double, const std::string& what) {
                                    if (what.starts_with("run") && ++calls == 3) throw Interrupted();
                                  }),
               Interrupted);
  const std::string journal = read_file(request.journal);
  ASSERT_EQ(std::count(journal.begin(), journal.end(), '\n'), 4) << journal;  // its study, runs 0 to 2
  // What run 2 answered is altered: it shows where the answer comes from.
  std::ofstream(request.journal) << journal.substr(0, journal.find("\n2 ")) << "\n2 1 -1 2 9 9 9 9 9 9 9\n";
  const FaultedPrints prints = run_faulted_prints(request);
  EXPECT_EQ(prints.runs[2].answer, PrintAnswer::silent);
  EXPECT_EQ(prints.runs[2].truth.tip_max, 9);
  EXPECT_NE(prints.runs[3].answer, PrintAnswer::not_run);
  EXPECT_FALSE(std::filesystem::exists(request.journal));
}

TEST(FaultedPrints, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  EXPECT_THROW(run_faulted_prints(small(folder, 0)), InputError);
  EXPECT_THROW(run_faulted_prints(small(folder, 1'000'001)), InputError);
  FaultedPrintsRequest mill = small(folder, 1);
  mill.machines = {"finishing"};
  EXPECT_THROW(run_faulted_prints(mill), InputError);
}

// The table of docs/faults.md.
TEST(SlowFaultedPrints, NoSpoiltPartIsAnsweredWithAGo) {
  const TemporaryFolder folder;
  FaultedPrintsRequest request = small(folder, 180, 3);
  request.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const FaultedPrints prints = run_faulted_prints(request);
  EXPECT_TRUE(prints.good()) << report::faulted_prints_table(prints);
  std::array<int, kPrintAnswers> answers{};
  for (const FaultedPrint& run : prints.runs) ++answers[static_cast<std::size_t>(run.answer)];
  // Neither all good nor all bad: else the question would not have been asked.
  EXPECT_GE(answers[static_cast<std::size_t>(PrintAnswer::good_go)], 40);
  EXPECT_GE(answers[static_cast<std::size_t>(PrintAnswer::spoilt_no)], 20);
}

}  // namespace
}  // namespace understudy::studies
