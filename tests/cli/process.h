// Runs the built program as a process, as a person would: arguments in, exit code, stdout and stderr out.
#pragma once
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace weft::test {

struct Result {
  int code = -1;    ///< exit code; 1000 + signal when a signal ended it
  std::string out;  ///< stdout
  std::string err;  ///< stderr
};

using Arguments = std::vector<std::string>;
using Environment = std::map<std::string, std::string>;

/// Runs `weft ARGUMENTS` with `changes` on top of this process's environment, for at most two minutes.
Result weft(const Arguments& arguments, const Environment& changes = {});

/// Starts `weft ARGUMENTS`, waits until `ready` says so (at most 20 s), sends `signal`, and waits for the
/// end.
Result weft_interrupted(const Arguments& arguments, const std::function<bool()>& ready, int signal = SIGINT);

/// An empty folder that is removed with the object.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  const std::filesystem::path& folder() const { return folder_; }
  std::size_t file_count() const;

 private:
  std::filesystem::path folder_;
};

std::string read_text(const std::filesystem::path&);
void write_text(const std::filesystem::path&, const std::string&);
std::vector<std::string> lines_of(const std::string&);

/// Whether `weft devices` knows a usable Vulkan device.
bool has_vulkan();

}  // namespace weft::test

/// Skips for lack of a Vulkan device; with WEFT_REQUIRE_GPU=1 that is a failure.
#define NEEDS_VULKAN()                                       \
  if (!weft::test::has_vulkan()) {                           \
    const char* required = std::getenv("WEFT_REQUIRE_GPU");  \
    if (required != nullptr && std::string(required) == "1") \
      FAIL() << "no Vulkan device, and WEFT_REQUIRE_GPU=1";  \
    GTEST_SKIP() << "no Vulkan device";                      \
  }                                                          \
  static_assert(true, "")

/// The exit code with both streams as the explanation.
#define EXPECT_CODE(result, wanted) EXPECT_EQ((result).code, wanted) << (result).out << (result).err
#define EXPECT_SAYS(text, part) \
  EXPECT_NE((text).find(part), std::string::npos) << "'" << (part) << "' is not in: " << (text)
