// Choosing a device, refusing with reasons, and failing as the documented exit codes say.
#include <algorithm>
#include <cctype>

#include "gpu/commands.h"
#include "gpu_fixture.h"

namespace weft {
namespace {

using namespace gpu;

class Devices : public test::GpuTest {
 protected:
  /// The message of the error that opening a device with this choice gives.
  static std::string refusal(const DeviceOptions& options) {
    try {
      const Device opened(options);
      ADD_FAILURE() << "a device was opened: " << opened.info().name;
    } catch (const Error& problem) {
      EXPECT_EQ(problem.code(), Exit::no_device);
      return problem.what();
    }
    return {};
  }
  static DeviceOptions choosing(const std::string& choice) {
    DeviceOptions options;
    options.choice = choice;
    return options;
  }
};

int rank(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return 4;
    default: return 3;
  }
}

TEST_F(Devices, AreListedInRankWithUnusableOnesLast) {
  const auto list = list_devices();
  ASSERT_FALSE(list.empty());
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_EQ(list[i].index, i);
    EXPECT_EQ(list[i].uuid.size(), 36u);
    EXPECT_GT(list[i].memory_bytes, 0u);
    if (i == 0) continue;
    const bool later_usable = list[i].unusable.empty(), earlier_usable = list[i - 1].unusable.empty();
    EXPECT_FALSE(later_usable && !earlier_usable);
    if (later_usable != earlier_usable) continue;
    EXPECT_LE(rank(list[i - 1].type), rank(list[i].type));
  }
}

TEST_F(Devices, AreChosenByPartOfNameIndexOrUuid) {
  const DeviceInfo first = list_devices().front();
  std::string part = first.name.substr(1, 5);
  std::transform(part.begin(), part.end(), part.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  for (const std::string& choice : {std::string(), part, std::string("0"), first.uuid}) {
    const Device opened(choosing(choice));
    EXPECT_EQ(opened.info().uuid, first.uuid) << "choice \"" << choice << "\"";
  }
}

TEST_F(Devices, AnUnknownChoiceNamesWhatIsThere) {
  for (const char* choice : {"no such device", "9999", "00000000-0000-0000-0000-000000000000"}) {
    const std::string text = refusal(choosing(choice));
    EXPECT_NE(text.find(choice), std::string::npos) << text;
    for (const DeviceInfo& info : list_devices()) EXPECT_NE(text.find(info.name), std::string::npos) << text;
  }
}

// Issue: "f64 on a device without it ... says which devices have it"; one that cannot run at all is none.
TEST(Float64, IsMissedByNamingTheDevicesThatHaveIt) {
  const DeviceInfo without{.name = "Plain"};
  const DeviceInfo unusable{.name = "Old", .float64 = true, .unusable = "no Vulkan 1.3"};
  const DeviceInfo first{.name = "Wide", .float64 = true}, second{.name = "Soft", .float64 = true};
  EXPECT_EQ(no_float64(without, std::vector{first, without, unusable, second}),
            "Plain has no float64; these have it: Wide, Soft");
  EXPECT_EQ(no_float64(without, std::vector{without, unusable}),
            "Plain has no float64; no device here has it");
}

TEST_F(Devices, AreWithoutFloat64WhereTheSwitchSaysSo) {
  const test::ScopedEnvironment without("WEFT_WITHOUT_FLOAT64", "1");
  for (const DeviceInfo& info : list_devices()) EXPECT_FALSE(info.float64) << info.name;
}

TEST_F(Devices, AMissingExtensionIsNamed) {
  DeviceOptions options;
  options.device_extensions = {"VK_KHR_no_such_extension"};
  EXPECT_NE(refusal(options).find("VK_KHR_no_such_extension"), std::string::npos);
  options.device_extensions.clear();
  options.instance_extensions = {"VK_KHR_no_such_instance"};
  EXPECT_NE(refusal(options).find("VK_KHR_no_such_instance"), std::string::npos);
}

TEST_F(Devices, WithoutADriverTheListIsEmptyAndOpeningSaysWhatToInstall) {
  const test::ScopedEnvironment none("VK_DRIVER_FILES", "/nonexistent"),
      old("VK_ICD_FILENAMES", "/nonexistent");
  EXPECT_TRUE(list_devices().empty());
  EXPECT_NE(refusal({}).find("mesa-vulkan-drivers"), std::string::npos);
}

TEST_F(Devices, AMissingValidationLayerNamesItsPackage) {
  const test::ScopedEnvironment none("VK_LAYER_PATH", "/nonexistent");
  DeviceOptions options;
  options.validation = true;
  EXPECT_NE(refusal(options).find("vulkan-validationlayers"), std::string::npos);
}

// Two submissions go through, the third finds the device lost; closing it afterwards is clean.
TEST_F(Devices, ASimulatedLossIsReportedOnSubmission) {
  const test::ScopedEnvironment loss("WEFT_SIMULATE_DEVICE_LOSS_AFTER", "2");
  const auto lost = make_device();
  lost->run_once([](VkCommandBuffer) {});
  lost->run_once([](VkCommandBuffer) {});
  try {
    lost->run_once([](VkCommandBuffer) {});
    FAIL() << "a lost device took work";
  } catch (const Error& problem) {
    EXPECT_EQ(problem.code(), Exit::no_device);
    EXPECT_NE(std::string(problem.what()).find("VK_ERROR_DEVICE_LOST"), std::string::npos) << problem.what();
  }
  EXPECT_EQ(lost->completed(), 2u);
  expect_silence(*lost);
}

TEST_F(Devices, ABadDebugSwitchIsAUsageError) {
  const test::ScopedEnvironment loss("WEFT_SIMULATE_DEVICE_LOSS_AFTER", "soon");
  try {
    make_device();
    FAIL() << "\"soon\" was taken for a number";
  } catch (const Error& problem) {
    EXPECT_EQ(problem.code(), Exit::usage);
  }
}

TEST_F(Devices, AnswersOfVulkanCarryTheDocumentedExitCode) {
  const std::pair<VkResult, Exit> answers[] = {{VK_ERROR_OUT_OF_DEVICE_MEMORY, Exit::no_device},
                                               {VK_ERROR_OUT_OF_HOST_MEMORY, Exit::no_device},
                                               {VK_ERROR_DEVICE_LOST, Exit::no_device},
                                               {VK_ERROR_INITIALIZATION_FAILED, Exit::internal}};
  for (const auto& [result, code] : answers) {
    try {
      check(result, "do this");
      FAIL() << "an error passed as success";
    } catch (const Error& problem) {
      EXPECT_EQ(problem.code(), code);
      EXPECT_NE(std::string(problem.what()).find("do this"), std::string::npos);
    }
  }
  EXPECT_NO_THROW(check(VK_SUCCESS, "do this"));
}

// A value handed out by submit is reached by wait, in order.
TEST_F(Devices, TheTimelineCountsSubmissions) {
  Commands commands(device(), "empty", Reuse::many);
  commands.record([](VkCommandBuffer) {});
  const std::uint64_t first = device().submit(commands.handle());
  const VkCommandBuffer twice[] = {commands.handle(), commands.handle()};
  const std::uint64_t second = device().submit(twice);
  EXPECT_EQ(second, first + 1);
  device().wait(second);
  EXPECT_EQ(device().completed(), second);
  EXPECT_EQ(device().submitted(), second);
}

}  // namespace
}  // namespace weft
