#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/drive/gap_latency.h"
#include "cli/drive/watched_port.h"
#include "cli/drive_watch.h"
#include "cli/options/camera_option.h"
#include "cli/options/print_request.h"
#include "cli/options/watch_options.h"
#include "cli/progress.h"
#include "control/preflight.h"
#include "control/resume/resumed_program.h"
#include "core/counted_interrupts.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/is_file.h"
#include "core/units.h"
#include "core/version.h"
#include "drivers/camera/camera_port.h"
#include "drivers/driver_port.h"
#include "drivers/emergency_port.h"
#include "drivers/open_port.h"
#include "machine/record/recording_port.h"

namespace understudy::cli {
namespace {

struct DriveOptions {
  PrintRequest print;
  std::string port, rehearsal, record = "drive.record", resume, camera;
  bool without_rehearsal = false;
  WatchOptions watch;
};

constexpr double kToRest = 60;      // [s], for a machine that brakes
constexpr double kPoll = 0.02;      // [s]
constexpr double kObedience = 5.0;  // [s], for heater and fan

/// Everything between the print loop and the machine, outermost last.
class Driven {
 public:
  Driven(const DriveOptions& options, const PreparedPrint& print,
         std::unique_ptr<drivers::FrameSource> camera)
      : port_(drivers::open_port(options.port, print.machine)),
        emergency_(*port_, [] { return CountedInterrupts::count() > 1; }),
        camera_(camera ? std::make_unique<drivers::CameraPort>(emergency_, std::move(camera)) : nullptr),
        writer_(options.record, port_->axis_count()),
        recorded_(camera_ ? static_cast<machine::MachinePort&>(*camera_) : emergency_, writer_) {
    note(fmt::format("version {}", kVersion));
    note("program " + options.print.program);
    note("program_sha256 " + print.program.sha256);
    note("machine_sha256 " + print.machine.sha256);
    if (!print.fixture_sha256.empty()) note("fixture_sha256 " + print.fixture_sha256);
    note("port " + options.port);
    note("command " + command_line());
  }

  machine::MachinePort& port() { return recorded_; }
  void note(const std::string& text) {
    writer_.note(text);
    writer_.flush();
  }
  /// What the machine itself says of its fault; empty: nothing.
  std::string fault_text() const {
    const auto* driver = dynamic_cast<const drivers::DriverPort*>(port_.get());
    return driver ? driver->fault_text() : "";
  }
  const drivers::CameraUse* camera() const { return camera_ ? &camera_->use() : nullptr; }
  bool emergency() const { return emergency_.stopped(); }

  /// The axes rest or a fault stands, and heater and fan are off.
  void come_to_rest() {
    const double deadline = recorded_.now() + kToRest;
    while (recorded_.state().moving && recorded_.now() < deadline)
      if (recorded_.wait_until(recorded_.now() + kPoll) != machine::Status::ok) break;
    static_cast<void>(recorded_.set_outputs({}, recorded_.now() + kObedience));
    // What is said last must have reached the machine.
    static_cast<void>(recorded_.wait_until(recorded_.now() + kPoll));
  }

 private:
  std::unique_ptr<machine::MachinePort> port_;
  drivers::EmergencyPort emergency_;
  std::unique_ptr<drivers::CameraPort> camera_;  // null: the port's own
  machine::RecordWriter writer_;
  machine::RecordingPort recorded_;
};

class DriveProgress : public control::PrintObserver {
 public:
  explicit DriveProgress(DriveWatch* watch) : watch_(watch) {}
  void progress(std::size_t done, std::size_t total, double) override {
    const double share = static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, total));
    line_.show(share, "printing");
    if (watch_) watch_->progress(share);
  }

 private:
  DriveWatch* watch_;
  ProgressLine line_;
};

