// Private to this folder: a program in KRL, statement by statement.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "toolpath/robot/krl_values.h"
#include "toolpath/robot/robot_path.h"
#include "toolpath/robot/robot_program.h"
#include "toolpath/robot/unknown_statements.h"

namespace understudy::toolpath {

class KrlReader {
 public:
  KrlReader(std::string_view text, const std::string& file, const RobotOptions& options);

  /// Declarations of the .dat file.
  void read_data(std::string_view text);
  Program read();

 private:
  using Scanner = StatementScanner;
  using Handler = void (KrlReader::*)(const std::string& word, Scanner&);
  struct Routine {
    std::size_t first = 0, last = 0;  ///< lines between DEF and END
    bool takes_parameters = false;
  };

  static const std::unordered_map<std::string_view, Handler>& handlers();
  void find_routines();
  void run(const Routine& routine);
  std::size_t run_line(std::size_t index);
  std::size_t pass_block(std::size_t index, const std::string& word);
  void run_statement(const std::string& word, Scanner& scanner);
  bool is_ignored(const std::string& word) const;
  void count_line(int line);
  void check_variables(const Place& place) const;

  void declare(const std::string& word, Scanner& scanner);
  void move(const std::string& word, Scanner& scanner);
  void move_round(const std::string& word, Scanner& scanner);
  void move_relative(const std::string& word, Scanner& scanner);
  void wait(const std::string& word, Scanner& scanner);
  void basis(const std::string& word, Scanner& scanner);
  void trigger(const std::string& word, Scanner& scanner);
  void interrupt(const std::string& word, Scanner& scanner);
  void begin_spline(const std::string& word, Scanner& scanner);
  void end_spline(const std::string& word, Scanner& scanner);
  void nothing(const std::string& word, Scanner& scanner);
  void assign_or_call(const std::string& word, Scanner& scanner);
  void assign(const std::string& name, const std::string& component, Scanner& scanner);
  void assign_system(const std::string& name, const std::string& component, Scanner& scanner);
  void call(const std::string& name, Scanner& scanner);

  /// System variables that change nothing on the twin.
  static bool is_without_effect(const std::string& name);
  KrlValue value_of(Scanner& scanner);
  double number_of(Scanner& scanner);
  Pose place_of(const KrlStructure& frame, Scanner& scanner);
  KrlStructure position_of(Scanner& scanner);
  void check_external_axes(const KrlStructure& position, const Place& place);
  std::optional<double> read_move_end(Scanner& scanner);
  std::optional<double> read_with(Scanner& scanner);
  double speed(std::optional<double> own) const;
  void set_base(const std::string& name, const KrlValue& value);
  void set_numbered_base(double number);
  bool set_output(const std::string& name, Scanner& scanner, bool after_next);

  std::string file_;
  const RobotOptions& options_;
  std::vector<std::string_view> lines_;  // without comments
  std::unordered_map<std::string, Routine> routines_;
  std::string main_;
  KrlVariables variables_;
  std::unordered_map<std::string, std::string> signals_;  // names of outputs
  std::map<std::string, double> external_axes_;           // in the first position that has them
  RobotPath path_;
  UnknownStatements unknown_;
  std::vector<std::string> calls_;
  std::size_t lines_run_ = 0;
  double cp_speed_ = 0;  // [m/s]
  double override_ = 1;
  std::optional<double> speed_before_spline_;
  bool ended_ = false;  // the present routine, by RETURN
};

}  // namespace understudy::toolpath
