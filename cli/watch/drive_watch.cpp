#include "cli/drive_watch.h"

#include <algorithm>
#include <filesystem>

#include "cli/watch/watched_run.h"
#include "rehearsal/axis_columns.h"

namespace understudy::cli {
namespace {

constexpr const char* kNote =
    "The curves are what the machine says of its axes, and where these put the tip by the controller's "
    "geometry; gap and errors are not known.";

class PageOfDrive final : public DriveWatch {
 public:
  PageOfDrive(const machine::MachineDescription& machine, const std::string& program, int port)
      : run_(port), mechanism_(machine.make_mechanism()), X_WB_(machine.X_WB), X_BT_(machine.X_BT_home) {
    rehearsal::Record described;
    described.program_name = std::filesystem::path(program).filename().string();
    described.machine_name = machine.name;
    described.title = described.program_name + " on " + machine.name;
    described.axes = rehearsal::axis_columns(*mechanism_);
    run_.record.begins_motion(described, kNote);
    run_.record.progress(0, "checking the machine");
  }

  void moved(const SeenMotion& seen) override {
    rehearsal::TracePoint point;
    point.time = seen.state.time;
    point.line = seen.line;
    point.axes = seen.state.position;
    const auto axes =
        std::span<const double>(point.axes).first(static_cast<std::size_t>(mechanism_->axis_count()));
    Pose X_BT;
    if (mechanism_->forward(axes, X_BT_, X_BT) == kinematics::SolveStatus::ok) X_BT_ = X_BT;
    point.X_WT = point.X_WT_programmed = X_WB_ * X_BT_;
    point.extruding = seen.filament > filament_;
    filament_ = std::max(filament_, seen.filament);
    if (point.extruding && begun_) path_ += (point.X_WT.translation() - tip_).norm();
    point.path = path_;
    tip_ = point.X_WT.translation();
    begun_ = true;
    run_.record.moved(point);
  }

  void progress(double share) override { run_.record.progress(share, "printing"); }
  void complete() override { run_.server.end("The print is complete."); }

 private:
  WatchedRun run_;
  std::shared_ptr<const kinematics::Mechanism> mechanism_;
  Pose X_WB_, X_BT_;
  Vec3 tip_ = Vec3::Zero();
  double filament_ = 0, path_ = 0;  // [m]
  bool begun_ = false;
};

}  // namespace

std::unique_ptr<DriveWatch> watch_drive(const machine::MachineDescription& machine,
                                        const std::string& program, int port) {
  return std::make_unique<PageOfDrive>(machine, program, port);
}

}  // namespace understudy::cli
