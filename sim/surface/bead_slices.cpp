#include "sim/surface/bead_slices.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/interrupt.h"
#include "sim/surface/swept_shell.h"

namespace understudy::sim {
namespace {

/// Equal times, each with its end.
class Times {
 public:
  Times(const std::vector<BeadStretch>& stretches, std::size_t count) : count_(count) {
    begin_ = std::numeric_limits<double>::infinity();
    end_ = -begin_;
    for (const BeadStretch& stretch : stretches)
      for (const BeadSection& section : stretch) {
        begin_ = std::min(begin_, section.laid_at);
        end_ = std::max(end_, section.laid_at);
      }
  }
  double end_of(std::size_t slice) const {
    if (slice + 1 >= count_) return end_;
    return begin_ + (end_ - begin_) * static_cast<double>(slice + 1) / static_cast<double>(count_);
  }
  /// The first slice by whose end that time has come.
  std::size_t slice_at(double time) const {
    std::size_t low = 0, high = count_ - 1;
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      if (time <= end_of(middle))
        high = middle;
      else
        low = middle + 1;
    }
    return low;
  }

 private:
  double begin_ = 0, end_ = 0;
  std::size_t count_;
};

/// A stretch with a section more wherever a slice ends within it, and the slice of what leads to each
/// section.
struct CutStretch {
  BeadStretch sections;
  std::vector<std::size_t> slices;
};

CutStretch cut(const BeadStretch& stretch, const Times& times) {
  CutStretch result{{stretch.front()}, {times.slice_at(stretch.front().laid_at)}};
  for (std::size_t i = 1; i < stretch.size(); ++i) {
    const BeadSection &a = stretch[i - 1], &b = stretch[i];
    const std::size_t last = std::max(times.slice_at(b.laid_at), result.slices.back());
    for (std::size_t slice = times.slice_at(a.laid_at); slice < last; ++slice) {
      const double time = times.end_of(slice);
      if (!(a.laid_at < time && time < b.laid_at)) continue;
      result.sections.push_back(section_between(a, b, (time - a.laid_at) / (b.laid_at - a.laid_at)));
      result.slices.push_back(slice);
    }
    result.sections.push_back(b);
    result.slices.push_back(last);
  }
  return result;
}

/// Appends what of a stretch lies in each slice.
void append_to_slices(const CutStretch& cut, int sides, std::vector<SweptShell>& shells,
                      std::vector<BeadSlice>& slices) {
  const BeadStretch& sections = cut.sections;
  const auto note = [&](std::size_t slice) {
    const SweptShell& shell = shells[slice];
    for (std::size_t v = slices[slice].where.size(); v < shell.sections.size(); ++v)
      slices[slice].where.push_back(sections[shell.sections[v]]);
  };
  if (sections.size() < 2 || cut.slices[1] == cut.slices.back()) {
    append_whole(sections, sides, shells[cut.slices.back()]);
    return note(cut.slices.back());
  }
  for (std::size_t first = 0; first + 1 < sections.size();) {
    const std::size_t slice = cut.slices[first + 1];
    std::size_t last = first + 1;
    while (last + 1 < sections.size() && cut.slices[last + 1] == slice) ++last;
    append_swept(sections, {first, last}, sides, shells[slice]);
    note(slice);
    first = last;
  }
}

}  // namespace

std::vector<BeadSlice> slice_beads(const std::vector<BeadStretch>& stretches, const SliceSettings& settings) {
  if (settings.count == 0) throw InputError("0 slices of what was laid: at least 1 is needed");
  const Times times(stretches, settings.count);
  std::vector<SweptShell> shells(settings.count);
  std::vector<BeadSlice> slices(settings.count);
  for (const BeadStretch& stretch : stretches) {
    stop_if_interrupted();
    append_to_slices(cut(stretch, times), sides_within(stretch, settings.chord_error), shells, slices);
  }
  std::vector<BeadSlice> laid;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    if (shells[i].mesh.triangles.empty()) continue;
    slices[i].by = times.end_of(i);
    slices[i].mesh = std::move(shells[i].mesh);
    slices[i].normals = std::move(shells[i].normals);
    laid.push_back(std::move(slices[i]));
  }
  return laid;
}

}  // namespace understudy::sim
