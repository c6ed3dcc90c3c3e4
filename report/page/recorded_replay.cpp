#include "report/page/recorded_replay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file/is_file.h"
#include "core/file/read_file.h"
#include "core/text/json_depth.h"
#include "core/units.h"
#include "report/page/unpack.h"

namespace understudy::report {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;
using rehearsal::ReplayBody;

std::vector<double> column(const Json& value) {
  const double unit = value.at("unit");
  return unpack_values(value.at("data").get_ref<const std::string&>(), unit);
}

/// A column of lengths, all of them there [m].
std::vector<double> finite(const Json& value, const char* name, double scale = 1) {
  std::vector<double> values = column(value);
  for (double& v : values) {
    if (!std::isfinite(v)) throw InputError(fmt::format("{} has a missing value", name));
    v *= scale;
  }
  return values;
}

void require_length(std::size_t length, std::size_t wanted, const char* name) {
  if (length != wanted)
    throw InputError(fmt::format("{} has {} values where {} are needed", name, length, wanted));
}

Quat unit_quaternion(double w, double x, double y, double z) {
  const Quat q(w, x, y, z);
  if (!(std::abs(q.norm() - 1) < 1e-3))
    throw InputError(fmt::format("a rotation has length {}, not 1", q.norm()));
  return q.normalized();
}

std::vector<Pose> poses(const Json& value) {
  const char* names[] = {"x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"};
  std::array<std::vector<double>, 7> c;
  for (std::size_t i = 0; i < 7; ++i) {
    c[i] = finite(value.at(names[i]), names[i], i < 3 ? from_mm(1) : 1);
    require_length(c[i].size(), c[0].size(), names[i]);
  }
  std::vector<Pose> result;
  for (std::size_t k = 0; k < c[0].size(); ++k)
    result.push_back(
        make_pose(unit_quaternion(c[3][k], c[4][k], c[5][k], c[6][k]), Vec3(c[0][k], c[1][k], c[2][k])));
  return result;
}

Vec3 place(const Json& mm) {
  require_length(mm.size(), 3, "a place");
  const Vec3 p(mm[0].get<double>(), mm[1].get<double>(), mm[2].get<double>());
  return from_mm(1) * p;
}

Pose one_pose(const Json& value) {
  const Json& q = value.at("turn");
  require_length(q.size(), 4, "turn");
  return make_pose(unit_quaternion(q[0], q[1], q[2], q[3]), place(value.at("place_mm")));
}

std::shared_ptr<const geometry::Mesh> mesh(const Json& value) {
  const auto x = finite(value.at("x_mm"), "x_mm", from_mm(1)),
             y = finite(value.at("y_mm"), "y_mm", from_mm(1)),
             z = finite(value.at("z_mm"), "z_mm", from_mm(1));
  require_length(y.size(), x.size(), "y_mm");
  require_length(z.size(), x.size(), "z_mm");
  std::vector<Vec3> vertices;
  for (std::size_t i = 0; i < x.size(); ++i) vertices.emplace_back(x[i], y[i], z[i]);
  const auto corners = unpack_integers(value.at("corners").get_ref<const std::string&>());
  std::vector<std::array<int, 3>> triangles(corners.size() / 3);
  for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
    if (corners[i] < 0 || corners[i] >= static_cast<std::int64_t>(x.size()))
      throw InputError(fmt::format("a triangle has the corner {} of {}", corners[i], x.size()));
    triangles[i / 3][i % 3] = static_cast<int>(corners[i]);
  }
  return std::make_shared<geometry::Mesh>(std::move(vertices), std::move(triangles));
}

/// `at_mm`, which a box for a mesh has, becomes part of the pose.
geometry::Shape shape(const std::string& name, const Json& form, const Pose& X_FS) {
  geometry::Shape result{name, geometry::Sphere{1e-3}, X_FS};
  const auto number = [&](const char* key, std::size_t i) {
    const double mm = form.at(key).at(i);
    if (!(mm >= 0)) throw InputError(fmt::format("{} of {} is {}", key, name, mm));
    return from_mm(mm);
  };
  if (form.contains("sphere_mm")) {
    result.form = geometry::Sphere{number("sphere_mm", 0)};
  } else if (form.contains("capsule_mm")) {
    result.form = geometry::Capsule{number("capsule_mm", 0), number("capsule_mm", 1)};
  } else if (form.contains("cylinder_mm")) {
    result.form = geometry::Cylinder{number("cylinder_mm", 0), number("cylinder_mm", 1)};
  } else if (form.contains("frustum_mm")) {
    result.form =
        geometry::Frustum{number("frustum_mm", 0), number("frustum_mm", 1), number("frustum_mm", 2)};
  } else if (form.contains("box_mm")) {
    result.form = geometry::Box{place(form.at("box_mm"))};
    if (form.contains("at_mm")) result.X_FS = X_FS * make_pose(Quat::Identity(), place(form.at("at_mm")));
  } else {
    result.form = geometry::MeshShape{mesh(form.at("mesh"))};
  }
  return result;
}

