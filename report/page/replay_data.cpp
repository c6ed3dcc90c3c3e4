#include "report/page/replay_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <type_traits>
#include <variant>

#include <nlohmann/json.hpp>

#include "core/text/stable_number.h"
#include "core/units.h"
#include "geometry/mesh.h"
#include "report/page/pack.h"
#include "report/trace/kept_points.h"
#include "sim/surface/bead_sweep.h"

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using rehearsal::Record;
using rehearsal::Replay;
using rehearsal::ReplayBody;
using rehearsal::TracePoint;

constexpr double kMicrometre = 1e-3;  // [mm]
constexpr double kTime = 1e-4;        // [s]
constexpr double kTurn = 1e-5;        // of a quaternion's entries: 20 urad
// [m], tried in turn until the sections fit. The first is that of a close-up.
constexpr std::array kTolerances{2e-6, 10e-6, 30e-6, 60e-6, 100e-6, 200e-6};

/// Values of a column; `unit` says what one of them is worth.
Json column(const std::vector<double>& values, double unit) {
  return {{"unit", unit}, {"data", pack_values(values, unit)}};
}

Json three(const Vec3& v_m) {
  Json list = Json::array();
  for (int i = 0; i < 3; ++i) list.push_back(stable_number(to_mm(v_m[i]), "a coordinate"));
  return list;
}

/// Four columns for a rotation, three for a place. Neighbouring quaternions lie on one side.
class PoseColumns {
 public:
  void add(const Pose& X) {
    Quat q(X.linear());
    if (!place_[0].empty() && q.dot(last_) < 0) q.coeffs() = -q.coeffs();
    last_ = q;
    for (int i = 0; i < 3; ++i) place_[static_cast<std::size_t>(i)].push_back(to_mm(X.translation()[i]));
    const double entries[] = {q.w(), q.x(), q.y(), q.z()};
    for (std::size_t i = 0; i < 4; ++i) turn_[i].push_back(entries[i]);
  }
  Json value() const {
    Json object;
    const char* places[] = {"x_mm", "y_mm", "z_mm"};
    const char* turns[] = {"qw", "qx", "qy", "qz"};
    for (std::size_t i = 0; i < 3; ++i) object[places[i]] = column(place_[i], kMicrometre);
    for (std::size_t i = 0; i < 4; ++i) object[turns[i]] = column(turn_[i], kTurn);
    return object;
  }

 private:
  std::array<std::vector<double>, 3> place_;
  std::array<std::vector<double>, 4> turn_;
  Quat last_ = Quat::Identity();
};

Json pose_value(const Pose& X) {
  Quat q(X.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  Json turn = Json::array();
  for (const double c : {q.w(), q.x(), q.y(), q.z()}) turn.push_back(stable_number(c, "a rotation"));
  return {{"place_mm", three(X.translation())}, {"turn", turn}};
}

/// Places of the vertices and the triangles' corners.
Json mesh_value(const geometry::Mesh& mesh) {
  std::array<std::vector<double>, 3> places;
  for (const Vec3& v : mesh.vertices())
    for (int i = 0; i < 3; ++i) places[static_cast<std::size_t>(i)].push_back(to_mm(v[i]));
  std::vector<std::int64_t> corners;
  for (const auto& triangle : mesh.triangles())
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  return {{"x_mm", column(places[0], kMicrometre)},
          {"y_mm", column(places[1], kMicrometre)},
          {"z_mm", column(places[2], kMicrometre)},
          {"corners", pack_integers(corners)}};
}

Json form_value(const geometry::Shape& shape, const ReplayBudget& budget) {
  const auto mm = [](double v) { return stable_number(to_mm(v), "a body's length"); };
  return std::visit(
      [&](const auto& form) -> Json {
        using Form = std::decay_t<decltype(form)>;
        if constexpr (std::is_same_v<Form, geometry::Sphere>) {
          return {{"sphere_mm", Json::array({mm(form.radius)})}};
        } else if constexpr (std::is_same_v<Form, geometry::Capsule>) {
          return {{"capsule_mm", {mm(form.radius), mm(form.length)}}};
        } else if constexpr (std::is_same_v<Form, geometry::Cylinder>) {
          return {{"cylinder_mm", {mm(form.radius), mm(form.length)}}};
        } else if constexpr (std::is_same_v<Form, geometry::Frustum>) {
          return {{"frustum_mm", {mm(form.radius_bottom), mm(form.radius_top), mm(form.height)}}};
        } else if constexpr (std::is_same_v<Form, geometry::Box>) {
          return {{"box_mm", three(form.size)}};
        } else {
          const geometry::Mesh& mesh = *form.mesh;
          if (mesh.triangles().size() <= budget.triangles) return {{"mesh", mesh_value(mesh)}};
          return {{"box_mm", three(mesh.upper() - mesh.lower())},
                  {"at_mm", three(0.5 * (mesh.upper() + mesh.lower()))},
                  {"box_for_triangles", mesh.triangles().size()}};
        }
      },
      shape.form);
}

Json body_value(const ReplayBody& body, const ReplayBudget& budget) {
  Json object{{"name", body.shape.name}, {"form", form_value(body.shape, budget)}};
  switch (body.carrier) {
    case ReplayBody::Carrier::world:
      object["carrier"] = "world";
      break;
    case ReplayBody::Carrier::tool:
      object["carrier"] = "tool";
      break;
    case ReplayBody::Carrier::strut:
      object["carrier"] = "strut";
      object["from_mm"] = three(body.from_W);
      object["to_tool_mm"] = three(body.to_T);
      return object;
    case ReplayBody::Carrier::axes: {
      PoseColumns poses;
      for (const Pose& X_WF : body.X_WF) poses.add(X_WF);
      object["carrier"] = "axes";
      object["poses"] = poses.value();
      return object;
    }
  }
  object["pose"] = pose_value(body.shape.X_FS);
  return object;
}

/// Which points of a trace a straight line between neighbours stands for to within `tolerance` [m], its
/// extrusion included.
std::vector<std::size_t> points_within(const std::vector<TracePoint>& trace, double tolerance) {
  constexpr std::size_t kMost = 256;
  const auto stands_for = [&](std::size_t a, std::size_t b) {
    const double span = trace[b].time - trace[a].time;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double share = span > 0 ? (trace[i].time - trace[a].time) / span : 0;
      const Vec3 there =
          trace[a].X_WT.translation() + share * (trace[b].X_WT.translation() - trace[a].X_WT.translation());
      if ((trace[i].X_WT.translation() - there).norm() > tolerance) return false;
      if (trace[i].extruding != trace[b].extruding) return false;
    }
    return angle_between(trace[a].X_WT.linear(), trace[b].X_WT.linear()) < 0.05;
  };
  return kept_points(trace.size(), kMost, stands_for);
}

