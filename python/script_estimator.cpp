#include "python/script_estimator.h"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <Eigen/Cholesky>

#include "calibration/calibrated.h"
#include "core/error.h"
#include "machine/pose_array.h"
#include "python/arrays.h"

namespace understudy::python {

using namespace calibration;

namespace {

std::vector<std::string> hexapod_names() {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= kStruts; ++i) {
    for (const char* joint : {"base joint", "platform joint"})
      for (const char axis : {'x', 'y', 'z'}) names.push_back(fmt::format("{} {} {}", joint, i, axis));
    names.push_back(fmt::format("length offset {}", i));
  }
  return names;
}

Eigen::VectorXd numbers_of(const HexapodGeometry& geometry) {
  Eigen::VectorXd numbers(kGeometryParameters);
  for (std::size_t i = 0; i < kStruts; ++i)
    numbers.segment<kStrutParameters>(static_cast<Eigen::Index>(kStrutParameters * i))
        << geometry.base_joint[i],
        geometry.platform_joint[i], geometry.length_offset[i];
  return numbers;
}

Twist none() { return Twist::Constant(std::numeric_limits<double>::quiet_NaN()); }

}  // namespace

std::vector<std::string> ScriptProblem::names() const {
  return is_chain() ? chain_parameter_names(chain_->nominal.chain) : hexapod_names();
}

Eigen::VectorXd ScriptProblem::nominal() const {
  if (!is_chain()) return numbers_of(hexapod_->nominal.geometry);
  return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names().size()));
}

std::size_t ScriptProblem::sample_count() const {
  return is_chain() ? chain_->samples.size() : hexapod_->samples.size();
}

Pose ScriptProblem::measured(std::size_t sample) const {
  return is_chain() ? chain_->samples[sample].X_ST : hexapod_->samples[sample].X_BT;
}

Mat6 ScriptProblem::covariance(std::size_t sample) const {
  return is_chain() ? chain_->samples[sample].covariance : hexapod_->samples[sample].covariance;
}

std::vector<double> ScriptProblem::axes(std::size_t sample) const {
  if (is_chain()) return chain_->samples[sample].axes;
  const StrutLengths& moved_by = hexapod_->samples[sample].displacement;
  return {moved_by.begin(), moved_by.end()};
}

kinematics::PerStrut<Approach> ScriptProblem::approach(std::size_t sample) const {
  return is_chain() ? kinematics::PerStrut<Approach>{} : hexapod_->samples[sample].approach;
}

void ScriptProblem::check(const Eigen::VectorXd& parameters) const {
  const Eigen::VectorXd from = nominal();
  if (parameters.size() != from.size())
    throw InputError(fmt::format("parameters: {} numbers, expected {}", parameters.size(), from.size()));
  if (!parameters.allFinite()) throw InputError("parameters: not all of them are finite");
}

HexapodParameters ScriptProblem::hexapod(const Eigen::VectorXd& parameters) const {
  check(parameters);
  return moved(hexapod_->nominal, ParameterVector(parameters - nominal()), {});
}

ChainParameters ScriptProblem::chain(const Eigen::VectorXd& parameters) const {
  check(parameters);
  return moved(chain_->nominal, parameters);
}

std::vector<Twist> ScriptProblem::residuals(const Eigen::VectorXd& parameters) const {
  std::vector<Twist> all;
  if (is_chain()) {
    const ChainParameters machine = chain(parameters);
    for (const ChainSample& sample : chain_->samples)
      all.push_back(pose_error(sample.X_ST, forward(machine, sample.axes)));
    return all;
  }
  const HexapodParameters machine = hexapod(parameters);
  for (const PoseSample& sample : hexapod_->samples) {
    const auto reached = kinematics::forward(machine.geometry, strut_lengths(machine, sample), sample.X_BT);
    all.push_back(reached.status == kinematics::SolveStatus::ok ? pose_error(sample.X_BT, reached.X_BT)
                                                                : none());
  }
  return all;
}

