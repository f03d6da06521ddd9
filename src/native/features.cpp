// Asks the processor once what it has.
#include "native/features.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <vector>

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
  if (wanted.empty()) return *kernels_here().front();
  std::string there;
  for (const Kernels* kernels : kernels_here()) {
    if (in_lower_case(kernels->name) == in_lower_case(wanted)) return *kernels;
    there += (there.empty() ? "" : ", ") + std::string(kernels->name);
  }
  throw error(Exit::usage, "{} is \"{}\"; it must be one of those that this machine has: {}",
              from_environment ? "WEFT_VECTOR" : "the vector width", wanted, there);
}

}  // namespace weft::native
