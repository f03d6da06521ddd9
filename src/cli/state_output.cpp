// Chooses the writer by the file's extension, before anything is simulated.
#include "cli/state_output.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "cli/text.h"
#include "core/error.h"
#include "core/text.h"

namespace weft::cli {
namespace {

using namespace std::string_view_literals;
namespace fs = std::filesystem;

constexpr std::array kExtensions = {".csv"sv, ".ply"sv, ".obj"sv, ".pc2"sv};

}  // namespace

void require_writable(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status found = fs::status(target, ignored);
  constexpr fs::perms kWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  const bool guarded = fs::exists(found) && ((found.permissions() & kWrite) == fs::perms::none ||
                                             access(target.c_str(), W_OK) != 0);
  if (guarded && !fs::is_directory(found))
    throw error(Exit::io, "--out {} is write-protected; choose another name, or allow writing (chmod u+w)",
                in_quotes(target.string(), 200));
  const AtomicFile probe(target);
}

StateOutput::StateOutput(const fs::path& target, const Model& model) : target_(target), model_(model) {
  const std::string extension = target.extension().string();
  if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end())
    throw error(Exit::usage, "--out {}: there is no format for {}; it must end in {}{}",
                in_quotes(target.string(), 200),
                extension.empty() ? "a name without extension" : in_quotes(extension),
                fmt::join(kExtensions, ", "), suggestion(extension, kExtensions));
  require_writable(target);
  if (extension == ".pc2") cache_ = std::make_unique<PointCache>(target, model.grid);
}

void StateOutput::frame(const State& state) {
  if (cache_) cache_->add(state);
}

void StateOutput::finish(const State& state) {
  if (cache_) return cache_->commit();
  const std::string extension = target_.extension().string();
  const bool full = model_.scene.solver.precision == "f64";
  if (extension == ".csv") return write_csv(target_, model_, state, full ? Digits::full : Digits::single);
  if (extension == ".ply") return write_ply(target_, model_, state);
  write_obj(target_, model_, state);
}

}  // namespace weft::cli