/// A digest of the poses and feeds that are printed: what options of the path make of the program.
std::string path_digest(const PreparedPrint& print) {
  std::string bytes;
  for (const toolpath::Step& step : print.program.steps) {
    const Eigen::Matrix4d X = step.X_WT.matrix();
    bytes.append(reinterpret_cast<const char*>(X.data()), sizeof(double) * 16);
    for (const double value : {step.feed, step.duration, step.filament})
      bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  return sha256_hex(bytes);
}

void check_before(const PreparedPrint& print, Driven& driven) {
  const auto checks = control::preflight(print.program, print.machine, driven.port(), print.gap_control);
  std::string refused;
  for (const control::PreflightCheck& check : checks) {
    fmt::print("  {:9} {:5} {}\n", check.name, check.good ? "good" : "BAD", check.text);
    if (!check.good && refused.empty()) refused = check.name + ": " + check.text;
  }
  if (refused.empty()) return;
  driven.note("stopped before anything moved: " + refused);
  throw MachineError("nothing has moved: " + refused);
}

[[noreturn]] void stopped(Driven& driven, const std::string& why) {
  driven.come_to_rest();
  const std::string text = driven.fault_text();
  const std::string said = text.empty() ? why : fmt::format("{}: {}", why, text);
  driven.note("stopped " + said);
  throw MachineError(said + "; heater and fan are off");
}

/// Where the print goes on that a record tells of; nothing of another print is resumed.
control::Restart restart_of(const std::string& file, const PreparedPrint& print,
                            const std::optional<report::RecordedRun>& run) {
  const control::CutRecord cut = control::read_cut_record(file, print.program);
  const auto same = [&](const char* key, const std::string& now, const char* what) {
    if (cut.note(key) != now)
      throw InputError({file},
                       fmt::format("it is the record of another {} than now: it is not resumed", what));
  };
  same("program_sha256", print.program.sha256, "program");
  same("machine_sha256", print.machine.sha256, "machine file or calibration");
  same("fixture_sha256", print.fixture_sha256, "--fixture");
  same("rehearsal", run ? run->inputs_sha256 : "", "--rehearsal");
  same("path_sha256", path_digest(print), "--place, --turn, or other option of the path");
  if (std::ranges::find(cut.notes, "completed") != cut.notes.end())
    throw InputError({file}, "its print is complete: nothing is left to print");
  std::optional<control::Restart> begun;
  if (const std::string words = cut.note("resumed"); !words.empty()) {
    begun = control::restart_of_words(words, print.program);
    if (!begun) throw InputError({file}, "its note 'resumed " + words + "' is no step of the program");
  }
  control::Restart restart =
      control::restart_after(cut, file, print.program, print.machine, print.part.get(), begun);
  if (print.gap_control == control::GapControl::off) restart.offset_W.setZero();
  fmt::print("resumes {}:{} with {:.1f} % of its step laid\n", print.program.file,
             print.program.steps[restart.step].line, 100 * restart.done);
  if (cut.laid.queued > 0)
    fmt::print(
        "  the record ends without a stop: the machine may have gone on for {:.2f} s; look at the part\n",
        cut.laid.queued);
  return restart;
}

control::PrintResult print_on(const PreparedPrint& print, const std::optional<control::Restart>& restart,
                              Driven& driven, DriveWatch* watch) {
  control::PrintOptions options;
  if (restart) options.offset_W = restart->offset_W;
  options.gap_control = print.gap_control;
  options.part = print.part.get();
  DriveProgress progress(watch);
  WatchedPort watched(driven.port(), [watch](const SeenMotion& seen) {
    if (watch) watch->moved(seen);
  });
  machine::MachinePort& port = watch ? static_cast<machine::MachinePort&>(watched) : driven.port();
  try {
    return control::print(print.program, print.machine, port, options, &progress);
  } catch (const Interrupted&) {
    driven.come_to_rest();
    stopped(driven, driven.emergency() ? "stopped as an emergency by a second signal"
                                       : "stopped under control by a signal");
  }
}

int drive(const DriveOptions& options) {
  PrintRequest asked = options.print;
  std::optional<report::RecordedRun> run;
  PrintRequest rehearsed;
  if (!options.without_rehearsal) {
    run = report::read_recorded_run(options.rehearsal);
    rehearsed = rehearsed_request(run->command);
    asked = given_over(rehearsed, command_line());
  }
  PreparedPrint print = prepare_print(asked);
  if (run) require_rehearsal(options.rehearsal, *run, rehearsed, asked, print);

  if (is_file(options.record))  // before the machine is woken up
    throw InputError({options.record},
                     "it is there already, and nothing is written over it: name another by --record");
  std::optional<control::Restart> restart;
  const std::string path = path_digest(print);
  if (!options.resume.empty()) {
    restart = restart_of(options.resume, print, run);
    print.program =
        control::resumed_program(print.program, print.machine, print.part.get(), *restart).program;
  }
  std::unique_ptr<drivers::FrameSource> camera;
  if (!options.camera.empty()) camera = open_camera(options.camera);
  std::unique_ptr<DriveWatch> watch;
  if (options.watch.watch) watch = watch_drive(print.machine, asked.program, options.watch.port);
  const CountedInterrupts interrupts;
  Driven driven(options, print, std::move(camera));
  driven.note("path_sha256 " + path);
  if (restart) {
    driven.note("resumed " + control::restart_words(*restart));
    driven.note("resumed_from " + options.resume);
  }
  driven.note(run ? "rehearsal " + run->inputs_sha256 : "without a rehearsal");
  check_before(print, driven);
  const control::PrintResult result = print_on(print, restart, driven, watch.get());
  if (!result.completed) {
    const int line = result.stop.line;
    stopped(driven, line > 0 ? fmt::format("stopped at {}:{}: {}", asked.program, line, result.stop.why)
                             : fmt::format("stopped: {}", result.stop.why));
  }
  driven.come_to_rest();
  driven.note("completed");
  if (watch) watch->complete();
  fmt::print("printed {} on {}: {} moves, {:.1f} mm of filament, {:.1f} s\n  record {}\n", asked.program,
             options.port, result.moves, to_mm(result.extruded), result.duration, options.record);
  if (const std::string latency = gap_latency_line(options.record); !latency.empty())
    fmt::print("  {}\n", latency);
  if (const drivers::CameraUse* use = driven.camera())
    fmt::print("  camera: {} frames used, {} missing by their stamps, {:.0f} ms old at most\n", use->used,
               use->dropped, 1e3 * use->oldest);
  return kGood;
}

}  // namespace

