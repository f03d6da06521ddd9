// The kernels that trials found fastest, kept in a small JSON file from run to run.
#include "sim/kernel_memory.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"

namespace weft {
namespace {

using Json = nlohmann::json;

constexpr int kVersion = 3;  // of the file, and of the kernels it speaks of
constexpr std::size_t kMostBytes = 1 << 20;

/// The file's content, or a fresh one when there is none that can be used.
Json contents(const std::filesystem::path& file) {
  const Json fresh = {{"version", kVersion}, {"kernels", Json::object()}};
  try {
    Json json = Json::parse(read_file(file, kMostBytes));
    const bool whole =
        json.is_object() && json.value("version", 0) == kVersion && json["kernels"].is_object();
    return whole ? json : fresh;
  } catch (const Error&) {  // missing
    return fresh;
  } catch (const Json::exception&) {  // damaged
    return fresh;
  }
}

}  // namespace

std::string kernel_memory_key(const Plan& plan) {
  const PlanStep& step = plan.steps.at(0);
  std::string key = fmt::format("{}x{}", step.range.x, step.range.y);
  if (plan.sheet_rows != 0) key += fmt::format(" in cloths of {}", plan.sheet_rows);
  for (const PlanStep& each : plan.steps) {
    key += fmt::format(" {}", each.pass->name);
    for (const Constant& constant : each.constants) key += fmt::format(":{}", constant.value);
  }
  return key;
}

std::optional<Kernel> remembered_kernel(const std::filesystem::path& file, const std::string& key) {
  const Json json = contents(file);
  const auto entry = json["kernels"].find(key);
  if (entry == json["kernels"].end()) return {};
  try {
    Kernel kernel;
    kernel.kind = static_cast<KernelKind>(entry->at("kind").get<unsigned>());
    entry->at("columns").get_to(kernel.columns);
    entry->at("rows").get_to(kernel.rows);
    entry->at("substeps").get_to(kernel.substeps);
    entry->at("bands").get_to(kernel.bands);
    entry->at("queues").get_to(kernel.queues);
    return kernel;
  } catch (const Json::exception&) {
    return {};
  }
}

void remember_kernel(const std::filesystem::path& file, const std::string& key, const Kernel& kernel) {
  Json json = contents(file);
  json["kernels"][key] = {{"kind", static_cast<unsigned>(kernel.kind)},
                          {"columns", kernel.columns},
                          {"rows", kernel.rows},
                          {"substeps", kernel.substeps},
                          {"bands", kernel.bands},
                          {"queues", kernel.queues}};
  std::error_code problem;
  std::filesystem::create_directories(file.parent_path(), problem);
  try {
    write_file(file, json.dump(1) + '\n');
  } catch (const Error&) {  // a read-only or full disk: only a trial is lost
  }
}

}  // namespace weft
