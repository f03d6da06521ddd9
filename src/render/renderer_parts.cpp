// What a Renderer makes on first use: its pipelines and index buffers.
#include <algorithm>
#include <span>
#include <string>

#include "render/mesh.h"
#include "render/renderer.h"

namespace weft {

void Renderer::set_model(const Model& model) {
  device_.wait_idle();
  model_ = &model;
  stage_.bounds = scene_bounds(model, film_s_);
  ball_count_ = ball_count(model);
  make_solids();
  if (model.grid.nx == listed_.nx && model.grid.ny == listed_.ny && model.grid.cloths == listed_.cloths)
    return;
  drop_cloth_lists();
  listed_ = model.grid;
}

/// The pictures that use them must be finished.
void Renderer::drop_cloth_lists() {
  for (const List list : {kAllTriangles, kHalfTriangles, kShadowMesh, kLines}) lists_[list] = {};
}

std::string_view Renderer::kind_name(Kind kind) {
  constexpr std::array<std::string_view, kKindCount> kNames{"shadow of cloth", "shadow of lines",
                                                            "shadow of balls", "shadow of solids",
                                                            "cloth",           "cloth flat",
                                                            "cloth heat",      "cloth flat heat",
                                                            "wireframe",       "wireframe heat",
                                                            "balls",           "solids",
                                                            "floor",           "sky"};
  return kNames[kind];
}

DrawPipelineOptions Renderer::describe(Kind kind) const {
  DrawPipelineOptions options;
  options.name = kind_name(kind);
  options.color_format = color_format_;
  options.samples = samples_;
  const bool flat = kind == kFlat || kind == kFlatHeat;
  const bool heat = kind == kSmoothHeat || kind == kFlatHeat || kind == kWireHeat;
  options.constants = {device_.info().software ? 12u : 24u, flat ? 1u : 0u, heat ? 1u : 0u};
  switch (kind) {
    case kShadowTriangles:
    case kShadowLines:
    case kShadowBalls:
    case kShadowSolids:
      options.vertex = kind == kShadowBalls    ? "draw/shadow_ball.vert"
                       : kind == kShadowSolids ? "draw/shadow_solid.vert"
                                               : "draw/shadow_cloth.vert";
      options.attributes = kind == kShadowBalls ? 0 : 1;
      options.cull_back = kind == kShadowBalls || kind == kShadowSolids;
      options.shadow = true;
      options.color_format = VK_FORMAT_UNDEFINED;
      options.samples = VK_SAMPLE_COUNT_1_BIT;
      if (kind == kShadowLines) options.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
      return options;
    case kBalls:
      options.vertex = "draw/ball.vert";
      options.fragment = "draw/ball.frag";
      options.cull_back = true;
      return options;
    case kSolids:
      options.vertex = "draw/solid.vert";
      options.fragment = "draw/ball.frag";
      options.attributes = 2;
      options.cull_back = true;
      return options;
    case kFloor:
      options.vertex = "draw/floor.vert";
      options.fragment = "draw/floor.frag";
      options.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
      return options;
    case kSky:
      options.vertex = "draw/sky.vert";
      options.fragment = "draw/sky.frag";
      options.writes_depth = false;
      return options;
    default:
      options.vertex = heat ? "draw/cloth_heat.vert" : "draw/cloth.vert";
      options.fragment = "draw/cloth.frag";
      options.attributes = 2;
      if (kind != kWire && kind != kWireHeat) return options;
      options.fragment = "draw/wire.frag";
      options.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
      return options;
  }
}

void Renderer::make_solids() {
  solids_ = {};
  const SolidTriangles made = solid_triangles(*model_);
  solids_.bodies = made.bodies;
  if (made.bodies.empty()) return;
  const auto filled = [&](const char* name, auto span, VkBufferUsageFlags usage) {
    const auto bytes = std::as_bytes(span);
    gpu::Buffer buffer(device_, name, bytes.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                       gpu::Memory::device);
    buffer.write(bytes);
    return buffer;
  };
  solids_.position = filled("solid positions", std::span(made.position), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  solids_.normal = filled("solid normals", std::span(made.normal), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  solids_.indices = filled("solid triangles", std::span(made.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
}

const DrawPipeline& Renderer::pipeline(Kind kind) {
  DrawPipeline& made = pipelines_[kind];
  if (!made) made = DrawPipeline(device_, layout_->handle(), describe(kind));
  return made;
}

void Renderer::make_pipelines() {
  for (std::uint32_t kind = 0; kind < kKindCount; ++kind) pipeline(static_cast<Kind>(kind));
}

std::vector<std::string_view> Renderer::pipelines() const {
  std::vector<std::string_view> names;
  for (std::uint32_t kind = 0; kind < kKindCount; ++kind)
    if (pipelines_[kind]) names.push_back(kind_name(static_cast<Kind>(kind)));
  return names;
}

const Renderer::Indices& Renderer::indices(List list) {
  Indices& made = lists_[list];
  if (made.buffer) return made;
  constexpr std::array<const char*, kListCount> kNames{"cloth triangles", "cloth half triangles",
                                                       "shadow mesh", "cloth lines", "ball triangles"};
  const Grid& grid = model_->grid;
  const auto generate = [&] {
    switch (list) {
      case kAllTriangles: return cloth_triangles(grid, listed_stride_);
      case kHalfTriangles: return cloth_half_triangles(grid, listed_stride_);
      case kShadowMesh:
        return cloth_triangles(grid, std::max(listed_stride_, stride_for(grid, kShadowCells)));
      case kLines: return cloth_lines(grid, listed_stride_);
      default: return ball_triangles();
    }
  };
  const std::vector<std::uint32_t> words = generate();
  made.count = static_cast<std::uint32_t>(words.size());
  made.buffer =
      gpu::Buffer(device_, kNames[list], words.size() * sizeof(std::uint32_t),
                  VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::device);
  made.buffer.write(std::as_bytes(std::span(words)));
  return made;
}

}  // namespace weft
