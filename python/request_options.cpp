#include "python/request_options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "core/error.h"
#include "core/text/shell_quoted.h"
#include "rehearsal/request/fault_words.h"

namespace understudy::python {
namespace py = pybind11;
namespace {

using rehearsal::RehearsalRequest;
using Words = std::vector<std::string>;

/// One keyword: takes its value into the request, and returns the words of the command line for it.
struct Option {
  const char* name;
  std::function<Words(const Option&, const py::handle&, RehearsalRequest&)> take;
};

std::string flag_of(const Option& option) {
  std::string flag = std::string("--") + option.name;
  std::ranges::replace(flag, '_', '-');
  return flag;
}

[[noreturn]] void refuse(const Option& option, const py::handle& value, const std::string& expected) {
  throw InputError(fmt::format("{} {}: expected {}", option.name, std::string(py::repr(value)), expected));
}

template <typename Type>
Type cast_to(const Option& option, const py::handle& value, const char* expected) {
  try {
    return value.cast<Type>();
  } catch (const py::cast_error&) {
    refuse(option, value, expected);
  }
}

/// A str, or a path.
std::string text_of(const Option& option, const py::handle& value) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::hasattr(value, "__fspath__")) return py::str(value.attr("__fspath__")());
  refuse(option, value, "a str or a path");
}

Option text(const char* name, std::string& (*field)(RehearsalRequest&)) {
  return {name, [field](const Option& option, const py::handle& value, RehearsalRequest& request) {
            const std::string word = text_of(option, value);
            if (word.empty()) throw InputError(fmt::format("{} is empty: leave the option out", option.name));
            field(request) = word;
            return Words{flag_of(option), word};
          }};
}

struct Range {
  double low, high;
  bool low_is_in = true;
};
constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr Range kPositive{0, kAny, false};

double number_of(const Option& option, const py::handle& value, const Range& range) {
  const double number = py::isinstance<py::bool_>(value) || py::isinstance<py::str>(value)
                            ? (refuse(option, value, "a number"), 0)
                            : cast_to<double>(option, value, "a number");
  if (!(number >= range.low && number <= range.high && (range.low_is_in || number > range.low)))
    refuse(option, value,
           range.high == kAny ? "a number above 0" : fmt::format("{:g}..{:g}", range.low, range.high));
  return number;
}

template <typename Field>
Option number(const char* name, Field field, Range range) {
  return {name, [field, range](const Option& option, const py::handle& value, RehearsalRequest& request) {
            const double taken = number_of(option, value, range);
            field(request) = taken;
            return Words{flag_of(option), fmt::format("{}", taken)};
          }};
}

Option sign(const char* name, int& (*field)(RehearsalRequest&)) {
  return {name, [field](const Option& option, const py::handle& value, RehearsalRequest& request) {
            const double taken = number_of(option, value, {-1, 1});
            if (taken != -1 && taken != 1) refuse(option, value, "-1 or 1");
            field(request) = static_cast<int>(taken);
            return Words{flag_of(option), fmt::format("{}", taken)};
          }};
}

Option flag(const char* name, const char* word, bool& (*field)(RehearsalRequest&), bool word_means) {
  return {name, [=](const Option& option, const py::handle& value, RehearsalRequest& request) {
            if (!py::isinstance<py::bool_>(value)) refuse(option, value, "True or False");
            field(request) = value.cast<bool>();
            return field(request) == word_means ? Words{word} : Words{};
          }};
}

std::vector<double> numbers_of(const Option& option, const py::handle& value, std::size_t count) {
  std::vector<double> taken;
  if (!py::isinstance<py::str>(value) &&
      (py::isinstance<py::sequence>(value) || py::hasattr(value, "__array__")))
    taken = cast_to<std::vector<double>>(option, value, "numbers");
  if (taken.empty() || (count > 0 && taken.size() != count))
    refuse(option, value, count > 0 ? fmt::format("{} numbers", count) : "numbers");
  return taken;
}

Option numbers(const char* name, std::vector<double>& (*field)(RehearsalRequest&), std::size_t count) {
  return {name, [=](const Option& option, const py::handle& value, RehearsalRequest& request) {
            field(request) = numbers_of(option, value, count);
            return Words{flag_of(option), fmt::format("{}", fmt::join(field(request), ","))};
          }};
}

Words words_of(const Option& option, const py::handle& value) {
  if (py::isinstance<py::str>(value)) return {value.cast<std::string>()};
  return cast_to<Words>(option, value, "a str, or several");
}

Words take_seed(const Option& option, const py::handle& value, RehearsalRequest& request) {
  const char* const expected = "a whole number from 0 to 18446744073709551615";
  if (py::isinstance<py::bool_>(value)) refuse(option, value, expected);
  request.seed = cast_to<std::uint64_t>(option, value, expected);
  return {"--seed", std::to_string(request.seed)};
}

Words take_places(const Option& option, const py::handle& value, RehearsalRequest& request) {
  request.registration.places = cast_to<int>(option, value, "a whole number");
  return {"--places", std::to_string(request.registration.places)};
}

