// The table of keys: complete, unambiguous, and the same as the handbook's.
#define GLFW_INCLUDE_NONE
#include "viewer/keys.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace weft {
namespace {

TEST(Keys, EveryKeyHasOneMeaning) {
  std::map<std::pair<int, bool>, int> meanings;
  for (const KeyRow& row : key_rows())
    if (row.key != 0) ++meanings[{row.key, row.only_paused}];
  for (const auto& [key, count] : meanings) EXPECT_EQ(count, 1) << "GLFW key " << key.first;
}

TEST(Keys, RightStepsWhilePausedAndTurnsOtherwise) {
  ASSERT_NE(find_key(GLFW_KEY_RIGHT, true), nullptr);
  EXPECT_EQ(find_key(GLFW_KEY_RIGHT, true)->command, Command::step);
  EXPECT_EQ(find_key(GLFW_KEY_RIGHT, false)->command, Command::turn_right);
  EXPECT_EQ(find_key(GLFW_KEY_PERIOD, false), nullptr);
  EXPECT_EQ(find_key(GLFW_KEY_PERIOD, true)->command, Command::step);
}

TEST(Keys, NumbersOpenTheirScenes) {
  for (int number = 1; number <= 6; ++number) {
    const KeyRow* row = find_key(GLFW_KEY_0 + number, false);
    ASSERT_NE(row, nullptr);
    EXPECT_EQ(row->command, Command::scene);
    EXPECT_EQ(row->argument, number);
  }
}

// F1 shows the rows that have text; docs/viewer.md holds the same lines.
TEST(Keys, TheHandbookListsTheTable) {
  std::ifstream file(WEFT_SOURCE_DIR "/docs/viewer.md");
  ASSERT_TRUE(file) << "docs/viewer.md is missing";
  std::stringstream text;
  text << file.rdbuf();
  for (const KeyRow& row : key_rows()) {
    if (row.keys.empty()) continue;
    const std::string line = "| " + std::string(row.keys) + " | " + std::string(row.about) + " |";
    EXPECT_NE(text.str().find(line), std::string::npos) << "docs/viewer.md lacks: " << line;
  }
}

}  // namespace
}  // namespace weft