std::vector<std::size_t> path_points(const std::vector<TracePoint>& trace, std::size_t most,
                                     double& tolerance) {
  for (const double t : {5e-6, 20e-6, 60e-6, 200e-6}) {
    tolerance = t;
    std::vector<std::size_t> kept = points_within(trace, t);
    if (kept.size() <= most) return kept;
  }
  std::vector<std::size_t> kept;  // evenly in time: what lies between is no longer bounded
  tolerance = -1;
  for (std::size_t i = 0; i < most; ++i) kept.push_back(i * (trace.size() - 1) / (most - 1));
  return kept;
}

Json path_value(const Record& record, const ReplayBudget& budget) {
  Json object;
  double tolerance = 0;
  PoseColumns poses;
  std::vector<double> times, gaps, tips, turns;
  std::vector<std::int64_t> extruding;
  for (const std::size_t i : path_points(record.trace, budget.points, tolerance)) {
    const TracePoint& point = record.trace[i];
    times.push_back(point.time);
    extruding.push_back(point.extruding ? 1 : 0);
    poses.add(point.X_WT);
    gaps.push_back(to_um(point.gap));
    tips.push_back(to_um(point.tip_error));
    turns.push_back(1e3 * point.orientation_error);
  }
  object["points"] = times.size();
  if (tolerance > 0) object["within_um"] = to_um(tolerance);
  object["time_s"] = column(times, kTime);
  object["extruding"] = pack_integers(extruding);
  object["tool"] = poses.value();
  object["gap_um"] = column(gaps, 0.1);
  object["tip_error_um"] = column(tips, 0.1);
  object["orientation_error_mrad"] = column(turns, 1e-3);
  return object;
}

/// From when on each line of the program was carried out.
Json lines_value(const std::vector<TracePoint>& trace) {
  std::vector<double> times;
  std::vector<std::int64_t> lines;
  for (const TracePoint& point : trace) {
    if (!lines.empty() && lines.back() == point.line) continue;
    times.push_back(point.time);
    lines.push_back(point.line);
  }
  return {{"time_s", column(times, kTime)}, {"line", pack_integers(lines)}};
}

/// Stretches that the page draws.
struct DrawnBeads {
  std::vector<sim::BeadStretch> stretches;
  double tolerance = 0;   ///< [m]
  std::size_t every = 1;  ///< one of so many
};

/// As fine as the budget lets them be. Never holds many more sections than that: there may be millions.
DrawnBeads drawn_beads(const sim::BeadIndex& beads, std::size_t sections_most) {
  DrawnBeads drawn;
  std::size_t sections = 0;
  for (const double tolerance : kTolerances) {
    drawn = {{}, tolerance, 1};
    sections = 0;
    const bool all = sim::sweep_beads(beads, {HUGE_VAL, tolerance}, [&](sim::BeadStretch stretch) {
      sections += stretch.size();
      drawn.stretches.push_back(std::move(stretch));
      return sections <= sections_most;
    });
    if (all) return drawn;
  }
  const sim::SweepSettings coarsest{HUGE_VAL, kTolerances.back()};
  sections = 0;
  sim::sweep_beads(beads, coarsest, [&](const sim::BeadStretch& stretch) {
    sections += stretch.size();
    return true;
  });
  drawn = {{}, coarsest.tolerance, sections / sections_most + 1};
  std::size_t number = 0;
  sim::sweep_beads(beads, coarsest, [&](sim::BeadStretch stretch) {
    if (number++ % drawn.every == 0) drawn.stretches.push_back(std::move(stretch));
    return true;
  });
  return drawn;
}

