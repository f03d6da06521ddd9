// A picture as SVG text, made of rectangles, paths and words only.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weft::study {

/// How a shape is painted. Colours are "#rrggbb" or "none"; widths and dashes are in picture units.
struct Paint {
  std::string fill = "none", stroke = "none";
  double width = 1.0;
  std::string dash = {};  ///< "6 4"; empty: solid
  double opacity = 1.0;
};

struct Words {
  double size = 14.0;
  std::string anchor = "start";  ///< "start", "middle", "end"
  std::string color = "#222222";
  bool bold = false;
  double turned_deg = 0.0;  ///< about its own place
};

using PicturePoint = std::pair<double, double>;

class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}
  void rectangle(double x, double y, double width, double height, const Paint& paint);
  void path(const std::vector<PicturePoint>& points, bool closed, const Paint& paint);
  void line(PicturePoint from, PicturePoint to, const Paint& paint) { path({from, to}, false, paint); }
  void circle(double x, double y, double radius, const Paint& paint);
  void text(double x, double y, std::string_view words, const Words& look);
  /// The whole document; `title` is what a screen reader says.
  std::string document(std::string_view title) const;

 private:
  double width_, height_;
  std::string body_;
};

/// & < > and quotes as entities; control bytes left out.
std::string escaped(std::string_view text);

}  // namespace weft::study
