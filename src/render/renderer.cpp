// Records a picture: view block, shadow map, cloth, balls, floor, sky.
#include "render/renderer.h"

#include <algorithm>
#include <span>

#include "core/error.h"
#include "render/mesh.h"

namespace weft {
namespace {

constexpr std::uint32_t kShadowSize = 2048, kShadowSizeSoftware = 1024;

void barrier(VkCommandBuffer commands, const VkMemoryBarrier2* memory, const VkImageMemoryBarrier2* image) {
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = memory != nullptr ? 1 : 0;
  dependency.pMemoryBarriers = memory;
  dependency.imageMemoryBarrierCount = image != nullptr ? 1 : 0;
  dependency.pImageMemoryBarriers = image;
  vkCmdPipelineBarrier2(commands, &dependency);
}

VkImageMemoryBarrier2 image_barrier(const gpu::Image& image) {
  VkImageMemoryBarrier2 change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  change.image = image.handle();
  change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  change.subresourceRange = {image.options().aspect, 0, 1, 0, 1};
  return change;
}

constexpr VkPipelineStageFlags2 kDepthStages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;

/// To an attachment whose former contents do not matter, after whatever used it last.
void begin_attachment(VkCommandBuffer commands, const gpu::Image& image) {
  const bool depth = image.options().aspect == VK_IMAGE_ASPECT_DEPTH_BIT;
  VkImageMemoryBarrier2 change = image_barrier(image);
  change.srcStageMask = kDepthStages | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                        VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  change.srcAccessMask =
      depth ? VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT : VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  change.dstStageMask = depth ? kDepthStages : VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  change.dstAccessMask = change.srcAccessMask | (depth ? VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT
                                                       : VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT);
  change.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  change.newLayout =
      depth ? VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  barrier(commands, nullptr, &change);
}

VkRenderingAttachmentInfo cleared(VkImageView view, VkImageLayout layout, float depth) {
  VkRenderingAttachmentInfo attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  attachment.imageView = view;
  attachment.imageLayout = layout;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  attachment.clearValue.depthStencil = {depth, 0};
  return attachment;
}

}  // namespace

VkSampleCountFlagBits choose_samples(gpu::Device& device, std::uint32_t wish) {
  if (wish != 0 && wish != 1 && wish != 4)
    throw error(Exit::usage, "samples is {}; it must be 1 or 4 (0 chooses by the device)", wish);
  const auto able =
      device.limits().framebufferColorSampleCounts & device.limits().framebufferDepthSampleCounts;
  const bool four = wish == 4 || (wish == 0 && !device.info().software);
  return four && (able & VK_SAMPLE_COUNT_4_BIT) != 0 ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
}

Renderer::Renderer(gpu::Device& device, const Model& model, VkFormat color_format,
                   VkSampleCountFlagBits samples, double film_s)
    : device_(device), model_(&model), color_format_(color_format), samples_(samples), film_s_(film_s) {
  stage_.shadow_size = device.info().software ? kShadowSizeSoftware : kShadowSize;
  set_model(model);
  view_ =
      gpu::Buffer(device, "view", sizeof(shared::View),
                  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::device);
  gpu::ImageOptions map;
  map.format = kDepthFormat;
  map.width = map.height = stage_.shadow_size;
  map.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  map.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  shadow_map_ = gpu::Image(device, "shadow map", map);
  layout_.emplace(device, view_, shadow_map_);
}

void Renderer::fit_attachments(VkExtent2D extent) {
  const gpu::ImageOptions& now = depth_.options();
  if (depth_ && now.width == extent.width && now.height == extent.height) return;
  if (depth_) device_.wait_idle();
  gpu::ImageOptions options;
  options.format = kDepthFormat;
  options.width = extent.width;
  options.height = extent.height;
  options.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  options.samples = samples_;
  options.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  depth_ = gpu::Image(device_, "depth", options);
  if (samples_ == VK_SAMPLE_COUNT_1_BIT) return;
  options.format = color_format_;
  options.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  options.aspect = VK_IMAGE_ASPECT_COLOR_BIT;
  color_ = gpu::Image(device_, "multisampled colour", options);
}

void Renderer::write_view(VkCommandBuffer commands, const shared::View& view) {
  constexpr VkPipelineStageFlags2 kReaders =
      VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  VkMemoryBarrier2 before{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  before.srcStageMask = kReaders | VK_PIPELINE_STAGE_2_TRANSFER_BIT;
  before.dstStageMask = VK_PIPELINE_STAGE_2_TRANSFER_BIT;
  before.srcAccessMask = before.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier(commands, &before, nullptr);
  vkCmdUpdateBuffer(commands, view_.handle(), 0, sizeof view, &view);
  // The cloth was written by compute passes, or copied from the host: both are made visible here.
  VkMemoryBarrier2 after{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  after.srcStageMask = VK_PIPELINE_STAGE_2_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  after.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_WRITE_BIT;
  after.dstStageMask = kReaders | VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT;
  after.dstAccessMask = VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                        VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT;
  barrier(commands, &after, nullptr);
}

DrawCounts Renderer::draw(VkCommandBuffer commands, const DrawTarget& target, const DrawBuffers& cloth,
                          const Camera& camera, double time_s, const Look& look, std::uint32_t slot) {
  WEFT_ASSERT(slot < kDrawSlots);
  counts_ = {};
  slot_ = slot;
  time_s_ = time_s;
  if (look.stride != listed_stride_) {
    device_.wait_idle();
    drop_cloth_lists();
    listed_stride_ = look.stride;
  }
  fit_attachments(target.extent);
  if (look.heat) layout_->bind_positions(slot, cloth.position);
  const double aspect = double{1.0} * target.extent.width / target.extent.height;
  device_.begin_label(commands, "picture");
  write_view(commands, make_view(*model_, stage_, camera, aspect, time_s, look.heat_full));
  draw_shadows(commands, cloth, look);
  draw_scene(commands, target, cloth, look);
  device_.end_label(commands);
  return counts_;
}

void Renderer::begin_pass(VkCommandBuffer commands, const VkRenderingInfo& info) {
  vkCmdBeginRendering(commands, &info);
  const VkExtent2D extent = info.renderArea.extent;
  const VkViewport viewport{0.0f, 0.0f, static_cast<float>(extent.width), static_cast<float>(extent.height),
                            0.0f, 1.0f};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
  const VkDescriptorSet set = layout_->set(slot_);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_->handle(), 0, 1, &set, 0,
                          nullptr);
}

/// A software device spends half of a picture of 256 × 256 particles on the shadow of triangles smaller than
/// a texel of its map; every second or fourth particle throws the same shadow.
Renderer::List Renderer::shadow_list(const Look& look) const {
  if (look.shading == Shading::flat) return kHalfTriangles;
  return device_.info().software && listed_.nx > kShadowCells + 1 ? kShadowMesh : kAllTriangles;
}

void Renderer::draw_shadows(VkCommandBuffer commands, const DrawBuffers& cloth, const Look& look) {
  device_.begin_label(commands, "shadow map");
  begin_attachment(commands, shadow_map_);
  VkRenderingAttachmentInfo depth =
      cleared(shadow_map_.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, 1.0f);
  depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea.extent = {stage_.shadow_size, stage_.shadow_size};
  info.layerCount = 1;
  info.pDepthAttachment = &depth;
  begin_pass(commands, info);
  if (look.wireframe)
    draw_cloth(commands, kShadowLines, kLines, cloth);
  else
    draw_cloth(commands, kShadowTriangles, shadow_list(look), cloth);
  if (ball_count_ > 0) draw_balls(commands, kShadowBalls);
  draw_solids(commands, kShadowSolids);
  vkCmdEndRendering(commands);

  VkImageMemoryBarrier2 read = image_barrier(shadow_map_);
  read.srcStageMask = kDepthStages;
  read.srcAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  read.dstStageMask = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  read.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  read.oldLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  read.newLayout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
  barrier(commands, nullptr, &read);
  device_.end_label(commands);
}

void Renderer::draw_scene(VkCommandBuffer commands, const DrawTarget& target, const DrawBuffers& cloth,
                          const Look& look) {
  device_.begin_label(commands, "scene");
  begin_attachment(commands, depth_);
  VkRenderingAttachmentInfo depth = cleared(depth_.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, 0.0f);
  VkRenderingAttachmentInfo color = cleared(target.view, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, 0.0f);
  color.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;  // the sky covers what nothing else does
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  if (color_) {
    begin_attachment(commands, color_);
    color.imageView = color_.view();
    color.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    color.resolveImageView = target.view;
    color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  }
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea.extent = target.extent;
  info.layerCount = 1;
  info.colorAttachmentCount = 1;
  info.pColorAttachments = &color;
  info.pDepthAttachment = &depth;
  begin_pass(commands, info);

  const bool flat = look.shading == Shading::flat;
  const List list = look.wireframe ? kLines : (flat ? kHalfTriangles : kAllTriangles);
  const Kind plain = look.wireframe ? kWire : (flat ? kFlat : kSmooth);
  const Kind heat = look.wireframe ? kWireHeat : (flat ? kFlatHeat : kSmoothHeat);
  draw_cloth(commands, look.heat ? heat : plain, list, cloth);
  count_cloth(list);
  if (ball_count_ > 0) draw_balls(commands, kBalls);
  draw_solids(commands, kSolids);
  if (model_->scene.floor) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline(kFloor).handle());
    vkCmdDraw(commands, 4, 1, 0, 0);
    ++counts_.draws;
  }
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline(kSky).handle());
  vkCmdDraw(commands, 3, 1, 0, 0);
  ++counts_.draws;
  vkCmdEndRendering(commands);
  device_.end_label(commands);
}

