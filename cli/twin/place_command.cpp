#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/dialect_options.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/staged_file.h"
#include "core/interrupt.h"
#include "machine/default_machine.h"
#include "rehearsal/inspection/inspect.h"
#include "rehearsal/placement/placement.h"
#include "report/picture/placement_picture.h"
#include "report/picture/png.h"
#include "report/placement_report.h"

namespace understudy::cli {
namespace {

struct PlaceCall {
  rehearsal::RehearsalRequest request;
  std::string picture, json;
  bool no_turn = false;
  OutputOptions told;
  int grid = rehearsal::PlacementOptions{}.grid;
};

void check_outputs(const PlaceCall& call) {
  if (!call.picture.empty()) {
    if (std::filesystem::path(call.picture).extension() != ".png")
      throw InputError(fmt::format("{}: a picture ends in .png", call.picture));
    check_writable(call.picture);
  }
  if (!call.json.empty()) check_writable(call.json);
}

void write_outputs(const PlaceCall& call, const rehearsal::Placement& placement, const std::string& title) {
  std::vector<std::unique_ptr<StagedFile>> files;
  if (!call.picture.empty())
    files.push_back(std::make_unique<StagedFile>(
        call.picture, report::encode_png(report::placement_picture(placement, title))));
  if (!call.json.empty())
    files.push_back(std::make_unique<StagedFile>(
        call.json,
        report::placement_json(placement, {call.request.program, call.request.machine, command_line()})));
  stop_if_interrupted();
  for (const auto& file : files) file->commit();
}

int run_place(const PlaceCall& call) {
  check_outputs(call);
  const std::string title =
      std::filesystem::path(call.request.program).filename().string() + " on " + call.request.machine;
  rehearsal::PlacementOptions options;
  options.may_turn = !call.no_turn;
  options.grid = call.grid;
  rehearsal::Placement placement;
  {
    ProgressLine line(!call.told.quiet);
    placement = rehearsal::find_placement(call.request, options, line.teller());
  }
  write_outputs(call, placement, title);
  const std::string text = report::placement_text(placement, title);
  if (call.told.quiet) {
    fmt::print("{}", text.substr(0, text.find('\n') + 1));
    return placement.possible ? kGood : kNo;
  }
  fmt::print("{}", text);
  if (placement.possible)
    fmt::print("to rehearse it: {}\n",
               rehearsal::rehearse_command(rehearsal::placed(call.request, placement.place),
                                           std::filesystem::path(call.request.program).stem().string()));
  for (const std::string& file : {call.picture, call.json})
    if (!file.empty()) fmt::print("{}\n", file);
  return placement.possible ? kGood : kNo;
}

}  // namespace

void add_place(CLI::App& app, Action& action) {
  auto call = std::make_shared<PlaceCall>();
  auto* command = app.add_subcommand(
      "place", "Where on the table to put a program: farthest from limits, singular postures and collisions");
  command->add_option("program", call->request.program, "G-code")->required();
  add_machine_option(*command, call->request.machine);
  command->add_option("--fixture", call->request.fixture,
                      "what stands on the table and is to be kept clear of: an STL in mm, or a name under "
                      "models/parts");
  command->add_flag("--no-turn", call->no_turn, "neither turn the program nor the tool");
  command->add_option("--grid", call->grid, "points of the map along the longer side of the table")
      ->check(CLI::Range(5, 200))
      ->capture_default_str();
  command->add_option("-o,--output", call->picture, "IMAGE.png: the margin over the table");
  command->add_option("--json", call->json, "FILE.json of the answer and the map");
  add_quiet_option(*command, call->told, "no progress, and the first line of the answer alone");
  add_dialect_options(*command, call->request.dialect);
  command->footer(
      "The margin is 0 at a limit and 1 in the middle of a range (docs/placement.md). Exit status 1: no "
      "place\n"
      "holds every limit; the answer names the limit, the line and by how much.");
  command->callback([=, &action] { action = [=] { return run_place(*call); }; });
}

}  // namespace understudy::cli
