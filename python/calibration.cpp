// Calibration of a machine from arrays.
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "calibration/machine/calibrate_machine.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/units.h"
#include "machine/file/beside_machine.h"
#include "machine/file/calibration_section.h"
#include "machine/file/section_text.h"
#include "machine/pose_array.h"
#include "python/arrays.h"
#include "python/long_work.h"
#include "python/machine.h"
#include "python/module.h"
#include "python/script_estimator.h"

namespace understudy::python {
namespace {

using namespace calibration;

constexpr const char* kArrays = "arrays";  // in place of a file's name
using Noise = std::pair<double, double>;

MachineKind kind_of(const Machine& machine) {
  return machine.description.is_chain() ? MachineKind::chain : MachineKind::hexapod;
}

/// 1 sigma of each axis [m], [rad], or whole covariances (n, 6, 6).
struct NoiseArgument {
  MeasurementNoise assumed = kReferenceNoise;
  py::object rows;  ///< keeps what `covariances` are
  std::optional<std::span<const double>> covariances;
};

NoiseArgument noise_of(const py::object& noise, py::ssize_t rows) {
  NoiseArgument argument;
  if (noise.is_none()) return argument;
  if (py::isinstance<py::array>(noise)) {
    const auto array = py::reinterpret_borrow<py::array>(noise);
    if (array.ndim() != 3 || array.shape(0) != rows || array.shape(1) != 6 || array.shape(2) != 6)
      throw InputError(fmt::format(
          "noise: expected (position [m], rotation [rad]), or covariances of shape ({}, 6, 6)", rows));
    argument.rows = array.attr("reshape")(rows, 36);
    argument.covariances = read_rows(argument.rows, {"noise", 36, "covariances", rows});
    return argument;
  }
  try {
    const auto [position, rotation] = noise.cast<Noise>();
    argument.assumed = {position, rotation};
  } catch (const py::cast_error&) {
    throw InputError("noise: expected (position [m], rotation [rad]), or covariances (n, 6, 6)");
  }
  if (!(argument.assumed.position > 0 && argument.assumed.rotation > 0))
    throw InputError(fmt::format("noise: {:g} m and {:g} rad: both are above 0", argument.assumed.position,
                                 argument.assumed.rotation));
  return argument;
}

Approach approach_of(double side) {
  if (side != -1 && side != 0 && side != 1)
    throw InputError(fmt::format("approach: {:g} is none of -1, 0, 1", side));
  return static_cast<Approach>(static_cast<int>(side));
}

Measurements measurements_of(const Machine& machine, const py::object& axes, const py::object& poses,
                             const NoiseArgument& noise, const py::object& approach) {
  const auto n = static_cast<std::size_t>(machine.mechanism->axis_count());
  const auto columns = static_cast<py::ssize_t>(n);
  const auto q = read_rows(axes, {"axes", columns, "as commanded, [m] or [rad]"});
  const auto rows = static_cast<py::ssize_t>(q.size() / n);
  const auto X = read_rows(poses, {"poses", 7, "measured X_WT: x y z [m], qw qx qy qz", rows});
  Measurements measurements;
  measurements.file = kArrays;
  measurements.noise_given = noise.covariances.has_value();
  measurements.approach_told = !approach.is_none();
  const auto sides = measurements.approach_told
                         ? read_rows(approach, {"approach", columns, "-1, 0 or 1 of each strut", rows})
                         : std::span<const double>();
  for (std::size_t j = 0; j < static_cast<std::size_t>(rows); ++j) {
    MeasuredPose pose;
    pose.line = static_cast<int>(j) + 1;
    pose.X_WT = pose_of(X.subspan(machine::kPoseNumbers * j), "poses");
    pose.covariance =
        noise.covariances ? Mat6(Mat6::Map(noise.covariances->data() + 36 * j)) : noise.assumed.covariance();
    pose.axes.assign(q.begin() + static_cast<std::ptrdiff_t>(n * j),
                     q.begin() + static_cast<std::ptrdiff_t>(n * (j + 1)));
    for (std::size_t i = 0; !sides.empty() && i < kStruts; ++i)
      pose.approach[i] = approach_of(sides[n * j + i]);
    measurements.poses.push_back(pose);
  }
  measurements.sha256 = sha256_hex(measurements_csv(measurements, machine.description, kArrays));
  return measurements;
}

std::shared_ptr<Estimator> chosen(const py::object& estimator, const Machine& machine) {
  if (py::isinstance<py::str>(estimator))
    return make_estimator(estimator.cast<std::string>(), kind_of(machine));
  return estimator_of_script(estimator);
}

std::string name_of(const py::object& estimator) {
  if (py::isinstance<py::str>(estimator)) return estimator.cast<std::string>();
  const py::object named =
      py::hasattr(estimator, "__name__") ? estimator : py::object(py::type::of(estimator));
  return std::string(py::str(named.attr("__name__")));
}

MachineCalibration calibrate(const Machine& machine, const py::object& axes, const py::object& poses,
                             const py::object& noise, const py::object& approach,
                             const py::object& estimator) {
  const auto by = chosen(estimator, machine);
  const auto rows =
      py::isinstance<py::array>(poses) && py::array(poses).ndim() > 0 ? py::array(poses).shape(0) : 0;
  const NoiseArgument assumed = noise_of(noise, rows);
  const Measurements measurements = measurements_of(machine, axes, poses, assumed, approach);
  MachineCalibration result;
  result.file = kArrays;
  result.estimator = name_of(estimator);
  result.command = "understudy.calibrate() of arrays";
  result.noise = assumed.assumed;
  result.noise_given = measurements.noise_given;
  result.machine = machine.description;
  run_long([&] { calibrate_measurements(measurements, machine.description, *by, result); });
  return result;
}

/// [m] or [rad] of a parameter line's unit.
double si_of(const std::string& unit) {
  if (unit == "mm") return kMillimetre;
  return unit == "um" ? kMicrometre : unit == "deg" ? kDegree : 1;
}

template <typename Value>
py::array_t<double> column_of(const MachineCalibration& result, const Value& value) {
  std::vector<double> column;
  for (const ParameterLine& line : result.parameters) column.push_back(value(line) * si_of(line.unit));
  return copied(column);
}

py::array_t<double> residuals_of(const MachineCalibration& result, Twist PoseResidual::*which) {
  std::vector<double> numbers;
  for (const PoseResidual& pose : result.poses) {
    const Twist& e = pose.*which;
    numbers.insert(numbers.end(), e.data(), e.data() + 6);
  }
  return copied(numbers, 6);
}

py::array_t<bool> used_of(const MachineCalibration& result) {
  py::array_t<bool> used(static_cast<py::ssize_t>(result.poses.size()));
  for (std::size_t j = 0; j < result.poses.size(); ++j)
    used.mutable_at(static_cast<py::ssize_t>(j)) = result.poses[j].used;
  return used;
}

/// The calibrated machine file, with the files that it names.
void write(const MachineCalibration& result, const std::string& file) {
  machine::check_machine_output(file);
  StagedFile staged = machine::staged_with_section(
      result.machine.file, machine::calibration_section(result.machine, result.stored), file);
  auto urdf = machine::staged_urdf(result.machine.file, file);
  const auto companions = machine::staged_companions(result.machine.file, file);
  if (urdf) urdf->commit();
  for (const auto& companion : companions) companion->commit();
  staged.commit();
}

void add_result(py::module_& module) {
  py::class_<MachineCalibration>(module, "Calibration", "A calibrated machine, and how well it is known.")
      .def_property_readonly("estimator", [](const MachineCalibration& r) { return r.estimator; })
      .def_property_readonly(
          "machine", [](const MachineCalibration& r) { return Machine(r.machine, r.machine.name); },
          "The calibrated description: its axes() and poses() are those of the found parameters.")
      .def_property_readonly(
          "names",
          [](const MachineCalibration& r) {
            std::vector<std::string> names;
            for (const auto& line : r.parameters) names.push_back(line.name);
            return names;
          },
          "Of the estimated parameters.")
      .def_property_readonly(
          "before",
          [](const MachineCalibration& r) { return column_of(r, [](const auto& l) { return l.before; }); },
          "[m] or [rad].")
      .def_property_readonly(
          "after",
          [](const MachineCalibration& r) { return column_of(r, [](const auto& l) { return l.after; }); },
          "[m] or [rad].")
      .def_property_readonly(
          "sigma",
          [](const MachineCalibration& r) { return column_of(r, [](const auto& l) { return l.sigma; }); },
          "1 sigma [m] or [rad]; NaN where the estimator gave no covariance.")
      .def_property_readonly(
          "covariance", [](const MachineCalibration& r) { return r.stored.covariance; },
          "Of the numbers that the machine file stores, SI: of a hexapod in the order of "
          "`names`. Empty where the estimator gave none.")
      .def_property_readonly(
          "residuals_before",
          [](const MachineCalibration& r) { return residuals_of(r, &PoseResidual::before); },
          "(n, 6), measured less modelled: tip [m], rotation vector [rad], in B.")
      .def_property_readonly(
          "residuals", [](const MachineCalibration& r) { return residuals_of(r, &PoseResidual::after); },
          "The same after the calibration.")
      .def_property_readonly("used", &used_of, "(n,) bool, False: rejected as an outlier.")
      .def_property_readonly("chi_square", [](const MachineCalibration& r) { return r.chi_square; })
      .def_property_readonly("degrees_of_freedom",
                             [](const MachineCalibration& r) { return r.degrees_of_freedom; })
      .def_property_readonly("iterations", [](const MachineCalibration& r) { return r.iterations; })
      .def_property_readonly(
          "tip_sigma", [](const MachineCalibration& r) { return r.tip.rms; },
          "[m], RMS over the work space of the tip's 3D uncertainty; NaN: not known.")
      .def_property_readonly(
          "redundant", [](const MachineCalibration& r) { return r.redundant; },
          "Parameters that no pose can tell beside the others.")
      .def_property_readonly("warnings", [](const MachineCalibration& r) { return r.warnings; })
      .def("write", &write, py::arg("file"),
           "The calibrated machine.yaml, as `understudy calibrate -o` has it.")
      .def("__repr__", [](const MachineCalibration& r) {
        return fmt::format("<understudy.Calibration of {} by {}: {} parameters from {} poses>",
                           r.machine.name, r.estimator, r.parameters.size(), r.poses.size());
      });
}

}  // namespace

void add_calibration(py::module_& module) {
  add_script_problem(module);
  add_result(module);
  module.def(
      "estimator_names", [](const Machine& machine) { return estimator_names(kind_of(machine)); },
      py::arg("machine"), "Words that calibrate() and benchmark_calibration() take for this machine.");
  module.def(
      "calibrate", &calibrate, py::arg("machine"), py::arg("axes"), py::arg("poses"), py::kw_only(),
      py::arg("noise") = py::none(), py::arg("approach") = py::none(),
      py::arg("estimator") = "maximum_likelihood",
      "From what was commanded and measured to a calibrated machine. axes: (n, axes), as commanded; of a "
      "hexapod strut lengths. poses: (n, 7), measured X_WT. noise: 1 sigma of each axis (position [m], "
      "rotation [rad]), or covariances (n, 6, 6) in W; 20 um and 0.2 mrad are assumed. approach: (n, 6), "
      "1 where a strut came by lengthening, -1 by shortening; needed by with_play. estimator: a name, or "
      "an object with calibrate(problem). InputError says what the poses lack.");
}

}  // namespace understudy::python
