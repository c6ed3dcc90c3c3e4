// Stretches of elements that do not stick, as they come.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "sim/deposition/bead_builder.h"

namespace understudy::sim {

class UnsupportedStretchRecorder {
 public:
  /// `done`, unless empty, is called for each stretch at its end.
  UnsupportedStretchRecorder(const Workpiece& workpiece, double reach, double least_width,
                             std::function<void(const UnsupportedStretch&)> done)
      : workpiece_(workpiece), reach_(reach), least_width_(least_width), done_(std::move(done)) {}

  /// What the extrusion was like when the element was laid.
  struct Conditions {
    double nozzle_temperature = 0, fan = 0;
    double interface_temperature = 0;  ///< [K], lowest of the element
    bool on_printed = false;           ///< what lies below is printed
    double highest_gap = 0;            ///< [m], upper end of the line's band
  };
  /// Elements in order, each before it joins the workpiece.
  void add(const Element& element, const Conditions& conditions);
  /// A drop that falls: its path is bare before the element that goes on from it.
  void drop(const Element& element);
  void finish();
  const std::vector<UnsupportedStretch>& stretches() const { return stretches_; }

 private:
  BarePath bare_path(const Element& element) const;
  void begin(const Element& element, const Conditions& conditions);
  void extend(const Element& element, const Conditions& conditions);
  void end(bool held);
  bool touches_something(const Vec3& p_W, double diameter, std::size_t before) const;

  const Workpiece& workpiece_;
  double reach_;        // [m], between a strand's surface and what holds it
  double least_width_;  // [m]: no row is narrower, however thin it starts
  std::function<void(const UnsupportedStretch&)> done_;
  std::vector<UnsupportedStretch> stretches_;
  bool open_ = false;
  BarePath fallen_;               // up to the next element
  bool last_held_ = false;        // the element before this one sticks
  double last_held_width_ = 0;    // [m]
  bool last_on_printed_ = false;  // to printed material
  std::size_t first_bead_ = 0;    // of the open stretch
  double diameter_ = 0;           // [m], of its last element
  double row_width_ = 0;          // [m], that it is no narrower than
  double covered_ = 0;            // [m^2], length times width of its elements
};

}  // namespace understudy::sim
