#include "python/arrays.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "machine/pose_array.h"

namespace understudy::python {
namespace {

std::string shape_of(const py::array& array) {
  std::string text;
  for (py::ssize_t d = 0; d < array.ndim(); ++d) text += fmt::format("{}{}", d ? ", " : "", array.shape(d));
  return fmt::format("({}{})", text, array.ndim() == 1 ? "," : "");
}

std::string shape_of(const RowsWanted& wanted) {
  const std::string rows = wanted.rows < 0 ? "n" : std::to_string(wanted.rows);
  return wanted.columns == 0 ? fmt::format("({},)", rows) : fmt::format("({}, {})", rows, wanted.columns);
}

bool has_shape(const py::array& array, const RowsWanted& wanted) {
  if (array.ndim() != (wanted.columns == 0 ? 1 : 2)) return false;
  return (wanted.rows < 0 || array.shape(0) == wanted.rows) &&
         (wanted.columns == 0 || array.shape(1) == wanted.columns);
}

[[noreturn]] void refuse(const RowsWanted& wanted, const std::string& why) {
  throw InputError(fmt::format("{}: {}", wanted.name, why));
}

py::array checked(const py::handle& object, const RowsWanted& wanted) {
  if (!py::isinstance<py::array>(object))
    refuse(wanted, fmt::format("a {} is no numpy.ndarray; expected float64 of shape {}: {}",
                               Py_TYPE(object.ptr())->tp_name, shape_of(wanted), wanted.about));
  const auto array = py::reinterpret_borrow<py::array>(object);
  if (!py::dtype::of<double>().is(array.dtype()) && !array.dtype().equal(py::dtype::of<double>()))
    refuse(wanted, fmt::format("of type {}, expected float64: {}.astype(numpy.float64) makes a copy of it",
                               std::string(py::str(array.dtype())), wanted.name));
  if (!has_shape(array, wanted))
    refuse(wanted,
           fmt::format("of shape {}, expected {}: {}", shape_of(array), shape_of(wanted), wanted.about));
  if (!(array.flags() & py::array::c_style))
    refuse(wanted, fmt::format("its rows do not lie one after the other (strides of Fortran order, or of a "
                               "slice), expected C order: numpy.ascontiguousarray({}) makes a copy of it",
                               wanted.name));
  if (reinterpret_cast<std::uintptr_t>(array.data()) % alignof(double) != 0)
    refuse(wanted, "its numbers are not aligned: numpy.require(..., requirements='CA') makes a copy of it");
  return array;
}

}  // namespace

std::span<const double> read_rows(const py::handle& object, const RowsWanted& wanted) {
  const py::array array = checked(object, wanted);
  return {static_cast<const double*>(array.data()), static_cast<std::size_t>(array.size())};
}

std::span<double> write_rows(const py::handle& object, const RowsWanted& wanted) {
  py::array array = checked(object, wanted);
  if (!array.writeable()) refuse(wanted, "it may not be written");
  return {static_cast<double*>(array.mutable_data()), static_cast<std::size_t>(array.size())};
}

py::array rows_or_new(const std::optional<py::array>& out, const RowsWanted& wanted) {
  if (out) {
    write_rows(*out, wanted);
    return *out;
  }
  if (wanted.columns == 0) return py::array_t<double>(wanted.rows);
  return py::array_t<double>({wanted.rows, wanted.columns});
}

namespace {

py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace

py::array view_of(const double* first, py::ssize_t count, py::ssize_t stride, const py::object& owner) {
  return read_only(py::array(py::dtype::of<double>(), {count}, {stride}, first, owner));
}

py::array view_of_rows(const double* first, py::ssize_t count, py::ssize_t columns, py::ssize_t stride,
                       const py::object& owner) {
  const auto step = static_cast<py::ssize_t>(sizeof(double));
  return read_only(py::array(py::dtype::of<double>(), {count, columns}, {stride, step}, first, owner));
}

py::array_t<double> copied(std::span<const double> numbers, py::ssize_t columns) {
  const auto size = static_cast<py::ssize_t>(numbers.size());
  py::array_t<double> array = columns == 0
                                  ? py::array_t<double>(size)
                                  : py::array_t<double>({size / std::max<py::ssize_t>(1, columns), columns});
  std::copy(numbers.begin(), numbers.end(), array.mutable_data());
  return array;
}

py::array_t<double> matrix_of(const Pose& pose) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = pose.matrix();
  return copied({rows.data(), 16}, 4);
}

py::array_t<double> numbers_of(const Pose& pose) {
  py::array_t<double> array(static_cast<py::ssize_t>(machine::kPoseNumbers));
  kinematics::write_pose(pose, array.mutable_data());
  return array;
}

Pose pose_of(std::span<const double> numbers, const char* name) {
  Pose pose;
  if (kinematics::read_pose(numbers.data(), pose)) return pose;
  const double length =
      std::sqrt(std::inner_product(numbers.begin() + 3, numbers.begin() + 7, numbers.begin() + 3, 0.0));
  throw InputError(fmt::format("{}: the quaternion's length is {:.6f}, not 1 within {:g}", name, length,
                               kinematics::kUnitQuaternion));
}

py::array_t<std::uint8_t> picture_of(const Image& image) {
  py::array_t<std::uint8_t> picture({image.height(), image.width()});
  std::copy(image.pixels.begin(), image.pixels.end(), picture.mutable_data());
  return picture;
}

}  // namespace understudy::python
