#include "cli/plan/plan_options.h"

namespace understudy::cli {

void add_plan(CLI::App& app, Action& action) {
  auto* plan = app.add_subcommand("plan", "Make a program for a part");
  plan->require_subcommand(1);
  add_plan_surface(*plan, action);
  add_plan_planar(*plan, action);
  add_plan_waypoints(*plan, action);
  add_plan_lattice(*plan, action);
  add_plan_spiral(*plan, action);
  add_plan_support_free(*plan, action);
  add_plan_finishing(*plan, action);
}

}  // namespace understudy::cli
