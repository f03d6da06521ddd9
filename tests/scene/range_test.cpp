// Every parameter's range: both ends are taken, what lies beyond and what is not finite is refused.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "scene/parameters.h"
#include "scene/scene_text.h"

namespace weft {
namespace {

/// A scene in which every section stands, so that any one key can be overridden.
const char* const kEverything = R"(
[cloth]
resolution = 5
center = [0, 50, 0]
[[cloths]]
center = [0, 60, 0]
[[pins]]
at = [0, 0]
radius = 1000
[gravity]
[air]
drag = 1
[wind]
velocity = [0, 0, 1]
period = 2
[floor]
[[spheres]]
center = [0, 0, 0]
radius = 1
[tethers]
[tearing]
strain = 0.3
[[capsules]]
a = [0, 0, 0]
b = [1, 0, 0]
radius = 1
[[boxes]]
center = [0, 0, 0]
size = [1, 1, 1]
[[meshes]]
file = "mesh.obj"
center = [0, 0, 0]
[aerodynamics]
[self_collision]
thickness = 0.01
[expect]
)";

/// `--set` text that gives every number of the parameter the value.
std::string setting(const Parameter& p, const std::string& value) {
  const bool is_item = is_list_section(p.section);
  const std::string key = fmt::format("{}{}.{}", p.section, is_item ? ".0" : "", p.key);
  if (p.kind == ParameterKind::vec2) return fmt::format("{}=[{}, {}]", key, value, value);
  if (p.kind == ParameterKind::vec3) return fmt::format("{}=[{}, {}, {}]", key, value, value, value);
  return fmt::format("{}={}", key, value);
}

bool is_numeric(const Parameter& p) { return p.kind != ParameterKind::word && p.kind != ParameterKind::keys; }

std::string exact(double value) { return fmt::format("{}", value); }

/// A cloth's own sizes are tried alone: the pins and colliders of the full scene would not fit every size.
/// A pin may name every cloth there can be where there are as many.
std::string scene_for(const Parameter& p) {
  if (p.section == "cloth") return "[cloth]\n";
  std::string text = kEverything;
  if (p.section == "pins" && p.key == "cloth")
    for (int further = 2; further < 64; ++further) text += "[[cloths]]\ncenter = [0, 70, 0]\n";
  return text;
}

TEST(Ranges, EveryRowIsWellFormed) {
  for (const Parameter& p : parameters()) {
    SCOPED_TRACE(fmt::format("{}.{}", p.section, p.key));
    EXPECT_EQ(find_parameter(p.section, p.key), &p) << "the key appears twice";
    EXPECT_TRUE(p.get != nullptr && p.set != nullptr);
    EXPECT_FALSE(p.about.empty() || p.example.empty());
    if (!is_numeric(p)) continue;
    EXPECT_LT(p.minimum, p.maximum);
    EXPECT_GE(p.slider_maximum, p.slider_minimum);
    if (p.slider_maximum > p.slider_minimum) {
      EXPECT_GE(p.slider_minimum, p.minimum);
      EXPECT_LE(p.slider_maximum, p.maximum);
    }
    EXPECT_TRUE(!p.slider_logarithmic || p.slider_minimum > 0.0);
  }
}

TEST(Ranges, BothEndsAreTaken) {
  for (const Parameter& p : parameters()) {
    if (!is_numeric(p)) continue;
    if (p.section == "floor" && p.key == "normal") continue;  // (−1, −1, −1) is a ceiling's, and refused
    for (const double end : {p.minimum, p.maximum}) {
      std::vector<std::string> set{setting(p, exact(end))};
      // The other side keeps in proportion, so that the rows stay within 2 to 4096; a pin of radius 0 needs a
      // particle at its very place, which the corner has.
      if (p.section == "cloth" && p.key == "width") set.push_back("cloth.height=" + exact(end));
      if (p.section == "cloth" && p.key == "height") set.push_back("cloth.width=" + exact(end));
      EXPECT_EQ(refusal(scene_for(p), set), "accepted") << set[0];
    }
  }
}

TEST(Ranges, BeyondTheEndsIsRefused) {
  for (const Parameter& p : parameters()) {
    if (!is_numeric(p)) continue;
    const double step =
        p.kind == ParameterKind::integer ? 1.0 : 1e-9 + 1e-6 * (std::abs(p.maximum) + std::abs(p.minimum));
    const bool is_small = p.minimum > 0.0 && p.kind != ParameterKind::integer;
    const double below = is_small ? p.minimum * 0.999 : p.minimum - step;
    for (const double beyond : {below, p.maximum + step}) {
      const std::string change = setting(p, exact(beyond));
      const std::string message = refusal(scene_for(p), {change});
      EXPECT_TRUE(contains(message, "--set " + change.substr(0, 20)) && contains(message, "it must be"))
          << message;
    }
  }
}

TEST(Ranges, NotFiniteIsRefused) {
  for (const Parameter& p : parameters()) {
    if (!is_numeric(p)) continue;
    for (const char* value : {"nan", "inf", "-inf", "1e400"}) {
      const std::string message = refusal(scene_for(p), {setting(p, value)});
      EXPECT_TRUE(contains(message, "must be") || contains(message, "TOML"))
          << setting(p, value) << ": " << message;
    }
  }
}

TEST(Ranges, WrongTypesAreRefused) {
  for (const Parameter& p : parameters()) {
    const bool is_text = p.kind == ParameterKind::word;
    const std::string change = setting(p, is_text ? "7" : "\"seven\"");
    if (p.section.empty()) continue;
    EXPECT_TRUE(contains(refusal(scene_for(p), {change}), "it must be")) << change;
  }
}

TEST(Ranges, ValuesSurviveTheTrip) {
  Scene scene = read(kEverything, {}).scene;
  for (const Parameter& p : parameters()) {
    if (!is_numeric(p)) continue;
    const double value = std::floor(0.5 * (p.minimum + p.maximum));
    ParameterValue given = value;
    if (p.kind == ParameterKind::vec2) given = glm::dvec2(value, p.maximum);
    if (p.kind == ParameterKind::vec3) given = glm::dvec3(value, p.minimum, p.maximum);
    p.set(scene, 0, given);
    EXPECT_EQ(p.get(scene, 0), given) << p.section << "." << p.key;
  }
}

TEST(Ranges, SectionsComeAndGo) {
  Scene scene;
  for (const std::string_view section : section_names()) {
    add_section(scene, section);
    EXPECT_TRUE(has_section(scene, section)) << section;
    remove_section(scene, section);
    const bool always = section == "cloth" || section == "material" || section == "solver";
    EXPECT_EQ(has_section(scene, section), always) << section;
  }
}

}  // namespace
}  // namespace weft
