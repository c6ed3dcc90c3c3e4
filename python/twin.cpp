// The twin's MachinePort: a script that holds it is a controller.
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "core/error.h"
#include "machine/pose_array.h"
#include "python/arrays.h"
#include "python/machine.h"
#include "python/module.h"
#include "python/record_arrays.h"
#include "python/request_options.h"
#include "rehearsal/live_twin.h"

namespace understudy::python {
namespace {

using machine::Status;
using rehearsal::LiveTwin;

constexpr double kForever = std::numeric_limits<double>::infinity();

class Twin {
 public:
  explicit Twin(const py::dict& options)
      : request_(request_of("", options)), owner_(std::this_thread::get_id()) {
    const py::gil_scoped_release without_lock;
    twin_ = std::make_unique<LiveTwin>(request_);
  }

  /// Of the thread that made it, and of an engine that has not failed.
  LiveTwin& whole() const {
    if (std::this_thread::get_id() != owner_)
      throw InputError("a Twin belongs to the thread that made it: its microscope draws there");
    twin_->check_engine();
    return *twin_;
  }
  machine::MachinePort& port() const { return whole().port(); }
  std::size_t axis_count() const { return static_cast<std::size_t>(port().axis_count()); }

  /// Lets time pass without the interpreter's lock.
  template <typename Call>
  Status without_lock(const Call& call) const {
    machine::MachinePort& to = port();
    Status status;
    {
      const py::gil_scoped_release released;
      status = call(to);
    }
    twin_->check_engine();
    return status;
  }

  Machine machine() const { return {whole().setup().machine, request_.machine}; }

