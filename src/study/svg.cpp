// Writing SVG. Two decimals are a hundredth of a pixel.
#include "study/svg.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace weft::study {
namespace {

std::string attributes(const Paint& paint) {
  std::string text = fmt::format(" fill=\"{}\" stroke=\"{}\" stroke-width=\"{:.2f}\"", paint.fill,
                                 paint.stroke, paint.width);
  if (!paint.dash.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", paint.dash);
  if (paint.opacity < 1.0) text += fmt::format(" opacity=\"{:.2f}\"", paint.opacity);
  return text;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else if (static_cast<unsigned char>(c) >= 0x20)
      safe += c;
  }
  return safe;
}

void Svg::rectangle(double x, double y, double width, double height, const Paint& paint) {
  body_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"{}/>\n", x, y,
                       width, height, attributes(paint));
}

void Svg::path(const std::vector<PicturePoint>& points, bool closed, const Paint& paint) {
  std::string steps;
  for (const auto& [x, y] : points) steps += fmt::format("{}{:.2f} {:.2f}", steps.empty() ? "M" : " L", x, y);
  body_ += fmt::format("<path d=\"{}{}\"{} stroke-linejoin=\"round\"/>\n", steps, closed ? " Z" : "",
                       attributes(paint));
}

void Svg::circle(double x, double y, double radius, const Paint& paint) {
  constexpr int kSides = 24;
  std::vector<PicturePoint> points;
  for (int s = 0; s < kSides; ++s) {
    const double angle = 2.0 * std::numbers::pi * s / kSides;
    points.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle));
  }
  path(points, true, paint);
}

void Svg::text(double x, double y, std::string_view words, const Words& look) {
  const std::string turn = look.turned_deg != 0.0 ? fmt::format(" transform=\"rotate({:.0f} {:.2f} {:.2f})\"",
                                                                look.turned_deg, x, y)
                                                  : "";
  body_ += fmt::format(
      "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\"{}{}>{}"
      "</text>\n",
      x, y, look.size, look.anchor, look.color, look.bold ? " font-weight=\"bold\"" : "", turn,
      escaped(words));
}

std::string Svg::document(std::string_view title) const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\" role=\"img\">\n<title>{2}"
      "</title>\n{3}</svg>\n",
      width_, height_, escaped(title), body_);
}

}  // namespace weft::study
