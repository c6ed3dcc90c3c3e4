#include "machine/accepted_errors.h"

#include "core/units.h"

namespace understudy::machine {
namespace {

constexpr double kOrientation = 5 * kDegree;
constexpr double kMilled = 0.1e-3;  // [m]

}  // namespace

AcceptedErrors default_accepted_errors(const Tool& tool) {
  return {tool.prints() ? tool.nozzle_diameter : kMilled, kOrientation};
}

void read_accepted_errors(YamlMap& map, AcceptedErrors& errors) {
  errors.tip = map.quantity("tip_mm", {0.001, 100}, "largest distance of the true tip from the programmed");
  errors.orientation =
      map.quantity("orientation_deg", {0.001, 90}, "largest angle of the true tool to the programmed");
}

}  // namespace understudy::machine
