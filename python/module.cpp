#include "python/module.h"

#include <opencv2/core/utility.hpp>

#include "core/simd.h"
#include "core/version.h"

PYBIND11_MODULE(_core, module) {
  using namespace understudy;
  // The same bytes whatever the number of cores, as the command has it.
  cv::setNumThreads(1);
  cv::setUseOptimized(false);
  module.doc() = "Understudy's rooms as Python sees them. SI units: m, rad, s; poses are x y z, w x y z.";
  module.attr("__version__") = kVersion;
  python::add_errors(module);
  simd();  // refuses a choice that is none
  python::add_machine(module);
  python::add_sight(module);
  python::add_rehearsal(module);
  python::add_twin(module);
  python::add_calibration(module);
  python::add_studies(module);
}
