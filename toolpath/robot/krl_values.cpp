#include "toolpath/robot/krl_values.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "toolpath/robot/robot_frames.h"
#include "toolpath/robot/unknown_statements.h"

namespace understudy::toolpath {
namespace {

using Scanner = StatementScanner;
constexpr double kLargestIndex = 1e6;
constexpr std::size_t kMostComponents = 64;
constexpr std::size_t kMostText = 100;  // of which nothing is read

KrlValue sum(Scanner& scanner, const KrlVariables& variables);

KrlValue unknown(const KrlValue& a, const KrlValue& b) {
  if (const auto* left = std::get_if<KrlUnknown>(&a)) return *left;
  if (const auto* right = std::get_if<KrlUnknown>(&b)) return *right;
  return KrlUnknown{"an expression"};
}

KrlValue calculated(char operation, const KrlValue& a, const KrlValue& b) {
  const auto *left = std::get_if<double>(&a), *right = std::get_if<double>(&b);
  if (left == nullptr || right == nullptr) return unknown(a, b);
  if (operation == '+') return *left + *right;
  if (operation == '-') return *left - *right;
  if (operation == '*') return *left * *right;
  if (*right == 0) return KrlUnknown{"a quotient by 0"};
  return *left / *right;
}

/// a : b, the frame b seen from where a stands.
KrlValue composed(const KrlValue& a, const KrlValue& b) {
  const auto *left = std::get_if<KrlStructure>(&a), *right = std::get_if<KrlStructure>(&b);
  if (left == nullptr || right == nullptr || left->is_axes() || right->is_axes()) return unknown(a, b);
  return krl_frame(krl_pose(*left, Pose::Identity()) * krl_pose(*right, Pose::Identity()));
}

/// {X 1,Y 2} or {FRAME: X 1,Y 2}, behind the first bracket.
KrlValue structure(Scanner& scanner, const KrlVariables& variables) {
  const Scanner::Deeper deeper(scanner);
  KrlStructure result;
  KrlValue bad = 0.0;
  for (bool first = true; !scanner.take('}'); first = false) {
    if (!first) scanner.expect(',');
    std::string name = scanner.name();
    if (name.empty()) scanner.fail("the name of a component");
    if (result.fields.size() == kMostComponents)
      scanner.fail("the end of a structure of that many components");
    if (first && scanner.take(':')) name = scanner.name();
    if (scanner.take('[')) scanner.expect(']');  // of a text
    const KrlValue value = sum(scanner, variables);
    if (const auto* number = std::get_if<double>(&value))
      result.set(name, *number);
    else if (const auto* open = std::get_if<KrlUnknown>(&value))
      bad = *open;
  }
  if (std::holds_alternative<KrlUnknown>(bad)) return bad;
  return result;
}

KrlValue variable(Scanner& scanner, const KrlVariables& variables) {
  const std::string name = krl_variable_name(scanner, variables);
  if (name == "TRUE") return 1.0;
  if (name == "FALSE") return 0.0;
  if (scanner.peek() == '(') throw UnknownStatement(scanner.place(), name);
  std::string component;
  while (scanner.take('.')) component += (component.empty() ? "" : ".") + scanner.name();
  const KrlValue* value = variables.find(name);
  if (value == nullptr) return KrlUnknown{name};
  if (component.empty()) return *value;
  if (const auto* whole = std::get_if<KrlStructure>(value))
    if (const auto part = whole->find(component)) return *part;
  return KrlUnknown{name + "." + component};
}

KrlValue primary(Scanner& scanner, const KrlVariables& variables) {
  const Scanner::Deeper deeper(scanner);
  if (scanner.begins_number()) return scanner.number();
  if (scanner.take('{')) return structure(scanner, variables);
  if (scanner.take('#')) return "#" + scanner.name();
  if (scanner.peek() == '"') return scanner.quoted().substr(0, kMostText);
  if (scanner.take('-')) return calculated('*', -1.0, primary(scanner, variables));
  if (scanner.take('+')) return primary(scanner, variables);
  if (scanner.take('(')) {
    KrlValue inner = sum(scanner, variables);
    scanner.expect(')');
    return inner;
  }
  return variable(scanner, variables);
}

KrlValue frame(Scanner& scanner, const KrlVariables& variables) {
  KrlValue value = primary(scanner, variables);
  while (scanner.take(':')) value = composed(value, primary(scanner, variables));
  return value;
}

KrlValue product(Scanner& scanner, const KrlVariables& variables) {
  return scan_row(
      scanner, "*/", [&] { return frame(scanner, variables); }, calculated);
}

KrlValue sum(Scanner& scanner, const KrlVariables& variables) {
  return scan_row(
      scanner, "+-", [&] { return product(scanner, variables); }, calculated);
}

std::size_t bytes_of(const KrlValue& value) {
  if (const auto* unknown = std::get_if<KrlUnknown>(&value)) return unknown->name.size();
  if (const auto* text = std::get_if<std::string>(&value)) return text->size();
  std::size_t bytes = 0;
  if (const auto* structure = std::get_if<KrlStructure>(&value))
    for (const auto& field : structure->fields) bytes += sizeof field + field.first.size();
  return bytes;
}

}  // namespace

std::optional<double> KrlStructure::find(std::string_view name) const {
  for (const auto& [known, value] : fields)
    if (known == name) return value;
  return std::nullopt;
}

void KrlStructure::set(const std::string& name, double value) {
  for (auto& [known, old] : fields)
    if (known == name) {
      old = value;
      return;
    }
  fields.emplace_back(name, value);
}

bool KrlStructure::is_axes() const {
  bool axes = false;
  for (const auto& field : fields) {
    if (field.first == "X" || field.first == "Y" || field.first == "Z") return false;
    axes = axes || (field.first.size() == 2 && field.first[0] == 'A');
  }
  return axes;
}

const KrlValue* KrlVariables::find(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : &found->second;
}

void KrlVariables::set(const std::string& name, KrlValue value) {
  KrlValue& variable = values_[name];
  bytes_ += bytes_of(value);
  bytes_ -= bytes_of(variable);
  variable = std::move(value);
}

void KrlVariables::set_component(const std::string& name, const std::string& component,
                                 const KrlValue& value) {
  KrlValue& whole = values_.try_emplace(name, KrlStructure{}).first->second;
  bytes_ -= bytes_of(whole);
  if (!std::holds_alternative<KrlStructure>(whole)) whole = KrlStructure{};
  const auto* number = std::get_if<double>(&value);
  if (number != nullptr)
    std::get<KrlStructure>(whole).set(component, *number);
  else
    whole = KrlUnknown{name + "." + component};
  bytes_ += bytes_of(whole);
}

std::string krl_indexed(std::string name, StatementScanner& scanner, const KrlVariables& variables) {
  if (!scanner.take('[')) return name;
  if (scanner.take(']')) return name;  // a text
  const Scanner::Deeper deeper(scanner);
  const KrlValue index = sum(scanner, variables);
  while (scanner.take(',')) sum(scanner, variables);
  scanner.expect(']');
  const auto* number = std::get_if<double>(&index);
  if (number == nullptr || !(std::abs(*number) <= kLargestIndex)) return name + "[]";
  return fmt::format("{}[{}]", name, std::lround(*number));
}

std::string krl_variable_name(StatementScanner& scanner, const KrlVariables& variables) {
  std::string name = scanner.name();
  if (name.empty()) scanner.fail("a value");
  return krl_indexed(std::move(name), scanner, variables);
}

KrlValue krl_expression(StatementScanner& scanner, const KrlVariables& variables) {
  return sum(scanner, variables);
}

Pose krl_pose(const KrlStructure& frame, const std::optional<Pose>& present) {
  const auto component = [&](std::string_view name, double old) { return frame.find(name).value_or(old); };
  const Pose X = present.value_or(Pose::Identity());
  Vec3 p;
  for (int i = 0; i < 3; ++i)
    p[i] = from_mm(
        component(std::string_view("XYZ").substr(static_cast<std::size_t>(i), 1), to_mm(X.translation()[i])));
  if (!frame.find("A") && !frame.find("B") && !frame.find("C")) return make_pose(Mat3(X.linear()), p);
  const Vec3 old = abc_of(X.linear());
  return make_pose(
      rotation_abc(from_deg(component("A", to_deg(old[0]))), from_deg(component("B", to_deg(old[1]))),
                   from_deg(component("C", to_deg(old[2])))),
      p);
}

KrlStructure krl_frame(const Pose& X) {
  const Vec3 p = X.translation(), abc = abc_of(X.linear());
  KrlStructure frame;
  for (int i = 0; i < 3; ++i) frame.fields.emplace_back(std::string(1, "XYZ"[i]), to_mm(p[i]));
  for (int i = 0; i < 3; ++i) frame.fields.emplace_back(std::string(1, "ABC"[i]), to_deg(abc[i]));
  return frame;
}

}  // namespace understudy::toolpath
