// What `weft study` leaves in its folder: points as CSV and JSON, a page to read, diagrams as SVG and PNG.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "study/study.h"

namespace weft::study {

struct ReportFiles {
  std::vector<std::filesystem::path> written;
  std::string png_missing;  ///< why there are no PNG files; empty when there are
};

/// Writes points.csv, points.json, report.html and work-precision-NX[-springs].svg and .png into `folder`.
/// The PNG are the SVG pictures painted by assets/study/svg_to_png.py, which needs Python with matplotlib.
/// @throws Error(Exit::io)
ReportFiles write_report(const std::filesystem::path& folder, const Study& study);

/// The page by itself: pictures inside, no links to anything.
std::string report_html(const Study& study);

}  // namespace weft::study
