#include "toolpath/gcode/gcode_work_offsets.h"

#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "toolpath/gcode/gcode_position.h"

namespace understudy::toolpath {
namespace {

/// G54 is the first, G59.3 the ninth.
std::size_t index_of(double code) {
  const double whole = std::floor(code);
  return static_cast<std::size_t>(whole - 54 + std::round(10 * (code - whole)));
}

}  // namespace

void WorkOffsets::select(const Block& block) {
  if (const Word* word = block.find(Command::work_offset)) active_ = index_of(word->value);
}

void WorkOffsets::set(Block& block, double unit, bool relative, const Vec3& reading) {
  const Word& code = *block.find(Command::retract);
  const Word *l = block.take('L'), *p = block.take('P');
  const bool by_reading = l != nullptr && l->value == 20;
  if (l == nullptr || (l->value != 2 && !by_reading))
    block.fail(code, fmt::format("'{}' sets work offsets by L2 or L20 alone; tables of tools are not read",
                                 l == nullptr ? code.text : l->text));
  const auto count = static_cast<double>(tables_.size());
  if (p == nullptr || !(p->value >= 0 && p->value <= count && p->value == std::floor(p->value)))
    block.fail(p == nullptr ? code : *p,
               fmt::format("'{}' needs P, a whole number from 0 (the work offset in use) to {:g}",
                           p == nullptr ? code.text : p->text, count));
  if (block.find_any("XYZ") == nullptr) block.fail(code, fmt::format("'{}' names none of X Y Z", code.text));
  if (relative)
    block.fail(code, fmt::format("'{}' under G91: controllers differ in what it adds; put G90 before it",
                                 code.text));
  Vec3& table = tables_[p->value == 0 ? active_ : static_cast<std::size_t>(p->value) - 1];
  for (int i = 0; i < 3; ++i) {
    const Word* word = block.take("XYZ"[i]);
    if (word == nullptr) continue;
    const double value = length_of(block, *word, unit);
    table[i] = by_reading ? reading[i] - value : value;
    if (std::abs(table[i]) > kLargestCoordinate)
      block.fail(*word, fmt::format("'{}' leads to an offset of {:.6g} mm, beyond {:.6g} mm", word->text,
                                    to_mm(table[i]), to_mm(kLargestCoordinate)));
  }
}

}  // namespace understudy::toolpath
