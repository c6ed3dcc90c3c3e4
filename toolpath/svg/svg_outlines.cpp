#include "toolpath/svg/svg_outlines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

#include <2geom/elliptical-arc.h>
#include <2geom/path-sink.h>
#include <2geom/pathvector.h>
#include <2geom/svg-path-parser.h>
#include <fmt/format.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/text/xml.h"
#include "core/units.h"
#include "toolpath/svg/svg_transform.h"

namespace understudy::toolpath {
namespace {

using Element = tinyxml2::XMLElement;
using std::string_view;

constexpr double kPixel = 25.4 * kMillimetre / 96;  // CSS
constexpr int kDeepest = 100;                       // groups in groups
constexpr int kHalvings = 20;                       // of a curve
constexpr std::size_t kMostPoints = 1'000'000;
constexpr double kLargest = 100;  // [m], from the drawing's origin: larger is no part of a printer

// What draws nothing, and is passed over with all that it holds.
constexpr std::array<string_view, 12> kSilent{"defs",           "title",          "desc",   "metadata",
                                              "style",          "symbol",         "marker", "clipPath",
                                              "linearGradient", "radialGradient", "mask",   "filter"};

std::string name_of(const Element& e) {
  const char* id = e.Attribute("id");
  return id ? fmt::format("<{} id=\"{}\">", e.Name(), printable(id)) : fmt::format("<{}>", e.Name());
}

class Drawing {
 public:
  Drawing(std::string file, double tolerance) : file_(std::move(file)), tolerance_(tolerance) {}

  std::vector<SvgStroke> read() {
    tinyxml2::XMLDocument document;
    const std::string text = read_file(file_);
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
      throw InputError({file_, document.ErrorLineNum(), 0},
                       fmt::format("it is no XML: {}", document.ErrorName()));
    const Element* root = document.RootElement();
    if (root == nullptr || string_view(root->Name()) != "svg")
      throw InputError({file_, 1, 0}, "its root is no <svg>: it is no SVG drawing");
    const SvgTransform page = page_of(*root);
    for (const Element* e = root->FirstChildElement(); e; e = e->NextSiblingElement()) add(*e, page, 0);
    if (strokes_.empty()) throw InputError({file_, 0, 0}, "the drawing has no outline: nothing to print");
    return std::move(strokes_);
  }

 private:
  [[noreturn]] void fail(const Element& e, const std::string& why) const {
    throw InputError({file_, e.GetLineNum(), 0}, fmt::format("{}: {}", name_of(e), why));
  }

  /// The number at the beginning of `text`, which moves on behind it.
  static std::optional<double> take_number(string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n,"), text.size()));
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
  }

  /// In user units; percentages mean nothing here.
  double number(const Element& e, const char* key, std::optional<double> missing = 0) const {
    const char* text = e.Attribute(key);
    if (text == nullptr) {
      if (missing) return *missing;
      fail(e, fmt::format("it has no {}", key));
    }
    string_view rest = text;
    const auto value = take_number(rest);
    if (!value || !(rest.empty() || rest == "px"))
      fail(e, fmt::format("{}=\"{}\" is not a number", key, printable(text)));
    return *value;
  }

  /// [m]; nothing where the attribute is missing or a share of the window.
  std::optional<double> page_length(const Element& e, const char* key) const {
    const char* text = e.Attribute(key);
    if (text == nullptr) return std::nullopt;
    string_view rest = text;
    const auto value = take_number(rest);
    if (value && rest == "%") return std::nullopt;
    constexpr std::array<std::pair<string_view, double>, 7> kUnits{{{"", kPixel},
                                                                    {"px", kPixel},
                                                                    {"mm", kMillimetre},
                                                                    {"cm", 10 * kMillimetre},
                                                                    {"in", 96 * kPixel},
                                                                    {"pt", 96 * kPixel / 72},
                                                                    {"pc", 16 * kPixel}}};
    const auto unit = std::ranges::find(kUnits, rest, &std::pair<string_view, double>::first);
    if (!value || !(*value > 0) || unit == kUnits.end())
      fail(e,
           fmt::format("{}=\"{}\" is no length above 0 in mm, cm, in, pt, pc or px", key, printable(text)));
    return *value * unit->second;
  }

