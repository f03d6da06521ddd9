// What the window tells of itself: to its panels, and in the log's line to a test or a bug report.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "gpu/buffer.h"
#include "viewer/application.h"

namespace weft {
namespace {

/// For the log: whether there is a study, or one runs.
const char* accuracy_text(const Accuracy* accuracy) {
  if (accuracy == nullptr) return "closed";
  if (accuracy->study_run() != nullptr) return "running";
  return accuracy->study() != nullptr ? "kept" : "none";
}

}  // namespace

PanelFacts Application::facts() const {
  PanelFacts facts = constant_facts_;
  facts.pictures_per_s = pictures_per_s_;
  facts.draw_ms = painter_.draw_ms();
  facts.scale = painter_.scale();
  facts.share = share_.text(picture_s_, paint_s_, painter_.scale());
  facts.automatic_scale = painter_.automatic_scale();
  facts.present_mode = swapchain_.present_mode();
  facts.costs = &costs_;
  facts.trying = finder_.trying();
  if (running_.on_gpu() != nullptr)
    facts.kernels = fitting_kernel_names(device_, running_.simulation().plan());
  if (facts.validating) facts.validation_messages = device_.validation_messages().size();
  return facts;
}

/// What only an open accuracy panel has.
std::string Application::accuracy_figures() const {
  if (!accuracy_) return "";
  const auto& error = accuracy_->watch().frame_error();
  return fmt::format(" precision={} error_slider={} study_button={} wish_error={:.6e} live_error={:.3e}",
                     running_.scene().solver.precision, fmt::join(error_slider_, ","),
                     fmt::join(study_button_, ","), accuracy_->wish().error_m, error ? error->error_m : -1.0);
}

void Application::log() {
  if (!log_.on()) return;
  const Camera& camera = view_.camera;
  const auto flag = [](bool on) { return on ? 1 : 0; };
  const std::string settings = fmt::format(
      "scene={} native={} paused={} resolution={} speed={:.3f} membrane={:.6g} smooth={} wireframe={} "
      "heat={} help={} "
      "overlay={} "
      "timings={} accuracy={} study={} solver={} panels={} quit_question={} filming={} error={} hand={} "
      "hand_pins={} pins={} minimised={} "
      "size={}x{} rebuilds={} kernel={}",
      running_.which(), flag(running_.on_gpu() == nullptr), flag(running_.paused()), running_.model().grid.nx,
      running_.pacer().speed(), running_.scene().material.membrane_n_m,
      flag(view_.look.shading == Shading::smooth), flag(view_.look.wireframe), flag(view_.look.heat),
      flag(view_.help), flag(view_.overlay), flag(view_.timings), flag(view_.accuracy),
      accuracy_text(accuracy_.get()), running_.scene().solver.name, flag(view_.panels), flag(view_.ask_quit),
      flag(view_.filming), flag(view_.message && view_.message->is_error), flag(running_.hand().holds()),
      running_.hand_pins().size(), running_.scene().pins.size(), flag(window_.minimised()),
      window_.framebuffer().width, window_.framebuffer().height, rebuilds_,
      running_.on_gpu() != nullptr ? running_.on_gpu()->kernel().how : "native");
  const std::string figures = fmt::format(
      "time_s={:.6f} real_time={:.6f} slow={} pictures={} rate={:.1f} draw_ms={:.2f} frame_ms={:.2f} "
      "needs={:.3f} "
      "scale={:.2f} share={} "
      "gap_ms={:.1f} picture_gap_ms={:.1f} rebuild_ms={:.1f} kept_plan={} live={} live_bytes={} messages={} "
      "substeps={} "
      "stretch={:.5f} "
      "camera={:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f} slider={}{}",
      running_.simulation().time_s(), running_.pacer().real_time_factor(),
      flag(running_.pacer().slow_motion()), pictures_, pictures_per_s_, painter_.draw_ms(),
      running_.figures().frame_ms, running_.figures().frame_ms / running_.allowed_ms(), painter_.scale(),
      share_.step(), longest_gap_ms_, longest_picture_gap_ms_, running_.figures().rebuild_ms,
      flag(running_.figures().kept_plan), device_.allocator().live_count(), device_.allocator().live_bytes(),
      device_.validation_messages().size(), running_.simulation().plan().substeps,
      running_.figures().max_stretch, camera.target_m.x, camera.target_m.y, camera.target_m.z, camera.yaw_rad,
      camera.pitch_rad, camera.distance_m, fmt::join(resolution_slider_, ","), accuracy_figures());
  if (log_.state(settings, figures)) longest_gap_ms_ = longest_picture_gap_ms_ = 0.0;
}

}  // namespace weft
