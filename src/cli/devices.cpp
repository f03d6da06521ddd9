// `weft devices`: the ranked list that --device chooses from, the CPU reference and the vector units.
#include "cli/command.h"
#include "cli/setup.h"
#include "cli/table.h"
#include "gpu/device.h"
#include "native/features.h"

namespace weft::cli {
namespace {

const char* type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return "software";
    default: return "other";
  }
}

std::vector<nlohmann::ordered_json> row_of(const gpu::DeviceInfo& info) {
  return {std::to_string(info.index),
          info.name,
          type_name(info.type),
          info.software,
          info.driver,
          info.api_version,
          info.memory_bytes / (1u << 20),
          info.float64,
          info.uuid,
          info.unusable.empty() ? "yes" : "no: " + info.unusable};
}

Exit run_devices(const Options& o) {
  Table table{
      {"index", "name", "type", "software", "driver", "vulkan", "memory_mib", "float64", "uuid", "usable"},
      {}};
  const std::vector<gpu::DeviceInfo> found = gpu::list_devices();
  for (const gpu::DeviceInfo& info : found) table.rows.push_back(row_of(info));
  table.rows.push_back(
      {"cpu", "CPU reference", "reference", true, nullptr, nullptr, nullptr, true, nullptr, "yes"});
  table.rows.push_back({"native", fmt::format("CPU, {}", native::find_kernels().name), "vector units", true,
                        nullptr, nullptr, nullptr, false, nullptr, "yes"});
  print_result(to_text(table, o.format));
  if (found.empty()) note(o, "there is no Vulkan device; install a driver, or use --device native");
  return Exit::ok;
}

}  // namespace

const Command devices_command{"devices",
                              "lists the devices, best first",
                              "  weft devices\n  weft simulate 1 --device 0 --time 0.5",
                              [](CLI::App&, Options&) {},
                              run_devices,
                              false};

}  // namespace weft::cli
