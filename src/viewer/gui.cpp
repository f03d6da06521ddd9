// Start, look and drawing of the panels.
#include "viewer/gui.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <cmath>
#include <filesystem>

namespace weft {
namespace {

void check_imgui(VkResult result) { gpu::check(result, "drawing the panels"); }

void set_look(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 6.0f;
  style.FrameRounding = 3.0f;
  style.GrabRounding = 3.0f;
  style.WindowBorderSize = 0.0f;
  style.ItemSpacing = {8.0f, 5.0f};
  style.WindowPadding = {10.0f, 8.0f};
  style.Colors[ImGuiCol_WindowBg] = {0.07f, 0.08f, 0.10f, 0.88f};
  style.Colors[ImGuiCol_TitleBg] = {0.10f, 0.12f, 0.16f, 0.95f};
  style.Colors[ImGuiCol_TitleBgActive] = {0.14f, 0.20f, 0.30f, 0.95f};
  style.ScaleAllSizes(scale);
}

/// A proportional font where the system has one that ImGui can read; its built-in one elsewhere.
void load_font(float scale) {
  static constexpr const char* kFiles[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                           "/usr/share/fonts/TTF/DejaVuSans.ttf",
                                           "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"};
  // Latin, Greek, dashes, super- and subscripts, arrows, mathematical signs.
  static constexpr ImWchar kGlyphs[] = {0x20,   0xff,   0x370,  0x3ff,  0x2010, 0x2027, 0x2070,
                                        0x209f, 0x2190, 0x21ff, 0x2200, 0x22ff, 0};
  ImGuiIO& io = ImGui::GetIO();
  for (const char* file : kFiles) {
    if (!std::filesystem::exists(file)) continue;
    if (io.Fonts->AddFontFromFileTTF(file, std::round(14.0f * scale), nullptr, kGlyphs) != nullptr) return;
  }
  io.Fonts->AddFontDefault();
  io.FontGlobalScale = scale;
}

}  // namespace

Gui::Gui(gpu::Device& device, Window& window, const Swapchain& swapchain, float scale) : device_(device) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // no file left behind; panels have their places
  set_look(scale);
  load_font(scale);
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4};
  VkDescriptorPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  pool.maxSets = 4;
  pool.poolSizeCount = 1;
  pool.pPoolSizes = &size;
  gpu::check(vkCreateDescriptorPool(device.handle(), &pool, nullptr, &pool_), "descriptors for the panels");
  make_render_pass(swapchain.format());
  ImGui_ImplGlfw_InitForVulkan(window.handle(), true);  // chains the callbacks already installed
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = device.instance();
  info.PhysicalDevice = device.physical();
  info.Device = device.handle();
  info.QueueFamily = device.queue_family();
  info.Queue = device.queue();
  info.DescriptorPool = pool_;
  info.MinImageCount = 2;
  info.ImageCount = 3;  // sets of vertex buffers in turn; more than frames in flight
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = check_imgui;
  ImGui_ImplVulkan_Init(&info, render_pass_);
  upload_fonts();
}

Gui::~Gui() {
  ImGui_ImplVulkan_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  destroy_framebuffers();
  vkDestroyRenderPass(device_.handle(), render_pass_, nullptr);
  vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
}

void Gui::make_render_pass(VkFormat format) {
  VkAttachmentDescription color{};
  color.format = format;
  color.samples = VK_SAMPLE_COUNT_1_BIT;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  color.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  color.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkSubpassDependency before{};
  before.srcSubpass = VK_SUBPASS_EXTERNAL;
  before.srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
  before.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  before.dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  before.dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  VkSubpassDependency after{};  // a screenshot may copy the image next
  after.dstSubpass = VK_SUBPASS_EXTERNAL;
  after.srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  after.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  after.dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT;
  after.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  before.dstSubpass = after.srcSubpass = 0;
  after.dstSubpass = VK_SUBPASS_EXTERNAL;
  const VkSubpassDependency dependencies[] = {before, after};
  VkRenderPassCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = 1;
  info.pAttachments = &color;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  gpu::check(vkCreateRenderPass(device_.handle(), &info, nullptr, &render_pass_), "the panels' render pass");
}

void Gui::upload_fonts() {
  device_.run_once([](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

void Gui::make_framebuffers(const Swapchain& swapchain) {
  destroy_framebuffers();
  for (const SwapchainImage& image : swapchain.images()) {
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = render_pass_;
    info.attachmentCount = 1;
    info.pAttachments = &image.view;
    info.width = swapchain.extent().width;
    info.height = swapchain.extent().height;
    info.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    gpu::check(vkCreateFramebuffer(device_.handle(), &info, nullptr, &framebuffer), "a framebuffer");
    framebuffers_.push_back(framebuffer);
  }
  generation_ = swapchain.generation();
}

void Gui::destroy_framebuffers() {
  for (const VkFramebuffer framebuffer : framebuffers_)
    vkDestroyFramebuffer(device_.handle(), framebuffer, nullptr);
  framebuffers_.clear();
}

void Gui::begin_frame() {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Gui::skip_frame() { ImGui::EndFrame(); }

void Gui::draw(VkCommandBuffer commands, const Swapchain& swapchain, const SwapchainImage& image) {
  ImGui::Render();
  // The swapchain waits for the device before it replaces its images, so the old framebuffers are idle.
  if (generation_ != swapchain.generation()) make_framebuffers(swapchain);
  VkRenderPassBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  begin.renderPass = render_pass_;
  begin.framebuffer = framebuffers_[image.index];
  begin.renderArea.extent = swapchain.extent();
  vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
  vkCmdEndRenderPass(commands);
}

bool Gui::wants_mouse() const { return ImGui::GetIO().WantCaptureMouse; }

bool Gui::wants_keyboard() const { return ImGui::GetIO().WantTextInput; }

}  // namespace weft
