// Private to this folder: values of RAPID, and expressions of them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/frames.h"
#include "toolpath/robot/statement_scanner.h"

namespace understudy::toolpath {

/// A number (of bool 1 and 0), a text, or a list: robtarget, pos, orient, speeddata...; in mm and degrees.
struct RapidValue {
  enum class Kind : unsigned char { unknown, number, text, list };
  Kind kind = Kind::unknown;
  double number = 0;
  std::string text;  ///< of an unknown, and of a list that a variable holds: the name

  static RapidValue of(double number);
  static RapidValue of_name(std::string name);
  static RapidValue list(std::vector<RapidValue> parts);
  bool is_number() const { return kind == Kind::number; }
  /// Of a list; else none.
  const std::vector<RapidValue>& parts() const;
  bool is_list(std::size_t size) const { return kind == Kind::list && parts().size() >= size; }
  /// Of lists within each other; 0 of what is no list.
  int depth() const { return depth_; }

 private:
  int depth_ = 0;
  std::shared_ptr<const std::vector<RapidValue>> parts_;  // a copy costs the same whatever its length
};

/// What follows the name of an instruction or function.
struct RapidArguments {
  std::vector<RapidValue> positional;
  std::vector<std::pair<std::string, RapidValue>> optional;  ///< named, after a backslash; no value: unknown

  const RapidValue* find(std::string_view name) const;
};

class RapidVariables {
 public:
  const RapidValue* find(const std::string& name) const;
  /// Throws InputError at `place` for lists that nest deeper than brackets may, as `a := [a]` again and
  /// again.
  void set(const std::string& name, RapidValue value, const Place& place);
  /// The present robtarget, which CRobT gives.
  std::function<RapidValue()> present;

  /// Which part trans, rot, x, q1, uframe... name.
  static std::optional<std::size_t> part_of(std::string_view component);

 private:
  std::unordered_map<std::string, RapidValue> values_;
};

/// Sums, products, lists, components, elements NAME{2}, and the functions Offs, RelTool, OrientZYX and CRobT.
/// Unknown parts make a number unknown. Throws InputError for what is no expression, UnknownStatement for
/// other functions.
RapidValue rapid_expression(StatementScanner& scanner, const RapidVariables& variables);
/// To the end of the statement, or behind `end`.
RapidArguments rapid_arguments(StatementScanner& scanner, const RapidVariables& variables, char end);

/// [m], of [pos, orient, ...]; nothing: it is none. Throws InputError for an orientation of another length
/// than 1.
std::optional<Pose> rapid_pose(const RapidValue& value, const Place& place);
RapidValue rapid_target(const Pose& X);

}  // namespace understudy::toolpath
