// The instructions of RAPID.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/units.h"
#include "toolpath/robot/rapid_reader.h"

namespace understudy::toolpath {
namespace {

constexpr double kSameExternalAxis = 1e-3;  // [mm] or [deg], which files round
constexpr double kUnusedAxis = 9e8;         // 9E9, of an axis that there is not

/// The controller's own speeds: v100 is 100 mm/s. Nothing: no such name.
std::optional<double> named_speed(const std::string& name) {
  static constexpr int kSpeeds[] = {5,   10,  20,  30,   40,   50,   60,   80,   100,  150,  200,  300, 400,
                                    500, 600, 800, 1000, 1500, 2000, 2500, 3000, 4000, 5000, 6000, 7000};
  int speed = 0;
  const char* end = name.data() + name.size();
  if (name.size() < 2 || std::from_chars(name.data() + 1, end, speed).ptr != end || name[0] != 'V')
    return std::nullopt;
  if (std::find(std::begin(kSpeeds), std::end(kSpeeds), speed) == std::end(kSpeeds)) return std::nullopt;
  return from_mm(speed);
}

/// `whole` with another value in the part that the names lead to.
RapidValue with_part(const RapidValue& whole, std::span<const std::string> names, RapidValue value,
                     const Place& place) {
  if (names.empty()) return value;
  constexpr std::size_t kMostParts = 64;
  const auto index = RapidVariables::part_of(names.front());
  if (!index || *index >= whole.parts().size() || whole.parts().size() > kMostParts)
    throw UnknownStatement(place, names.front());
  std::vector<RapidValue> parts = whole.parts();
  parts[*index] = with_part(parts[*index], names.subspan(1), std::move(value), place);
  return RapidValue::list(std::move(parts));
}

}  // namespace

const std::unordered_map<std::string_view, RapidReader::Handler>& RapidReader::handlers() {
  using R = RapidReader;
  static const std::unordered_map<std::string_view, Handler> all{
      {"VAR", &R::declare},         {"PERS", &R::declare},        {"CONST", &R::declare},
      {"LOCAL", &R::declare},       {"TASK", &R::declare},        {"MOVEL", &R::move},
      {"MOVEJ", &R::move},          {"MOVELDO", &R::move},        {"MOVEJDO", &R::move},
      {"MOVELAO", &R::move},        {"MOVEJAO", &R::move},        {"MOVEC", &R::move_round},
      {"MOVEABSJ", &R::move_axes},  {"SETDO", &R::set_output},    {"SETAO", &R::set_output},
      {"SETGO", &R::set_output},    {"SET", &R::set_output},      {"RESET", &R::set_output},
      {"WAITTIME", &R::wait},       {"VELSET", &R::set_velocity}, {"CONFL", &R::nothing},
      {"CONFJ", &R::nothing},       {"SINGAREA", &R::nothing},    {"ACCSET", &R::nothing},
      {"TPERASE", &R::nothing},     {"TPWRITE", &R::nothing},     {"WAITROB", &R::nothing},
      {"CIRPATHMODE", &R::nothing}, {"PATHACCLIM", &R::nothing},  {"WORLDACCLIM", &R::nothing},
      {"GRIPLOAD", &R::nothing},    {"ACTUNIT", &R::nothing},     {"DEACTUNIT", &R::nothing},
      {"CLKRESET", &R::nothing},    {"CLKSTART", &R::nothing},    {"CLKSTOP", &R::nothing},
      {"STOP", &R::nothing},        {"EOFFSOFF", &R::nothing},    {"RETURN", &R::nothing},
      {"EXIT", &R::nothing},        {"MOTIONSUP", &R::nothing},   {"CORNERPATHWARNING", &R::nothing}};
  return all;
}

void RapidReader::run_instruction(const std::string& word, Scanner& scanner) {
  const auto handler = handlers().find(word);
  if (handler == handlers().end()) return assign_or_call(word, scanner);
  (this->*handler->second)(word, scanner);
}

void RapidReader::nothing(const std::string& word, Scanner&) {
  returned_ = returned_ || word == "RETURN";
  exited_ = exited_ || word == "EXIT";
}

/// CONST robtarget p10:=[...]; arrays p{3}:=[...,...,...]. The type does not matter.
void RapidReader::declare(const std::string& word, Scanner& scanner) {
  std::string type = word;
  while (type == "LOCAL" || type == "TASK" || type == "VAR" || type == "PERS" || type == "CONST")
    type = scanner.name();
  if (type.empty()) scanner.fail("a type");
  const std::string name = scanner.name();
  if (name.empty()) scanner.fail("a name");
  if (scanner.take('{')) {
    rapid_arguments(scanner, variables_, '}');
  }
  if (!scanner.take(':')) return;
  scanner.expect('=');
  variables_.set(name, rapid_expression(scanner, variables_), scanner.place());
}

RapidArguments RapidReader::arguments(Scanner& scanner, std::size_t at_least) {
  RapidArguments all = rapid_arguments(scanner, variables_, '\0');
  if (all.positional.size() < at_least)
    throw InputError(scanner.place(),
                     fmt::format("{} arguments, {} are needed", all.positional.size(), at_least));
  return all;
}

Pose RapidReader::target(const RapidValue& value, Scanner& scanner) {
  if (value.kind == RapidValue::Kind::unknown) throw UnknownStatement(scanner.place(), value.text);
  const auto X_UN = rapid_pose(value, scanner.place());
  if (!X_UN)
    throw InputError(scanner.place(),
                     "a target needs a position and an orientation, [[x,y,z],[q1,q2,q3,q4],...]");
  check_external_axes(value, scanner);
  return *X_UN;
}

/// Where track and table stand: the pose is stated in the work object, so that it does not matter while they
/// rest.
void RapidReader::check_external_axes(const RapidValue& target, Scanner& scanner) {
  if (!target.is_list(4)) return;
  const auto& axes = target.parts()[3].parts();
  for (std::size_t i = 0; i < axes.size() && i < 6; ++i) {
    if (!axes[i].is_number() || std::abs(axes[i].number) > kUnusedAxis) continue;
    const double before = external_axes_.try_emplace(i, axes[i].number).first->second;
    const std::string name = fmt::format("EAX_{}", static_cast<char>('A' + i));
    if (std::abs(axes[i].number - before) > kSameExternalAxis && !is_ignored(name))
      unknown_.add(UnknownStatement(scanner.place(), name));
  }
}

RapidReader::Speed RapidReader::speed(const RapidArguments& arguments, std::size_t at,
                                      Scanner& scanner) const {
  Speed speed;
  if (const RapidValue* time = arguments.find("T"); time != nullptr && time->is_number()) {
    speed.duration = time->number;
    return speed;
  }
  const RapidValue& value = arguments.positional[at];
  if (const RapidValue* own = arguments.find("V"); own != nullptr && own->is_number()) {
    speed.feed = from_mm(own->number);
  } else if (value.is_list(1) && value.parts()[0].is_number()) {
    speed.feed = from_mm(value.parts()[0].number);
  } else {
    const std::string name = upper_case(value.text);
    const auto named = named_speed(name);
    if (name == "VMAX") return speed;
    if (!named) throw UnknownStatement(scanner.place(), value.text.empty() ? "speed" : value.text);
    speed.feed = *named;
  }
  speed.feed *= override_;
  if (fastest_ > 0) speed.feed = std::min(speed.feed, fastest_);
  return speed;
}

/// The tool's name and \WObj.
void RapidReader::set_frames(const RapidArguments& arguments, std::size_t tool_at, Scanner& scanner) {
  if (tool_at < arguments.positional.size()) {
    const RapidValue& tool = arguments.positional[tool_at];
    path_.set_tool(tool.text);
    if (tool.is_list(1) && tool.parts()[0].is_number() && tool.parts()[0].number == 0)
      throw InputError(scanner.place(),
                       "a tool that stands still while the robot holds the work is not read");
  }
  const RapidValue* work = arguments.find("WOBJ");
  const RapidValue* wobj0 = variables_.find("WOBJ0");
  const RapidValue& value = work != nullptr ? *work : *wobj0;
  if (value.kind == RapidValue::Kind::unknown) return path_.set_base({value.text, std::nullopt});
  if (!value.is_list(5)) throw InputError(scanner.place(), "\\WObj needs a work object");
  if (value.parts()[0].is_number() && value.parts()[0].number != 0)
    throw InputError(scanner.place(),
                     "work that the robot holds, under a tool that stands still, is not read");
  const auto user = rapid_pose(value.parts()[3], scanner.place()),
             object = rapid_pose(value.parts()[4], scanner.place());
  path_.set_base({work != nullptr ? value.text : "wobj0",
                  user && object ? std::optional(*user * *object) : std::nullopt});
}

/// MoveL target, speed, zone, tool\WObj:=...; MoveLDO has a signal and its value from the end of the move on.
void RapidReader::move(const std::string& word, Scanner& scanner) {
  const bool sets = word.ends_with("DO") || word.ends_with("AO");
  const RapidArguments all = arguments(scanner, sets ? 6 : 2);
  set_frames(all, 3, scanner);
  const Pose X_UN = target(all.positional[0], scanner);
  const Speed at = speed(all, 1, scanner);
  ++path_.facts.statements[word];
  if (sets) {
    if (!all.positional[5].is_number()) throw UnknownStatement(scanner.place(), all.positional[5].text);
    path_.set_output(all.positional[4].text, all.positional[5].number, word.ends_with("AO"), true);
  }
  if (word.starts_with("MOVEJ") || (at.feed == 0 && at.duration == 0))
    path_.free(X_UN, at.feed);
  else
    path_.straight(X_UN, at.feed, at.duration);
}

void RapidReader::move_round(const std::string& word, Scanner& scanner) {
  const RapidArguments all = arguments(scanner, 3);
  set_frames(all, 4, scanner);
  const Pose via = target(all.positional[0], scanner), end = target(all.positional[1], scanner);
  const Speed at = speed(all, 2, scanner);
  ++path_.facts.statements[word];
  path_.arc(via.translation(), end, std::nullopt, at.feed, at.duration);
}

void RapidReader::move_axes(const std::string& word, Scanner& scanner) {
  arguments(scanner, 2);
  ++path_.facts.statements[word];
  path_.axes();
}

/// SetDO, SetAO and SetGO with a value; Set and Reset without.
void RapidReader::set_output(const std::string& word, Scanner& scanner) {
  const bool bare = word == "SET" || word == "RESET";
  const RapidArguments all = arguments(scanner, bare ? 1 : 2);
  if (const RapidValue* delay = all.find("SDELAY"); delay != nullptr && delay->number != 0)
    throw UnknownStatement(scanner.place(), word + "_SDelay");
  const RapidValue& signal = all.positional[0];
  if (signal.text.empty()) scanner.fail("the name of a signal");
  double value = word == "SET" ? 1 : 0;
  if (!bare) {
    const RapidValue& set = all.positional[1];
    const std::string name = upper_case(set.text);
    if (!set.is_number() && name != "HIGH" && name != "LOW")
      throw UnknownStatement(scanner.place(), set.text);
    value = set.is_number() ? set.number : name == "HIGH" ? 1 : 0;
  }
  ++path_.facts.statements[word];
  path_.set_output(signal.text, value, word == "SETAO" || word == "SETGO");
}

void RapidReader::wait(const std::string& word, Scanner& scanner) {
  const RapidArguments all = arguments(scanner, 1);
  if (!all.positional[0].is_number()) throw UnknownStatement(scanner.place(), all.positional[0].text);
  ++path_.facts.statements[word];
  path_.wait(all.positional[0].number);
}

/// VelSet percent, most mm/s.
void RapidReader::set_velocity(const std::string&, Scanner& scanner) {
  const RapidArguments all = arguments(scanner, 2);
  if (!all.positional[0].is_number() || !all.positional[1].is_number() || !(all.positional[0].number > 0) ||
      !(all.positional[0].number <= 100) || !(all.positional[1].number > 0))
    throw InputError(scanner.place(), "VelSet needs a percentage up to 100 and a speed in mm/s");
  override_ = all.positional[0].number / 100;
  fastest_ = from_mm(all.positional[1].number);
}

void RapidReader::assign_or_call(const std::string& word, Scanner& scanner) {
  if (scanner.at_end()) return call(word, scanner);
  std::vector<std::string> components;
  while (scanner.take('.')) components.push_back(scanner.name());
  if (!scanner.take(':')) throw UnknownStatement(scanner.place(), word);
  if (scanner.at_end()) return;  // a label, to which nothing jumps
  scanner.expect('=');
  RapidValue value = rapid_expression(scanner, variables_);
  const RapidValue* known = variables_.find(word);
  if (components.empty() || known == nullptr) return variables_.set(word, std::move(value), scanner.place());
  variables_.set(word, with_part(*known, components, std::move(value), scanner.place()), scanner.place());
}

}  // namespace understudy::toolpath
