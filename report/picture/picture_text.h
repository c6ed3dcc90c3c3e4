// Private to this folder: text on a picture.
#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace understudy::report {

const cv::Scalar kInk(40, 36, 32), kFaint(120, 116, 112), kPaper(255, 255, 255);

enum class Align { left, centre, right };

/// `at` is on the base line. OpenCV's strokes know ASCII only.
void write(cv::Mat& canvas, const std::string& text, cv::Point at, double size,
           const cv::Scalar& colour = kInk, Align align = Align::left);

}  // namespace understudy::report
