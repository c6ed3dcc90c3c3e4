#include "rehearsal/serving/serve.h"

#include <memory>

#include "rehearsal/serving/controller_session.h"
#include "rehearsal/serving/served_machine.h"

namespace understudy::rehearsal {
namespace {

constexpr int kPatience = 5;       // [ms] for bytes: what a status query may wait
constexpr int kIdlePatience = 50;  // [ms], without a client

/// From the first byte of a sender to its last.
class Visit {
 public:
  Visit(ServeLine& line, const machine::MachineDescription& machine, const toolpath::GcodeOptions& options,
        const ServeOptions& serving)
      : line_(line),
        serving_(serving),
        machine_(machine, options, planner_blocks(serving.dialect)),
        session_(make_session(serving.dialect, machine_)),
        began_(serving.clock()) {}

  ServedProgram run() {
    session_->greet();
    std::string why;
    while (why.empty()) {
      if (!line_.connected()) {
        why = "the sender has left";
        break;
      }
      session_->receive(line_.read(session_->room(), kPatience));
      const double now = serving_.speed * (serving_.clock() - began_);
      session_->tick(now);
      if (serving_.moved && !machine_.idle())
        serving_.moved({now, machine_.X_WT(), machine_.filament(), machine_.moves(), machine_.refused()});
      line_.write(session_->take_output());
      if (serving_.stop()) why = "interrupted";
      if (session_->aborted()) why = "the sender has aborted it";
      if (machine_.ended() && machine_.idle() && session_->quiet()) why = "the program has ended";
    }
    line_.write(session_->take_output());
    return {machine_.text(), machine_.moves(), machine_.refused(), why, session_->aborted()};
  }

 private:
  ServeLine& line_;
  const ServeOptions& serving_;
  ServedMachine machine_;
  std::unique_ptr<ControllerSession> session_;
  double began_;
};

}  // namespace

ServedProgram serve(ServeLine& line, const machine::MachineDescription& machine,
                    const toolpath::GcodeOptions& options, const ServeOptions& serving) {
  const auto tell = [&](const std::string& what) {
    if (serving.tell) serving.tell(what);
  };
  while (!serving.stop()) {
    if (!line.connected()) {
      line.read(0, kIdlePatience);
      continue;
    }
    tell("a sender has come");
    ServedProgram program = Visit(line, machine, options, serving).run();
    tell(program.ended);
    if (program.moves > 0 || program.refused > 0) return program;
  }
  ServedProgram nothing;
  nothing.ended = "interrupted";
  return nothing;
}

}  // namespace understudy::rehearsal
