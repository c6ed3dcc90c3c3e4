// Private to this folder: a program in RAPID, instruction by instruction.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "toolpath/robot/rapid_text.h"
#include "toolpath/robot/rapid_values.h"
#include "toolpath/robot/robot_path.h"
#include "toolpath/robot/robot_program.h"
#include "toolpath/robot/unknown_statements.h"

namespace understudy::toolpath {

class RapidReader {
 public:
  RapidReader(const std::string& text, const std::string& file, const RobotOptions& options);

  Program read();

 private:
  using Scanner = StatementScanner;
  using Handler = void (RapidReader::*)(const std::string& word, Scanner&);
  struct Routine {
    std::size_t first = 0, last = 0;  ///< statements between PROC and ENDPROC
    bool takes_parameters = false;
  };
  struct Speed {
    double feed = 0;      ///< [m/s]; 0: as fast as the robot goes
    double duration = 0;  ///< [s], where above 0
  };

  static const std::unordered_map<std::string_view, Handler>& handlers();
  void find_routines();
  std::string main_routine() const;
  void run(const Routine& routine);
  std::size_t run_statement(std::size_t index);
  std::size_t pass_block(std::size_t index);
  void run_instruction(const std::string& word, Scanner& scanner);
  bool is_ignored(const std::string& word) const;
  void count_statement(int line);

  void declare(const std::string& word, Scanner& scanner);
  void move(const std::string& word, Scanner& scanner);
  void move_round(const std::string& word, Scanner& scanner);
  void move_axes(const std::string& word, Scanner& scanner);
  void set_output(const std::string& word, Scanner& scanner);
  void wait(const std::string& word, Scanner& scanner);
  void set_velocity(const std::string& word, Scanner& scanner);
  void nothing(const std::string& word, Scanner& scanner);
  void assign_or_call(const std::string& word, Scanner& scanner);
  void call(const std::string& name, Scanner& scanner);

  RapidArguments arguments(Scanner& scanner, std::size_t at_least);
  Pose target(const RapidValue& value, Scanner& scanner);
  Speed speed(const RapidArguments& arguments, std::size_t at, Scanner& scanner) const;
  void set_frames(const RapidArguments& arguments, std::size_t tool_at, Scanner& scanner);
  void check_external_axes(const RapidValue& target, Scanner& scanner);

  std::string file_, text_;  // without comments
  const RobotOptions& options_;
  std::vector<RapidStatement> statements_;
  std::unordered_map<std::string, Routine> routines_;
  RapidVariables variables_;
  std::map<std::size_t, double> external_axes_;  // in the first target that has them
  RobotPath path_;
  UnknownStatements unknown_;
  std::vector<std::string> calls_;
  std::size_t statements_run_ = 0;
  double override_ = 1, fastest_ = 0;  // VelSet; [m/s], 0: no limit
  bool returned_ = false;              // from the present routine
  bool exited_ = false;
};

}  // namespace understudy::toolpath