void add_drive(CLI::App& app, Action& action) {
  auto options = std::make_shared<DriveOptions>();
  auto* command = app.add_subcommand(
      "drive", "Print on a real machine: the print loop of the rehearsal, on the port that a URI names");
  add_print_options(*command, options->print);
  command
      ->add_option("--port", options->port,
                   "URI of the machine (docs/drive.md): loopback:// (a dry run), "
                   "serial:///dev/ttyACM0?family=grblhal, tcp://host:port?family=reprapfirmware")
      ->required();
  auto* rehearsal = command->add_option(
      "--rehearsal", options->rehearsal,
      "folder of the rehearsal that says go to this print; options that are not given here are as rehearsed");
  auto* without = command->add_flag("--without-rehearsal", options->without_rehearsal,
                                    "print what no rehearsal has said go to");
  rehearsal->excludes(without);
  command
      ->add_option("--record", options->record,
                   "file to write with all that goes through the machine's port (docs/port-record.md)")
      ->capture_default_str();
  command->add_option(
      "--camera", options->camera,
      "camera of gap control, in place of the port's own: folder:DIR (pictures that are being "
      "written), v4l2:/dev/videoN, http://... (MJPEG)");
  command
      ->add_option("--resume", options->resume,
                   "record of this print that was cut short: goes on behind the last bead laid, from home")
      ->check(CLI::ExistingFile);
  add_watch_options(*command, options->watch, "the axes as they move");
  command->footer(
      "understudy rehearse scenarios/song-bottle.gcode --fixture bottle --out out\n"
      "understudy drive scenarios/song-bottle.gcode --port serial:///dev/ttyACM0?family=grblhal --rehearsal "
      "out\n"
      "Ctrl-C stops under control; a second one is an emergency stop.");
  command->callback([=, &action] {
    action = [=] {
      if (options->rehearsal.empty() && !options->without_rehearsal)
        throw InputError(
            "nothing is printed that was not rehearsed: name a folder by --rehearsal, or say "
            "--without-rehearsal");
      return drive(*options);
    };
  });
}

}  // namespace understudy::cli
