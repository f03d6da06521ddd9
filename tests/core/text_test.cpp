// Short numbers, quoted text, and the nearest of the known names.
#include "core/text.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace weft {
namespace {

TEST(Text, NumbersAreShort) {
  EXPECT_EQ(short_number(0.1), "0.1");
  EXPECT_EQ(short_number(-9.81), "-9.81");
  EXPECT_EQ(short_number(2e-5), "2e-05");
  EXPECT_EQ(short_number(1.0 / 3.0), "0.333333");
  EXPECT_EQ(short_number(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(Text, QuotesCutAndClean) {
  EXPECT_EQ(in_quotes("denim"), "\"denim\"");
  EXPECT_EQ(in_quotes("a\x1b[31m\n"), "\"a?[31m?\"");  // a file cannot colour the terminal
  EXPECT_EQ(in_quotes("abcdef", 3), "\"abc…\"");
  EXPECT_EQ(in_quotes("aé", 2), "\"a…\"");  // é is two bytes and stays whole
}

TEST(Text, EditDistanceCountsSlips) {
  EXPECT_EQ(edit_distance("density", "density"), 0u);
  EXPECT_EQ(edit_distance("densty", "density"), 1u);    // left out
  EXPECT_EQ(edit_distance("densitty", "density"), 1u);  // twice
  EXPECT_EQ(edit_distance("dnesity", "density"), 1u);   // swapped
  EXPECT_EQ(edit_distance("Density", "density"), 0u);   // case
  EXPECT_EQ(edit_distance("", "abc"), 3u);
}

TEST(Text, NearestNameIsNearOrNone) {
  const std::vector<std::string_view> known{"width", "height", "resolution", "damping", "damping_ratio_max"};
  EXPECT_EQ(nearest_name("hieght", known), "height");
  EXPECT_EQ(nearest_name("resolutoin", known), "resolution");
  EXPECT_EQ(nearest_name("res", known), "resolution");
  EXPECT_EQ(nearest_name("damping_ratio", known), "damping_ratio_max");
  EXPECT_EQ(nearest_name("colour", known), "");
  EXPECT_EQ(nearest_name("", known), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'w'), known), "");
}

TEST(Text, JoinsAsASentence) {
  const std::vector<std::string_view> words{"a", "b", "c"};
  EXPECT_EQ(joined(words), "a, b and c");
  EXPECT_EQ(joined(std::span(words).first(1)), "a");
}

TEST(Text, CountsAndLowersCase) {
  EXPECT_EQ(counted(0, "substep"), "0 substeps");
  EXPECT_EQ(counted(1, "substep"), "1 substep");
  EXPECT_EQ(counted(2, "substep"), "2 substeps");
  EXPECT_EQ(in_lower_case("CPU (Z) é"), "cpu (z) é");
}

}  // namespace
}  // namespace weft
