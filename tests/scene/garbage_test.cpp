// Whatever bytes a scene file holds, reading ends in a scene or in a usage error; what is accepted is sane.
#include <random>

#include "core/file.h"
#include "scene/parameters.h"
#include "scene/scene_text.h"

namespace weft {
namespace {

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t limit) {
  return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
}

/// Every value of an accepted scene keeps its row's rule.
void expect_sane(const Scene& scene) {
  for (const Parameter& p : parameters()) {
    for (std::size_t item = 0; item < item_count(scene, p.section); ++item) {
      if (p.section == "expect" || p.key == "preset" || p.key == "release") continue;  // may be absent
      EXPECT_EQ(broken_rule(p, p.get(scene, item)), "") << p.section << "." << p.key;
    }
  }
}

bool read_survives(const std::string& text) {
  try {
    expect_sane(read(text).scene);
    return true;
  } catch (const Error& mistake) {
    EXPECT_EQ(mistake.code(), Exit::usage) << mistake.what();
    return false;
  }
}

TEST(Garbage, RandomBytesAreRefused) {
  Random random(20240611);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string text(below(random, 200), '\0');
    for (char& byte : text) byte = static_cast<char>(below(random, 256));
    EXPECT_FALSE(read_survives(text));
  }
}

/// One slip: a byte changed, a piece removed, doubled, or moved, or a number made extreme.
std::string mutated(std::string text, Random& random) {
  static const char* const kPieces[] = {"nan",
                                        "-inf",
                                        "1e308",
                                        "-1",
                                        "0",
                                        "[",
                                        "]",
                                        "{",
                                        "\"",
                                        "=",
                                        "\n[[pins]]\n",
                                        "\n[cloth]\n",
                                        "9223372036854775808",
                                        "'",
                                        "\\",
                                        "\xff",
                                        "#",
                                        ".",
                                        "1e-320"};
  const std::size_t at = below(random, text.size());
  const std::size_t length = std::min(text.size() - at, below(random, 12));
  switch (below(random, 4)) {
    case 0: text[at] = static_cast<char>(below(random, 256)); break;
    case 1: text.erase(at, length); break;
    case 2: text.insert(below(random, text.size()), text.substr(at, length)); break;
    default: text.replace(at, length, kPieces[below(random, std::size(kPieces))]);
  }
  return text.empty() ? "x" : text;
}

TEST(Garbage, MutatedScenesAreReadOrRefused) {
  Random random(7);
  int accepted = 0, refused = 0;
  for (const AssetInfo& asset : list_scenes()) {
    const std::string original = read_file(asset.file);
    for (int trial = 0; trial < 500; ++trial) {
      std::string text = original;
      for (std::size_t slips = 1 + below(random, 4); slips > 0; --slips) text = mutated(text, random);
      ++(read_survives(text) ? accepted : refused);
    }
  }
  // Both happen, so the mutations neither destroy everything nor do nothing.
  EXPECT_GT(accepted, 100);
  EXPECT_GT(refused, 100);
}

TEST(Garbage, MutatedOverridesAreAppliedOrRefused) {
  Random random(11);
  const std::string scene = read_file(find_scene("5"));
  for (const char* start :
       {"material.density=0.3", "spheres.0.center=[0, 1, 0]", "wind={velocity=[0,0,1]}", "pins.0.at=[0,0]"}) {
    for (int trial = 0; trial < 500; ++trial) {
      std::string change = start;
      for (std::size_t slips = 1 + below(random, 3); slips > 0; --slips) change = mutated(change, random);
      refusal(scene, {change});
    }
  }
}

TEST(Garbage, DeepNestingIsRefused) {
  EXPECT_NE(refusal("[cloth]\nwidth = " + std::string(100000, '[')), "accepted");
  EXPECT_NE(refusal("[cloth]\nwidth = " + std::string(5000, '[') + std::string(5000, ']')), "accepted");
  EXPECT_NE(refusal("cloth" + std::string(20000, '.') + "x = 1"), "accepted");
  std::string dotted = "cloth";
  for (int k = 0; k < 20000; ++k) dotted += ".a";
  EXPECT_NE(refusal(dotted + " = 1"), "accepted");
  EXPECT_NE(refusal("[" + dotted + "]\n"), "accepted");
}

}  // namespace
}  // namespace weft
