// Private to this folder: values of KRL, and expressions of them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "core/frames.h"
#include "toolpath/robot/statement_scanner.h"

namespace understudy::toolpath {

/// FRAME, POS, E6POS, AXIS, FDAT...: components by name, in mm and degrees. Those that are left out are
/// unset.
struct KrlStructure {
  std::vector<std::pair<std::string, double>> fields;

  std::optional<double> find(std::string_view name) const;
  void set(const std::string& name, double value);
  /// Whether it names axes (A1...) and no X Y Z.
  bool is_axes() const;
};

/// What is not known here (inputs, timers, names that nothing declares).
struct KrlUnknown {
  std::string name;
};

/// Numbers (of BOOL 1 and 0), structures, words of enumerations, and texts.
using KrlValue = std::variant<KrlUnknown, double, KrlStructure, std::string>;

class KrlVariables {
 public:
  /// Null: not set. "NAME", or "NAME[3]" of a field.
  const KrlValue* find(const std::string& name) const;
  void set(const std::string& name, KrlValue value);
  void set_component(const std::string& name, const std::string& component, const KrlValue& value);
  /// What they need, but for their names: a line of few characters can copy a large one.
  std::size_t bytes() const { return bytes_; }

 private:
  std::size_t bytes_ = 0;
  std::unordered_map<std::string, KrlValue> values_;
};

/// `name` with the index that follows it, if one does, which is a number: "BASE_DATA[3]".
std::string krl_indexed(std::string name, StatementScanner& scanner, const KrlVariables& variables);
/// The name of a variable, likewise.
std::string krl_variable_name(StatementScanner& scanner, const KrlVariables& variables);

/// Sums, products, the geometric operator `:`, brackets, structures. Unknown parts make the whole unknown.
/// Throws InputError for what is no expression, UnknownStatement for calls of functions.
KrlValue krl_expression(StatementScanner& scanner, const KrlVariables& variables);

/// [m], [rad]; components that are unset are those of `present`.
Pose krl_pose(const KrlStructure& frame, const std::optional<Pose>& present);
KrlStructure krl_frame(const Pose& X);

}  // namespace understudy::toolpath