  /// From user units to [m], y upwards.
  SvgTransform page_of(const Element& svg) const {
    const auto width = page_length(svg, "width"), height = page_length(svg, "height");
    double scale = kPixel;
    if (const char* box = svg.Attribute("viewBox")) {
      string_view rest = box;
      std::array<double, 4> v{};
      for (double& each : v) {
        const auto value = take_number(rest);
        if (!value) fail(svg, fmt::format("viewBox=\"{}\" is not 4 numbers", printable(box)));
        each = *value;
      }
      if (!(v[2] > 0 && v[3] > 0))
        fail(svg, fmt::format("viewBox=\"{}\" has no area: it degenerates", printable(box)));
      // The whole box is seen, as `preserveAspectRatio` has it unless told otherwise.
      if (width && height) {
        scale = std::min(*width / v[2], *height / v[3]);
      } else if (width || height) {
        scale = width ? *width / v[2] : *height / v[3];
      }
    }
    SvgTransform page = SvgTransform::Identity();
    page.linear().diagonal() = Vec2(scale, -scale);
    return page;
  }

  void add(const Element& e, const SvgTransform& outer, int depth) {
    const string_view tag = e.Name();
    if (std::ranges::find(kSilent, tag) != kSilent.end() || tag.find(':') != string_view::npos) return;
    if (const char* display = e.Attribute("display"); display && string_view(display) == "none") return;
    if (depth > kDeepest) fail(e, fmt::format("groups in groups, more than {} deep", kDeepest));
    const SvgTransform here = outer * own_transform(e);
    if (tag == "g" || tag == "a") {
      for (const Element* child = e.FirstChildElement(); child; child = child->NextSiblingElement())
        add(*child, here, depth + 1);
      return;
    }
    add_paths(e, shape_of(e, tag), here);
  }

  SvgTransform own_transform(const Element& e) const {
    const char* text = e.Attribute("transform");
    if (text == nullptr) return SvgTransform::Identity();
    try {
      return svg_transform(text);
    } catch (const InputError& error) {
      fail(e, fmt::format("transform=\"{}\": {}", printable(text), error.what()));
    }
  }

  Geom::PathVector shape_of(const Element& e, string_view tag) const {
    if (tag == "path") return path_data(e);
    if (tag == "rect") return rectangle(e);
    if (tag == "circle") return ellipse(e, number(e, "r", std::nullopt), number(e, "r"));
    if (tag == "ellipse") return ellipse(e, number(e, "rx", std::nullopt), number(e, "ry", std::nullopt));
    if (tag == "polyline" || tag == "polygon") return polygon(e, tag == "polygon");
    if (tag == "line") {
      Geom::Path line(Geom::Point(number(e, "x1"), number(e, "y1")));
      line.appendNew<Geom::LineSegment>(Geom::Point(number(e, "x2"), number(e, "y2")));
      return Geom::PathVector(line);
    }
    fail(e, "it has no outline that can be printed: convert it to paths in the drawing program");
  }

  Geom::PathVector path_data(const Element& e) const {
    const char* data = e.Attribute("d");
    if (data == nullptr) fail(e, "it has no d");
    try {
      Geom::PathVector paths;
      Geom::PathBuilder builder(paths);
      Geom::parse_svg_path(data, builder);
      return paths;
    } catch (const std::exception& error) {
      fail(e, fmt::format("d=\"{}\" is no path data: {}", printable(string_view(data).substr(0, 60)),
                          printable(error.what())));
    }
  }

  double positive(const Element& e, const char* key, double value) const {
    if (!(value > 0)) fail(e, fmt::format("{} is {:g}, it must be above 0", key, value));
    return value;
  }

  Geom::PathVector ellipse(const Element& e, double rx, double ry) const {
    positive(e, "the radius", std::min(rx, ry));
    const Geom::Point middle(number(e, "cx"), number(e, "cy"));
    Geom::PathVector paths;
    Geom::PathBuilder builder(paths);
    builder.moveTo(middle + Geom::Point(rx, 0));
    builder.arcTo(rx, ry, 0, false, true, middle - Geom::Point(rx, 0));
    builder.arcTo(rx, ry, 0, false, true, middle + Geom::Point(rx, 0));
    builder.closePath();
    builder.flush();
    return paths;
  }

  Geom::PathVector rectangle(const Element& e) const {
    const double x = number(e, "x"), y = number(e, "y");
    const double w = positive(e, "width", number(e, "width", std::nullopt)),
                 h = positive(e, "height", number(e, "height", std::nullopt));
    const bool has_rx = e.Attribute("rx") != nullptr, has_ry = e.Attribute("ry") != nullptr;
    const double rx = std::clamp(number(e, has_rx ? "rx" : "ry"), 0.0, w / 2),
                 ry = std::clamp(number(e, has_ry ? "ry" : "rx"), 0.0, h / 2);
    Geom::PathVector paths;
    Geom::PathBuilder builder(paths);
    const bool round = rx > 0 && ry > 0;
    const auto corner = [&](double to_x, double to_y) {
      if (round) builder.arcTo(rx, ry, 0, false, true, Geom::Point(to_x, to_y));
    };
    const double ax = round ? rx : 0, ay = round ? ry : 0;
    builder.moveTo(Geom::Point(x + ax, y));
    builder.lineTo(Geom::Point(x + w - ax, y));
    corner(x + w, y + ay);
    builder.lineTo(Geom::Point(x + w, y + h - ay));
    corner(x + w - ax, y + h);
    builder.lineTo(Geom::Point(x + ax, y + h));
    corner(x, y + h - ay);
    builder.lineTo(Geom::Point(x, y + ay));
    corner(x + ax, y);
    builder.closePath();
    builder.flush();
    return paths;
  }

