#include "calibration/table/header_units.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

struct Unit {
  const char* name;
  double factor;  ///< [m] or [rad]
  bool angle;
};
constexpr Unit kUnits[] = {{"mm", kMillimetre, false}, {"m", 1, false},        {"um", kMicrometre, false},
                           {"inch", kInch, false},     {"deg", kDegree, true}, {"rad", 1, true}};

/// As headers write them; the micro sign in UTF-8 (two code points) and as older programs write it.
constexpr std::array<std::array<const char*, 2>, 9> kSpellings{{{"\xc2\xb5m", "um"},
                                                                {"\xce\xbcm", "um"},
                                                                {"\xb5m", "um"},
                                                                {"in", "inch"},
                                                                {"degree", "deg"},
                                                                {"degrees", "deg"},
                                                                {"\xc2\xb0", "deg"},
                                                                {"\xb0", "deg"},
                                                                {"radians", "rad"}}};

std::string one_spaced(const std::string& text) {
  std::istringstream in(text);
  std::string out, word;
  while (in >> word) out += (out.empty() ? "" : " ") + word;
  return out;
}

const Unit* unit_called(std::string word) {
  for (const auto& [spelling, name] : kSpellings)
    if (word == spelling) word = name;
  for (const Unit& unit : kUnits)
    if (word == unit.name) return &unit;
  return nullptr;
}

/// The one unit that the headers of `columns` tell; nothing where none does.
const Unit* unit_of(const DelimitedText& text, const std::vector<std::string>& columns, bool angle) {
  const Unit* found = nullptr;
  std::string first;
  for (const std::string& name : columns) {
    const std::size_t at = text.column(name);
    if (at >= text.header().size()) return nullptr;
    const std::string& header = text.header()[at];
    const Unit* unit = unit_called(header_name(header).unit);
    if (unit == nullptr || unit->angle != angle) continue;
    if (found != nullptr && unit != found)
      throw InputError({text.file(), 0, 0}, fmt::format("columns '{}' and '{}' have different units",
                                                        one_spaced(first), one_spaced(header)));
    found = unit;
    first = header;
  }
  return found;
}

const char* name_of(double factor, bool angle) {
  for (const Unit& unit : kUnits)
    if (unit.angle == angle && unit.factor == factor) return unit.name;
  return "?";
}

/// Takes the headers' unit into `factor`; contradictions are refused.
bool settle(const DelimitedText& text, const std::vector<std::string>& columns, bool angle, bool told,
            const std::string& key, double& factor) {
  const Unit* unit = unit_of(text, columns, angle);
  if (unit == nullptr) return told;
  if (told && unit->factor != factor)
    throw InputError(
        {text.file(), 0, 0},
        fmt::format("the header says {} of '{}', the map's {} says {}: mend the one that is wrong",
                    unit->name, header_name(text.header()[text.column(columns.front())]).name, key,
                    name_of(factor, angle)));
  factor = unit->factor;
  return true;
}

void settle_sigma(const DelimitedText& text, bool angle, NumberColumns& numbers) {
  if (const Unit* sigma = unit_of(text, numbers.sigma, angle))
    numbers.sigma_unit = sigma->factor;
  else if (!numbers.unit_told)
    numbers.sigma_unit = numbers.unit;
}

void settle_numbers(const DelimitedText& text, bool angle, const std::string& key, NumberColumns& numbers) {
  if (!settle(text, numbers.columns, angle, numbers.unit_told, key + ".unit", numbers.unit))
    throw InputError({text.file(), 0, 0},
                     fmt::format("no header names the unit of {}: state {}.unit in the map ({})", key, key,
                                 angle ? "deg or rad" : "mm, m, um or inch"));
  settle_sigma(text, angle, numbers);
}

}  // namespace

HeaderName header_name(const std::string& header) {
  const std::string text = one_spaced(header);
  const auto open = text.find_last_of("[(");
  const bool closed =
      text.size() > 2 && open != std::string::npos && text.back() == (text[open] == '[' ? ']' : ')');
  if (!closed) return {text, ""};
  const Unit* unit = unit_called(one_spaced(text.substr(open + 1, text.size() - open - 2)));
  if (unit == nullptr) return {text, ""};
  return {one_spaced(text.substr(0, open)), unit->name};
}

void settle_units(const DelimitedText& text, const DelimitedText& joints, TableMap& map) {
  if (map.position) settle_numbers(text, false, "position", *map.position);
  if (map.distance) settle_numbers(text, false, "distance", *map.distance);
  if (map.orientation) {
    const bool angles =
        map.reading.form == OrientationForm::euler || map.reading.form == OrientationForm::rotation_vector;
    if (angles) settle_numbers(text, true, "orientation", *map.orientation);
    if (!angles) settle_sigma(text, true, *map.orientation);
    map.reading.unit = map.orientation->unit;
  }
  map.joint_unit_told =
      settle(joints, map.joints.columns, true, map.joint_unit_told, "joints.unit", map.joints.unit);
  map.slide_unit_told =
      settle(joints, map.joints.columns, false, map.slide_unit_told, "joints.slide_unit", map.slide_unit);
}

}  // namespace understudy::calibration
