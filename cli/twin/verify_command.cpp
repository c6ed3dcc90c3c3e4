#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/twin/rehearse_into.h"
#include "cli/twin/rehearse_options.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "core/file/scratch_folder.h"
#include "core/version.h"
#include "machine/description.h"
#include "rehearsal/request/input_digest.h"
#include "report/recorded/recorded_run.h"
#include "report/recorded/verification.h"

namespace understudy::cli {
namespace {
namespace fs = std::filesystem;

/// In words; empty: they are those of the record.
std::string changed_inputs(const rehearsal::RehearsalRequest& request, const report::RecordedRun& recorded) {
  if (recorded.version != kVersion)
    return fmt::format("understudy {} wrote it, and this is {}", recorded.version, kVersion);
  if (machine::load_machine(request.machine).sha256 != recorded.machine_sha256)
    return fmt::format("the machine {} was changed", request.machine);
  if (sha256_hex(read_file(request.program)) != recorded.program_sha256)
    return fmt::format("the program {} was changed", request.program);
  if (rehearsal::inputs_sha256(request, recorded.program_sha256) != recorded.inputs_sha256)
    return "another input (fixture, material, as-built file, ...) was changed";
  return "";
}

int differs(const std::string& folder, const std::string& why) {
  fmt::print("{}: not verified: {}\n", folder, why);
  return kNo;
}

int verify(const std::string& folder) {
  const report::RecordedRun recorded = report::read_recorded_run(folder);
  if (const std::string why = why_not_as_written(folder); !why.empty()) return differs(folder, why);
  RehearseOptions options = read_rehearse_command(recorded.command);
  options.request = options.with_faults();
  options.request.command = recorded.command;
  options.request.record.clear();  // the user's: not to be written again
  if (const std::string why = changed_inputs(options.request, recorded); !why.empty())
    return differs(folder, why);

  const ScratchFolder out("verify");
  const fs::path again = out.path() / "again";
  fs::create_directory(again);
  std::string& as_printed = options.request.surface.as_printed;
  if (const std::string among = among_results(as_printed, options.folder, again.string());
      among != as_printed)
    as_printed = among;
  else if (!as_printed.empty())  // another file of the user's: not to be written again
    as_printed = (out.path() / ("as-printed" + fs::path(as_printed).extension().string())).string();
  rehearse_into(options.request, again);

  const auto differences = report::compare_results(folder, again);
  for (const auto& difference : differences) fmt::print("  {}: {}\n", difference.file, difference.details);
  if (!differences.empty())
    return differs(folder, fmt::format("{} of its files differ when it is run again", differences.size()));
  fmt::print(
      "{}: verified: the inputs are those of the record, and {} files are the same when it is run again\n",
      folder, report::compared_files(folder).size());
  return kGood;
}

}  // namespace

void add_verify(CLI::App& app, Action& action) {
  auto folder = std::make_shared<std::string>();
  auto* command = app.add_subcommand(
      "verify",
      "Run a rehearsal again from its folder of results and compare: status 1 where anything differs");
  command
      ->add_option("folder", *folder,
                   "results of understudy rehearse; relative names in its command count from here")
      ->required();
  command->callback([=, &action] { action = [=] { return verify(*folder); }; });
}

}  // namespace understudy::cli
