#include "toolpath/pass_over.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace understudy::toolpath {
namespace {

constexpr double kFeedAtRest = 0.03;  // [m/s], of filament
constexpr double kNoFilament = 1e-9;  // [m]: rounding

/// Filament as a hot end has it.
struct Filament {
  double fed = 0, most = 0;  // [m]
  void add(double filament) {
    fed += filament;
    most = std::max(most, fed);
  }
  double drawn_back() const { return most - fed; }
};

class Rest {
 public:
  Rest(Program& program, const Pose& X_WT_home) : program_(program) {
    kept_.reserve(program.steps.size());
    at_.X_WT = X_WT_home;
  }

  void add(const Step& step, bool impossible) {
    if (!moves(step)) {
      kept_.push_back(step);
      if (leaving_out_) kept_.back().X_WT = at_.X_WT;
      return;
    }
    const bool stays = leaving_out_ && step.kind != StepKind::home && step.X_WT.isApprox(left_out_.X_WT, 0);
    if (impossible || stays) {
      if (!leaving_out_) drawn_back_ = filament_.drawn_back();
      leaving_out_ = true;
      left_out_ = step;
    } else {
      if (leaving_out_) rejoin(step);
      kept_.push_back(step);
      at_ = step;
    }
    filament_.add(step.filament);
  }

  void finish() { program_.steps = std::move(kept_); }

 private:
  void rejoin(const Step& next) {
    const auto at = [&](StepKind kind, const Step& place) {
      Step step;
      step.kind = kind;
      step.X_WT = place.X_WT;
      step.rotary = place.rotary;
      step.line = next.line;
      return step;
    };
    if (next.kind != StepKind::travel && next.kind != StepKind::home) {
      at_ = at(StepKind::travel, left_out_);
      kept_.push_back(at_);
    }
    leaving_out_ = false;
    const double filament = drawn_back_ - filament_.drawn_back();
    if (std::abs(filament) < kNoFilament) return;
    kept_.push_back(at(filament > 0 ? StepKind::print : StepKind::move, at_));
    kept_.back().filament = filament;
    kept_.back().duration = std::abs(filament) / kFeedAtRest;
  }

  Program& program_;
  std::vector<Step> kept_;
  Step at_;  // where the tool is
  Filament filament_;
  bool leaving_out_ = false;
  Step left_out_;          // the last of them
  double drawn_back_ = 0;  // [m], before the first of them
};

}  // namespace

void pass_over(Program& program, const Pose& X_WT_home, const std::vector<std::size_t>& impossible) {
  Rest rest(program, X_WT_home);
  for (std::size_t i = 0; i < program.steps.size(); ++i)
    rest.add(program.steps[i], std::binary_search(impossible.begin(), impossible.end(), i));
  rest.finish();
}

}  // namespace understudy::toolpath
