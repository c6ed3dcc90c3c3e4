#include "control/program/rotary_words.h"

#include <charconv>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "core/assert.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::control {
namespace {

using kinematics::SolveStatus;

void expect_ok(SolveStatus status) {
  UNDERSTUDY_ASSERT(status == SolveStatus::ok,
                    "a program's numbers are finite, and the mechanism has rotary words");
}

constexpr double kLongestHead = 5;  // [m]

/// The length behind the colon of "head:60". [m]
double head_length(const std::string& word, const std::string& kind) {
  double length_mm = 0;
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data() + kind.size() + 1, end, length_mm);
  if (error != std::errc() || rest != end || !(std::abs(from_mm(length_mm)) <= kLongestHead))
    throw InputError(fmt::format("coordinates '{}': {}:L needs L, the pivot above the tip, within {:g} mm",
                                 word, kind, to_mm(kLongestHead)));
  return from_mm(length_mm);
}

/// Slides of a machine whose head tilts. Of what the words turn together, `below` is the table's part.
void read_as_head(double length, bool second_is_table, toolpath::RotaryWords& rotary) {
  const Vec3 tip(0, 0, -length);
  const auto turned = [tip_pose = rotary.tip_pose](double b, double c) -> Mat3 {
    return tip_pose(Vec3::Zero(), b, c).linear() * tip_pose(Vec3::Zero(), 0, 0).linear().transpose();
  };
  rotary.coordinates = toolpath::RotaryWords::Coordinates::crossing;
  rotary.crossing = [turned, tip, second_is_table](double b, double c) -> Pose {
    const Mat3 table = second_is_table ? turned(0, c) : Mat3(Mat3::Identity());
    return make_pose(table, Vec3(turned(b, c) * tip - table * tip));
  };
}

}  // namespace

void set_coordinates(const std::string& word, toolpath::RotaryWords& rotary) {
  using Coordinates = toolpath::RotaryWords::Coordinates;
  if (word == "tip")
    rotary.coordinates = Coordinates::tip;
  else if (word == "machine")
    rotary.coordinates = Coordinates::machine;
  else if (word == "crossing")
    rotary.coordinates = Coordinates::crossing;
  else if (word.starts_with("head:"))
    read_as_head(head_length(word, "head"), true, rotary);
  else if (word.starts_with("double-head:"))
    read_as_head(head_length(word, "double-head"), false, rotary);
  else
    throw InputError("coordinates '" + word + "': one of tip, machine, crossing, head:MM, double-head:MM");
}

std::optional<toolpath::RotaryWords> rotary_words(const machine::MachineDescription& machine) {
  const std::shared_ptr<const kinematics::Mechanism> mechanism = machine.make_mechanism();
  const auto words = mechanism->rotary_words();
  if (words.empty()) return std::nullopt;
  const machine::ProgramDialect& dialect = machine.dialect;
  const Pose X_WB = machine.X_WB, X_BW = X_WB.inverse();
  toolpath::RotaryWords rotary;
  rotary.letters = words[0].letter;
  rotary.b_home = words[0].home;
  rotary.b_unit = dialect.turn_units[0];
  if (words.size() > 1) {
    rotary.letters += words[1].letter;
    rotary.c_home = words[1].home;
    rotary.c_unit = dialect.turn_units[1];
  }
  rotary.tip_commands = dialect.tip_control_on;
  rotary.machine_commands = dialect.tip_control_off;
  rotary.tip_pose = [mechanism, X_WB, X_BW](const Vec3& p_WT, double b, double c) -> Pose {
    Pose X_BT = Pose::Identity();
    expect_ok(mechanism->pose_at_turns({X_BW * p_WT, b, c}, X_BT));
    return X_WB * X_BT;
  };
  rotary.crossing = [mechanism, X_WB, pivot = dialect.pivot_W, tip = dialect.tip_from_pivot_W](
                        double b, double c) -> Pose {
    Mat3 table_B, head_B;
    expect_ok(mechanism->parts_at_turns({Vec3::Zero(), b, c}, table_B, head_B));
    const Mat3 R_WB = X_WB.linear(), table = R_WB * table_B * R_WB.transpose(),
               head = R_WB * head_B * R_WB.transpose();
    return make_pose(table, Vec3(pivot + table * (head * tip - tip)));
  };
  set_coordinates(dialect.coordinates, rotary);
  if (!mechanism->has_slide_words()) return rotary;
  rotary.slides_pose = [mechanism, X_WB](const Vec3& slides, double b, double c) -> Pose {
    Pose X_BT = Pose::Identity();
    expect_ok(mechanism->pose_at_slides({slides, b, c}, X_BT));
    return X_WB * X_BT;
  };
  rotary.slides = [mechanism, X_BW](const Vec3& p_WT, double b, double c) -> Vec3 {
    Vec3 slides = Vec3::Zero();
    expect_ok(mechanism->slides_at_turns({X_BW * p_WT, b, c}, slides));
    return slides;
  };
  return rotary;
}

}  // namespace understudy::control
