#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/dialect_options.h"
#include "cli/options/machine_option.h"
#include "cli/options/seed_option.h"
#include "cli/options/watch_options.h"
#include "cli/twin/compensation_commands.h"
#include "cli/twin/rehearse_into.h"
#include "cli/twin/rehearse_options.h"
#include "cli/watch/watched_run.h"
#include "control/program/gcode_options.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "core/interrupt.h"
#include "machine/description.h"
#include "rehearsal/findings/verdict.h"
#include "rehearsal/program/program_reading.h"
#include "rehearsal/serving/controller_session.h"
#include "rehearsal/serving/serve.h"

namespace understudy::cli {
namespace {

struct ServeCall {
  rehearsal::RehearsalRequest request;
  std::string port, dialect = "grbl", folder = "served";
  double speed = 1;
  bool network = false;
  WatchOptions watch;
};

std::atomic<bool> asked_to_stop{false};

/// While it lives, Ctrl-C ends the serving and not the process: a report comes after it.
class StopBySignal {
 public:
  StopBySignal() : before_(std::signal(SIGINT, on_signal)), before_term_(std::signal(SIGTERM, on_signal)) {}
  ~StopBySignal() {
    std::signal(SIGINT, before_);
    std::signal(SIGTERM, before_term_);
  }
  StopBySignal(const StopBySignal&) = delete;
  StopBySignal& operator=(const StopBySignal&) = delete;

 private:
  static void on_signal(int) { asked_to_stop.store(true); }
  void (*before_)(int);
  void (*before_term_)(int);
};

/// What a sender sees of the machine, for the page.
class WatchedServing {
 public:
  WatchedServing(report::LiveRecord& record, const std::string& machine) : record_(record) {
    rehearsal::Record described;
    described.program_name = "received.gcode";
    described.machine_name = machine;
    described.title = described.program_name + " on " + machine;
    record_.begins_motion(
        described,
        "The curves are the motion that the sender is told; the rehearsal of it begins when the "
        "print has ended.");
    record_.progress(0, "waiting for a sender");
  }

  void moved(const rehearsal::ServedMotion& now) {
    rehearsal::TracePoint point;
    point.time = now.time;
    point.X_WT = point.X_WT_programmed = now.X_WT;
    point.extruding = now.filament > filament_;
    if (point.extruding) path_ += (now.X_WT.translation() - tip_).norm();
    point.path = path_;
    tip_ = now.X_WT.translation();
    filament_ = std::max(filament_, now.filament);
    record_.moved(point);
    record_.progress(0, fmt::format("receiving: {} moves, {} lines refused", now.moves, now.refused));
  }

