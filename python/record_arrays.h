// A record's samples as arrays.
#pragma once

#include <memory>

#include <pybind11/numpy.h>

#include "rehearsal/record.h"

namespace understudy::python {

/// By name; see `Record.trace` in understudy/_core.pyi. SI. Plain numbers are views that keep the record.
pybind11::dict trace_arrays(const std::shared_ptr<rehearsal::Record>& record);

/// The same of points that belong to nobody else.
pybind11::dict trace_arrays(std::vector<rehearsal::TracePoint> trace, std::size_t axis_count);

/// A dict for each look of the controller; gaps [m], pixels on the sensor.
pybind11::list frame_records(const std::shared_ptr<rehearsal::Record>& record);

}  // namespace understudy::python