ReplayBody body(const Json& value, std::size_t keys) {
  const std::string name = value.at("name"), carrier = value.at("carrier");
  ReplayBody result;
  result.shape =
      shape(name, value.at("form"), value.contains("pose") ? one_pose(value.at("pose")) : Pose::Identity());
  if (carrier == "tool") {
    result.carrier = ReplayBody::Carrier::tool;
  } else if (carrier == "strut") {
    result.carrier = ReplayBody::Carrier::strut;
    if (!std::holds_alternative<geometry::Capsule>(result.shape.form))
      throw InputError(fmt::format("{} is a strut and no capsule", name));
    result.from_W = place(value.at("from_mm"));
    result.to_T = place(value.at("to_tool_mm"));
  } else if (carrier == "axes") {
    result.carrier = ReplayBody::Carrier::axes;
    result.X_WF = poses(value.at("poses"));
    require_length(result.X_WF.size(), keys, "poses");
    // A box that stands for a mesh is beside the origin of what is posed.
    for (Pose& X_WF : result.X_WF) X_WF = X_WF * result.shape.X_FS;
    result.shape.X_FS = Pose::Identity();
  } else if (carrier != "world") {
    throw InputError(fmt::format("{} is carried by \"{}\"", name, carrier));
  }
  return result;
}

std::vector<rehearsal::TracePoint> path(const Json& value) {
  const auto times = finite(value.at("time_s"), "time_s");
  const auto X_WT = poses(value.at("tool"));
  const auto gaps = column(value.at("gap_um"));
  const auto extruding = unpack_integers(value.at("extruding").get_ref<const std::string&>());
  require_length(X_WT.size(), times.size(), "tool");
  require_length(gaps.size(), times.size(), "gap_um");
  require_length(extruding.size(), times.size(), "extruding");
  if (times.empty()) throw InputError("the path has no points");
  if (!std::is_sorted(times.begin(), times.end())) throw InputError("the path's times fall");
  std::vector<rehearsal::TracePoint> points(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    points[i].time = times[i];
    points[i].X_WT = X_WT[i];
    points[i].gap = from_mm(1e-3 * gaps[i]);
    points[i].extruding = extruding[i] != 0;
  }
  return points;
}

/// Sections that lie where the one before lies say nothing more: a page rounds to micrometres.
void append(const sim::BeadSection& section, sim::BeadStretch& stretch) {
  if (!stretch.empty() && stretch.back().middle_W == section.middle_W)
    stretch.back() = section;
  else
    stretch.push_back(section);
}

std::vector<sim::BeadStretch> beads(const Json& value) {
  const char* names[] = {"x_mm", "y_mm", "z_mm", "up_x", "up_y", "up_z", "width_mm", "height_mm", "time_s"};
  std::array<std::vector<double>, 9> c;
  for (std::size_t i = 0; i < c.size(); ++i) {
    c[i] = finite(value.at(names[i]), names[i], i < 3 || i == 6 || i == 7 ? from_mm(1) : 1);
    require_length(c[i].size(), c[0].size(), names[i]);
  }
  constexpr double kLeast = 1e-6;  // [m]: a bead that is thinner than the page's rounding
  std::vector<sim::BeadStretch> stretches;
  std::size_t at = 0;
  for (const std::int64_t count : unpack_integers(value.at("stretches").get_ref<const std::string&>())) {
    if (count < 1 || static_cast<std::uint64_t>(count) > c[0].size() - at)
      throw InputError(fmt::format("a stretch of beads has {} sections of {}", count, c[0].size() - at));
    sim::BeadStretch stretch;
    for (const std::size_t end = at + static_cast<std::size_t>(count); at < end; ++at) {
      const double height = std::max(c[7][at], kLeast);
      append({Vec3(c[0][at], c[1][at], c[2][at]), Vec3(c[3][at], c[4][at], c[5][at]).stableNormalized(),
              std::max(c[6][at], height), height, c[8][at], 0},
             stretch);
    }
    stretches.push_back(std::move(stretch));
  }
  require_length(at, c[0].size(), "stretches");
  return stretches;
}

