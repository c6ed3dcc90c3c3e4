#include "python/long_work.h"

#include <chrono>
#include <exception>
#include <future>
#include <memory>

#include "core/interrupt.h"

namespace understudy::python {
namespace py = pybind11;
namespace {

constexpr auto kLook = std::chrono::milliseconds(50);
constexpr auto kTell = std::chrono::milliseconds(100);

/// The work's flag is down again, whatever came of it.
struct Flag {
  ~Flag() { set_interrupted(false); }
};

bool signal_raised() {
  const py::gil_scoped_acquire with_lock;
  return PyErr_CheckSignals() != 0;
}

}  // namespace

void run_long(const std::function<void()>& work) {
  const Flag flag;
  bool raised = false;
  std::exception_ptr failure;
  {
    const py::gil_scoped_release without_lock;
    std::future<void> done = std::async(std::launch::async, work);
    while (done.wait_for(kLook) != std::future_status::ready) {
      if (raised || !signal_raised()) continue;
      raised = true;
      set_interrupted(true);
    }
    try {
      done.get();
    } catch (...) {
      failure = std::current_exception();
    }
  }
  if (raised) throw py::error_already_set();
  if (failure) std::rethrow_exception(failure);
}

Progress told_to(const py::object& callback) {
  if (callback.is_none()) return {};
  // The last owner may be a thread without the lock.
  const std::shared_ptr<py::object> kept(new py::object(callback), [](py::object* of) {
    const py::gil_scoped_acquire with_lock;
    delete of;
  });
  return
      [kept, last = std::chrono::steady_clock::time_point()](double share, const std::string& what) mutable {
        const auto now = std::chrono::steady_clock::now();
        if (share < 1 && now - last < kTell) return;
        last = now;
        const py::gil_scoped_acquire with_lock;
        (*kept)(share, what);
      };
}

}  // namespace understudy::python
