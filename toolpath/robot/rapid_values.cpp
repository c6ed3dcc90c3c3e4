#include "toolpath/robot/rapid_values.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "toolpath/robot/robot_frames.h"
#include "toolpath/robot/unknown_statements.h"

namespace understudy::toolpath {
namespace {

using Scanner = StatementScanner;
using Kind = RapidValue::Kind;
constexpr double kMostElements = 1e9;
constexpr std::size_t kMostText = 100;  // of which nothing is read
constexpr double kUnitLength = 1e-2;    // by which a quaternion of few digits may differ
constexpr int kDeepestList = 20;        // docs/limits.md

RapidValue sum(Scanner& scanner, const RapidVariables& variables);

RapidValue calculated(char operation, const RapidValue& a, const RapidValue& b) {
  if (!a.is_number() || !b.is_number()) {
    const RapidValue& first = a.is_number() ? b : a;
    return RapidValue::of_name(first.kind == Kind::unknown ? first.text : "an expression");
  }
  if (operation == '+') return RapidValue::of(a.number + b.number);
  if (operation == '-') return RapidValue::of(a.number - b.number);
  if (operation == '*') return RapidValue::of(a.number * b.number);
  if (b.number == 0) return RapidValue::of_name("a quotient by 0");
  return RapidValue::of(a.number / b.number);
}

RapidValue orientation(const Quat& q) {
  return RapidValue::list(
      {RapidValue::of(q.w()), RapidValue::of(q.x()), RapidValue::of(q.y()), RapidValue::of(q.z())});
}

double number_at(const RapidArguments& arguments, std::size_t i, const Scanner& scanner,
                 const char* function) {
  if (i >= arguments.positional.size() || !arguments.positional[i].is_number())
    throw InputError(scanner.place(), fmt::format("{} needs a number as argument {}", function, i + 1));
  return arguments.positional[i].number;
}

/// Offs and RelTool: a target moved along the axes of its work object, or in its own tool.
RapidValue moved_target(const std::string& name, const RapidArguments& arguments, Scanner& scanner) {
  if (arguments.positional.empty()) scanner.fail("a target");
  const RapidValue& target = arguments.positional[0];
  if (target.kind == Kind::unknown) return target;
  const auto X = rapid_pose(target, scanner.place());
  if (!X) throw InputError(scanner.place(), name + " needs a target");
  Vec3 by;
  for (int i = 0; i < 3; ++i)
    by[i] = from_mm(number_at(arguments, static_cast<std::size_t>(i) + 1, scanner, name.c_str()));
  Pose moved = *X;
  if (name == "OFFS") {
    moved.translation() += by;
  } else {
    moved = *X * make_pose(Quat::Identity(), by);
    for (int i = 0; i < 3; ++i)  // about x, then the new y, then the new z
      if (const RapidValue* turn =
              arguments.find(std::string_view("RXRYRZ").substr(static_cast<std::size_t>(2 * i), 2)))
        moved = moved * Eigen::AngleAxisd(from_deg(turn->number), Vec3::Unit(i));
  }
  std::vector<RapidValue> parts = rapid_target(moved).parts();
  for (std::size_t i = 2; i < target.parts().size() && i < 4; ++i) parts.push_back(target.parts()[i]);
  return RapidValue::list(std::move(parts));
}

RapidValue function(const std::string& name, Scanner& scanner, const RapidVariables& variables) {
  const Scanner::Deeper deeper(scanner);
  const RapidArguments arguments = rapid_arguments(scanner, variables, ')');
  if (name == "OFFS" || name == "RELTOOL") return moved_target(name, arguments, scanner);
  if (name == "CROBT" && variables.present) return variables.present();
  if (name == "ORIENTZYX")
    return orientation(Quat(rotation_abc(from_deg(number_at(arguments, 0, scanner, "OrientZYX")),
                                         from_deg(number_at(arguments, 1, scanner, "OrientZYX")),
                                         from_deg(number_at(arguments, 2, scanner, "OrientZYX")))));
  throw UnknownStatement(scanner.place(), name);
}

RapidValue list(Scanner& scanner, const RapidVariables& variables) {
  const Scanner::Deeper deeper(scanner);
  std::vector<RapidValue> parts;
  for (bool first = true; !scanner.take(']'); first = false) {
    if (!first) scanner.expect(',');
    parts.push_back(sum(scanner, variables));
  }
  return RapidValue::list(std::move(parts));
}

RapidValue name_value(Scanner& scanner, const RapidVariables& variables) {
  const std::string name = scanner.name();
  if (name.empty()) scanner.fail("a value");
  if (name == "TRUE") return RapidValue::of(1);
  if (name == "FALSE") return RapidValue::of(0);
  const std::string spelled = scanner.spelled();
  if (scanner.take('(')) return function(name, scanner, variables);
  const RapidValue* known = variables.find(name);
  if (known == nullptr) {
    while (scanner.take('.')) scanner.name();
    return RapidValue::of_name(spelled);
  }
  const RapidValue* part = known;
  const auto go_to = [&](std::optional<std::size_t> index) {
    part = part != nullptr && index && *index < part->parts().size() ? &part->parts()[*index] : nullptr;
  };
  while (scanner.peek() == '.' || scanner.peek() == '{') {
    if (scanner.take('.')) {
      go_to(RapidVariables::part_of(scanner.name()));
      continue;
    }
    scanner.take('{');
    const Scanner::Deeper deeper(scanner);
    do {
      const RapidValue index = sum(scanner, variables);
      const bool counts = index.is_number() && index.number >= 1 && index.number <= kMostElements;
      go_to(counts ? std::optional(static_cast<std::size_t>(index.number) - 1) : std::nullopt);
    } while (scanner.take(','));
    scanner.expect('}');
  }
  if (part == nullptr) return RapidValue::of_name(spelled);
  RapidValue value = *part;
  if (value.kind == Kind::list) value.text = spelled;
  return value;
}

RapidValue primary(Scanner& scanner, const RapidVariables& variables) {
  const Scanner::Deeper deeper(scanner);
  if (scanner.begins_number()) return RapidValue::of(scanner.number());
  if (scanner.take('[')) return list(scanner, variables);
  if (scanner.take('-')) return calculated('*', RapidValue::of(-1), primary(scanner, variables));
  if (scanner.take('+')) return primary(scanner, variables);
  if (scanner.peek() == '"') {
    RapidValue text;
    text.kind = Kind::text;
    text.text = scanner.quoted().substr(0, kMostText);
    return text;
  }
  if (scanner.take('(')) {
    RapidValue inner = sum(scanner, variables);
    scanner.expect(')');
    return inner;
  }
  return name_value(scanner, variables);
}

RapidValue product(Scanner& scanner, const RapidVariables& variables) {
  return scan_row(
      scanner, "*/", [&] { return primary(scanner, variables); }, calculated);
}

RapidValue sum(Scanner& scanner, const RapidVariables& variables) {
  return scan_row(
      scanner, "+-", [&] { return product(scanner, variables); }, calculated);
}

}  // namespace

RapidValue RapidValue::of(double number) {
  RapidValue value;
  value.kind = Kind::number;
  value.number = number;
  return value;
}

RapidValue RapidValue::of_name(std::string name) {
  RapidValue value;
  value.text = std::move(name);
  return value;
}

RapidValue RapidValue::list(std::vector<RapidValue> parts) {
  RapidValue value;
  value.kind = Kind::list;
  for (const RapidValue& part : parts) value.depth_ = std::max(value.depth_, part.depth_);
  ++value.depth_;
  value.parts_ = std::make_shared<const std::vector<RapidValue>>(std::move(parts));
  return value;
}

const std::vector<RapidValue>& RapidValue::parts() const {
  static const std::vector<RapidValue> kNone;
  return parts_ ? *parts_ : kNone;
}

const RapidValue* RapidArguments::find(std::string_view name) const {
  for (const auto& [known, value] : optional)
    if (known == name) return &value;
  return nullptr;
}

const RapidValue* RapidVariables::find(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : &found->second;
}

void RapidVariables::set(const std::string& name, RapidValue value, const Place& place) {
  if (value.depth() > kDeepestList)
    throw InputError(place, fmt::format("lists nest more than {} deep", kDeepestList));
  values_.insert_or_assign(name, std::move(value));
}

std::optional<std::size_t> RapidVariables::part_of(std::string_view component) {
  static const std::unordered_map<std::string_view, std::size_t> kParts{
      {"TRANS", 0},  {"ROT", 1},     {"ROBCONF", 2}, {"EXTAX", 3}, {"X", 0},      {"Y", 1},
      {"Z", 2},      {"Q1", 0},      {"Q2", 1},      {"Q3", 2},    {"Q4", 3},     {"UFRAME", 3},
      {"OFRAME", 4}, {"TFRAME", 1},  {"V_TCP", 0},   {"V_ORI", 1}, {"V_LEAX", 2}, {"V_REAX", 3},
      {"EAX_A", 0},  {"EAX_B", 1},   {"EAX_C", 2},   {"EAX_D", 3}, {"EAX_E", 4},  {"EAX_F", 5},
      {"ROBAX", 0},  {"ROBHOLD", 0}, {"CF1", 0},     {"CF4", 1},   {"CF6", 2},    {"CFX", 3}};
  const auto part = kParts.find(component);
  return part == kParts.end() ? std::nullopt : std::optional(part->second);
}

RapidValue rapid_expression(StatementScanner& scanner, const RapidVariables& variables) {
  return sum(scanner, variables);
}

RapidArguments rapid_arguments(StatementScanner& scanner, const RapidVariables& variables, char end) {
  RapidArguments arguments;
  while (end == '\0' ? !scanner.at_end() : !scanner.take(end)) {
    if (scanner.take(',')) continue;
    if (!scanner.take('\\')) {
      arguments.positional.push_back(sum(scanner, variables));
      continue;
    }
    const std::string name = scanner.name();
    if (name.empty()) scanner.fail("the name of an argument");
    RapidValue value = RapidValue::of_name(name);
    if (scanner.take(':')) {
      scanner.expect('=');
      value = sum(scanner, variables);
    }
    arguments.optional.emplace_back(name, std::move(value));
  }
  return arguments;
}

std::optional<Pose> rapid_pose(const RapidValue& value, const Place& place) {
  if (!value.is_list(2) || !value.parts()[0].is_list(3) || !value.parts()[1].is_list(4)) return std::nullopt;
  double p[3], q[4];
  for (std::size_t i = 0; i < 3; ++i) {
    if (!value.parts()[0].parts()[i].is_number()) return std::nullopt;
    p[i] = from_mm(value.parts()[0].parts()[i].number);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (!value.parts()[1].parts()[i].is_number()) return std::nullopt;
    q[i] = value.parts()[1].parts()[i].number;
  }
  const Quat turn(q[0], q[1], q[2], q[3]);
  if (!(std::abs(turn.norm() - 1) <= kUnitLength))
    throw InputError(
        place, fmt::format("the quaternion [{:.6g},{:.6g},{:.6g},{:.6g}] has length {:.6g}, not 1", q[0],
                           q[1], q[2], q[3], turn.norm()));
  return make_pose(turn.normalized(), Vec3(p[0], p[1], p[2]));
}

RapidValue rapid_target(const Pose& X) {
  std::vector<RapidValue> p;
  for (int i = 0; i < 3; ++i) p.push_back(RapidValue::of(to_mm(X.translation()[i])));
  return RapidValue::list({RapidValue::list(std::move(p)), orientation(Quat(X.linear()))});
}

}  // namespace understudy::toolpath
