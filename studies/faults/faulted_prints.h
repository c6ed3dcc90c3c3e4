// Faults on the whole machine: random prints on built machines, each under one random fault, answered go or
// no-go by a rehearsal and judged by the truth (docs/faults.md). A go on a spoilt part is a silent failure.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "studies/faults/print_judge.h"

namespace understudy::studies {

struct FaultedPrintsRequest {
  std::vector<std::string> machines;  ///< names or paths; empty: all that ship and print
  int runs = 2000;
  std::uint64_t seed = 1;
  int threads = 1;                ///< the result does not depend on it
  std::filesystem::path folder;   ///< programs and machines are written below it
  std::string named;              ///< the folder's name in commands; empty: `folder`
  std::filesystem::path journal;  ///< keeps what has run (core/file/run_journal.h); empty: nothing is kept
  std::string command;            ///< for the record
};

enum class PrintAnswer {
  good_go,    ///< go, and the part is within tolerance
  silent,     ///< go, and it is not
  named,      ///< the print stopped, and its reason names the fault
  spoilt_no,  ///< no-go, and it is not within tolerance
  cautious,   ///< no-go, and it is
  not_run     ///< the engine or the input refused
};
constexpr int kPrintAnswers = 6;
const char* to_string(PrintAnswer answer);  ///< "go, good"

/// One rehearsal under one fault.
struct FaultedPrint {
  int number = 0;
  std::string fault;        ///< a word of drawn_fault_kinds()
  std::string fault_words;  ///< as `--fault` takes them; empty: none
  std::string machine, print, program, as_built, gap_control;
  std::uint64_t seed = 0;  ///< of the built machine and of all noise
  std::string command;     ///< runs it again
  PrintAnswer answer = PrintAnswer::not_run;
  std::string stop;  ///< why the print stopped, in a word; empty: it ran to its end
  PrintTruth truth;
  std::string why;  ///< of one that was not run
};

/// Go or no-go, the reason of a stop ("" where there is none), and the truth, in one answer.
PrintAnswer answer_of(bool go, bool stop_names_fault, const PrintTruth& truth);

struct FaultCounts {
  std::string fault;
  int runs = 0;
  std::array<int, kPrintAnswers> answers{};
  int of(PrintAnswer answer) const { return answers[static_cast<std::size_t>(answer)]; }
};

struct FaultedPrints {
  std::uint64_t seed = 0;
  std::string command;
  std::vector<std::string> machines;
  std::vector<std::string> left_out;  ///< of those that print: none of what is drawn is within their limits
  int prints = 0;                     ///< different ones
  std::vector<FaultedPrint> runs;

  std::vector<FaultCounts> by_fault() const;  ///< in the order of drawn_fault_kinds()
  /// No go on a spoilt part.
  bool good() const;
};

/// Each block of 18 runs has every fault once, and none twice, on two prints; runs 0 to N - 1 are the same
/// whatever comes after them. Throws InputError for what is out of range, Interrupted.
FaultedPrints run_faulted_prints(const FaultedPrintsRequest& request, const Progress& progress = {});

}  // namespace understudy::studies
