#include "sim/faults/camera_faults.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/cut_image.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

constexpr int kVisible = 30;            // grey levels, a sixth of the dot: beyond noise and speckle's grain
constexpr double kLit = 20;             // grey levels over the unlit picture that belong to the dot
constexpr double kStripWidth = 30;      // [px], half a millimetre: a thread of molten plastic
constexpr double kPowerMax = 100;       // of the laser's own
constexpr double kGapOffsetMax = 5e-3;  // [m], beyond it the dot leaves the picture
constexpr double kOffsetMaxPx = 1000;   // farther than a picture is wide

std::size_t index(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) + static_cast<std::size_t>(x);
}

/// Centre of what the laser adds to a picture [px]; nothing where it adds nothing.
std::optional<Vec2> lit_centre(const Image& image, const Image& unlit) {
  double weight = 0;
  Vec2 sum(0, 0);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double light = image.at(x, y) - unlit.at(x, y) - kLit;
      if (light <= 0) continue;
      weight += light;
      sum += light * Vec2(image.region.x + x, image.region.y + y);
    }
  if (weight == 0) return std::nullopt;
  return Vec2(sum / weight);
}

bool visibly_differ(const Image& a, const Image& b) {
  if (!(a.region == b.region) || a.pixels.size() != b.pixels.size()) return true;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (std::abs(static_cast<int>(a.pixels[i]) - static_cast<int>(b.pixels[i])) > kVisible) return true;
  return false;
}

double power_of(const CameraFaultEvent& event) {
  switch (event.kind) {
    case CameraFaultKind::dark:
      return 0;
    case CameraFaultKind::dim:
    case CameraFaultKind::saturated:
      return event.power;
    default:
      return 1;
  }
}

void require(bool good, const CameraFaultEvent& event, const char* quantity, double value,
             const char* limit) {
  if (!good)
    throw InputError(
        fmt::format("camera fault {}: {} {:g} is not {}", to_string(event.kind), quantity, value, limit));
}

}  // namespace

const char* to_string(CameraFaultKind kind) {
  switch (kind) {
    case CameraFaultKind::dark:
      return "dark";
    case CameraFaultKind::dim:
      return "dim";
    case CameraFaultKind::saturated:
      return "saturated";
    case CameraFaultKind::frozen:
      return "frozen";
    case CameraFaultKind::stale:
      return "stale";
    case CameraFaultKind::lost:
      return "lost";
    case CameraFaultKind::ghost:
      return "ghost";
    case CameraFaultKind::cut_beam:
      return "cut_beam";
    case CameraFaultKind::strip:
      return "strip";
    case CameraFaultKind::displaced:
      return "displaced";
  }
  return "unknown";
}

std::string describe(const CameraFaultEvent& event) {
  std::string what = fmt::format("camera {} from {:.3f} s on", to_string(event.kind), event.time);
  if (event.share < 1) what += fmt::format(", {:.0f} % of the frames", 100 * event.share);
  switch (event.kind) {
    case CameraFaultKind::dim:
    case CameraFaultKind::saturated:
      return what + fmt::format(", laser at {:g} of its power", event.power);
    case CameraFaultKind::ghost:
      return what + fmt::format(", {:+.1f} um beyond the gap", to_um(event.gap_offset));
    case CameraFaultKind::cut_beam:
    case CameraFaultKind::strip:
      return what + fmt::format(", {:+.1f} px from the dot, towards {:.0f} deg", event.offset_px,
                                to_deg(event.direction));
    case CameraFaultKind::displaced:
      return what + fmt::format(", by {:+.0f} px", event.offset_px);
    default:
      return what;
  }
}

void check_camera_faults(const std::vector<CameraFaultEvent>& events) {
  for (const CameraFaultEvent& event : events) {
    require(event.time >= 0 && std::isfinite(event.time), event, "time [s]", event.time, "0 or later");
    require(event.share > 0 && event.share <= 1, event, "share", event.share, "above 0 and at most 1");
    require(std::abs(event.offset_px) <= kOffsetMaxPx, event, "offset [px]", event.offset_px,
            "within 1000 px");
    require(std::abs(event.gap_offset) <= kGapOffsetMax, event, "gap offset [m]", event.gap_offset,
            "within 5 mm");
    require(std::isfinite(event.direction), event, "direction [rad]", event.direction, "finite");
    if (event.kind == CameraFaultKind::dim)
      require(event.power >= 0 && event.power < 1, event, "power", event.power, "from 0 to below 1");
    if (event.kind == CameraFaultKind::saturated)
      require(event.power > 1 && event.power <= kPowerMax, event, "power", event.power,
              "above 1 and at most 100");
    if (event.kind == CameraFaultKind::displaced)
      require(std::abs(event.offset_px) >= 1, event, "offset [px]", event.offset_px,
              "1 px or more to either side");
  }
}