namespace {

constexpr const char* kNoCovariance =
    "the estimator gives no covariance: the uncertainty that its calibration leaves is not known";

struct Answer {
  Eigen::VectorXd parameters;
  Eigen::MatrixXd covariance;  ///< empty: none was given
};

/// Throws InputError for what is no answer.
Answer answer_of(const py::object& returned, Eigen::Index count) {
  Answer answer;
  const bool pair = py::isinstance<py::tuple>(returned) && py::len(returned) == 2;
  try {
    answer.parameters = (pair ? py::object(returned[py::int_(0)]) : returned).cast<Eigen::VectorXd>();
    if (pair) answer.covariance = py::object(returned[py::int_(1)]).cast<Eigen::MatrixXd>();
  } catch (const py::cast_error&) {
    throw InputError(
        fmt::format("it returned a {}, expected an array of {} numbers, or that and their covariance",
                    Py_TYPE(returned.ptr())->tp_name, count));
  }
  if (pair && (answer.covariance.rows() != count || answer.covariance.cols() != count))
    throw InputError(fmt::format("covariance: of shape ({}, {}), expected ({}, {})", answer.covariance.rows(),
                                 answer.covariance.cols(), count, count));
  return answer;
}

class ScriptEstimator final : public Estimator {
 public:
  explicit ScriptEstimator(py::object script) : script_(std::move(script)) {}
  // NOLINTNEXTLINE(bugprone-exception-escape): letting go of an object throws nothing
  ~ScriptEstimator() override {
    const py::gil_scoped_acquire with_lock;
    script_ = py::object();
  }

  Calibration calibrate(const Problem& problem, const Options&) const override {
    Calibration result = refused(problem, Status::no_answer, {});
    const ScriptProblem told(problem);
    Answer answer;
    result.message = ask(told, answer);
    if (!result.message.empty()) return result;
    result.parameters = told.hexapod(answer.parameters);
    result.pose = add_residuals(problem, {}, result);
    if (result.pose) {
      result.message = fmt::format("the answer is no machine: it cannot reach pose {}", *result.pose + 1);
      return result;
    }
    result.covariance = answer.covariance;
    finish(answer, "outliers, dev, play", result);
    return result;
  }

  ChainCalibration calibrate_chain(const ChainProblem& problem, const Options&) const override {
    ChainCalibration result;
    result.status = Status::no_answer;
    result.parameters = problem.nominal;
    result.used.assign(problem.samples.size(), true);
    const ScriptProblem told(problem);
    Answer answer;
    result.message = ask(told, answer);
    if (!result.message.empty()) return result;
    result.parameters = told.chain(answer.parameters);
    result.estimated = told.names();
    result.residuals = told.residuals(answer.parameters);
    for (std::size_t j = 0; j < problem.samples.size(); ++j) {
      const Twist& e = result.residuals[j];
      result.chi_square += e.dot(problem.samples[j].covariance.llt().solve(e));
    }
    result.degrees_of_freedom =
        6 * static_cast<int>(problem.samples.size()) - independent_parameters(problem.nominal.chain);
    result.covariance = answer.covariance;
    finish(answer, "outliers, play, bending", result);
    return result;
  }

 private:
  static void finish(const Answer& answer, const char* lacking, Estimation& result) {
    result.status = Status::ok;
    if (answer.covariance.size() == 0) result.warnings.emplace_back(kNoCovariance);
    if (std::string misfit = misfit_warning(result.chi_square, result.degrees_of_freedom, lacking);
        !misfit.empty())
      result.warnings.push_back(std::move(misfit));
  }