void Renderer::draw_cloth(VkCommandBuffer commands, Kind kind, List list, const DrawBuffers& cloth) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline(kind).handle());
  const VkBuffer buffers[] = {cloth.position, cloth.normal};
  const VkDeviceSize offsets[] = {0, 0};
  vkCmdBindVertexBuffers(commands, 0, describe(kind).attributes, buffers, offsets);
  if (cloth.torn_mesh != VK_NULL_HANDLE) {  // triangles of all cells, then lines of all particles
    const std::uint32_t triangles = 6 * (model_->grid.nx - 1) * (model_->grid.ny - 1);
    const bool lines = list == kLines;
    vkCmdBindIndexBuffer(commands, cloth.torn_mesh, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(commands, lines ? 6 * model_->grid.count() : triangles, 1, lines ? triangles : 0, 0, 0);
  } else {
    const Indices& order = indices(list);
    vkCmdBindIndexBuffer(commands, order.buffer.handle(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(commands, order.count, 1, 0, 0, 0);
  }
  ++counts_.draws;
}

void Renderer::draw_balls(VkCommandBuffer commands, Kind kind) {
  const Indices& order = indices(kBallTriangles);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline(kind).handle());
  vkCmdBindIndexBuffer(commands, order.buffer.handle(), 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(commands, order.count, ball_count_, 0, 0, 0);
  ++counts_.draws;
}

void Renderer::draw_solids(VkCommandBuffer commands, Kind kind) {
  if (solids_.bodies.empty()) return;
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline(kind).handle());
  const VkBuffer buffers[] = {solids_.position.handle(), solids_.normal.handle()};
  const VkDeviceSize offsets[] = {0, 0};
  vkCmdBindVertexBuffers(commands, 0, describe(kind).attributes, buffers, offsets);
  vkCmdBindIndexBuffer(commands, solids_.indices.handle(), 0, VK_INDEX_TYPE_UINT32);
  for (std::size_t body = 0; body < solids_.bodies.size(); ++body) {
    const glm::mat4 frame = body_frame(*model_, body, time_s_);
    vkCmdPushConstants(commands, layout_->handle(), VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof frame, &frame);
    vkCmdDrawIndexed(commands, solids_.bodies[body].index_count, 1, solids_.bodies[body].first_index, 0, 0);
    ++counts_.draws;
  }
}

void Renderer::count_cloth(List list) {
  (list == kLines ? counts_.cloth_lines : counts_.cloth_triangles) +=
      indices(list).count / (list == kLines ? 2 : 3);
}

}  // namespace weft
