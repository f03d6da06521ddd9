// Draws one scene into an image, straight from the buffers the compute passes write. Knows of no window
// and no file: src/render/offscreen.h and the viewer give it a command buffer and a colour image.
#pragma once
#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/device.h"
#include "render/camera.h"
#include "render/draw_pipeline.h"
#include "render/solid_mesh.h"
#include "render/view.h"
#include "sim/gpu_simulation.h"

namespace weft {

enum class Shading {
  smooth,  ///< every triangle, interpolated normals
  flat,    ///< half of the triangles with one normal each, so that the triangulation shows
};

/// What may change from picture to picture.
struct Look {
  Shading shading = Shading::smooth;
  bool wireframe = false;
  bool heat = false;         ///< strain as colour
  double heat_full = 0.05;   ///< the strain painted in full colour
  std::uint32_t stride = 1;  ///< every how manyth particle along each side is drawn, and the last
};

/// Where a picture goes. The image is a colour attachment of the renderer's format, without multisampling,
/// in VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL before and after; former contents are lost.
struct DrawTarget {
  VkImageView view = VK_NULL_HANDLE;
  VkExtent2D extent{};
};

/// What one picture took.
struct DrawCounts {
  std::uint64_t cloth_triangles = 0, cloth_lines = 0;
  std::uint32_t draws = 0;  ///< draw calls, shadow map included
};

/// Cells along the width that a software device's shadow shows.
inline constexpr std::uint32_t kShadowCells = 128;

/// Cells along the width that a window draws of a cloth on a software device: 1024² would take a second a
/// picture.
inline constexpr std::uint32_t kPictureCells = 384;

/// 4 on a GPU and 1 on a software device; fewer where the device cannot.
/// @throws Error(Exit::usage) when `wish` is not 0 (automatic), 1 or 4
VkSampleCountFlagBits choose_samples(gpu::Device& device, std::uint32_t wish);

class Renderer {
 public:
  /// The model must outlive the renderer. Colours are written sRGB-encoded: give a UNORM format.
  /// @param film_s  as scene_bounds has it: shadows are drawn within those
  Renderer(gpu::Device& device, const Model& model, VkFormat color_format, VkSampleCountFlagBits samples,
           double film_s = kSlideShown_s);

  /// Another model in place of the one before, on the same pipelines; it must outlive the renderer. Waits for
  /// the pictures being drawn.
  void set_model(const Model& model);

  /// Makes every pipeline now, so that a mistake in a shader shows before anything is drawn with it.
  /// @throws Error(Exit::usage) with the compiler's messages
  void make_pipelines();

  /// Records one picture: the shadow map, then the scene. Makes earlier compute writes visible to itself.
  /// @param slot  below kDrawSlots; the picture drawn with this slot before must be finished
  DrawCounts draw(VkCommandBuffer commands, const DrawTarget& target, const DrawBuffers& cloth,
                  const Camera& camera, double time_s, const Look& look, std::uint32_t slot = 0);

  /// Names of the pipelines made so far: only what the scene and the looks asked for.
  std::vector<std::string_view> pipelines() const;
  VkSampleCountFlagBits samples() const { return samples_; }
  const Model& model() const { return *model_; }

 private:
  enum Kind : std::uint32_t {
    kShadowTriangles,
    kShadowLines,
    kShadowBalls,
    kShadowSolids,
    kSmooth,
    kFlat,
    kSmoothHeat,
    kFlatHeat,
    kWire,
    kWireHeat,
    kBalls,
    kSolids,
    kFloor,
    kSky,
    kKindCount
  };
  enum List : std::uint32_t {
    kAllTriangles,
    kHalfTriangles,
    kShadowMesh,  // fewer triangles, where a device computes them one by one
    kLines,
    kBallTriangles,
    kListCount
  };
  struct Indices {
    gpu::Buffer buffer;
    std::uint32_t count = 0;
  };
  /// Capsules, boxes and meshes: one body's triangles behind the other's.
  struct Solids {
    gpu::Buffer position, normal, indices;
    std::vector<BodyRange> bodies;
  };

  void drop_cloth_lists();
  static std::string_view kind_name(Kind kind);
  List shadow_list(const Look& look) const;
  DrawPipelineOptions describe(Kind kind) const;
  const DrawPipeline& pipeline(Kind kind);
  const Indices& indices(List list);
  void fit_attachments(VkExtent2D extent);
  void write_view(VkCommandBuffer commands, const shared::View& view);
  void draw_shadows(VkCommandBuffer commands, const DrawBuffers& cloth, const Look& look);
  void draw_scene(VkCommandBuffer commands, const DrawTarget& target, const DrawBuffers& cloth,
                  const Look& look);
  void draw_cloth(VkCommandBuffer commands, Kind kind, List list, const DrawBuffers& cloth);
  void draw_balls(VkCommandBuffer commands, Kind kind);
  void draw_solids(VkCommandBuffer commands, Kind kind);
  void make_solids();
  void begin_pass(VkCommandBuffer commands, const VkRenderingInfo& info);
  void count_cloth(List list);

  gpu::Device& device_;
  const Model* model_;
  Grid listed_;  ///< what the index lists are of
  std::uint32_t listed_stride_ = 1;
  VkFormat color_format_;
  VkSampleCountFlagBits samples_;
  double film_s_;
  Stage stage_;
  gpu::Buffer view_;
  gpu::Image shadow_map_, color_, depth_;
  std::optional<DrawLayout> layout_;
  std::array<DrawPipeline, kKindCount> pipelines_;
  std::array<Indices, kListCount> lists_;
  Solids solids_;
  double time_s_ = 0.0;  ///< of the picture being recorded
  std::uint32_t ball_count_ = 0;
  std::uint32_t slot_ = 0;
  DrawCounts counts_;
};

}  // namespace weft