  /// Why there is no answer; empty where there is one.
  std::string ask(const ScriptProblem& problem, Answer& answer) const {
    const py::gil_scoped_acquire with_lock;
    try {
      const py::object called =
          py::hasattr(script_, "calibrate") ? py::object(script_.attr("calibrate")) : script_;
      const py::object returned = called(py::cast(problem));
      answer = answer_of(returned, problem.nominal().size());
      problem.residuals(answer.parameters);  // throws for a wrong number of them
      return {};
    } catch (py::error_already_set& error) {
      if (error.matches(PyExc_KeyboardInterrupt)) throw;
      return fmt::format("{}: {}", std::string(py::str(error.type().attr("__name__"))),
                         std::string(py::str(error.value())));
    } catch (const InputError& error) {
      return error.what();
    }
  }

  py::object script_;
};

}  // namespace

std::shared_ptr<Estimator> estimator_of_script(py::object script) {
  if (!py::hasattr(script, "calibrate") && !PyCallable_Check(script.ptr()))
    throw InputError(fmt::format("estimator: a {} is neither a name nor has it a method calibrate(problem)",
                                 Py_TYPE(script.ptr())->tp_name));
  return std::make_shared<ScriptEstimator>(std::move(script));
}

namespace {

template <typename Row>
py::array_t<double> rows_of(const ScriptProblem& problem, py::ssize_t columns, const Row& row) {
  py::array_t<double> rows({static_cast<py::ssize_t>(problem.sample_count()), columns});
  double* at = rows.mutable_data();
  for (std::size_t j = 0; j < problem.sample_count(); ++j, at += columns) row(j, at);
  return rows;
}

}  // namespace

void add_script_problem(py::module_& module) {
  py::class_<ScriptProblem>(module, "Problem", "What an estimator is given.")
      .def_property_readonly("is_chain", &ScriptProblem::is_chain)
      .def_property_readonly("names", &ScriptProblem::names, "Of the parameters.")
      .def_property_readonly(
          "nominal", &ScriptProblem::nominal,
          "Parameters to start from, SI: of a hexapod the 42, strut by strut; of a chain 0, "
          "offsets from its description.")
      .def_property_readonly(
          "axes",
          [](const ScriptProblem& p) {
            const auto columns = p.sample_count() == 0 ? 0 : p.axes(0).size();
            return rows_of(p, static_cast<py::ssize_t>(columns),
                           [&](std::size_t j, double* at) { std::ranges::copy(p.axes(j), at); });
          },
          "(n, axes): of a hexapod displacements of its drives, of a chain its readings.")
      .def_property_readonly(
          "poses",
          [](const ScriptProblem& p) {
            return rows_of(p, static_cast<py::ssize_t>(machine::kPoseNumbers),
                           [&](std::size_t j, double* at) { kinematics::write_pose(p.measured(j), at); });
          },
          "(n, 7), measured: of a hexapod X_BT, of a chain X_ST.")
      .def_property_readonly(
          "covariances",
          [](const ScriptProblem& p) {
            const auto rows = rows_of(p, 36, [&](std::size_t j, double* at) {
              const Mat6 covariance = p.covariance(j);
              std::copy_n(covariance.data(), 36, at);  // symmetric
            });
            return py::array(rows).attr("reshape")(p.sample_count(), 6, 6);
          },
          "(n, 6, 6), of each measurement's error (tip [m], rotation vector [rad]).")
      .def_property_readonly(
          "approach",
          [](const ScriptProblem& p) {
            return rows_of(p, 6, [&](std::size_t j, double* at) {
              for (const Approach side : p.approach(j)) *at++ = static_cast<double>(side);
            });
          },
          "(n, 6), of a hexapod: 1 a strut came by lengthening, -1 by shortening, 0 unknown.")
      .def(
          "residuals",
          [](const ScriptProblem& p, const Eigen::VectorXd& parameters) {
            const std::vector<Twist> all = p.residuals(parameters);
            return rows_of(p, 6, [&](std::size_t j, double* at) { std::copy_n(all[j].data(), 6, at); });
          },
          py::arg("parameters"),
          "(n, 6): measured less what a machine of these parameters makes, (tip [m], rotation vector [rad]); "
          "NaN where it cannot reach.");
}

}  // namespace understudy::python
