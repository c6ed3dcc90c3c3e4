#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "cli/options/seed_option.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/staged_file.h"
#include "core/units.h"
#include "report/picture/render_images.h"

namespace understudy::cli {
namespace {

constexpr double kUnitTolerance = 1e-4;  // as in G-code

struct RenderCall {
  report::RenderRequest request;
  std::vector<double> pose;
  std::string output;
};

Pose pose_of(const std::vector<double>& v) {
  for (const double x : v)
    if (!std::isfinite(x) || std::abs(x) > 1e5) throw InputError(fmt::format("--pose holds {:g}", x));
  const Quat q(v[3], v[4], v[5], v[6]);
  if (std::abs(q.norm() - 1) > kUnitTolerance)
    throw InputError(fmt::format("--pose: the quaternion's length is {:.6f}, not 1 within {:g}", q.norm(),
                                 kUnitTolerance));
  return make_pose(q.normalized(), from_mm(1) * Vec3(v[0], v[1], v[2]));
}

int run_render(const RenderCall& call) {
  report::RenderRequest request = call.request;
  if (!call.pose.empty()) request.X_WT = pose_of(call.pose);
  request.command = command_line();
  const std::filesystem::path path(call.output);
  if (path.extension() != ".png") throw InputError(fmt::format("{}: a picture ends in .png", call.output));
  std::filesystem::path truth = path;
  truth.replace_extension(".json");
  for (const auto& output : {path, truth}) check_writable(output);
  const report::RenderedImage image = report::render_image(request);
  StagedFile picture(path, image.png), its_truth(truth, image.truth);
  its_truth.commit();
  picture.commit();
  fmt::print("{}\n{}\n", path.string(), truth.string());
  return kGood;
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
  auto call = std::make_shared<RenderCall>();
  auto* command = app.add_subcommand("render", "One picture of the twin's cameras, with its truth");
  command->add_option("kind", call->request.kind, "laser, chessboard, targets or scene")
      ->required()
      ->check(CLI::IsMember({"laser", "chessboard", "targets", "scene"}));
  add_machine_option(*command, call->request.machine);
  command
      ->add_option("--pose", call->pose,
                   "x,y,z,qw,qx,qy,qz in mm: the tool's true pose in the frame of programs")
      ->delimiter(',')
      ->expected(7);
  command->add_option("--camera", call->request.camera, "0 or 1, of chessboard and targets")
      ->capture_default_str();
  command->add_option("--layer", call->request.layer, "0 (nearest) to 10, of the chessboard")
      ->capture_default_str();
  command->add_option("--seed", call->request.seed, "of noise and surface")
      ->check(seed_check())
      ->capture_default_str();
  command->add_option("-o,--output", call->output, "IMAGE.png; its truth goes to IMAGE.json")->required();
  command->footer("Without --pose: home; laser: above the table, at the gap that the machine aims at.");
  command->callback([=, &action] { action = [=] { return run_render(*call); }; });
}

}  // namespace understudy::cli
