// The parts of the module `understudy._core`; each adds its classes and functions. docs/python.md tells what
// users see, understudy/_core.pyi its types.
#pragma once

#include <pybind11/pybind11.h>

namespace understudy::python {

void add_errors(pybind11::module_& module);
void add_machine(pybind11::module_& module);
void add_sight(pybind11::module_& module);
void add_rehearsal(pybind11::module_& module);
void add_twin(pybind11::module_& module);
void add_calibration(pybind11::module_& module);
void add_studies(pybind11::module_& module);

}  // namespace understudy::python
