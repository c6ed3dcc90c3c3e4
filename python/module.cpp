#include "python/module.h"

#include "core/simd.h"
#include "core/version.h"
#include "vision/plain_instructions.h"

PYBIND11_MODULE(_core, module) {
  using namespace understudy;
  // The same bytes whatever the number of cores, as the command has it.
  vision::hold_opencv_to_plain_instructions();
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
