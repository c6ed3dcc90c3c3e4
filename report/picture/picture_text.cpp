#include "report/picture/picture_text.h"

#include <opencv2/imgproc.hpp>

namespace understudy::report {

void write(cv::Mat& canvas, const std::string& text, cv::Point at, double size, const cv::Scalar& colour,
           Align align) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  const int thickness = size > 0.8 ? 2 : 1;
  int base = 0;
  const int width = cv::getTextSize(text, kFont, size, thickness, &base).width;
  if (align == Align::centre) at.x -= width / 2;
  if (align == Align::right) at.x -= width;
  cv::putText(canvas, text, at, kFont, size, colour, thickness, cv::LINE_AA);
}

}  // namespace understudy::report
