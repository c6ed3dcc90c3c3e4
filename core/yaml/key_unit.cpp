#include "core/yaml/key_unit.h"

#include <array>

#include "core/units.h"

namespace understudy {
namespace {

// A suffix that ends in another stands before it.
constexpr std::array kUnits{
    KeyUnit{"_n_per_um", " N/um", 1 / kMicrometre},
    KeyUnit{"_nm_per_rad", " N m/rad", 1},
    KeyUnit{"_newton_metre", " N m", 1},
    KeyUnit{"_deg_per_s2", " deg/s^2", kDegree},
    KeyUnit{"_mm_per_s2", " mm/s^2", kMillimetre},
    KeyUnit{"_mm_per_s", " mm/s", kMillimetre},
    KeyUnit{"_deg_per_s", " deg/s", kDegree},
    KeyUnit{"_m_per_s", " m/s", 1},
    KeyUnit{"_kg_mm2", " kg mm^2", kMillimetre* kMillimetre},
    KeyUnit{"_px_per_mm", " px/mm", 1 / kMillimetre},
    KeyUnit{"_mm", " mm", kMillimetre},
    KeyUnit{"_um", " um", kMicrometre},
    KeyUnit{"_nm", " nm", 1e-9},
    KeyUnit{"_mrad", " mrad", 1e-3},
    KeyUnit{"_permille", " permille", 1e-3},
    KeyUnit{"_percent", " percent", 1e-2},
    KeyUnit{"_arcmin", " arcmin", kDegree / 60},
    KeyUnit{"_deg", " deg", kDegree},
    KeyUnit{"_hz", " Hz", 1},
    KeyUnit{"_n", " N", 1},
    KeyUnit{"_kg", " kg", 1},
    KeyUnit{"_ms", " ms", 1e-3},
    KeyUnit{"_s", " s", 1},
    KeyUnit{"_px", " px", 1},
    KeyUnit{"_levels", " grey levels", 1},
    KeyUnit{"_electrons", " electrons", 1},
    KeyUnit{"_kg_per_m3", " kg/m^3", 1},
    KeyUnit{"_j_per_kg_k", " J/(kg K)", 1},
    KeyUnit{"_w_per_m_k", " W/(m K)", 1},
    KeyUnit{"_gpa", " GPa", 1e9},
    KeyUnit{"_k", " K", 1},
    KeyUnit{"_c", " C", 1},  // the zero of the scale is the reader's to shift
};

}  // namespace

KeyUnit unit_of(std::string_view key) {
  for (const KeyUnit& unit : kUnits)
    if (key.ends_with(unit.suffix)) return unit;
  return {"", "", 1};
}

}  // namespace understudy
