// What goes wrong with the tool's microscope and its laser while the machine works, from a stated time on
// (docs/faults.md). Everything acts on pictures of the true scene, behind the port: the controller receives
// frames and learns nothing else.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "sim/exposure.h"

namespace understudy::sim {

enum class CameraFaultKind {
  dark,       ///< the laser is off
  dim,        ///< the laser has lost power
  saturated,  ///< the laser is too bright for the exposure
  frozen,     ///< the picture of the first frame after the fault for good; numbers and times go on
  stale,      ///< the former frame once more, with its number and its time
  lost,       ///< no frame comes
  ghost,      ///< a thread on the nozzle shines in place of the part: its dot moves with the tool
  cut_beam,   ///< an edge in the beam takes a part of every dot
  strip,      ///< a strip hangs before the camera and stands still in the picture
  displaced,  ///< the camera reads out another region than it was asked for, and says so
};
constexpr int kCameraFaultKinds = 10;
const char* to_string(CameraFaultKind kind);

struct CameraFaultEvent {
  CameraFaultKind kind = CameraFaultKind::dark;
  double time = 0;        ///< [s], port clock: from then on
  double share = 1;       ///< of the frames; which, is drawn
  double power = 1;       ///< dim: below 1; saturated: above 1; of what the laser has by itself
  double gap_offset = 0;  ///< ghost: [m], that the thread's dot shows beyond the gap when the fault began
  /// [px]: cut_beam, from the dot's centre to the edge, negative where the centre is hidden; strip, from the
  /// dot's centre as the fault begins to the strip's near side; displaced, along the sensor's x.
  double offset_px = 0;
  double direction = 0;  ///< cut_beam, strip: [rad], from the sensor's x towards its y, where it is hidden
};

/// "dark picture from 2.500 s on, 40 % of the frames"
std::string describe(const CameraFaultEvent& event);

/// Throws InputError for a time below 0, a share outside (0, 1], a power that is none of its kind, and
/// offsets beyond what a picture shows.
void check_camera_faults(const std::vector<CameraFaultEvent>& events);

/// Stands between a port and its microscope: ask() once for every frame, then either the former frame comes
/// again, or expose() gives the picture.
class FaultyCamera {
 public:
  /// `sensor` gives width and height only. Each event has a random stream of its own.
  FaultyCamera(const Camera& sensor, std::vector<CameraFaultEvent> events, std::uint64_t seed);

  bool sound() const { return faults_.empty(); }
  /// A frame is exposed at a time: which faults befall it.
  void ask(double time);
  /// Of the frame asked for: the former one is delivered in its place.
  bool repeats_former() const;
  /// The picture of the frame asked for; empty: it is lost.
  Image expose(const Shot& shot, const Exposure& exposure);
  /// The former frame was delivered.
  void count_former() { ++altered_; }
  /// Frames so far that did not come, came again, show another region, or differ visibly from what a sound
  /// camera would have shown.
  int altered() const { return altered_; }

 private:
  struct Fault {
    CameraFaultEvent event;
    Random random;
    bool strikes = false;         ///< the frame asked for
    std::optional<Image> frozen;  ///< whole sensor
    std::optional<Pose> X_WT_ghost;
    std::optional<Vec2> strip_px;  ///< on its near side
  };
  Image faulty(const Shot& shot, const Exposure& exposure);
  Image frozen(Fault& fault, const Shot& shot, const Exposure& exposure) const;
  Image ghost(Fault& fault, const Shot& shot, const Exposure& exposure) const;
  void hide(Fault& fault, const Shot& shot, const Exposure& exposure, Image& image) const;

  const Region sensor_;
  std::vector<Fault> faults_;
  int altered_ = 0;
};

}  // namespace understudy::sim
