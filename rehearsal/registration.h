// The part found by the machine's own gap sensor before the print (docs/registration.md): what is asked, and
// what came of it with the truth beside it.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "control/motion/constraint_check.h"
#include "control/registration/register_part.h"
#include "rehearsal/findings/finding.h"
#include "rehearsal/record.h"
#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

/// Nothing where none is asked for. Throws InputError: no part, no gap sensor, a pattern that the part does
/// not carry, a part that the sensor cannot look at.
std::optional<control::RegistrationTask> registration_task(const RehearsalRequest& request,
                                                           const machine::MachineDescription& machine,
                                                           const std::shared_ptr<const geometry::Mesh>& part,
                                                           const toolpath::Program& program);

/// What a run made of it.
struct RegistrationRun {
  control::Registration found;
  /// [m], at each place: the gap that the found part would have where the sensor read last, minus the true
  /// one; nothing where it was not measured.
  std::vector<std::optional<double>> error;
  /// What the moved program asks beyond the limits; it is not printed then.
  control::ConstraintReport limits;
  toolpath::Program program;                   ///< moved onto the part
  std::shared_ptr<const geometry::Mesh> part;  ///< moved likewise

  /// The program may be printed.
  bool good() const;
};

/// True gap [m] of the exposure with this number.
using TrueGap = std::function<std::optional<double>(std::uint64_t exposure)>;

/// Registers the part and moves the program onto it. `check_limits`: of the moved program.
RegistrationRun run_registration(const control::RegistrationTask& task, const toolpath::Program& program,
                                 const machine::MachineDescription& machine, machine::MachinePort& port,
                                 const TrueGap& true_gap, bool check_limits);

RegistrationFigures registration_figures(const RegistrationRun& run, const control::RegistrationTask& task);

/// Why the program is not printed.
std::vector<Finding> registration_findings(const RegistrationRun& run);

}  // namespace understudy::rehearsal
