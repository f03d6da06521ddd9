// Recording and showing one picture.
#include "viewer/painter.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/error.h"

namespace weft {
namespace {

struct Use {
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
  VkImageLayout layout;
};
constexpr Use kDrawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                     VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
constexpr Use kCopiedFrom{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                          VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
constexpr Use kCopiedTo{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
constexpr Use kForgotten{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED};
constexpr Use kPresented{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                         VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};

void change(VkCommandBuffer commands, VkImage image, const Use& from, const Use& to) {
  VkImageMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  barrier.srcStageMask = from.stage;
  barrier.srcAccessMask = from.access;
  barrier.oldLayout = from.layout;
  barrier.dstStageMask = to.stage;
  barrier.dstAccessMask = to.access;
  barrier.newLayout = to.layout;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

constexpr VkImageSubresourceLayers kColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

constexpr double kScales[] = {0.5, 0.65, 0.8, 1.0};
constexpr double kSlow_ms = 24.0, kQuick_ms = 14.0;  // drawing beyond and below which the scale follows
constexpr std::uint64_t kSettle_pictures = 8;

}  // namespace

Painter::Painter(gpu::Device& device, Swapchain& swapchain, Gui& gui, std::uint32_t samples)
    : device_(device),
      swapchain_(swapchain),
      gui_(gui),
      samples_(choose_samples(device, samples)),
      automatic_(device.info().software) {
  for (Frame& frame : frames_) {
    frame.commands = gpu::Commands(device, "picture");
    frame.timer = std::make_unique<gpu::Timer>(device, 2);
    VkSemaphoreCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    gpu::check(vkCreateSemaphore(device.handle(), &info, nullptr, &frame.acquired), "a semaphore");
  }
}

Painter::~Painter() {
  try {
    if (pending_) show_pending();
    device_.wait_idle();
  } catch (...) {  // a lost device has nothing left to wait for
  }
  for (Frame& frame : frames_) vkDestroySemaphore(device_.handle(), frame.acquired, nullptr);
}

void Painter::set_scale(double scale, bool automatic) {
  scale_ = scale;
  automatic_ = automatic;
}

bool Painter::idle() const {
  const std::uint64_t completed = device_.completed();
  return !pending_ &&
         std::ranges::all_of(frames_, [=](const Frame& frame) { return frame.submitted <= completed; });
}

void Painter::show_pending() {
  const Pending pending = *std::exchange(pending_, std::nullopt);
  swapchain_.present(pending.image);
}

std::optional<double> Painter::show_drawn() {
  if (!pending_ || pending_->submitted > device_.completed()) return std::nullopt;
  const auto drawn = std::chrono::steady_clock::now() - pending_->since;
  show_pending();
  return std::chrono::duration<double>(drawn).count();
}

void Painter::set_scale_most(double scale) {
  if (scale == scale_most_) return;
  scale_most_ = scale;
  if (!automatic_ || scale_ <= scale) return;
  scale_ = scale;
  draw_ms_ = 0.0;
  settled_until_ = painted_ + kSettle_pictures;
}

/// Draws the scene that runs now: the same renderer on another model, so that its pipelines stay.
void Painter::follow(const RunningScene& running) {
  if (!renderer_) {
    renderer_ = std::make_unique<Renderer>(device_, running.shown(), swapchain_.format(), samples_);
  } else if (shown_version_ != running.shown_version()) {
    renderer_->set_model(running.shown());
  }
  shown_version_ = running.shown_version();
}

void Painter::reload_shaders(const RunningScene& running) {
  device_.wait_idle();
  auto next = std::make_unique<Renderer>(device_, running.shown(), swapchain_.format(), samples_);
  next->make_pipelines();
  renderer_ = std::move(next);
  shown_version_ = running.shown_version();
}

void Painter::fit_scene_image(const SceneArea& area) {
  const auto scaled = [&](std::uint32_t pixels) {
    return std::max(1u, static_cast<std::uint32_t>(std::lround(scale_ * pixels)));
  };
  const std::uint32_t width = scaled(area.width), height = scaled(area.height);
  if (scene_image_ && scene_image_.options().width == width && scene_image_.options().height == height)
    return;
  device_.wait_idle();
  scene_image_ = gpu::Image(device_, "scene",
                            {.format = swapchain_.format(),
                             .width = width,
                             .height = height,
                             .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
}

std::optional<Painted> Painter::paint(const RunningScene& running, WindowSize framebuffer,
                                      const PaintRequest& request) {
  if (pending_) show_pending();  // its image may be needed
  const auto slot = static_cast<std::uint32_t>(painted_ % kFrames);
  Frame& frame = frames_[slot];
  if (frame.submitted != 0) {
    device_.wait(frame.submitted);
    const double ms = frame.timer->between_ms(0, 1);
    constexpr std::uint64_t kCompiling = 6;  // the first pictures wait for pipelines
    if (ms > 0.0 && painted_ > kCompiling) draw_ms_ = draw_ms_ > 0.0 ? 0.7 * draw_ms_ + 0.3 * ms : ms;
    adapt_scale();
  }
  const std::optional<SwapchainImage> image = swapchain_.acquire(frame.acquired, framebuffer);
  if (!image) {
    gui_.skip_frame();
    return std::nullopt;
  }
  follow(running);
  fit_scene_image(request.area);
  const VkCommandBuffer commands = frame.commands.begin();
  frame.timer->reset(commands);
  frame.timer->stamp(commands, 0);
  record(commands, running, request, *image, slot);
  frame.timer->stamp(commands, 1);
  frame.commands.end();
  frame.submitted = device_.submit(
      std::span(&commands, 1),
      {.wait = frame.acquired, .wait_stage = VK_PIPELINE_STAGE_2_TRANSFER_BIT, .signal = image->drawn});
  pending_ = Pending{*image, frame.submitted, std::chrono::steady_clock::now()};
  ++painted_;

  Painted painted;
  const bool wanted_now = request.screenshot || request.film;
  if (wanted_now || !device_.info().software) show_pending();
  if (wanted_now) device_.wait(frame.submitted);
  if (request.screenshot) painted.screenshot = picture_of(screenshot_, swapchain_.extent());
  if (request.film)
    painted.film = picture_of(film_, {scene_image_.options().width, scene_image_.options().height});
  return painted;
}

void Painter::record(VkCommandBuffer commands, const RunningScene& running, const PaintRequest& request,
                     const SwapchainImage& image, std::uint32_t slot) {
  const VkExtent2D extent{scene_image_.options().width, scene_image_.options().height};
  change(commands, scene_image_.handle(), kForgotten, kDrawn);
  const DrawnSimulation& simulation = running.simulation();
  renderer_->draw(commands, {scene_image_.view(), extent}, simulation.draw_buffers(), request.camera,
                  simulation.shown_time_s(), request.look, slot);
  change(commands, scene_image_.handle(), kDrawn, kCopiedFrom);
  if (request.film)
    copy_to_host(commands, scene_image_.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, extent, film_);
  copy_to_window(commands, request.area, image);
  gui_.draw(commands, swapchain_, image);
  if (!request.screenshot) return;
  change(commands, image.image, kPresented, kCopiedFrom);
  copy_to_host(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, swapchain_.extent(), screenshot_);
  change(commands, image.image, kCopiedFrom, {VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR});
}

void Painter::copy_to_window(VkCommandBuffer commands, const SceneArea& area, const SwapchainImage& image) {
  change(commands, image.image, kForgotten, kCopiedTo);
  const auto corner = [](std::uint32_t x, std::uint32_t y) {
    return VkOffset3D{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), 1};
  };
  const std::uint32_t width = scene_image_.options().width, height = scene_image_.options().height;
  // The window may have shrunk since the panels were laid out.
  const VkExtent2D window = swapchain_.extent();
  const auto x = static_cast<std::uint32_t>(area.x), y = static_cast<std::uint32_t>(area.y);
  const std::uint32_t right = std::min(x + area.width, window.width),
                      bottom = std::min(y + area.height, window.height);
  if (right > x && bottom > y) {
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = kColor;
    region.srcOffsets[1] = corner(width, height);
    region.dstOffsets[0] = {area.x, area.y, 0};
    region.dstOffsets[1] = corner(right, bottom);
    vkCmdBlitImage(commands, scene_image_.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
  }
  change(commands, image.image, kCopiedTo, kDrawn);
}

void Painter::copy_to_host(VkCommandBuffer commands, VkImage image, VkImageLayout now, VkExtent2D extent,
                           gpu::Buffer& pixels) {
  const VkDeviceSize bytes = VkDeviceSize{4} * extent.width * extent.height;
  if (!pixels || pixels.bytes() != bytes) {
    device_.wait_idle();
    pixels = gpu::Buffer(device_, "pixels", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback);
  }
  VkBufferImageCopy region{};
  region.imageSubresource = kColor;
  region.imageExtent = {extent.width, extent.height, 1};
  vkCmdCopyImageToBuffer(commands, image, now, pixels.handle(), 1, &region);
  VkMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_TRANSFER_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

Picture Painter::picture_of(const gpu::Buffer& pixels, VkExtent2D extent) const {
  Picture picture{
      .width = extent.width, .height = extent.height, .rgba = std::vector<std::uint8_t>(pixels.bytes())};
  pixels.read(std::as_writable_bytes(std::span(picture.rgba)));
  const bool blue_first = swapchain_.format() == VK_FORMAT_B8G8R8A8_UNORM;
  for (std::size_t p = 0; p < picture.rgba.size(); p += 4) {
    if (blue_first) std::swap(picture.rgba[p], picture.rgba[p + 2]);
    picture.rgba[p + 3] = 255;
  }
  return picture;
}

/// A software device draws fewer pixels rather than fewer pictures.
void Painter::adapt_scale() {
  if (!automatic_ || draw_ms_ <= 0.0 || painted_ < settled_until_) return;
  const auto* now = std::ranges::find_if(kScales, [&](double s) { return s >= scale_ - 1e-9; });
  const auto* chosen = now;
  const auto costs = [&](const double* scale) { return draw_ms_ * *scale * *scale / (*now * *now); };
  while (chosen != std::begin(kScales) && costs(chosen) > kSlow_ms) --chosen;
  if (draw_ms_ < kQuick_ms && now + 1 != std::end(kScales) && *(now + 1) <= scale_most_) {
    if (costs(now + 1) < kSlow_ms) chosen = now + 1;
  }
  settled_until_ = painted_ + kSettle_pictures;
  if (chosen == now) return;
  scale_ = *chosen;
  draw_ms_ = 0.0;
}

}  // namespace weft
