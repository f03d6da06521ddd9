// Shapes of what a study writes: CSV, JSON, SVG, HTML.
#include "study/report.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "study/chart.h"
#include "study_cloths.h"

namespace weft::study {
namespace {

Study sample() {
  Study study{.title = "a < b & \"c\"", .device = "a device", .date = "2026-01-31 17:05 UTC"};
  study.command = "weft study 1 --out x";
  study.time_s = 0.5;
  study.frame_s = 1.0 / 60.0;
  study.cloths = {Cloth{.nx = 9,
                        .ny = 9,
                        .agreement_m = 1e-10,
                        .ending = "agreed",
                        .twin_m = 1e-6,
                        .float_floor_m = 1e-5,
                        .discretisation_m = 1e-3,
                        .fine_nx = 17,
                        .equilibrium = "found"}};
  study.left_out = {{"rk4 f32", "runs elsewhere"}};
  for (const std::uint32_t n : {10u, 20u, 40u}) {
    Point point = point_of(10.0 * n, 1e-2 / (n * n));
    point.setting = {"leapfrog", "f32", n};
    point.nx = point.ny = 9;
    point.springs_per_s = 1e4 * n;
    study.points.push_back(point);
  }
  study.points.back().diverged = true;
  study.points.back().error_m = std::numeric_limits<double>::infinity();
  study.points[0].energy_drift = 0.25;
  return study;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Json, ReturnsTheStudy) {
  const Study study = sample();
  const Study read = study_from_json(to_json(study));
  EXPECT_EQ(to_json(read), to_json(study));
  EXPECT_EQ(read.title, study.title);
  EXPECT_TRUE(std::isinf(read.points[2].error_m));
  EXPECT_EQ(read.points[0].energy_drift, 0.25);
  EXPECT_FALSE(read.points[1].energy_drift);
  EXPECT_THROW(study_from_json("{}"), nlohmann::json::exception);
  EXPECT_THROW(study_from_json("{"), nlohmann::json::exception);
}

TEST(Promises, AreNotFinerThanTheReferenceIsKnown) {
  Study study = sample();
  study.cloths[0].agreement_m = 5e-5;  // between the errors of the two points that did not diverge
  EXPECT_EQ(study.promises_at(9)[0].error_m, study.points[0].error_m);
  EXPECT_EQ(study.promises_at(9)[1].error_m, 5e-5);
  EXPECT_TRUE(study.promises_at(9)[2].diverged);
}

TEST(Csv, HasAHeaderAndARowAPoint) {
  const std::string csv = points_csv(sample().points);
  EXPECT_EQ(csv.rfind("solver,precision,substeps,nx,ny,diverged,error_m,ms_per_simulated_s,", 0), 0u);
  EXPECT_EQ(occurrences(csv, "\r\n"), 4u);
  const std::size_t columns = occurrences(csv.substr(0, csv.find('\r')), ",");
  EXPECT_EQ(occurrences(csv, ","), 4 * columns);
  EXPECT_NE(csv.find("\r\nleapfrog,f32,40,9,9,true,inf,"), std::string::npos) << csv;
}

TEST(Svg, NamesWhatItShowsAndStaysInsideItsFrame) {
  const std::string svg = work_precision_svg(sample(), 9, CostAxis::device_time);
  for (const char* words :
       {"a &lt; b &amp; &quot;c&quot;", "a device", "2026-01-31", "leapfrog f32", "diverged", "real time",
        "ms per simulated second", "twins 1e-7 m apart", "leapfrog in float32", "17 particles"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(occurrences(svg, "<text"), occurrences(svg, "</text>"));
  EXPECT_NE(work_precision_svg(sample(), 9, CostAxis::spring_evaluations).find("spring evaluations"),
            std::string::npos);
}

// A logarithm has no place for the reference's own error, 0.
TEST(Svg, LeavesTheReferenceItselfOut) {
  Study study = sample();
  const auto without = occurrences(work_precision_svg(study, 9, CostAxis::device_time), "<path");
  ASSERT_GT(without, 0u);
  study.points.push_back(point_of(1000.0, 0.0));
  study.points.back().setting = {"leapfrog", "f32", 80};
  study.points.back().nx = study.points.back().ny = 9;
  const std::string svg = work_precision_svg(study, 9, CostAxis::device_time);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(occurrences(svg, "<path"), without);
}

TEST(Svg, SurvivesAStudyInWhichNothingWentWell) {
  Study study = sample();
  for (Point& point : study.points) {
    point.diverged = true;
    point.error_m = std::numeric_limits<double>::infinity();
  }
  study.cloths[0] = Cloth{.nx = 9, .ny = 9};
  EXPECT_EQ(work_precision_svg(study, 9, CostAxis::device_time).find("nan"), std::string::npos);
  study.points.clear();
  EXPECT_EQ(work_precision_svg(study, 9, CostAxis::device_time).find("nan"), std::string::npos);
}

TEST(Html, HoldsEverythingItself) {
  const std::string page = report_html(sample());
  EXPECT_EQ(occurrences(page, "<svg"), 2u);
  EXPECT_EQ(occurrences(page, "<tr"), 4u);
  EXPECT_EQ(occurrences(page, "class=\"diverged\""), 1u);
  EXPECT_EQ(page.find("src="), std::string::npos);
  EXPECT_EQ(page.find("href="), std::string::npos);
  EXPECT_NE(page.find("weft study 1 --out x"), std::string::npos);
  EXPECT_NE(page.find("rk4 f32: runs elsewhere"), std::string::npos);
}

}  // namespace
}  // namespace weft::study
