// Spawns the program with its streams in files, so that no pipe can fill up and block it.
#include "cli/process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace weft::test {
namespace {

using namespace std::chrono_literals;

std::vector<std::string> environment_with(const Environment& changes) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (!changes.contains(text.substr(0, text.find('=')))) all.push_back(text);
  }
  for (const auto& [name, value] : changes) all.push_back(name + "=" + value);
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

pid_t spawn(const Arguments& arguments, const Environment& changes, const Scratch& streams) {
  std::vector<std::string> words{WEFT_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = environment_with(changes);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, streams.path("out").c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, streams.path("err").c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t child = 0;
  const int failure = posix_spawn(&child, WEFT_PROGRAM, &actions, nullptr, pointers(words).data(),
                                  pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0)
    throw std::runtime_error(std::string("cannot start " WEFT_PROGRAM ": ") + strerror(failure));
  return child;
}

Result finish(pid_t child, const Scratch& streams) {
  const auto deadline = std::chrono::steady_clock::now() + 120s;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > deadline) kill(child, SIGKILL);
    std::this_thread::sleep_for(5ms);
  }
  Result result;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  result.out = read_text(streams.path("out"));
  result.err = read_text(streams.path("err"));
  return result;
}

}  // namespace

Result weft(const Arguments& arguments, const Environment& changes) {
  const Scratch streams;
  return finish(spawn(arguments, changes, streams), streams);
}

Result weft_interrupted(const Arguments& arguments, const std::function<bool()>& ready, int signal) {
  const Scratch streams;
  const pid_t child = spawn(arguments, {}, streams);
  const auto deadline = std::chrono::steady_clock::now() + 20s;
  while (!ready() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(5ms);
  std::this_thread::sleep_for(100ms);
  kill(child, signal);
  return finish(child, streams);
}

Scratch::Scratch() {
  std::string name = (std::filesystem::temp_directory_path() / "weft-cli-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  folder_ = name;
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::size_t Scratch::file_count() const {
  const std::filesystem::directory_iterator files(folder_);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool has_vulkan() {
  static const bool found = [] {
    for (const auto& row : nlohmann::json::parse(weft({"devices", "--format", "json"}).out))
      if (row["index"] != "cpu" && row["usable"] == "yes") return true;
    return false;
  }();
  return found;
}

}  // namespace weft::test
