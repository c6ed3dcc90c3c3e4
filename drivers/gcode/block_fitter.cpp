#include "drivers/gcode/block_fitter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace understudy::drivers {
namespace {

double on_grid(double value, double grid) { return std::round(value / grid) * grid; }

}  // namespace

BlockFitter::BlockFitter(const FitTolerance& tolerance, const BlockGrid& grid, std::vector<bool> turns)
    : tolerance_(tolerance), grid_(grid), turns_(std::move(turns)), samples_(1) {
  for (std::size_t i = 0; i < turns_.size(); ++i)
    weight_[i] = 1 / (turns_[i] ? tolerance_.angle : tolerance_.length);
}

void BlockFitter::begin(const PathSample& at) {
  from_ = at;
  for (std::size_t i = 0; i < turns_.size(); ++i) from_.position[i] = on_grid(at.position[i], grid_.axes[i]);
  from_.filament = on_grid(at.filament, grid_.filament);
  samples_.assign(1, at);
  good_ = 0;
  next_ = 1;
}

void BlockFitter::add(const PathSample& sample) {
  samples_.push_back(sample);
  settle();
}

/// A block from `from_` to the sample `last` keeps to all samples before that.
bool BlockFitter::fits(std::size_t last) const {
  const PathSample& to = samples_[last];
  const double begin = samples_.front().time, span = to.time - begin;
  machine::AxisVector step{};
  double step_square = 0;
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    step[i] = (on_grid(to.position[i], grid_.axes[i]) - from_.position[i]) * weight_[i];
    step_square += step[i] * step[i];
  }
  // Filament is one more axis: where axes turn round it tells how far the block has come.
  const double feed = (on_grid(to.filament, grid_.filament) - from_.filament) / tolerance_.filament;
  step_square += feed * feed;
  for (std::size_t n = 1; n < last; ++n) {
    const PathSample& sample = samples_[n];
    const double fed = (sample.filament - from_.filament) / tolerance_.filament;
    double along = fed * feed;
    for (std::size_t i = 0; i < turns_.size(); ++i)
      along += (sample.position[i] - from_.position[i]) * weight_[i] * step[i];
    const double due = sample.time - begin;
    const double earliest = std::max(0.0, due - tolerance_.time) / span;
    const double latest = std::min(span, due + tolerance_.time) / span;
    const double share = std::clamp(step_square > 0 ? along / step_square : due / span, earliest, latest);
    double off_square = (fed - share * feed) * (fed - share * feed);
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      const double off = (sample.position[i] - from_.position[i]) * weight_[i] - share * step[i];
      off_square += off * off;
    }
    if (off_square > 1) return false;
  }
  return true;
}

/// Between a sample to which a block fits and one to which none does.
std::size_t BlockFitter::longest(std::size_t good, std::size_t bad) const {
  while (bad - good > 1) {
    const std::size_t middle = good + (bad - good) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

void BlockFitter::settle() {
  while (samples_.size() > next_) {
    const bool too_long = samples_[next_].time - samples_.front().time > tolerance_.block_time_max;
    if (next_ > 1 && (too_long || !fits(next_))) {
      emit(longest(good_, next_));
      continue;
    }
    good_ = next_;
    next_ *= 2;
    // A block of the full length is not waited for to double.
    const auto end = std::ranges::find_if(
        samples_.begin() + static_cast<std::ptrdiff_t>(good_), samples_.end(),
        [&](const PathSample& s) { return s.time - samples_.front().time >= tolerance_.block_time_max; });
    next_ = std::min(next_, std::max(good_ + 1, static_cast<std::size_t>(end - samples_.begin())));
    if (samples_[good_].time - samples_.front().time >= tolerance_.block_time_max) emit(good_);
  }
}

void BlockFitter::finish() {
  while (samples_.size() > 1) {
    const std::size_t last = samples_.size() - 1;
    emit(last == 1 || fits(last) ? last : longest(std::max<std::size_t>(good_, 1), last));
    settle();
  }
}

void BlockFitter::emit(std::size_t last) {
  last = std::max<std::size_t>(last, 1);
  Block block;
  block.duration = samples_[last].time - samples_.front().time;
  block.line = samples_[last].line;
  block.executed = samples_[last].executed;
  block.rests = true;
  for (std::size_t i = 0; i < turns_.size(); ++i) {
    block.position[i] = on_grid(samples_[last].position[i], grid_.axes[i]);
    block.rests = block.rests && block.position[i] == from_.position[i];
  }
  block.filament = on_grid(samples_[last].filament, grid_.filament);
  block.rests = block.rests && block.filament == from_.filament;
  from_.position = block.position;
  from_.filament = block.filament;
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(last));
  good_ = 0;
  next_ = 1;
  blocks_.push_back(block);
}

std::optional<Block> BlockFitter::take() {
  if (taken_ == blocks_.size()) {
    blocks_.clear();
    taken_ = 0;
    return std::nullopt;
  }
  return blocks_[taken_++];
}

}  // namespace understudy::drivers
