// The statements of KRL.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/units.h"
#include "toolpath/robot/krl_reader.h"

namespace understudy::toolpath {
namespace {

/// System variables that change nothing on the twin: its limits are the machine description's.
constexpr std::string_view kWithoutEffect[] = {"$ACC",
                                               "$ACC_AXIS",
                                               "$VEL_AXIS",
                                               "$APO",
                                               "$ADVANCE",
                                               "$ORI_TYPE",
                                               "$CIRC_TYPE",
                                               "$BWDSTART",
                                               "$H_POS",
                                               "$LOAD",
                                               "$ACT_TOOL",
                                               "$ACT_BASE",
                                               "$JERK",
                                               "$GEAR_JERK",
                                               "$VEL_EXTAX",
                                               "$ACC_EXTAX",
                                               "PDAT_ACT",
                                               "LDAT_ACT",
                                               "$TIMER",
                                               "$TIMER_STOP",
                                               "$OV_ROB",
                                               "$DECEL",
                                               "$RED_VEL",
                                               "$RED_ACC",
                                               "$SPL_ORI_JOINT_AUTO",
                                               "$SPL_TSYS",
                                               "$CP_VEL_TYPE",
                                               "$CP_STATMON",
                                               "$SINGUL_STRATEGY",
                                               "$LOAD_A1",
                                               "$TORQMON",
                                               "$COLLMON_TOL_PRO",
                                               "$CIRC_MODE"};

}  // namespace

bool KrlReader::is_without_effect(const std::string& name) {
  const std::string bare = name.substr(0, name.find('['));
  return std::find(std::begin(kWithoutEffect), std::end(kWithoutEffect), bare) != std::end(kWithoutEffect);
}

const std::unordered_map<std::string_view, KrlReader::Handler>& KrlReader::handlers() {
  using R = KrlReader;
  static const std::unordered_map<std::string_view, Handler> all{{"DECL", &R::declare},
                                                                 {"GLOBAL", &R::declare},
                                                                 {"INT", &R::declare},
                                                                 {"REAL", &R::declare},
                                                                 {"BOOL", &R::declare},
                                                                 {"CHAR", &R::declare},
                                                                 {"FRAME", &R::declare},
                                                                 {"POS", &R::declare},
                                                                 {"E6POS", &R::declare},
                                                                 {"AXIS", &R::declare},
                                                                 {"E6AXIS", &R::declare},
                                                                 {"FDAT", &R::declare},
                                                                 {"LDAT", &R::declare},
                                                                 {"PDAT", &R::declare},
                                                                 {"SIGNAL", &R::declare},
                                                                 {"PTP", &R::move},
                                                                 {"LIN", &R::move},
                                                                 {"SPTP", &R::move},
                                                                 {"SLIN", &R::move},
                                                                 {"CIRC", &R::move_round},
                                                                 {"SCIRC", &R::move_round},
                                                                 {"PTP_REL", &R::move_relative},
                                                                 {"LIN_REL", &R::move_relative},
                                                                 {"WAIT", &R::wait},
                                                                 {"BAS", &R::basis},
                                                                 {"TRIGGER", &R::trigger},
                                                                 {"INTERRUPT", &R::interrupt},
                                                                 {"SPLINE", &R::begin_spline},
                                                                 {"ENDSPLINE", &R::end_spline},
                                                                 {"CONTINUE", &R::nothing},
                                                                 {"HALT", &R::nothing},
                                                                 {"EXT", &R::nothing},
                                                                 {"EXTFCT", &R::nothing},
                                                                 {"STRUC", &R::nothing},
                                                                 {"ENUM", &R::nothing},
                                                                 {"RETURN", &R::nothing}};
  return all;
}

void KrlReader::run_statement(const std::string& word, Scanner& scanner) {
  const auto handler = handlers().find(word);
  if (handler == handlers().end()) return assign_or_call(word, scanner);
  (this->*handler->second)(word, scanner);
}

void KrlReader::nothing(const std::string& word, Scanner&) { ended_ = ended_ || word == "RETURN"; }

/// DECL E6POS XP1={...},XP2={...}; what has no value yet is unknown.
void KrlReader::declare(const std::string& word, Scanner& scanner) {
  std::string type = word;
  while (type == "DECL" || type == "GLOBAL" || type == "CONST") type = scanner.name();
  if (type == "INTERRUPT") return interrupt(type, scanner);
  if (type == "STRUC" || type == "ENUM") return;
  if (type == "SIGNAL") {
    const std::string name = scanner.name();
    signals_[name] = krl_variable_name(scanner, variables_);
    return;
  }
  do {
    const std::string name = krl_variable_name(scanner, variables_);
    if (scanner.take('=')) variables_.set(name, value_of(scanner));
  } while (scanner.take(','));
}

KrlValue KrlReader::value_of(Scanner& scanner) {
  if (scanner.rest().find('$') != std::string_view::npos) {
    // Before any position it is where the program is taught to begin: the origin of its base, upright.
    const Pose X_UN = path_.X_UN().value_or(Pose::Identity());
    variables_.set("$POS_ACT", krl_frame(X_UN));
  }
  return krl_expression(scanner, variables_);
}

double KrlReader::number_of(Scanner& scanner) {
  const KrlValue value = value_of(scanner);
  if (const auto* unknown = std::get_if<KrlUnknown>(&value))
    throw UnknownStatement(scanner.place(), unknown->name);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  scanner.fail("a number");
}

void KrlReader::wait(const std::string& word, Scanner& scanner) {
  if (!scanner.take_name("SEC")) throw UnknownStatement(scanner.place(), "WAIT_" + scanner.name());
  ++path_.facts.statements[word];
  path_.wait(number_of(scanner));
}

/// BAS(#VEL_CP,0.1) of the controller's own library.
void KrlReader::basis(const std::string&, Scanner& scanner) {
  scanner.expect('(');
  scanner.expect('#');
  const std::string what = scanner.name();
  const bool given = scanner.take(',');
  const double value = given ? number_of(scanner) : 0;
  scanner.expect(')');
  static constexpr std::string_view kNone[] = {"INITMOV", "ACC_CP", "VEL_PTP", "ACC_PTP", "PTP_PARAMS",
                                               "PTP_DAT", "CP_DAT", "VEL_ORI", "ACC_ORI", "VEL_ORI1"};
  if (std::find(std::begin(kNone), std::end(kNone), what) != std::end(kNone)) return;
  if (!given) throw UnknownStatement(scanner.place(), "#" + what);
  if (what == "VEL_CP" || what == "CP_PARAMS") {
    cp_speed_ = value;
  } else if (what == "BASE" || what == "TOOL") {
    if (what == "BASE") return set_numbered_base(value);
    path_.set_tool(fmt::format("TOOL_DATA[{}]", std::lround(value)));
  } else {
    throw UnknownStatement(scanner.place(), "#" + what);
  }
}

/// TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE: at the start (0) or the end (1) of the next move.
void KrlReader::trigger(const std::string& word, Scanner& scanner) {
  const UnknownStatement unread(scanner.place(), word);
  if (!scanner.take_name("WHEN")) throw unread;
  const std::string where = scanner.name();
  scanner.expect('=');
  const double at = number_of(scanner);
  const bool on_start = scanner.take_name("ONSTART");
  if (!scanner.take_name("DELAY")) throw unread;
  scanner.expect('=');
  const bool delayed = number_of(scanner) != 0;
  if (!scanner.take_name("DO")) throw unread;
  const bool at_start = (where == "DISTANCE" && at == 0) || (where == "PATH" && at == 0 && on_start);
  const bool at_end = (where == "DISTANCE" && at == 1) || (where == "PATH" && at == 0 && !on_start);
  const std::string name = krl_variable_name(scanner, variables_);
  if (delayed || !(at_start || at_end) || !set_output(name, scanner, at_end)) throw unread;
}

/// The stop message that every program declares, and which are on: without effect.
void KrlReader::interrupt(const std::string&, Scanner& scanner) {
  const std::string what = scanner.name();
  if (what == "DECL" && scanner.rest().find("$STOPMESS") == std::string_view::npos)
    throw UnknownStatement(scanner.place(), "INTERRUPT");
}

void KrlReader::assign_or_call(const std::string& word, Scanner& scanner) {
  const std::string name = krl_indexed(word, scanner, variables_);
  if (scanner.peek() == '(') return call(name, scanner);
  if (scanner.take(':') && scanner.at_end()) return;  // a label, to which nothing jumps
  std::string component;
  while (scanner.take('.')) component += (component.empty() ? "" : ".") + scanner.name();
  if (!scanner.take('=')) throw UnknownStatement(scanner.place(), word);
  assign(name, component, scanner);
}

void KrlReader::assign(const std::string& name, const std::string& component, Scanner& scanner) {
  if (is_without_effect(name)) return;
  if (name == "FDAT_ACT" || name.starts_with('$') || signals_.contains(name))
    return assign_system(name, component, scanner);
  const KrlValue value = value_of(scanner);
  if (component.empty())
    variables_.set(name, value);
  else
    variables_.set_component(name, component, value);
}

/// Speeds, frames and outputs.
void KrlReader::assign_system(const std::string& name, const std::string& component, Scanner& scanner) {
  if (component.empty() && set_output(name, scanner, false)) return;
  const std::string text(scanner.rest());
  const KrlValue value = value_of(scanner);
  const auto* number = std::get_if<double>(&value);
  const auto* structure = std::get_if<KrlStructure>(&value);
  const std::string frame =
      text.starts_with('{') || !component.empty() ? name : upper_case(text.substr(0, 40));
  if (name == "$VEL") {
    const auto whole = structure != nullptr ? structure->find("CP") : std::nullopt;
    if (component == "CP" && number == nullptr) throw UnknownStatement(scanner.place(), "$VEL.CP");
    if (component == "CP") cp_speed_ = *number;
    if (component.empty() && whole) cp_speed_ = *whole;
  } else if (name == "$OV_PRO") {
    if (number == nullptr || !(*number > 0 && *number <= 100))
      scanner.fail("$OV_PRO of 1 to 100 before this");
    override_ = *number / 100;
  } else if (name == "$BASE") {
    if (component.empty())
      variables_.set(name, value);
    else
      variables_.set_component(name, component, value);
    set_base(frame, *variables_.find(name));
  } else if (name == "$TOOL") {
    path_.set_tool(frame);
  } else if (const auto* open = std::get_if<KrlUnknown>(&value); name == "FDAT_ACT" && open != nullptr) {
    // Of the controller's home it does not matter.
    if (!open->name.starts_with("FHOME") && !open->name.starts_with("FDEFAULT"))
      throw UnknownStatement(scanner.place(), open->name);
  } else if (name == "FDAT_ACT" && structure != nullptr) {
    const auto base = structure->find("BASE_NO"), tool = structure->find("TOOL_NO");
    if (tool) path_.set_tool(fmt::format("TOOL_DATA[{}]", std::lround(*tool)));
    if (base) set_numbered_base(*base);
  } else if (name == "$IPO_MODE" && text.find("#BASE") != std::string::npos) {
    return;
  } else {
    throw UnknownStatement(scanner.place(), component.empty() ? name.substr(0, name.find('[')) : name);
  }
}

void KrlReader::set_base(const std::string& name, const KrlValue& value) {
  const auto* frame = std::get_if<KrlStructure>(&value);
  path_.set_base({name, frame == nullptr ? std::nullopt : std::optional(krl_pose(*frame, Pose::Identity()))});
}

void KrlReader::set_numbered_base(double number) {
  const std::string name = fmt::format("BASE_DATA[{}]", std::lround(number));
  const KrlValue* known = variables_.find(name);
  set_base(name, known == nullptr ? KrlValue(KrlUnknown{name}) : *known);
}

/// $OUT[1]=TRUE and $ANOUT[1]=0.5, behind the name, or the name that SIGNAL gives. False: it is no output.
bool KrlReader::set_output(const std::string& name, Scanner& scanner, bool after_next) {
  const auto alias = signals_.find(name);
  const std::string output = alias == signals_.end() ? name : alias->second;
  const bool analogue = output.starts_with("$ANOUT[");
  if (!analogue && !output.starts_with("$OUT[")) return false;
  scanner.take('=');
  ++path_.facts.statements[analogue ? "$ANOUT" : "$OUT"];
  path_.set_output(output.substr(1), number_of(scanner), analogue, after_next);
  return true;
}

}  // namespace understudy::toolpath
