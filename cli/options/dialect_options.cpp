#include "cli/options/dialect_options.h"

#include <cctype>
#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>

namespace understudy::cli {
namespace {

std::string upper(std::string word) {
  for (char& c : word) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return word;
}

void read_place(const std::string& word, control::DialectRequest& dialect) {
  dialect.place_auto = word == "auto";
  if (dialect.place_auto) return;
  std::istringstream numbers(word);
  char comma[2] = {' ', ' '};
  auto& [x, y, z] = dialect.place_mm;
  numbers >> x >> comma[0] >> y >> comma[1] >> z;
  if (!numbers || comma[0] != ',' || comma[1] != ',' || numbers.peek() != std::char_traits<char>::eof())
    throw CLI::ValidationError("--place", "'" + word + "' is neither X,Y,Z in mm nor auto");
}

}  // namespace

void add_dialect_options(CLI::App& command, control::DialectRequest& dialect) {
  command
      .add_option_function<std::string>(
          "--place", [&dialect](const std::string& word) { read_place(word, dialect); },
          "X,Y,Z in mm: where the program's origin stands; auto: where `understudy place` puts it")
      ->type_name("X,Y,Z|auto")
      ->group("Programs of other machines");
  command
      .add_option("--turn", dialect.turn_deg,
                  "degrees: the program turned about the vertical through its origin")
      ->check(CLI::Range(-360., 360.))
      ->group("Programs of other machines");
  command
      .add_option("--spin", dialect.spin_deg,
                  "degrees: the tool turned about its own axis, on machines that can")
      ->check(CLI::Range(-360., 360.))
      ->group("Programs of other machines");
  command
      .add_option("--extruder-letter", dialect.extruder_letter,
                  "letter of the filament's axis, such as A; without it the machine file's, else E")
      ->group("Programs of other machines");
  add_reading_options(command, dialect);
  command
      .add_option("--macros", dialect.macros,
                  "Klipper's configuration, whose macros stand for commands that are unknown here")
      ->group("Programs of other machines");
  add_process_options(command, dialect);
  command
      .add_flag(
          "--strict", dialect.strict,
          "refuse a program with lines that cannot be read or made, instead of a no-go that tells of them "
          "and of the rest")
      ->group("Programs of other machines");
  command.add_option("--b-sign", dialect.b_sign, "-1: the program counts B the other way round")
      ->check(CLI::IsMember({-1, 1}))
      ->capture_default_str()
      ->group("Programs of other machines");
  command.add_option("--c-sign", dialect.c_sign, "-1: the program counts C the other way round")
      ->check(CLI::IsMember({-1, 1}))
      ->capture_default_str()
      ->group("Programs of other machines");
  command
      .add_option(
          "--coordinates", dialect.coordinates,
          "what X Y Z mean beside rotary words: tip (on the work), machine (the slides), crossing (the "
          "slides "
          "of a machine whose turning axes cross at the program's origin); without it the machine file's")
      ->group("Programs of other machines");
}

void add_reading_options(CLI::App& command, control::DialectRequest& dialect) {
  command
      .add_flag("--relative-extrusion", dialect.relative_extrusion,
                "E is relative from the start, as after M83, where a macro of the printer says so")
      ->group("Programs of other machines");
  command
      .add_option(
          "--ignore", dialect.ignored,
          "commands to pass over with their lines, such as M428,START_PRINT: of what they do the twin "
          "knows nothing")
      ->delimiter(',')
      ->transform(upper)
      ->group("Programs of other machines");
}

void add_process_options(CLI::App& command, control::DialectRequest& dialect) {
  const auto add = [&](const char* name, std::optional<double>& value, const char* about, double low,
                       double high) {
    command.add_option(name, value, about)->check(CLI::Range(low, high))->group("Programs of other machines");
  };
  add("--temperature", dialect.temperature_c,
      "C: the nozzle's from the start on, or from the ignored macro on that sets it", 100, 450);
  add("--nozzle", dialect.nozzle_mm, "mm: bore of the nozzle that is mounted, if not the machine file's",
      0.05, 10);
  add("--layer", dialect.layer_mm, "mm: height of the layers, where the path does not tell", 0.01, 10);
}

}  // namespace understudy::cli
