// The section `calibration` as text, and the file around it.
#include <cctype>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "core/output_file.h"
#include "core/units.h"
#include "machine/calibration_section.h"

namespace understudy::machine {
namespace {

constexpr const char* kKey = "calibration:";

// A nanometre, and 1e-9 of a direction: below every machine, so that the file loses nothing.
std::string text(const Vec3& v, double unit) {
  return fmt::format("[{:.9f}, {:.9f}, {:.9f}]", v.x() / unit, v.y() / unit, v.z() / unit);
}

std::string mount(const std::string& body, const Pose& X) {
  const Quat q(X.linear());
  return fmt::format("  {0}_mm: {1}\n  {0}_quaternion: [{2:.12f}, {3:.12f}, {4:.12f}, {5:.12f}]\n", body,
                     text(X.translation(), kMillimetre), q.w(), q.x(), q.y(), q.z());
}

std::string unit_text(const Vec3& v) {
  return fmt::format("[{:.12f}, {:.12f}, {:.12f}]", v.x(), v.y(), v.z());
}

std::string struts_text(const kinematics::HexapodGeometry& g) {
  std::string out = fmt::format("  deviation_mm: {:.9f}\n  struts:\n", to_mm(g.deviation));
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    out += fmt::format("    - {{base_joint_mm: {}, platform_joint_mm: {}, length_offset_mm: {:.9f}}}\n",
                       text(g.base_joint[i], kMillimetre), text(g.platform_joint[i], kMillimetre),
                       to_mm(g.length_offset[i]));
  return out;
}

std::string axes_text(const kinematics::Chain& chain) {
  std::string out = mount("tool", chain.X_OT_zero) + mount("work", chain.X_OS_zero) + "  axes:\n";
  for (const kinematics::ChainAxis& axis : chain.axes) {
    out += fmt::format("    - {{axis: {}, direction: {}", axis.name, unit_text(axis.direction));
    if (axis.angle) out += fmt::format(", point_mm: {}", text(axis.point, kMillimetre));
    out += "}\n";
  }
  return out;
}

/// In double quotes, as YAML and JSON have it.
std::string quoted(const std::string& word) {
  std::string out = "\"";
  for (const char c : word) {
    if (c == '"' || c == '\\') out += '\\';
    out += std::iscntrl(static_cast<unsigned char>(c)) ? '?' : c;
  }
  return out + "\"";
}

bool begins_top_level(const std::string& line) {
  return !line.empty() && !std::isspace(static_cast<unsigned char>(line[0]));
}

}  // namespace

std::string calibration_section(const MachineDescription& machine, const CalibratedParameters& parameters) {
  const CalibrationRecord& record = *machine.calibration;
  std::string out = fmt::format(
      "{}\n  # By understudy calibrate: the controller uses this in place of `geometry`.\n"
      "  estimator: {}\n  measurements: {}\n  measurements_sha256: {}\n  poses: {}\n",
      kKey, quoted(record.estimator), quoted(record.measurements), quoted(record.measurements_sha256),
      record.poses);
  if (std::isfinite(record.tip_sigma))
    out += fmt::format("  tip_sigma_um: {:.3f}   # RMS over the work space\n", to_um(record.tip_sigma));
  out += machine.visit([](const HexapodModel& hexapod) { return struts_text(hexapod.geometry); },
                       [](const ChainModel& chain) { return axes_text(chain.kinematics.chain); });
  return out + calibrated_parameters_text(machine, parameters);
}

std::string with_section(const std::string& text, const std::string& section) {
  std::istringstream in(text);
  std::string out, line;
  bool inside = false;
  while (std::getline(in, line)) {
    if (line.starts_with(kKey)) {
      inside = true;
      continue;
    }
    if (inside && begins_top_level(line)) inside = false;
    if (!inside) out += line + "\n";
  }
  while (out.ends_with("\n\n")) out.pop_back();
  return out + "\n" + section;
}

void write_calibrated(const MachineDescription& machine, const std::filesystem::path& path,
                      const CalibratedParameters& parameters) {
  namespace fs = std::filesystem;
  if (path.extension() != ".yaml")
    throw InputError(fmt::format("{}: a machine file ends in .yaml", path.string()));
  const std::string original = read_file(machine.file);
  const fs::path trial = path.parent_path() / ("." + path.stem().string() + ".part.yaml");
  write_file(trial, with_section(original, calibration_section(machine, parameters)));
  try {
    load_machine(fs::absolute(trial).string());
    fs::rename(trial, path);
  } catch (const InputError& error) {
    std::error_code ignored;
    fs::remove(trial, ignored);
    throw InputError(
        fmt::format("{}: the calibrated machine would be refused: {}", path.string(), error.what()));
  } catch (...) {
    std::error_code ignored;
    fs::remove(trial, ignored);
    throw;
  }
}

}  // namespace understudy::machine
