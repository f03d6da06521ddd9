// Asks the processor once what it has.
#include "native/features.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <vector>

#include "core/environment.h"
#include "core/error.h"
#include "core/text.h"

namespace weft::native {
namespace {

std::vector<const Kernels*> found() {
  std::vector<const Kernels*> all;
  for (const Kernels* kernels : {kernels_v4(), kernels_v3(), kernels_v2(), kernels_plain()})
    if (kernels != nullptr) all.push_back(kernels);
  return all;
}

}  // namespace

std::span<const Kernels* const> kernels_here() {
  static const std::vector<const Kernels*> all = found();
  return all;
}

const Kernels& find_kernels(const std::string& name) {
  const char* asked = std::getenv("WEFT_VECTOR");
  const bool from_environment = name.empty() && asked != nullptr;
  const std::string wanted = from_environment ? asked : name;
  if (wanted.empty() && !from_environment) return *kernels_here().front();
  std::string there;
  for (const Kernels* kernels : kernels_here()) {
    if (in_lower_case(kernels->name) == in_lower_case(wanted)) return *kernels;
    there += (there.empty() ? "" : ", ") + std::string(kernels->name);
  }
  throw error(Exit::usage, "{} is {}; it must be one of those that this machine has: {}{}",
              from_environment ? "The environment variable WEFT_VECTOR" : "the vector width",
              in_quotes(wanted, 80), there, from_environment ? " (unset WEFT_VECTOR for the widest)" : "");
}

std::optional<std::uint32_t> wished_threads() {
  const auto count = environment_number("WEFT_THREADS", 1, kThreadsMax);
  return count ? std::optional(static_cast<std::uint32_t>(*count)) : std::nullopt;
}

}  // namespace weft::native
