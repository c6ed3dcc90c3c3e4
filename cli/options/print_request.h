// What a print on a real machine is asked for: the part of a rehearsal's request that the machine has to
// know.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <CLI/App.hpp>

#include "control/print.h"
#include "control/program/dialect_request.h"
#include "geometry/mesh.h"
#include "machine/default_machine.h"
#include "machine/description.h"
#include "report/recorded/recorded_run.h"
#include "toolpath/program.h"

namespace understudy::cli {

struct PrintRequest {
  std::string program;
  std::string machine = machine::kDefaultMachine;  ///< name or path
  std::string fixture;                             ///< STL or a name under models/parts; empty: none
  std::string gap_control;  ///< off, start, continuous; empty: start on a machine that sees, else off
  control::DialectRequest dialect;
};

/// `request` must outlive `command`.
void add_print_options(CLI::App& command, PrintRequest& request);

/// What a print needs, read.
struct PreparedPrint {
  machine::MachineDescription machine;
  toolpath::Program program;
  std::shared_ptr<const geometry::Mesh> part;  ///< null: without a fixture
  std::string fixture_sha256;                  ///< empty: without a fixture
  control::GapControl gap_control = control::GapControl::off;
};

/// As strictly as a machine needs it: a line that cannot be read is an InputError.
PreparedPrint prepare_print(const PrintRequest& request);

/// What the rehearsal with these words printed. Throws InputError where the machine cannot do the same, such
/// as with --register.
PrintRequest rehearsed_request(const std::string& rehearse_command);

/// Reads `words` of a command over the request of a rehearsal: options that are not given stay as rehearsed.
PrintRequest given_over(const PrintRequest& rehearsed, const std::string& drive_command);

/// Throws InputError unless `run`, the rehearsal in `folder`, says go to this very print: program, machine,
/// fixture and every option of the path.
void require_rehearsal(const std::string& folder, const report::RecordedRun& run,
                       const PrintRequest& rehearsed, const PrintRequest& asked, const PreparedPrint& print);

}  // namespace understudy::cli