Json beads_value(const sim::BeadIndex& beads, const Replay& replay, const ReplayBudget& budget) {
  const auto [stretches, tolerance, every] = drawn_beads(beads, budget.sections);
  std::array<std::vector<double>, 6> place;  // x y z, and the normal's
  std::vector<double> widths, heights, times;
  std::vector<std::int64_t> lines, sections, types;
  std::map<std::string, std::int64_t> numbers{{"", 0}};
  Json names_of_types = Json::array({""});
  const auto type_at = [&](int line) -> std::int64_t {
    const auto after = std::partition_point(replay.features.begin(), replay.features.end(),
                                            [&](const auto& change) { return change.first <= line; });
    const std::string name = after == replay.features.begin() ? "" : std::prev(after)->second;
    const auto [entry, is_new] = numbers.try_emplace(name, static_cast<std::int64_t>(numbers.size()));
    if (is_new) names_of_types.push_back(name);
    return entry->second;
  };
  for (const sim::BeadStretch& stretch : stretches) {
    sections.push_back(static_cast<std::int64_t>(stretch.size()));
    for (const sim::BeadSection& section : stretch) {
      for (int i = 0; i < 3; ++i) {
        place[static_cast<std::size_t>(i)].push_back(to_mm(section.middle_W[i]));
        place[static_cast<std::size_t>(i) + 3].push_back(section.up_W[i]);
      }
      widths.push_back(to_mm(section.width));
      heights.push_back(to_mm(section.height));
      times.push_back(section.laid_at);
      lines.push_back(section.line);
      types.push_back(type_at(section.line));
    }
  }
  Json object;
  object["beads"] = beads.size();
  object["within_um"] = stable_number(to_um(tolerance), "tolerance");
  if (every > 1) object["one_stretch_of"] = every;
  object["stretches"] = pack_integers(sections);
  const char* names[] = {"x_mm", "y_mm", "z_mm", "up_x", "up_y", "up_z"};
  for (std::size_t i = 0; i < 6; ++i) object[names[i]] = column(place[i], i < 3 ? kMicrometre : 1e-3);
  object["width_mm"] = column(widths, kMicrometre);
  object["height_mm"] = column(heights, kMicrometre);
  object["time_s"] = column(times, kTime);
  object["line"] = pack_integers(lines);
  if (!replay.features.empty()) {
    object["type"] = pack_integers(types);
    object["type_names"] = names_of_types;
  }
  return object;
}

/// Whole lines of the program, from its beginning.
Json program_value(const Replay& replay, const ReplayBudget& budget) {
  const std::string& program = replay.program;
  std::size_t size = program.size();
  Json object;
  if (size > budget.program_bytes) size = program.rfind('\n', budget.program_bytes);
  if (const std::size_t left_out = program.size() - size + replay.program_left_out; left_out > 0)
    object["left_out_bytes"] = left_out;
  object["text"] = pack_text(std::string_view(program).substr(0, size));
  return object;
}

}  // namespace

Json replay_data(const Record& record, const ReplayBudget& budget) {
  if (!record.replay || record.trace.empty()) return nullptr;
  const Replay& replay = *record.replay;
  Json object;
  object["path"] = path_value(record, budget);
  object["lines"] = lines_value(record.trace);
  object["key_time_s"] = column(replay.key_times, kTime);
  object["bodies"] = Json::array();
  for (const ReplayBody& body : replay.bodies) object["bodies"].push_back(body_value(body, budget));
  if (!replay.X_WO.empty()) {
    PoseColumns frame;
    for (const Pose& X_WO : replay.X_WO) frame.add(X_WO);
    object["machine_frame"] = frame.value();
  }
  if (record.scene) {
    const rehearsal::Scene& scene = *record.scene;
    object["table"] = {{"form", form_value(scene.table, budget)}, {"pose", pose_value(scene.table.X_FS)}};
    if (scene.part) {
      if (scene.part->triangles().size() <= budget.triangles)
        object["part"] = mesh_value(*scene.part);
      else
        object["part_left_out_triangles"] = scene.part->triangles().size();
    }
    if (scene.printed && scene.printed->beads().size() > 0)
      object["beads"] = beads_value(scene.printed->beads(), replay, budget);
  }
  object["program"] = program_value(replay, budget);
  return object;
}

}  // namespace understudy::report