  Geom::PathVector polygon(const Element& e, bool closed) const {
    const char* text = e.Attribute("points");
    if (text == nullptr) fail(e, "it has no points");
    string_view rest = text;
    std::vector<double> v;
    while (rest.find_first_not_of(" \t\r\n,") != string_view::npos) {
      const auto value = take_number(rest);
      if (!value) fail(e, fmt::format("points: '{}' is not a number", printable(rest.substr(0, 20))));
      v.push_back(*value);
    }
    if (v.size() < 4 || v.size() % 2 != 0)
      fail(e, fmt::format("points: {} numbers, two for each of at least 2 points are needed", v.size()));
    Geom::Path path(Geom::Point(v[0], v[1]));
    for (std::size_t i = 2; i < v.size(); i += 2)
      path.appendNew<Geom::LineSegment>(Geom::Point(v[i], v[i + 1]));
    path.close(closed);
    return Geom::PathVector(path);
  }

  void add_paths(const Element& e, const Geom::PathVector& paths, const SvgTransform& to_page) {
    for (const Geom::Path& path : paths) {
      SvgStroke stroke;
      stroke.element = fmt::format("{} of line {}", name_of(e), e.GetLineNum());
      const auto at = [&](const Geom::Curve& curve, double t) -> Vec2 {
        const Geom::Point p = curve.pointAt(t);
        return to_page * Vec2(p.x(), p.y());
      };
      for (const Geom::Curve& curve : path) {
        check_size(e, [&](double t) { return at(curve, t); });
        if (stroke.points.empty()) stroke.points.push_back(at(curve, 0));
        flatten([&](double t) { return at(curve, t); }, 0, 1, curve.isLineSegment() ? kHalvings : 0, stroke);
      }
      if (stroke.points.size() < 2) continue;  // a move without a line
      for (const Vec2& p : stroke.points) check_place(e, p);
      points_ += stroke.points.size();
      if (points_ > kMostPoints) fail(e, fmt::format("the drawing has more than {} points", kMostPoints));
      strokes_.push_back(std::move(stroke));
    }
  }

  /// Before it is cut into pieces: a circle of 1e300 would become a million of them first.
  void check_size(const Element& e, const std::function<Vec2(double)>& at) const {
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) check_place(e, at(t));
  }

  void check_place(const Element& e, const Vec2& p) const {
    if (!p.allFinite()) fail(e, "a point of its outline is not finite");
    if (p.norm() > kLargest)
      fail(e, fmt::format("its outline comes to {:.3g} m from the drawing's origin, at most {:g} m are read",
                          p.norm(), kLargest));
  }

  /// Appends what lies behind `from` up to `to`.
  void flatten(const std::function<Vec2(double)>& at, double from, double to, int depth,
               SvgStroke& stroke) const {
    const Vec2 a = at(from), b = at(to);
    bool straight = depth >= kHalvings;
    if (!straight) {
      straight = true;
      const double length = (b - a).norm();
      // Quarters, for an S has its chord through the middle.
      for (const double part : {0.25, 0.5, 0.75}) {
        const Vec2 p = at(from + part * (to - from)) - a;
        const double along = length > 0 ? std::clamp(p.dot(b - a) / length, 0.0, length) : 0;
        const Vec2 foot = length > 0 ? Vec2(along / length * (b - a)) : Vec2(Vec2::Zero());
        straight = straight && (p - foot).norm() <= tolerance_;
      }
    }
    if (!straight) {
      const double middle = 0.5 * (from + to);
      flatten(at, from, middle, depth + 1, stroke);
      return flatten(at, middle, to, depth + 1, stroke);
    }
    if (b != a) stroke.points.push_back(b);
  }

  std::string file_;
  double tolerance_;
  std::vector<SvgStroke> strokes_;
  std::size_t points_ = 0;
};

}  // namespace

std::vector<SvgStroke> read_svg(const std::filesystem::path& path, double chord_tolerance) {
  return Drawing(path.string(), chord_tolerance).read();
}

}  // namespace understudy::toolpath
