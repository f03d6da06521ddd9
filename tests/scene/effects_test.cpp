// The list of effects: complete, and what it adds it takes away again.
#include "scene/effects.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/parameters.h"
#include "scene/reader.h"

namespace weft {
namespace {

Scene bare_cloth() {
  return parse_scene("[cloth]\nresolution = 8\n[material]\ndamping = 0\n", "bare.toml").scene;
}

/// Every parameter of every section that the scene has.
std::vector<ParameterValue> values_of(const Scene& scene) {
  std::vector<ParameterValue> values;
  for (const Parameter& row : parameters())
    for (std::size_t item = 0; item < item_count(scene, row.section); ++item)
      if (has_section(scene, row.section)) values.push_back(row.get(scene, item));
  return values;
}

/// NaN, which says "absent", equals itself here.
bool same(const std::vector<ParameterValue>& a, const std::vector<ParameterValue>& b) {
  return std::ranges::equal(a, b, [](const ParameterValue& x, const ParameterValue& y) {
    const auto *number = std::get_if<double>(&x), *other = std::get_if<double>(&y);
    const bool both_nan = number && other && *number != *number && *other != *other;
    return both_nan || x == y;
  });
}

TEST(Effects, EveryOptionalSectionIsOne) {
  for (const std::string_view section : section_names()) {
    const bool always = section.empty() || section == "cloth" || section == "material" ||
                        section == "solver" || section == "expect";
    if (always || section == "cloths") continue;  // more cloth, which cannot be there and idle
    EXPECT_TRUE(std::ranges::any_of(effects(), [&](const Effect& e) { return e.name == section; }))
        << section << " has no row in src/scene/effects.cpp";
  }
}

TEST(Effects, WhatIsAddedIsThereAndIsTakenAwayWhole) {
  const Scene bare = bare_cloth();
  EXPECT_TRUE(effects_of(bare).empty());
  for (const Effect& effect : effects()) {
    const Scene with = with_effect(bare, effect.name);
    EXPECT_TRUE(has_effect(with, effect)) << effect.name;
    EXPECT_EQ(effects_of(with).size(), effect.needs.empty() ? 1u : 2u) << effect.name;
    EXPECT_TRUE(same(values_of(with_effect(with, effect.name)), values_of(with))) << effect.name << " twice";
    Scene without = without_effect(with, effect.name);
    if (!effect.needs.empty()) without = without_effect(without, effect.needs);
    EXPECT_TRUE(same(values_of(without), values_of(bare))) << effect.name << " left something behind";
  }
}

TEST(Effects, WhatNeedsAnotherGoesWithIt) {
  const Scene windy = with_effect(bare_cloth(), "wind");
  EXPECT_TRUE(windy.air.has_value());
  EXPECT_FALSE(without_effect(windy, "air").wind.has_value());
}

}  // namespace
}  // namespace weft