 private:
  report::LiveRecord& record_;
  Vec3 tip_ = Vec3::Zero();
  double filament_ = 0, path_ = 0;  // [m]
};

rehearsal::ServedProgram receive(const ServeCall& call, report::LiveRecord* live) {
  const auto machine = machine::load_machine(call.request.machine);
  const auto options = control::gcode_options(call.request.dialect, machine);
  const auto line = rehearsal::open_serve_line(rehearsal::parse_serve_address(call.port, call.network));
  rehearsal::ServeOptions serving;
  serving.dialect = call.dialect;
  serving.speed = call.speed;
  const auto began = std::chrono::steady_clock::now();
  serving.clock = [began] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  };
  serving.stop = [] { return asked_to_stop.load(); };
  serving.tell = [](const std::string& what) { fmt::print(stderr, "{}\n", what); };
  std::optional<WatchedServing> watched;
  if (live) {
    watched.emplace(*live, machine.name);
    serving.moved = [&watched](const rehearsal::ServedMotion& now) { watched->moved(now); };
  }
  fmt::print("{} listens as {} on {}\n", machine.name, call.dialect, line->name());
  std::fflush(stdout);
  const StopBySignal stop;
  return rehearsal::serve(*line, machine, options, serving);
}

int run_serve(const ServeCall& call) {
  static_cast<void>(rehearsal::parse_serve_address(call.port, call.network));
  OutputFolder out(call.folder);
  std::optional<WatchedRun> watched;
  if (call.watch.watch) watched.emplace(call.watch.port);
  report::LiveRecord* live = watched ? &watched->record : nullptr;
  const rehearsal::ServedProgram program = receive(call, live);
  if (program.moves == 0) {
    fmt::print("{}: no move was received, so there is nothing to rehearse\n", program.ended);
    if (watched) watched->server.end("No move was received: there is nothing to rehearse.");
    return kNo;
  }
  rehearsal::RehearsalRequest request = call.request;
  request.program = (out.path() / "received.gcode").string();
  write_file(request.program, program.text);
  request.command = fmt::format(
      "understudy rehearse {} --machine {} --engine {} --seed {} --out {}",
      shell_quoted((std::filesystem::path(call.folder) / "received.gcode").string()),
      shell_quoted(request.machine), request.engine, request.seed, shell_quoted(call.folder + "-again"));
  const rehearsal::Record record = rehearse_into(request, out.path(), false, live);
  stop_if_interrupted();
  out.commit();
  if (watched)
    watched->server.finish(read_file((std::filesystem::path(call.folder) / "report.html").string()));
  fmt::print("{}: {} moves received, {} lines refused\n", program.ended, program.moves, program.refused);
  fmt::print("{}: {}\n", record.title, headline(grade_of(record)));
  fmt::print("report: {}\n", (std::filesystem::path(call.folder) / "report.html").string());
  return record.go && program.refused == 0 && !program.aborted ? kGood : kNo;
}

}  // namespace

void add_serve(CLI::App& app, Action& action) {
  auto call = std::make_shared<ServeCall>();
  auto* command = app.add_subcommand(
      "serve", "The twin as a controller that any sender of G-code prints on; a rehearsal report at the end");
  add_machine_option(*command, call->request.machine);
  command
      ->add_option(
          "--port", call->port,
          "where senders find it: tcp:HOST:PORT (0: any free port), or pty:PATH, a serial port of that name")
      ->required();
  command->add_option("--dialect", call->dialect, "what it speaks: grbl (grblHAL 1.1f) or marlin (Marlin 2)")
      ->check(CLI::IsMember(rehearsal::session_dialects()))
      ->capture_default_str();
  command
      ->add_option("--speed", call->speed,
                   "seconds of the machine in a second: 10 prints ten times as fast as the machine would")
      ->check(CLI::Range(0.1, 10000.0))
      ->capture_default_str();
  command->add_flag("--network", call->network, "allow an address that other computers reach");
  command->add_option("--out", call->folder, "folder of results, with received.gcode")->capture_default_str();
  auto& request = call->request;
  request.engine = "quasistatic";
  command->add_option("--engine", request.engine, "plant of the rehearsal: mujoco, bullet, quasistatic")
      ->capture_default_str();
  command->add_option("--fixture", request.fixture,
                      "the inserted part: an STL in mm, or a name under models/parts");
  command->add_option("--material", request.material, "filament: a name under models/materials or a file");
  command->add_option("--as-built", request.as_built, "the machine that stands there, as of `rehearse`");
  command->add_option("--gap-control", request.gap_control, "off, start or continuous, as of `rehearse`");
  command->add_option("--seed", request.seed, "of the as-built errors and of all noise")
      ->check(seed_check())
      ->capture_default_str();
  add_dialect_options(*command, request.dialect);
  add_watch_options(*command, call->watch, "the print as it comes, and the report as it grows,");
  command->footer(
      "Example:\n"
      "  understudy serve --machine hexapod --port pty:/tmp/twin --dialect marlin --out served &\n"
      "  pronsole -e 'connect /tmp/twin 115200' ...     (or any sender that opens a serial port)\n"
      "Ends after one print: at M2 or M30, when its sender leaves, or at Ctrl-C; then the rehearsal is "
      "written.\n"
      "Exit status: 0 GO, 1 NO-GO, a refused line, an abort, or nothing received (docs/serve.md).");
  command->callback([=, &action] { action = [=] { return run_serve(*call); }; });
}

}  // namespace understudy::cli
