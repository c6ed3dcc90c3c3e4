#include "python/machine.h"

#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/error.h"
#include "machine/default_machine.h"
#include "machine/pose_array.h"
#include "python/arrays.h"
#include "python/module.h"

namespace understudy::python {
namespace {

using kinematics::SolveStatus;

constexpr SolveStatus kStatuses[] = {SolveStatus::ok, SolveStatus::unreachable, SolveStatus::singular,
                                     SolveStatus::not_converged, SolveStatus::bad_input};

const char* const kPoseColumns = "x y z [m], qw qx qy qz";

std::vector<std::string> axis_names(const Machine& machine) {
  std::vector<std::string> names;
  for (int i = 0; i < machine.mechanism->axis_count(); ++i) names.push_back(machine.mechanism->axis_name(i));
  return names;
}

std::vector<std::string> axis_units(const Machine& machine) {
  std::vector<std::string> units;
  for (int i = 0; i < machine.mechanism->axis_count(); ++i)
    units.emplace_back(machine.mechanism->axis_is_angle(i) ? "rad" : "m");
  return units;
}

RowsWanted poses_wanted(py::ssize_t rows = -1) {
  return {"poses", static_cast<py::ssize_t>(machine::kPoseNumbers), kPoseColumns, rows};
}

RowsWanted axes_wanted(const Machine& machine, py::ssize_t rows = -1) {
  std::string about;
  const auto names = axis_names(machine), units = axis_units(machine);
  for (std::size_t i = 0; i < names.size(); ++i)
    about += fmt::format("{}{} [{}]", i ? " " : "", names[i], units[i]);
  return {"axes", static_cast<py::ssize_t>(names.size()), about, rows};
}

void check_threads(int threads) {
  if (threads < 0 || threads > 1024) throw InputError(fmt::format("threads {} is outside 0..1024", threads));
}

using Solve = void (*)(const machine::MachineDescription&, std::span<const double>, std::span<double>,
                       machine::StatusBytes, int);

/// Reads `in`, and answers into `out` or a new array, without the interpreter's lock.
py::tuple solved(const Machine& machine, std::span<const double> in, const RowsWanted& wanted,
                 const std::optional<py::array>& out, Solve solve, int threads) {
  check_threads(threads);
  const py::array answers = rows_or_new(out, wanted);
  py::array_t<std::uint8_t> status(wanted.rows);
  const std::span<double> numbers = write_rows(answers, wanted);
  const machine::StatusBytes bytes(status.mutable_data(), static_cast<std::size_t>(wanted.rows));
  {
    const py::gil_scoped_release without_lock;
    solve(machine.description, in, numbers, bytes, threads);
  }
  return py::make_tuple(answers, status);
}

py::tuple axes_of(const Machine& machine, const py::object& poses, const std::optional<py::array>& out,
                  int threads) {
  const std::span<const double> in = read_rows(poses, poses_wanted());
  const auto rows = static_cast<py::ssize_t>(in.size() / machine::kPoseNumbers);
  return solved(machine, in, axes_wanted(machine, rows), out, machine::axes_of_poses, threads);
}

py::tuple poses_of(const Machine& machine, const py::object& axes, const std::optional<py::array>& out,
                   int threads) {
  const RowsWanted wanted = axes_wanted(machine);
  const std::span<const double> in = read_rows(axes, wanted);
  const auto rows = static_cast<py::ssize_t>(in.size()) / wanted.columns;
  return solved(machine, in, poses_wanted(rows), out, machine::poses_of_axes, threads);
}

/// The first limit that each pose breaks, as the command `axes` prints it.
std::vector<std::string> limits_broken(const Machine& machine, const py::object& poses,
                                       const py::object& axes) {
  const std::span<const double> X = read_rows(poses, poses_wanted());
  const auto rows = static_cast<py::ssize_t>(X.size() / machine::kPoseNumbers);
  const RowsWanted wanted = axes_wanted(machine, rows);
  const std::span<const double> q = read_rows(axes, wanted);
  const auto count = static_cast<std::size_t>(wanted.columns);
  const Pose X_BW = machine.description.X_WB.inverse();
  std::vector<std::string> broken;
  for (std::size_t n = 0; n < static_cast<std::size_t>(rows); ++n) {
    std::vector<kinematics::LimitViolation> violations;
    const std::span<const double> row = q.subspan(count * n, count);
    const bool solved = !std::isnan(row[0]);
    machine.mechanism->check(X_BW * pose_of(X.subspan(machine::kPoseNumbers * n), "poses"),
                             solved ? row : std::span<const double>(), violations);
    broken.push_back(violations.empty() ? "" : to_string(violations.front()));
  }
  return broken;
}

py::array_t<double> limits(const Machine& machine) {
  std::vector<double> ends;
  for (int i = 0; i < machine.mechanism->axis_count(); ++i) {
    const auto range = machine.mechanism->axis_range(i);
    ends.insert(ends.end(), {range.lower, range.upper});
  }
  return copied(ends, 2);
}

py::array_t<double> home_axes(const Machine& machine) {
  kinematics::AxisVector axes{};
  const auto count = static_cast<std::size_t>(machine.mechanism->axis_count());
  const SolveStatus status =
      machine.mechanism->inverse(machine.mechanism->home(), {}, std::span(axes).first(count));
  if (status != SolveStatus::ok)
    throw InputError(
        fmt::format("machine {} cannot stand at its home: {}", machine.description.name, to_string(status)));
  return copied(std::span(axes).first(count));
}

py::dict gap_limits(const Machine& machine) {
  const machine::GapLimits& gap = machine.description.gap;
  py::dict limits;
  limits["accepted_min"] = gap.accepted_min;
  limits["accepted_max"] = gap.accepted_max;
  limits["aim"] = gap.aim;
  limits["standoff"] = gap.standoff;
  return limits;
}

py::object drive_limits(const Machine& machine, double machine::Drive::*value) {
  std::vector<double> values;
  for (int i = 0; i < machine.mechanism->axis_count(); ++i)
    values.push_back(machine.description.drives[static_cast<std::size_t>(i)].*value);
  return copied(values);
}

}  // namespace

Machine::Machine(const std::string& name_or_path)
    : Machine(machine::load_machine(name_or_path), name_or_path) {}

Machine::Machine(machine::MachineDescription of, std::string named)
    : word(std::move(named)), description(std::move(of)), mechanism(description.make_mechanism()) {}

void add_machine(py::module_& module) {
  py::list words;
  for (const SolveStatus status : kStatuses) words.append(to_string(status));
  module.attr("SOLVE_STATUS") = py::tuple(words);
  module.def("machine_names", &machine::machine_names, "Names of the machines that Machine() knows.");
  module.def(
      "models_folder", [] { return machine::models_folder(); },
      "Folder of the machines, parts and materials that have names.");

  py::class_<Machine>(module, "Machine",
                      "A machine as its description has it: what a controller believes, not what was built.")
      .def(
          py::init<const std::string&>(), py::arg("name_or_path") = machine::kDefaultMachine,
          "A name that machine_names() knows, or the path of a machine.yaml. InputError names file, line and "
          "key.")
      .def_property_readonly("name", [](const Machine& m) { return m.description.name; })
      .def_property_readonly("mechanism", [](const Machine& m) { return m.description.mechanism; })
      .def_property_readonly("file", [](const Machine& m) { return m.description.file.string(); })
      .def_property_readonly("sha256", [](const Machine& m) { return m.description.sha256; })
      .def_property_readonly("axis_names", &axis_names, "In the order of every array of axes.")
      .def_property_readonly("axis_units", &axis_units, "'m' or 'rad' of each axis.")
      .def_property_readonly("axis_limits", &limits, "(axes, 2): lower and upper end, infinite without one.")
      .def_property_readonly(
          "axis_velocity_max",
          [](const Machine& m) { return drive_limits(m, &machine::Drive::velocity_max); }, "[m/s] or [rad/s]")
      .def_property_readonly(
          "axis_acceleration_max",
          [](const Machine& m) { return drive_limits(m, &machine::Drive::acceleration_max); },
          "[m/s^2] or [rad/s^2]")
      .def_property_readonly(
          "home", [](const Machine& m) { return numbers_of(m.description.X_WB * m.mechanism->home()); },
          "X_WT, (7,): x y z [m], qw qx qy qz.")
      .def_property_readonly("home_axes", &home_axes, "Axes at home [m] or [rad].")
      .def_property_readonly("gap_limits", &gap_limits,
                             "Gap [m] at which a bead is laid: accepted_min, accepted_max, aim, standoff.")
      .def_property_readonly(
          "cycle_time", [](const Machine& m) { return m.description.cycle_time; },
          "[s], period of setpoints.")
      .def_property_readonly("has_microscope", [](const Machine& m) { return m.description.has_microscope; })
      .def("axes", &axes_of, py::arg("poses"), py::kw_only(), py::arg("out") = py::none(),
           py::arg("threads") = 0,
           "Inverse kinematics near home. poses: (n, 7) float64, X_WT as x y z [m], qw qx qy qz, read in "
           "place. "
           "Returns axes (n, axes), [m] or [rad], written into `out` where it is given, and statuses (n,) "
           "uint8, "
           "indices of SOLVE_STATUS; rows without an answer are NaN. threads 0: all cores. Limits are not "
           "looked at: limits_broken() does.")
      .def("poses", &poses_of, py::arg("axes"), py::kw_only(), py::arg("out") = py::none(),
           py::arg("threads") = 0,
           "Forward kinematics on the branch of home. axes: (n, axes) float64, [m] or [rad]. Returns poses "
           "(n, 7), X_WT, and statuses as axes() does.")
      .def("limits_broken", &limits_broken, py::arg("poses"), py::arg("axes"),
           "Of each pose with its axes the first limit that it breaks, in words; '' where it breaks none.")
      .def("__repr__", [](const Machine& m) {
        return fmt::format("<understudy.Machine '{}': {}, {} axes>", m.description.name,
                           m.description.mechanism, m.mechanism->axis_count());
      });
}

}  // namespace understudy::python
