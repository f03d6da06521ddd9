// The pipeline cache's file: a header of our own with length and checksum, because drivers trust the
// blob they are given, then Vulkan's blob.
#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/cache.h"
#include "core/error.h"
#include "gpu/log.h"
#include "gpu/pipeline.h"

namespace weft::gpu {
namespace {

struct FileHeader {
  std::array<char, 8> magic = {'W', 'E', 'F', 'T', 'P', 'C', '0', '1'};
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;
};

using Blob = std::vector<char>;

std::uint64_t checksum(const Blob& blob) { return fnv1a_64({blob.data(), blob.size()}); }

/// Vulkan's own header (VkPipelineCacheHeaderVersionOne) must name this very device.
bool is_of(const VkPhysicalDeviceProperties& device, const Blob& blob) {
  VkPipelineCacheHeaderVersionOne header;
  if (blob.size() < sizeof header) return false;
  std::memcpy(&header, blob.data(), sizeof header);
  return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == device.vendorID &&
         header.deviceID == device.deviceID &&
         std::memcmp(header.pipelineCacheUUID, device.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

/// The blob of a whole file of this device; empty otherwise.
Blob load(const std::filesystem::path& file, const VkPhysicalDeviceProperties& device) {
  std::ifstream stream(file, std::ios::binary);
  FileHeader header;
  const FileHeader ours;
  if (!stream.read(reinterpret_cast<char*>(&header), sizeof header)) return {};
  Blob blob{std::istreambuf_iterator<char>(stream), {}};
  const bool whole =
      header.magic == ours.magic && header.bytes == blob.size() && header.checksum == checksum(blob);
  return whole && is_of(device, blob) ? blob : Blob{};
}

/// Under a temporary name first: a crash leaves the old file or none, never half of one.
bool store(const std::filesystem::path& file, const Blob& blob) {
  std::error_code problem;
  std::filesystem::create_directories(file.parent_path(), problem);
  const auto temporary = file.string() + fmt::format(".{}.tmp", getpid());
  FileHeader header;
  header.bytes = blob.size();
  header.checksum = checksum(blob);
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream.write(reinterpret_cast<const char*>(&header), sizeof header);
  stream.write(blob.data(), static_cast<std::streamsize>(blob.size()));
  stream.close();
  if (stream) {
    std::filesystem::rename(temporary, file, problem);
    if (!problem) return true;
  }
  std::filesystem::remove(temporary, problem);
  return false;
}

}  // namespace

struct PipelineCache::Impl {
  Device& device;
  std::filesystem::path file;
  VkPipelineCache cache = VK_NULL_HANDLE;
  bool loaded = false;
  std::uint64_t saved_checksum = 0;
};

PipelineCache::PipelineCache(Device& device, std::filesystem::path folder)
    : impl_(std::make_unique<Impl>(Impl{.device = device, .file = {}})) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(device.physical(), &properties);
  if (folder.empty()) folder = cache_folder();
  if (!folder.empty())
    impl_->file =
        folder / fmt::format("pipelines-{}-{:08x}.bin", device.info().uuid, properties.driverVersion);
  const Blob blob = impl_->file.empty() ? Blob{} : load(impl_->file, properties);
  impl_->loaded = !blob.empty();
  impl_->saved_checksum = impl_->loaded ? checksum(blob) : 0;
  VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  info.initialDataSize = blob.size();
  info.pInitialData = blob.empty() ? nullptr : blob.data();
  check(vkCreatePipelineCache(device.handle(), &info, nullptr, &impl_->cache), "create a pipeline cache");
}

PipelineCache::~PipelineCache() {
  try {
    save();
  } catch (const std::exception& problem) {
    log()->warn("The pipeline cache is not saved: {}", problem.what());
  }
  vkDestroyPipelineCache(impl_->device.handle(), impl_->cache, nullptr);
}

VkPipelineCache PipelineCache::handle() const { return impl_->cache; }
std::filesystem::path PipelineCache::file() const { return impl_->file; }
bool PipelineCache::loaded() const { return impl_->loaded; }

void PipelineCache::save() {
  if (impl_->file.empty()) return;
  std::size_t bytes = 0;
  check(vkGetPipelineCacheData(impl_->device.handle(), impl_->cache, &bytes, nullptr), "read the cache");
  Blob blob(bytes);
  check(vkGetPipelineCacheData(impl_->device.handle(), impl_->cache, &bytes, blob.data()), "read the cache");
  blob.resize(bytes);
  const std::uint64_t sum = checksum(blob);
  if (sum == impl_->saved_checksum) return;
  if (store(impl_->file, blob))
    impl_->saved_checksum = sum;
  else
    log()->warn("The pipeline cache {} cannot be written; pipelines are compiled anew at every start",
                impl_->file.string());
}

}  // namespace weft::gpu
