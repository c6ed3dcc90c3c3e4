// Errors of the rooms as exceptions of Python, with the text that the command prints.
#include <exception>

#include "core/error.h"
#include "python/module.h"

namespace understudy::python {
namespace py = pybind11;
namespace {

/// Of the module, which outlives them all.
PyObject *input_error = nullptr, *machine_error = nullptr;

void raise_input_error(const InputError& error) {
  const py::object raised = py::reinterpret_borrow<py::object>(input_error)(error.what());
  const Place& place = error.place();
  raised.attr("file") = place.file.empty() ? py::object(py::none()) : py::str(place.file);
  raised.attr("line") = place.line == 0 ? py::object(py::none()) : py::int_(place.line);
  raised.attr("column") = place.column == 0 ? py::object(py::none()) : py::int_(place.column);
  PyErr_SetObject(input_error, raised.ptr());
}

PyObject* add_error(py::module_& module, const char* name, PyObject* base, const char* about) {
  const std::string whole = std::string("understudy.") + name;
  PyObject* const type = PyErr_NewExceptionWithDoc(whole.c_str(), about, base, nullptr);
  if (!type) throw py::error_already_set();
  module.attr(name) = py::reinterpret_borrow<py::object>(type);
  return type;
}

}  // namespace

void add_errors(py::module_& module) {
  input_error = add_error(module, "InputError", PyExc_ValueError,
                          "A user's mistake: a file, an option, an array. `file`, `line` and `column` say "
                          "where, None where there is no such place. The command ends with status 2.");
  machine_error = add_error(module, "MachineError", PyExc_RuntimeError,
                            "The machine or the engine failed. The command ends with status 3.");
  // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 gives its translators a copy
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      raise_input_error(error);
    } catch (const MachineError& error) {
      PyErr_SetString(machine_error, error.what());
    } catch (const Interrupted& error) {
      PyErr_SetString(PyExc_KeyboardInterrupt, error.what());
    }
  });
}

}  // namespace understudy::python
