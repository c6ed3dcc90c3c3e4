#include "machine/optics_mounting.h"

#include <array>

#include "core/units.h"

namespace understudy::machine {
namespace {

enum class Kind { offset, turn, scale };

struct Freedom {
  const char* name;
  Kind kind;
};

constexpr std::array<Freedom, kMountingFreedoms> kFreedoms{{{"laser offset x", Kind::offset},
                                                            {"laser offset y", Kind::offset},
                                                            {"laser turn x", Kind::turn},
                                                            {"laser turn y", Kind::turn},
                                                            {"camera offset x", Kind::offset},
                                                            {"camera offset y", Kind::offset},
                                                            {"camera offset z", Kind::offset},
                                                            {"camera turn x", Kind::turn},
                                                            {"camera turn y", Kind::turn},
                                                            {"camera turn z", Kind::turn},
                                                            {"picture scale", Kind::scale}}};

const Freedom& freedom(int index) { return kFreedoms[static_cast<std::size_t>(index)]; }

}  // namespace

OpticsMounting mounting_of(const MachineDescription& machine) {
  return {machine.laser.X_TL, machine.microscope.X_TC, machine.microscope.camera.focal_px};
}

OpticsMounting drawn_mounting(const MachineDescription& machine) {
  return machine.gap_sensor ? machine.gap_sensor->drawn : mounting_of(machine);
}

double drawn_waist(const MachineDescription& machine) {
  const bool measured = machine.gap_sensor && machine.gap_sensor->waist;
  return measured ? machine.gap_sensor->waist->drawn : machine.laser.waist_diameter;
}

OpticsMounting moved(const OpticsMounting& from, const MountingVector& error) {
  const Pose X_LL = make_pose(exp_rotation(Vec3(error[2], error[3], 0)), Vec3(error[0], error[1], 0));
  const Pose X_CC = make_pose(exp_rotation(error.segment<3>(7)), error.segment<3>(4));
  return {from.X_TL * X_LL, from.X_TC * X_CC, from.focal_px * (1 + error[10])};
}

void set_mounting(const OpticsMounting& mounting, Laser& laser, Microscope& microscope) {
  laser.X_TL = mounting.X_TL;
  microscope.X_TC = mounting.X_TC;
  microscope.camera.focal_px = mounting.focal_px;
}

void set_distortion(const std::vector<double>& brown, Camera& camera) {
  camera.k1 = brown[0];
  camera.k2 = brown[1];
  camera.p1 = brown[2];
  camera.p2 = brown[3];
}

double picture_scale(const MachineDescription& machine) {
  const Laser& laser = machine.laser;
  const Microscope& microscope = machine.microscope;
  const Vec3 b = laser.X_TL.linear().col(2), o = laser.X_TL.translation();
  const Vec3 crossing_C = microscope.X_TC.inverse() * Vec3(o - o.z() / b.z() * b);
  return microscope.camera.focal_px / crossing_C.z();
}

MountingVector mounting_sigmas(const MountingTolerances& tolerances) {
  MountingVector sigmas;
  for (int i = 0; i < kMountingFreedoms; ++i) {
    const Kind kind = freedom(i).kind;
    sigmas[i] = kind == Kind::offset ? tolerances.position
                : kind == Kind::turn ? tolerances.angle
                                     : tolerances.scale;
  }
  return sigmas;
}

const char* mounting_freedom(int index) { return freedom(index).name; }

double mounting_file_unit(int index) { return freedom(index).kind == Kind::offset ? kMillimetre : 1; }

const char* mounting_report_unit(int index, double& si) {
  const Kind kind = freedom(index).kind;
  si = kind == Kind::offset ? kMicrometre : 1e-3;
  return kind == Kind::offset ? "um" : kind == Kind::turn ? "mrad" : "permille";
}

}  // namespace understudy::machine