FaultyCamera::FaultyCamera(const Camera& camera, std::vector<CameraFaultEvent> events, std::uint64_t seed)
    : sensor_(camera.sensor()) {
  check_camera_faults(events);
  for (std::size_t i = 0; i < events.size(); ++i)
    faults_.push_back({events[i], Random(seed, fmt::format("camera fault {}", i)), false, {}, {}, {}});
}

void FaultyCamera::ask(double time) {
  for (Fault& fault : faults_)
    fault.strikes = time >= fault.event.time && fault.random.uniform() < fault.event.share;
}

bool FaultyCamera::repeats_former() const {
  return std::any_of(faults_.begin(), faults_.end(), [](const Fault& fault) {
    return fault.strikes && fault.event.kind == CameraFaultKind::stale;
  });
}

Image FaultyCamera::expose(const Shot& shot, const Exposure& exposure) {
  if (std::none_of(faults_.begin(), faults_.end(), [](const Fault& fault) { return fault.strikes; }))
    return exposure(shot);
  Image image = faulty(shot, exposure);
  if (visibly_differ(image, exposure(shot))) ++altered_;
  return image;
}

/// Light first, then what replaces the picture, then what stands before it, then the camera itself.
Image FaultyCamera::faulty(const Shot& shot, const Exposure& exposure) {
  Shot taken = shot;
  for (const Fault& fault : faults_)
    if (fault.strikes) {
      taken.laser *= power_of(fault.event);
      if (fault.event.kind == CameraFaultKind::lost) return {};
      if (fault.event.kind == CameraFaultKind::displaced)
        taken.region.x += static_cast<int>(std::lround(fault.event.offset_px));
    }
  Image image = exposure(taken);
  for (Fault& fault : faults_) {
    if (!fault.strikes || image.pixels.empty()) continue;
    if (fault.event.kind == CameraFaultKind::ghost) image = ghost(fault, taken, exposure);
    if (fault.event.kind == CameraFaultKind::frozen) image = frozen(fault, taken, exposure);
    if (fault.event.kind == CameraFaultKind::cut_beam || fault.event.kind == CameraFaultKind::strip)
      hide(fault, taken, exposure, image);
  }
  return image;
}

Image FaultyCamera::frozen(Fault& fault, const Shot& shot, const Exposure& exposure) const {
  if (!fault.frozen) {
    Shot whole = shot;
    whole.region = sensor_;
    fault.frozen = exposure(whole);
  }
  return cut(*fault.frozen, shot.region);
}

/// The dot as the tool had it when the fault began, on a surface whose grain is new in every frame: it
/// flickers as speckle does.
Image FaultyCamera::ghost(Fault& fault, const Shot& shot, const Exposure& exposure) const {
  if (!fault.X_WT_ghost) {
    fault.X_WT_ghost = shot.X_WT;
    fault.X_WT_ghost->translation() += fault.event.gap_offset * tool_axis(shot.X_WT);
  }
  Shot thread = shot;
  thread.X_WT = *fault.X_WT_ghost;
  thread.surface = 1 + fault.random.bits() / 2;
  return exposure(thread);
}

/// What is hidden looks as it does without the laser.
void FaultyCamera::hide(Fault& fault, const Shot& shot, const Exposure& exposure, Image& image) const {
  Shot dark = shot;
  dark.laser = 0;
  const Image unlit = exposure(dark);
  const Vec2 side(std::cos(fault.event.direction), std::sin(fault.event.direction));
  const bool strip = fault.event.kind == CameraFaultKind::strip;
  std::optional<Vec2> edge = fault.strip_px;
  if (!edge) {
    const auto centre = lit_centre(image, unlit);
    if (!centre) return;
    edge = *centre + fault.event.offset_px * side;
    if (strip) fault.strip_px = edge;
  }
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double beyond = (Vec2(image.region.x + x, image.region.y + y) - *edge).dot(side);
      if (beyond > 0 && (!strip || beyond < kStripWidth))
        image.pixels[index(image, x, y)] = unlit.pixels[index(image, x, y)];
    }
}

}  // namespace understudy::sim
