// How many standard deviations the gap controller asks for, in one place.
#pragma once

namespace understudy::control {

/// Kept between an estimate and a limit that the nozzle must not pass: of a Gaussian, one in 740 lies beyond,
/// and what lies beyond is still half of the smallest accepted gap away from the part.
constexpr double kSafeSigmas = 3;

/// That a single reading may be off before it counts as wrong: one in 16 000, about one in a print of six
/// minutes at 40 frames a second.
constexpr double kPlausibleSigmas = 4;

/// Of a step of the tool, that readings may differ from it: a wrong slope of the surface, or a sensor whose
/// calibration is off.
constexpr double kScaleError = 0.15;

}  // namespace understudy::control
