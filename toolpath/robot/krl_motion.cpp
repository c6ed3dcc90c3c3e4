// The moves of KRL.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/units.h"
#include "toolpath/robot/krl_reader.h"

namespace understudy::toolpath {
namespace {

constexpr double kMostTurns = 100;          // of a CIRC
constexpr double kSameExternalAxis = 1e-3;  // [mm] or [deg], which files round

bool is_home_name(const std::string& name) {
  return name.starts_with("HOME") || name.starts_with("XHOME") || name.starts_with("$AXIS_HOME") ||
         name.starts_with("$H_POS");
}

/// Behind the bracket that closes.
void skip_arguments(StatementScanner& scanner) {
  for (int depth = 1; depth > 0;) {
    if (scanner.at_end()) scanner.fail("')'");
    if (scanner.take('('))
      ++depth;
    else if (scanner.take(')'))
      --depth;
    else
      scanner.take(scanner.peek());
  }
}

}  // namespace

KrlStructure KrlReader::position_of(Scanner& scanner) {
  const KrlValue value = value_of(scanner);
  if (const auto* unknown = std::get_if<KrlUnknown>(&value)) {
    if (!is_home_name(unknown->name)) throw UnknownStatement(scanner.place(), unknown->name);
    return KrlStructure{{{"A1", 0.0}}};  // of the controller's
  }
  const auto* position = std::get_if<KrlStructure>(&value);
  if (position == nullptr) scanner.fail("a position");
  return *position;
}

/// Where rail and table stand: the pose is stated in the base, so that it does not matter while they rest.
void KrlReader::check_external_axes(const KrlStructure& position, const Place& place) {
  for (const auto& [name, value] : position.fields) {
    if (name.size() != 2 || name[0] != 'E' || name[1] < '1' || name[1] > '6') continue;
    const double before = external_axes_.try_emplace(name, value).first->second;
    if (std::abs(value - before) > kSameExternalAxis && !is_ignored(name))
      unknown_.add(UnknownStatement(place, name));
  }
}

Pose KrlReader::place_of(const KrlStructure& frame, Scanner& scanner) {
  if (!path_.X_UN())
    for (const char* name : {"X", "Y", "Z", "A", "B", "C"})
      if (!frame.find(name))
        throw InputError(
            scanner.place(),
            fmt::format("{} is left out, and where the tool stands before this the program does not say",
                        name));
  return krl_pose(frame, path_.X_UN());
}

double KrlReader::speed(std::optional<double> own) const { return override_ * own.value_or(cp_speed_); }

/// C_DIS and the like, WITH. The speed that WITH states [m/s].
std::optional<double> KrlReader::read_move_end(Scanner& scanner) {
  while (!scanner.at_end()) {
    if (scanner.take(',')) continue;
    const std::string word = scanner.name();
    if (word == "WITH") return read_with(scanner);
    if (!word.starts_with("C_")) scanner.fail("C_DIS, C_VEL, C_ORI or the end of the move");
  }
  return std::nullopt;
}

/// $VEL.CP=0.1, ... and what inline forms write: $VEL=SVEL_CP(0.1, ,LCPDAT1), $BASE=SBASE(FP1.BASE_NO).
std::optional<double> KrlReader::read_with(Scanner& scanner) {
  std::optional<double> own;
  do {
    const std::string name = krl_variable_name(scanner, variables_);
    const std::string component = scanner.take('.') ? scanner.name() : "";
    scanner.expect('=');
    Scanner value = scanner;
    const std::string function = value.name();
    if (!function.empty() && value.take('(')) {
      scanner = value;
      if (function == "SVEL_CP")
        own = number_of(scanner);
      else if (function == "SBASE")
        set_numbered_base(number_of(scanner));
      else if (!is_without_effect(name) && name != "$TOOL" && name != "$IPO_MODE")
        throw UnknownStatement(scanner.place(), function);
      skip_arguments(scanner);
    } else if (name == "$VEL" && component == "CP") {
      own = number_of(scanner);
    } else if (is_without_effect(name) || name == "$VEL") {
      value_of(scanner);
    } else {
      throw UnknownStatement(scanner.place(), name);
    }
  } while (scanner.take(','));
  return own;
}

void KrlReader::move(const std::string& word, Scanner& scanner) {
  const KrlStructure position = position_of(scanner);
  const std::optional<double> own = read_move_end(scanner);
  const bool free = word == "PTP" || word == "SPTP";
  ++path_.facts.statements[word];
  if (position.is_axes()) {
    if (!free) throw InputError(scanner.place(), fmt::format("{} takes X Y Z, not axis values", word));
    return path_.axes();
  }
  check_external_axes(position, scanner.place());
  const Pose X_UN = place_of(position, scanner);
  if (free)
    path_.free(X_UN);
  else
    path_.straight(X_UN, speed(own));
}

void KrlReader::move_round(const std::string& word, Scanner& scanner) {
  const KrlStructure via = position_of(scanner);
  scanner.expect(',');
  const KrlStructure end = position_of(scanner);
  std::optional<double> angle;
  if (scanner.take(',') && scanner.take_name("CA")) angle = from_deg(number_of(scanner));
  const std::optional<double> own = read_move_end(scanner);
  ++path_.facts.statements[word];
  if (angle && std::abs(*angle) > 2 * std::numbers::pi * kMostTurns)
    throw InputError(scanner.place(), fmt::format("CA of more than {:g} turns", kMostTurns));
  check_external_axes(end, scanner.place());
  if (!path_.X_UN()) path_.fail("an arc whose start the program does not say: move to it first");
  path_.arc(krl_pose(via, path_.X_UN()).translation(), place_of(end, scanner), angle, speed(own));
}

/// Along the axes of the base, or with #TOOL of the tool.
void KrlReader::move_relative(const std::string& word, Scanner& scanner) {
  const KrlStructure by = position_of(scanner);
  bool in_tool = false;
  if (scanner.take('#')) {
    const std::string frame = scanner.name();
    in_tool = frame == "TOOL";
    if (!in_tool && frame != "BASE") scanner.fail("#BASE or #TOOL");
  }
  const std::optional<double> own = read_move_end(scanner);
  for (const auto& [name, value] : by.fields)
    if (name != "X" && name != "Y" && name != "Z" && value != 0)
      throw UnknownStatement(scanner.place(), word + "_" + name);
  ++path_.facts.statements[word];
  if (!path_.X_UN()) path_.fail(fmt::format("{} from a place that the program does not say", word));
  const Vec3 offset = krl_pose(by, Pose::Identity()).translation();
  Pose X_UN = *path_.X_UN();
  X_UN.translation() += in_tool ? Vec3(X_UN.linear() * offset) : offset;
  if (word == "PTP_REL")
    path_.free(X_UN);
  else
    path_.straight(X_UN, speed(own));
}

void KrlReader::begin_spline(const std::string&, Scanner& scanner) {
  if (!scanner.take_name("WITH")) return;
  const double before = cp_speed_;
  if (const auto own = read_with(scanner)) {
    speed_before_spline_ = before;
    cp_speed_ = *own;
  }
}

void KrlReader::end_spline(const std::string&, Scanner&) {
  if (speed_before_spline_) cp_speed_ = *speed_before_spline_;
  speed_before_spline_.reset();
}

}  // namespace understudy::toolpath