 private:
  rehearsal::RehearsalRequest request_;
  std::thread::id owner_;
  std::unique_ptr<LiveTwin> twin_;
};

std::span<const double> optional_rows(const py::object& rows, const RowsWanted& wanted) {
  return rows.is_none() ? std::span<const double>() : read_rows(rows, wanted);
}

std::vector<int> lines_of(const py::object& line, std::size_t count) {
  if (py::isinstance<py::int_>(line)) return std::vector<int>(count, line.cast<int>());
  std::vector<int> lines;
  try {
    lines = line.cast<std::vector<int>>();
  } catch (const py::cast_error&) {
    throw InputError("line: expected a whole number, or one for each setpoint");
  }
  if (lines.size() != count)
    throw InputError(fmt::format("line: {} numbers for {} setpoints", lines.size(), count));
  return lines;
}

Status submit(const Twin& twin, const py::object& times, const py::object& positions,
              const py::object& velocities, const py::object& filament, const py::object& line,
              double deadline) {
  const std::span<const double> t = read_rows(times, {"times", 0, "[s] of the port's clock, increasing"});
  const auto rows = static_cast<py::ssize_t>(t.size());
  const std::size_t n = twin.axis_count();
  const auto columns = static_cast<py::ssize_t>(n);
  const auto q = read_rows(positions, {"positions", columns, "axes [m] or [rad]", rows});
  const auto v = optional_rows(velocities, {"velocities", columns, "axes [m/s] or [rad/s]", rows});
  const auto e = optional_rows(filament, {"filament", 0, "[m] fed since the start", rows});
  const std::vector<int> lines = lines_of(line, t.size());
  std::vector<machine::Setpoint> setpoints(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    machine::Setpoint& setpoint = setpoints[i];
    setpoint.time = t[i];
    std::copy_n(&q[n * i], n, setpoint.position.begin());
    if (!v.empty()) std::copy_n(&v[n * i], n, setpoint.velocity.begin());
    if (!e.empty()) setpoint.filament = e[i];
    setpoint.line = lines[i];
  }
  return twin.without_lock([&](machine::MachinePort& port) { return port.submit(setpoints, deadline); });
}

py::tuple capture(const Twin& twin, const std::optional<std::tuple<int, int, int, int>>& region,
                  double deadline) {
  const machine::MachineDescription& known = twin.whole().setup().machine;
  if (!known.has_microscope)
    throw InputError(fmt::format("machine {} has no microscope to look through", known.name));
  const Camera& camera = known.microscope.camera;
  Region wanted = camera.sensor();
  if (region) std::tie(wanted.x, wanted.y, wanted.width, wanted.height) = *region;
  machine::Frame frame;
  const Status status =
      twin.without_lock([&](machine::MachinePort& port) { return port.capture(wanted, frame, deadline); });
  return py::make_tuple(status, status == Status::ok ? py::cast(std::move(frame)) : py::none());
}

py::array_t<double> axes_of(const machine::AxisVector& axes, std::size_t count) {
  return copied(std::span(axes).first(count));
}

struct State {
  machine::AxisState state;
  std::size_t axis_count;
};

void add_words(py::module_& module) {
  py::enum_<Status>(module, "Status", "What a call of the port answers; look at it.")
      .value("ok", Status::ok)
      .value("queue_full", Status::queue_full, "nothing of the call was queued: wait and call again")
      .value("deadline_exceeded", Status::deadline_exceeded)
      .value("faulted", Status::faulted, "a sticky fault stands: State.fault")
      .value("rejected", Status::rejected, "time not increasing, not finite, beyond the axis range")
      .value("no_frame", Status::no_frame, "the camera delivered nothing");
  using machine::UrgentCommand;
  py::enum_<UrgentCommand>(module, "UrgentCommand", "What bypasses the queue.")
      .value("hold", UrgentCommand::hold)
      .value("resume", UrgentCommand::resume)
      .value("stop", UrgentCommand::stop)
      .value("clear_fault", UrgentCommand::clear_fault);
}

void add_answers(py::module_& module) {
  py::class_<State>(module, "State", "What the drives report at an instant.")
      .def_property_readonly(
          "time", [](const State& s) { return s.state.time; }, "[s], port clock now.")
      .def_property_readonly(
          "sampled_at", [](const State& s) { return s.state.sampled_at; },
          "[s], when `position` was measured.")
      .def_property_readonly(
          "position", [](const State& s) { return axes_of(s.state.position, s.axis_count); },
          "(axes,), as the drives measure [m] or [rad].")
      .def_property_readonly("accepted", [](const State& s) { return s.state.accepted; })
      .def_property_readonly("executed", [](const State& s) { return s.state.executed; })
      .def_property_readonly("free_slots", [](const State& s) { return s.state.free_slots; })
      .def_property_readonly("moving", [](const State& s) { return s.state.moving; })
      .def_property_readonly(
          "fault", [](const State& s) { return std::string(to_string(s.state.fault)); },
          "'no fault', or the words of a sticky one.");
  py::class_<machine::Frame>(module, "Frame", "A picture of the tool's microscope.")
      .def_property_readonly(
          "image", [](const machine::Frame& f) { return picture_of(f.image); },
          "(height, width) uint8, top row first.")
      .def_property_readonly(
          "region",
          [](const machine::Frame& f) {
            return py::make_tuple(f.image.region.x, f.image.region.y, f.image.region.width,
                                  f.image.region.height);
          },
          "x, y, width, height on the sensor [px].")
      .def_readonly("exposed_at", &machine::Frame::exposed_at, "[s], middle of the exposure, port clock.")
      .def_readonly("received_at", &machine::Frame::received_at, "[s].")
      .def_readonly("number", &machine::Frame::number,
                    "Counts exposures; a repeated number is a stale frame.");
}

py::dict deposition_of(const Twin& twin) {
  const sim::DepositionSummary summary = twin.whole().deposition();
  py::dict told;
  told["length"] = summary.length;
  told["in_band_fraction"] = summary.in_band_fraction;
  told["gap_min"] = summary.gap_min;
  told["gap_mean"] = summary.gap_mean;
  told["gap_max"] = summary.gap_max;
  told["deposited_volume"] = summary.deposited_volume;
  return told;
}

py::object optional_number(const std::optional<double>& number) {
  return number ? py::object(py::float_(*number)) : py::none();
}

}  // namespace

void add_twin(py::module_& module) {
  add_words(module);
  add_answers(module);
  py::class_<Twin>(
      module, "Twin",
      "The twin as a MachinePort. Time is the port's: it passes inside wait_until() and capture().")
      .def(py::init<const py::dict&>(), py::arg("options"))
      .def_property_readonly("machine", &Twin::machine, "What the controller knows of the machine.")
      .def_property_readonly("axis_count", [](const Twin& t) { return t.port().axis_count(); })
      .def_property_readonly(
          "now", [](const Twin& t) { return t.port().now(); }, "[s], port clock.")
      .def_property_readonly(
          "state",
          [](const Twin& t) {
            return State{t.port().state(), t.axis_count()};
          },
          "What the drives report now.")
      .def("submit", &submit, py::arg("times"), py::arg("positions"), py::kw_only(),
           py::arg("velocities") = py::none(), py::arg("filament") = py::none(), py::arg("line") = 0,
           py::arg("deadline") = kForever,
           "Queues setpoints, all or none. times (n,) [s], increasing strictly; positions (n, axes) [m] or "
           "[rad]; velocities (n, axes), 0 without; filament (n,) [m] fed since the start, 0 without; line: "
           "of "
           "the program. Between setpoints the port interpolates with position and velocity.")
      .def(
          "wait_until",
          [](const Twin& t, double time) {
            if (!std::isfinite(time)) throw InputError("time: it is not finite");
            return t.without_lock([&](machine::MachinePort& port) { return port.wait_until(time); });
          },
          py::arg("time"), "Lets time pass until the clock shows `time` [s], or a fault stops it.")
      .def(
          "urgent", [](const Twin& t, machine::UrgentCommand command) { return t.port().urgent(command); },
          py::arg("command"), "hold: brake and keep the queue; stop: brake and drop it; resume; clear_fault.")
      .def(
          "set_outputs",
          [](const Twin& t, double temperature, double fan, double deadline) {
            return t.port().set_outputs({temperature, fan}, deadline);
          },
          py::kw_only(), py::arg("nozzle_temperature") = 0.0, py::arg("fan") = 0.0,
          py::arg("deadline") = kForever, "Temperature [K], 0: heater off; fan 0..1.")
      .def("capture", &capture, py::arg("region") = py::none(), py::kw_only(), py::arg("deadline") = kForever,
           "Exposes one frame and waits for it. region: x, y, width, height [px]; None: the sensor. Returns "
           "(Status, Frame or None).")
      .def(
          "true_pose", [](const Twin& t) { return numbers_of(t.whole().true_pose()); },
          "X_WT as it is (7,). For judges: a controller does not know it.")
      .def(
          "true_gap", [](const Twin& t) { return optional_number(t.whole().true_gap()); },
          "[m] along the tool axis, None where nothing lies below. For judges.")
      .def(
          "least_clearance", [](const Twin& t) { return optional_number(t.whole().least_clearance()); },
          "[m], of the nozzle to what it may touch, so far; negative inside. For judges.")
      .def("deposition", &deposition_of, "What was laid so far, in m and m^3. For judges.")
      .def(
          "trace", [](const Twin& t) { return trace_arrays(t.whole().trace(), t.axis_count()); },
          "What happened so far, as Record.trace; programmed_pose is what the setpoints ask for. For "
          "judges.");
}

}  // namespace understudy::python
