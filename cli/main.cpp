// understudy: the command, and the one place where every error becomes a line and an exit status.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/drive/identify_command.h"
#include "cli/new_machine_command.h"
#include "cli/plain_processor.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/process/standard_streams.h"
#include "core/simd.h"
#include "core/text/printable.h"
#include "core/version.h"
#include "vision/plain_instructions.h"

namespace {

using namespace understudy;

/// The standard error may be closed: there is nobody to tell that.
int fail(int status, const std::string& message) {
  std::fputs(fmt::format("understudy: {}\n", printable(message)).c_str(), stderr);
  return status;
}

/// An answer that did not arrive is none.
int delivered(int status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  return fail(cli::kFailed, fmt::format("cannot write standard output: {}", std::strerror(errno)));
}

/// CLI11 would only say that a sub-command is missing.
void check_commands(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  std::string words;  // those that name `command`
  for (int i = 1; i < argc && argv[i][0] != '-' && command->get_require_subcommand_min() > 0; ++i) {
    std::vector<std::string> known;
    for (const CLI::App* sub : command->get_subcommands({})) known.push_back(sub->get_name());
    if (std::find(known.begin(), known.end(), argv[i]) == known.end()) {
      const std::vector<std::string> left_out = cli::left_out_commands();
      if (i == 1 && std::find(left_out.begin(), left_out.end(), argv[i]) != left_out.end())
        throw InputError(fmt::format("this build is without the twin: {} needs it", argv[i]));
      const std::string nearest = nearest_word(std::string(argv[i]), known);
      throw InputError(fmt::format("unknown command '{}{}'{}", words, argv[i],
                                   nearest.empty() ? fmt::format(": see understudy {}--help", words)
                                                   : fmt::format("; did you mean '{}{}'?", words, nearest)));
    }
    command = command->get_subcommand(argv[i]);
    words += command->get_name() + " ";
  }
}

/// The command with its sub-commands, as far as CLI11 has read them.
std::string command_read(const CLI::App& app) {
  std::string words = app.get_name();
  for (const CLI::App* command = &app; !command->get_subcommands().empty();) {
    command = command->get_subcommands().front();
    words += " " + command->get_name();
  }
  return words;
}

std::string footer() {
  const std::string status =
      "Exit status: 0 good, 1 the answer is no, 2 bad input or usage, 3 the machine or the engine failed; "
      "128 + the number of a signal that ended it.\n";
  const std::vector<std::string> left_out = cli::left_out_commands();
  if (left_out.empty())
    return status + "Start with: understudy rehearse scenarios/song-bottle.gcode --fixture bottle --out out";
  return status + fmt::format("This build is without the twin: it leaves out {}.", fmt::join(left_out, ", "));
}

int run(int argc, char** argv) {
  simd();  // refuses a choice that is none, whatever the command
  CLI::App app("Rehearses prints of machines that print in many directions, and says go or no-go.",
               "understudy");
  app.set_version_flag("--version", std::string("understudy ") + kVersion);
  app.require_subcommand(1);
  app.footer(footer());
  cli::Action action;
  cli::add_twin_commands(app, action);
  cli::add_plan(app, action);
  cli::add_kinematics(app, action);
  cli::add_calibrate(app, action);
  cli::add_identify(app, action);
  cli::add_measure(app, action);
  cli::add_export(app, action);
  cli::add_new_machine(app, action);
  cli::add_drive(app, action);
  cli::add_post(app, action);
  cli::add_inspection(app, action);
  check_commands(app, argc, argv);
  try {
    app.parse(argc, argv);
    cli::check_numbers(app);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    return fail(cli::kBadInput, fmt::format("{} (see {} --help)", e.what(), command_read(app)));
  }
  return action ? action() : cli::kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  // The same bytes whatever the number of cores, and whatever instructions the processor has.
  vision::hold_opencv_to_plain_instructions();
  keep_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is a failed write
  watch_for_interrupt();
  cli::remember_command_line(argc, argv);
  try {
    cli::restart_on_plain_instructions(argv);
    return delivered(run(argc, argv));
  } catch (const InputError& e) {
    return fail(cli::kBadInput, e.what());
  } catch (const Interrupted&) {
    fail(cli::kFailed, std::string(kInterrupted));
    die_of_interrupt();
    return cli::kFailed;
  } catch (const std::bad_alloc&) {
    return fail(cli::kFailed, "out of memory");
  } catch (const std::exception& e) {
    return fail(cli::kFailed, e.what());
  }
}
