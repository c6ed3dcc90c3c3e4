// Work that takes its time: without the interpreter's lock, and Ctrl-C ends it as it ends the command.
#pragma once

#include <functional>

#include <pybind11/pybind11.h>

#include "core/progress.h"

namespace understudy::python {

/// Runs `work` on a thread of its own, while this one looks for signals. What `work` throws comes out; of a
/// signal's handler that raises, that comes out once `work` has stopped. Called with the lock, which is free
/// meanwhile.
void run_long(const std::function<void()>& work);

/// Calls `callback(share, what)` at most ten times a second, with the lock; None: nothing.
Progress told_to(const pybind11::object& callback);

}  // namespace understudy::python
