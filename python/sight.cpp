// What a controller may know of laser and microscope, and the very code that reads the dot in their pictures.
#include <memory>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "control/gap/gap_reading.h"
#include "control/gap/gap_sensor.h"
#include "core/error.h"
#include "machine/fixture_file.h"
#include "python/arrays.h"
#include "python/machine.h"
#include "python/module.h"
#include "rehearsal/fixture.h"
#include "vision/dot/dot.h"

namespace understudy::python {
namespace {

struct Part {
  std::shared_ptr<const geometry::Mesh> mesh;
};

void check_sees(const Machine& machine) {
  if (!machine.description.has_microscope)
    throw InputError(fmt::format("machine {} has no laser and no microscope", machine.description.name));
}

py::dict laser_of(const Machine& machine) {
  check_sees(machine);
  const machine::Laser& laser = machine.description.laser;
  py::dict told;
  told["X_TL"] = matrix_of(laser.X_TL);
  told["waist_diameter"] = laser.waist_diameter;
  told["wavelength"] = laser.wavelength;
  told["peak_level"] = laser.peak_level;
  return told;
}

py::dict microscope_of(const Machine& machine) {
  check_sees(machine);
  const machine::Microscope& seen = machine.description.microscope;
  const Camera& camera = seen.camera;
  py::dict told;
  told["X_TC"] = matrix_of(seen.X_TC);
  told["width"] = camera.width;
  told["height"] = camera.height;
  told["focal_px"] = camera.focal_px;
  told["centre_px"] = copied({camera.centre_px.data(), 2});
  told["distortion"] = py::make_tuple(camera.k1, camera.k2, camera.p1, camera.p2);
  told["exposure"] = seen.exposure;
  told["transfer"] = seen.transfer;
  told["blur_px"] = seen.blur_px;
  return told;
}

constexpr py::ssize_t kSideMax = 65'536;

using Pixels = py::array_t<std::uint8_t, py::array::c_style>;

Image image_of(const py::object& object, const std::tuple<int, int>& corner) {
  if (!py::isinstance<py::array>(object))
    throw InputError(fmt::format("image: a {} is no numpy.ndarray; expected uint8 of shape (height, width)",
                                 Py_TYPE(object.ptr())->tp_name));
  const auto array = py::reinterpret_borrow<py::array>(object);
  if (!array.dtype().equal(py::dtype::of<std::uint8_t>()) || array.ndim() != 2)
    throw InputError(fmt::format("image: {} of {} dimensions, expected uint8 of shape (height, width)",
                                 std::string(py::str(array.dtype())), array.ndim()));
  for (const py::ssize_t d : {0, 1})
    if (array.shape(d) > kSideMax)
      throw InputError(fmt::format("image: {} pixels a side, at most {}", array.shape(d), kSideMax));
  const Pixels pixels(object);  // one after the other, whatever slice it was
  Image image;
  image.region = {std::get<0>(corner), std::get<1>(corner), static_cast<int>(pixels.shape(1)),
                  static_cast<int>(pixels.shape(0))};
  image.pixels.assign(pixels.data(), pixels.data() + pixels.size());
  return image;
}

py::dict dot_in(const Machine& machine, const py::object& object, const std::tuple<int, int>& corner) {
  check_sees(machine);
  const vision::DotMeasurement dot =
      vision::measure_dot(image_of(object, corner), control::dot_options(machine.description));
  py::dict told;
  told["status"] = vision::to_string(dot.status);
  told["position_px"] = copied({dot.position_px.data(), 2});
  told["covariance_px2"] = copied({dot.covariance_px2.data(), 4}, 2);  // symmetric
  told["spread_px2"] = copied({dot.spread_px2.data(), 4}, 2);
  told["contrast"] = dot.contrast;
  told["radius_px"] = dot.radius_px;
  told["saturated_fraction"] = dot.saturated_fraction;
  return told;
}

Part part_of(const Machine& machine, const std::string& part) {
  return {rehearsal::read_fixture(machine::find_fixture(part), machine.description)};
}

Pose pose_argument(const py::object& pose) {
  return pose_of(read_rows(pose, {"pose", 0, "x y z [m], qw qx qy qz", 7}), "pose");
}

/// Slope and curvature of the drawn part under the tool.
py::tuple surface_under(const Part& part, const py::object& pose) {
  const control::LocalSurface surface = control::local_surface(*part.mesh, pose_argument(pose));
  return py::make_tuple(copied({surface.slope.data(), 2}), copied({surface.curvature.data(), 4}, 2));
}

py::object height_over(const Part& part, const py::object& pose) {
  const auto height = control::height_over(*part.mesh, pose_argument(pose));
  return height ? py::object(py::float_(*height)) : py::none();
}

/// The controller's own reading of a picture, where a script does not want to make one.
py::object gap_in(const Machine& machine, const Part* part, const py::object& pose, const py::object& image,
                  const std::tuple<int, int>& corner) {
  check_sees(machine);
  const control::LocalSurface surface =
      part ? control::local_surface(*part->mesh, pose_argument(pose)) : control::LocalSurface{};
  const vision::DotMeasurement dot =
      vision::measure_dot(image_of(image, corner), control::dot_options(machine.description));
  control::GapReading reading;
  if (dot.status != vision::DotStatus::ok || !control::read_gap(machine.description, surface, dot, reading))
    return py::none();
  return py::make_tuple(reading.gap, reading.sigma);
}

}  // namespace

void add_sight(py::module_& module) {
  module.def("laser", &laser_of, py::arg("machine"),
             "The laser as the machine's file has it: X_TL (4, 4), z along the beam; waist_diameter and "
             "wavelength [m].");
  module.def("microscope", &microscope_of, py::arg("machine"),
             "The camera as the machine's file has it: X_TC (4, 4), z forward, x right, y down; focal_px, "
             "centre_px, distortion (k1, k2, p1, p2), exposure and transfer [s].");
  module.def(
      "measure_dot", &dot_in, py::arg("machine"), py::arg("image"), py::arg("corner") = py::make_tuple(0, 0),
      "Where the laser's dot is in a picture (height, width) of uint8, whose first pixel is `corner` of "
      "the sensor: position_px on the sensor, with covariance.");
  module.def(
      "read_gap", &gap_in, py::arg("machine"), py::arg("part"), py::arg("pose"), py::arg("image"),
      py::arg("corner") = py::make_tuple(0, 0),
      "(gap, sigma) [m] as our controller reads it with the drawn part under X_WT = pose; part None: a "
      "plane across the tool. None where there is no dot, or no gap explains it.");
  py::class_<Part>(module, "Part", "A drawn part in W: what a controller knows of it.")
      .def(py::init(&part_of), py::arg("machine"), py::arg("part"),
           "The path of an STL in mm, or a name under models/parts.")
      .def("surface_under", &surface_under, py::arg("pose"),
           "(slope (2,), curvature (2, 2) [1/m]) in T around the point under the tool, the tip at gap 0 on "
           "it: z = slope . xy + 1/2 xy curvature xy.")
      .def("height_over", &height_over, py::arg("pose"),
           "[m], of the tip over the part along the tool axis; None where that does not meet it.");
}

}  // namespace understudy::python