Words take_place(const Option& option, const py::handle& value, RehearsalRequest& request) {
  rehearsal::DialectRequest& dialect = request.dialect;
  if (py::isinstance<py::str>(value)) {
    if (value.cast<std::string>() != "auto") refuse(option, value, "'auto', or x, y, z in mm");
    dialect.place_auto = true;
    return {"--place", "auto"};
  }
  const std::vector<double> place = numbers_of(option, value, 3);
  std::ranges::copy(place, dialect.place_mm.begin());
  return {"--place", fmt::format("{}", fmt::join(place, ","))};
}

Words take_ignored(const Option& option, const py::handle& value, RehearsalRequest& request) {
  for (std::string word : words_of(option, value)) {
    for (char& c : word) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    request.dialect.ignored.push_back(word);
  }
  return {"--ignore", fmt::format("{}", fmt::join(request.dialect.ignored, ","))};
}

Words take_faults(const Option& option, const py::handle& value, RehearsalRequest& request) {
  Words words;
  for (const std::string& fault : words_of(option, value)) {
    rehearsal::add_fault(fault, request);
    words.insert(words.end(), {"--fault", fault});
  }
  return words;
}

// NOLINTBEGIN(bugprone-macro-parentheses): a lambda
#define FIELD(path) \
  [](RehearsalRequest & r) -> auto& { return r.path; }
// NOLINTEND(bugprone-macro-parentheses)

const std::vector<Option>& options_known() {
  static const std::vector<Option> known{
      text("machine", FIELD(machine)),
      text("before", FIELD(before)),
      numbers("home_axes", FIELD(home_axes), 0),
      text("engine", FIELD(engine)),
      text("fixture", FIELD(fixture)),
      text("material", FIELD(material)),
      text("as_built", FIELD(as_built)),
      {"seed", take_seed},
      text("gap_control", FIELD(gap_control)),
      flag("register", "--register", FIELD(registration.wanted), true),
      text("pattern", FIELD(registration.pattern)),
      {"places", take_places},
      number("tip_tolerance", FIELD(tip_tolerance_mm), kPositive),
      number("orientation_tolerance", FIELD(orientation_tolerance_deg), kPositive),
      {"place", take_place},
      number("turn", FIELD(dialect.turn_deg), {-360, 360}),
      number("spin", FIELD(dialect.spin_deg), {-360, 360}),
      text("extruder_letter", FIELD(dialect.extruder_letter)),
      {"ignore", take_ignored},
      text("macros", FIELD(dialect.macros)),
      number("temperature", FIELD(dialect.temperature_c), {100, 450}),
      number("nozzle", FIELD(dialect.nozzle_mm), {0.05, 10}),
      number("layer", FIELD(dialect.layer_mm), {0.01, 10}),
      flag("strict", "--strict", FIELD(dialect.strict), true),
      flag("relative_extrusion", "--relative-extrusion", FIELD(dialect.relative_extrusion), true),
      sign("b_sign", FIELD(dialect.b_sign)),
      sign("c_sign", FIELD(dialect.c_sign)),
      text("coordinates", FIELD(dialect.coordinates)),
      text("as_printed", FIELD(surface.as_printed)),
      text("intended", FIELD(surface.intended)),
      number("depth_of_cut", FIELD(surface.depth_of_cut_mm), {0.001, 100}),
      text("stock", FIELD(surface.stock)),
      numbers("profile", FIELD(surface.profile_mm), 6),
      numbers("probe", FIELD(surface.probe), 3),
      number("max_time", FIELD(max_time), kPositive),
      flag("pictures", "--no-pictures", FIELD(keep_scene), false),
      {"fault", take_faults},
  };
  return known;
}

#undef FIELD

/// Of options that exclude or need each other, as the command has it.
void check_pairs(const RehearsalRequest& request) {
  if (!request.before.empty() && !request.home_axes.empty()) throw InputError("home_axes excludes before");
  if (!request.surface.stock.empty() && request.surface.depth_of_cut_mm)
    throw InputError("stock excludes depth_of_cut");
}

}  // namespace

RehearsalRequest request_of(const std::string& program, const py::dict& options) {
  RehearsalRequest request;
  request.program = program;
  Words command{"understudy", "rehearse"}, names;
  if (!program.empty()) command.push_back(program);
  for (const Option& option : options_known()) names.emplace_back(option.name);
  for (const auto& [key, value] : options) {
    const auto name = py::cast<std::string>(key);
    if (std::ranges::find(names, name) != names.end()) continue;
    const std::string near = nearest_word(name, names);
    throw InputError(fmt::format("unknown option '{}'{}", name,
                                 near.empty() ? "" : fmt::format(", did you mean '{}'?", near)));
  }
  for (const Option& option : options_known()) {
    if (!options.contains(option.name)) continue;
    const py::object value = options[option.name];
    if (value.is_none()) continue;
    const Words words = option.take(option, value, request);
    command.insert(command.end(), words.begin(), words.end());
  }
  check_pairs(request);
  for (std::string& word : command) word = shell_quoted(word);
  request.command = fmt::format("{}", fmt::join(command, " "));
  return request;
}

}  // namespace understudy::python
