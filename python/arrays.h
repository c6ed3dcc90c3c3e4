// NumPy arrays as the rooms take numbers: in place where they are read and where they are answered. What is
// not of the type, shape and order that is asked for is refused by its name, never converted in silence.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <pybind11/numpy.h>

#include "core/frames.h"
#include "core/image.h"

namespace understudy::python {

namespace py = pybind11;

/// What an array shall be: "poses", 7 columns, "x y z [m], qw qx qy qz".
struct RowsWanted {
  const char* name;
  py::ssize_t columns;  ///< 0: one number a row
  std::string about;
  py::ssize_t rows = -1;  ///< -1: any
};

/// The numbers of a C-contiguous float64 array of `wanted` shape. Throws InputError that names the array and
/// what is wrong with it: no array, its type, its shape, its order, or that it may not be written.
std::span<const double> read_rows(const py::handle& array, const RowsWanted& wanted);
std::span<double> write_rows(const py::handle& array, const RowsWanted& wanted);

/// `out` where it is given, checked; else a new array.
py::array rows_or_new(const std::optional<py::array>& out, const RowsWanted& wanted);

/// A read-only view of numbers that `owner` keeps: `count` of them, each `stride` bytes after the other.
py::array view_of(const double* first, py::ssize_t count, py::ssize_t stride, const py::object& owner);
/// The same of rows of `columns` numbers that lie side by side.
py::array view_of_rows(const double* first, py::ssize_t count, py::ssize_t columns, py::ssize_t stride,
                       const py::object& owner);

/// A new array of these numbers; `columns` 0: of one dimension.
py::array_t<double> copied(std::span<const double> numbers, py::ssize_t columns = 0);
/// 4 x 4, by rows.
py::array_t<double> matrix_of(const Pose& pose);
/// x y z, w x y z with w not negative.
py::array_t<double> numbers_of(const Pose& pose);
/// Of seven numbers. Throws InputError where the quaternion is not of unit length.
Pose pose_of(std::span<const double> numbers, const char* name);

/// Grey levels, one row a line, top first; owns its numbers.
py::array_t<std::uint8_t> picture_of(const Image& image);

}  // namespace understudy::python
