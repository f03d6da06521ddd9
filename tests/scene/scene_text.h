// Helpers of the scene tests: reading a text, and the message with which it is refused.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "scene/reader.h"

namespace weft {

inline LoadedScene read(const std::string& text, std::vector<std::string> set = {}) {
  return parse_scene(text, "scene.toml", {std::move(set)});
}

/// The message of the refusal, or "accepted". Every refusal of a scene is a usage error.
inline std::string refusal(const std::string& text, std::vector<std::string> set = {}) {
  try {
    read(text, std::move(set));
  } catch (const Error& mistake) {
    EXPECT_EQ(mistake.code(), Exit::usage) << mistake.what();
    return mistake.what();
  }
  return "accepted";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Expects that `text` is refused with every one of `parts` in the message.
inline void expect_refused(const std::string& text, const std::vector<std::string>& parts,
                           std::vector<std::string> set = {}) {
  const std::string message = refusal(text, std::move(set));
  for (const std::string& part : parts)
    EXPECT_TRUE(contains(message, part)) << message << "\n lacks: " << part;
}

}  // namespace weft
