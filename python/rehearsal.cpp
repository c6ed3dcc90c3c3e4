// Rehearsals and their records.
#include <memory>
#include <string>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "core/file/output_folder.h"
#include "python/arrays.h"
#include "python/long_work.h"
#include "python/module.h"
#include "python/record_arrays.h"
#include "python/request_options.h"
#include "rehearsal/rehearse.h"
#include "report/page/write_results.h"
#include "report/summary_json.h"
#include "report/trace/trace_csv.h"

namespace understudy::python {
namespace {

using rehearsal::Record;
using SharedRecord = std::shared_ptr<Record>;

SharedRecord rehearse(const std::string& program, const py::dict& options, const py::object& progress) {
  const rehearsal::RehearsalRequest request = request_of(program, options);
  const auto record = std::make_shared<Record>();
  const Progress tell = told_to(progress);
  run_long([&] { *record = rehearsal::rehearse(request, tell); });
  return record;
}

/// The folder that the command writes, complete or not at all.
void write(const SharedRecord& record, const std::string& folder) {
  run_long([&] {
    OutputFolder out(folder);
    report::write_results(*record, report::pictures_of(*record), out.path());
    out.commit();
  });
}

py::object parsed(const std::string& json) { return py::module_::import("json").attr("loads")(json); }

}  // namespace

void add_rehearsal(py::module_& module) {
  module.def("rehearse", &rehearse, py::arg("program"), py::arg("options"), py::arg("progress") = py::none());
  py::class_<Record, SharedRecord>(module, "Record",
                                   "What a rehearsal found out: what the command writes into its folder.")
      .def_property_readonly(
          "go", [](const Record& r) { return r.go; }, "The verdict.")
      .def_property_readonly("title", [](const Record& r) { return r.title; })
      .def_property_readonly(
          "command", [](const Record& r) { return r.provenance.command; },
          "The command line that makes the same results.")
      .def_property_readonly("summary_json", &report::summary_json, "The bytes of summary.json.")
      .def_property_readonly(
          "summary", [](const Record& r) { return parsed(report::summary_json(r)); },
          "summary.json as a dict, in the units of files: each key names its own.")
      .def_property_readonly(
          "findings",
          [](const Record& r) -> py::object { return parsed(report::summary_json(r))["findings"]; },
          "Of the summary: a dict each, errors first.")
      .def_property_readonly("trace_csv", &report::trace_csv, "The bytes of trace.csv.")
      .def_property_readonly(
          "trace", [](const SharedRecord& r) { return trace_arrays(r); },
          "Arrays of the trace by name, SI, one row an instant: truth beside command. Those "
          "of plain numbers are read-only views into the record.")
      .def_property_readonly(
          "frames", &frame_records,
          "The microscope's pictures that the controller looked at, the truth beside them.")
      .def("write", &write, py::arg("folder"),
           "Writes the results of `understudy rehearse --out FOLDER`: whole, or not at all.")
      .def("__repr__", [](const Record& r) {
        return fmt::format("<understudy.Record {}: {}, {} findings>", r.title, r.go ? "GO" : "NO-GO",
                           r.findings.size());
      });
}

}  // namespace understudy::python