/// What the record says of its being less than the whole.
std::vector<std::string> shortfalls(const Json& report, const Json& replay) {
  std::vector<std::string> found;
  for (const Json& finding : report.at("summary").at("findings")) {
    const std::string message = finding.value("message", "");
    if (message.starts_with("the print stopped") || message.starts_with("gap control stopped"))
      found.push_back("the record is of a part of the print: " + message);
  }
  if (const auto n = replay.value("part_left_out_triangles", std::uint64_t{0}))
    found.push_back(fmt::format("the record is without the part, which has {} triangles", n));
  for (const Json& body : replay.at("bodies"))
    if (const auto n = body.at("form").value("box_for_triangles", std::uint64_t{0}))
      found.push_back(fmt::format("{} is a box: it has {} triangles", body.value("name", "a body"), n));
  if (replay.contains("beads"))
    if (const auto n = replay.at("beads").value("one_stretch_of", std::uint64_t{1}); n > 1)
      found.push_back(fmt::format("the record has one stretch of beads of {}", n));
  if (!replay.at("path").contains("within_um"))
    found.push_back("the record has the tool's path thinned evenly: how far it is off is not known");
  return found;
}

RecordedReplay replay_of(const Json& report) {
  const Json& replay = report.at("replay");
  RecordedReplay result;
  result.title = report.value("title", "");
  result.path = path(replay.at("path"));
  if (replay.at("path").contains("within_um"))
    result.path_within = from_mm(1e-3 * replay.at("path").at("within_um").get<double>());
  result.machine.key_times = finite(replay.at("key_time_s"), "key_time_s");
  const std::size_t keys = result.machine.key_times.size();
  for (const Json& one : replay.at("bodies")) result.machine.bodies.push_back(body(one, keys));
  if (replay.contains("machine_frame")) {
    result.machine.X_WO = poses(replay.at("machine_frame"));
    require_length(result.machine.X_WO.size(), keys, "machine_frame");
  }
  if (replay.contains("table")) {
    const Json& table = replay.at("table");
    result.table = shape("table", table.at("form"), one_pose(table.at("pose")));
  }
  if (replay.contains("part")) result.part = mesh(replay.at("part"));
  if (replay.contains("beads")) {
    result.beads = beads(replay.at("beads"));
    result.beads_within = from_mm(1e-3 * replay.at("beads").at("within_um").get<double>());
  }
  if (report.contains("gap_band"))
    result.gap_band = GapBand{from_mm(report.at("gap_band").at("min_mm").get<double>()),
                              from_mm(report.at("gap_band").at("max_mm").get<double>())};
  result.shortfalls = shortfalls(report, replay);
  return result;
}

/// The text of the data block.
std::string data_block(const std::string& page) {
  const std::string_view opens = "<script type=\"application/json\" id=\"record\">";
  const std::size_t open = page.find(opens);
  if (open == std::string::npos)
    throw InputError("it has no data of a rehearsal: name a folder that understudy rehearse wrote");
  const std::size_t begin = open + opens.size(), end = page.find("</script>", begin);
  if (end == std::string::npos) throw InputError("it is cut short: its data block does not end");
  return page.substr(begin, end - begin);
}

Json parsed(const std::string& text) {
  if (nests_deeper(text)) throw InputError(fmt::format("it is nested more than {} deep", kJsonDepthMax));
  Json report = Json::parse(text, nullptr, false);
  if (!report.is_object()) throw InputError("its data block is damaged: it is no JSON object");
  const std::string schema = report.value("schema", "");
  if (schema != "understudy.report/1")
    throw InputError(
        fmt::format("its data is of version \"{}\", and this understudy reads understudy.report/1: "
                    "rehearse again",
                    schema));
  if (!report.contains("replay"))
    throw InputError("it has no replay: rehearse a program that runs, and without --no-pictures");
  return report;
}

}  // namespace

RecordedReplay read_recorded_replay(const fs::path& folder) {
  const fs::path file = folder / "report.html";
  if (!is_file(file))
    throw InputError({file.string()}, "it is not there: name a folder that understudy rehearse wrote");
  const std::string page = read_file(file);
  try {
    return replay_of(parsed(data_block(page)));
  } catch (const InputError& error) {
    throw InputError({file.string()}, error.what());
  } catch (const Json::exception& error) {
    const std::string what = error.what();  // "[json.exception.out_of_range.403] key 'path' not found"
    throw InputError({file.string()}, "its data block is damaged: " + what.substr(what.find(']') + 2));
  }
}

}  // namespace understudy::report
