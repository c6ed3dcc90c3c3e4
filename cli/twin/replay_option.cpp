#include "cli/twin/replay_option.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "rehearsal/replayed_record.h"
#include "report/page/replay_page.h"
#include "report/replay_report.h"

namespace understudy::cli {
namespace {

constexpr std::array<std::string_view, 9> kOfReplays{"--replay",   "--agree-within", "--machine",
                                                     "--as-built", "--engine",       "--seed",
                                                     "--out",      "--quiet",        "--json"};

void refuse_others(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0 &&
        std::find(kOfReplays.begin(), kOfReplays.end(), option->get_name()) == kOfReplays.end())
      throw InputError(fmt::format(
          "--replay takes its commands from the record, and {} is of no use with it: leave it out",
          option->get_name()));
}

}  // namespace

void add_replay_options(CLI::App& command, ReplayOptions& options) {
  command
      .add_option("--replay", options.record,
                  "port record (docs/port-record.md): feed the twin its commands in place of a program, and "
                  "compare positions (docs/identify.md)")
      ->group("Replay of a record");
  command
      .add_option("--agree-within", options.agree_within,
                  "um[,arcmin]: largest difference of a strut or slide, and of a turn, that is agreement; "
                  "else the machine's play and steps")
      ->delimiter(',')
      ->expected(1, 2)
      ->check(CLI::PositiveNumber)
      ->needs(command.get_option("--replay"))
      ->group("Replay of a record");
  command.get_option("program")->required(false);
}

int run_replay(const CLI::App& command, const RehearseOptions& rehearsal, const ReplayOptions& options) {
  refuse_others(command);
  rehearsal::RecordReplayRequest request;
  request.record = options.record;
  request.twin = rehearsal.request;
  request.twin.command = command_line();
  if (!options.agree_within.empty()) request.agree_length = kMicrometre * options.agree_within[0];
  if (options.agree_within.size() > 1) request.agree_angle = from_deg(options.agree_within[1] / 60);
  OutputFolder out(rehearsal.folder);
  rehearsal::ReplayedRecord replay;
  {
    ProgressLine line(!rehearsal.output.quiet);
    replay = rehearsal::replay_record(request, line.teller());
  }
  const std::string json = report::replay_json(replay);
  write_file(out.path() / "replay.json", json);
  write_file(out.path() / "replay.csv", report::replay_csv(replay));
  write_file(out.path() / "report.html", report::replay_html(replay));
  stop_if_interrupted();
  out.commit();
  const std::string text = report::replay_text(replay);
  print_answer(rehearsal.output,
               {fmt::format("{}report: {}\n", text,
                            (std::filesystem::path(rehearsal.folder) / "report.html").string()),
                text.substr(0, text.find('\n') + 1), json});
  return replay.agrees() ? kGood : kNo;
}

}  // namespace understudy::cli
