// The main loop: input, simulation, panels, picture, and the pace of it all.
#include "viewer/application.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "gpu/shader.h"
#include "render/image.h"
#include "render/mesh.h"
#include "viewer/accuracy_panel.h"
#include "viewer/thread_order.h"

namespace weft {
namespace {

// Time for the simulation between two pictures: as much as drawing takes, within these. One chunk more may
// come on top, of at most about 50 ms.
constexpr double kBudgetLeast_s = 0.028, kBudgetMost_s = 0.045;
constexpr double kRest_s = 0.1;  // between looks at a window that shows nothing new

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::filesystem::path log_file(const ViewerOptions& options) {
  if (!options.log.empty()) return options.log;
  const char* file = std::getenv("WEFT_VIEWER_LOG");
  return file != nullptr ? file : "";
}

gpu::DeviceOptions device_options(const ViewerOptions& options) {
  if (options.device == "cpu")
    throw Error(
        Exit::usage,
        "--device is cpu; the window shows what a Vulkan device or native computes (weft devices lists "
        "them; weft render and weft simulate know cpu)");
  return {.choice = options.device == "native" ? "" : options.device,
          .validation = options.validation,
          .force_staging = options.force_staging,
          .instance_extensions = Window::instance_extensions(),
          .device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME}};
}

/// The device of the window, once its name is known to be allowed.
const gpu::Device& allowed(const gpu::Device& device) {
  const char* required = std::getenv("WEFT_REQUIRE_GPU");
  if (required != nullptr && std::string(required) == "1" && device.info().software)
    throw error(Exit::no_device,
                "WEFT_REQUIRE_GPU=1 and the device is {}, a software device; choose a GPU with --device "
                "(weft devices "
                "lists them), install its Vulkan driver, or unset WEFT_REQUIRE_GPU",
                device.info().name);
  return device;
}

/// As `weft simulate` does it: native where nobody speaks of Vulkan and the device is a software one.
ComputeOn compute_on(const ViewerOptions& options, const gpu::Device& device) {
  if (options.device == "native") return ComputeOn::native;
  const bool speaks_of_vulkan = !options.device.empty() || !options.kernel.empty() ||
                                !options.shader_dir.empty() || options.validation || options.force_staging ||
                                std::getenv("WEFT_KERNEL") != nullptr;
  return speaks_of_vulkan || !device.info().software ? ComputeOn::device : ComputeOn::native;
}

/// Drawing takes what computing leaves of the cores. Before a thread that computes is made.
int drawing_behind(const ViewerOptions& options, const gpu::Device& device,
                   const std::vector<int>& threads_before) {
  const bool shares = device.info().software && compute_on(options, device) == ComputeOn::native;
  return shares ? put_behind(threads_before) : 0;
}

float content_scale(const Window& window) {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window.handle(), &x, &y);
  return std::clamp(x, 1.0f, 3.0f);
}

double display_period_s() {
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  const int rate = mode != nullptr && mode->refreshRate > 0 ? mode->refreshRate : 60;
  // A little quicker than the display: where it sets the pace itself, waiting here must not miss its turn.
  return 0.92 / std::clamp(rate, 30, 240);
}

}  // namespace

Application::Application(const ViewerOptions& options)
    : options_(options),
      log_(log_file(options)),
      window_("Weft", {options.width, options.height}),
      threads_before_device_(threads_now()),
      device_(device_options(options)),
      threads_behind_(drawing_behind(options, device_, threads_before_device_)),
      surface_(allowed(device_), window_),
      swapchain_(device_, surface_, options.present_mode),
      ui_scale_(content_scale(window_)),
      running_(device_, options.overrides, options.scene, options.kernel, compute_on(options, device_)),
      gui_(device_, window_, swapchain_, ui_scale_),
      painter_(device_, swapchain_, gui_, options.samples),
      controls_(window_, gui_),
      costs_(device_),
      finder_(device_, !device_.info().software || options.kernel == "auto") {
  constant_facts_.device = device_.info().name;
  constant_facts_.software = device_.info().software;
  constant_facts_.samples = static_cast<std::uint32_t>(painter_.samples());
  constant_facts_.scenes = numbered_scenes();
  constant_facts_.materials = list_materials();
  constant_facts_.validating = device_.validating();
  constant_facts_.present_modes = swapchain_.present_modes();
  picture_s_ = display_period_s();
  place_scene();
  view_.camera = view_.home = default_camera(running_.shown(), view_.area.aspect());
  window_.set_title("Weft: " + running_.scene().title);
  if (device_.info().software)
    view_.say(
        fmt::format("no GPU is used: {} computes, {} draws", running_.computed_by(), device_.info().label()),
        6.0);
  if (!running_.warnings().empty()) view_.say(running_.warnings().front(), 8.0);
}

template <class Action>
void Application::attempt(Action&& action) {
  try {
    action();
  } catch (const Error& mistake) {
    if (mistake.code() == Exit::internal) throw;
    spdlog::warn("{}", mistake.what());
    view_.complain(mistake.what());
    log_.event(fmt::format("refused {}", mistake.what()));
  }
}

void Application::run() {
  while (!window_.should_close() && !time_to_quit()) {
    const bool resting =
        running_.paused() && !controls_.busy() && seconds(Clock::now() - last_event_) > kAwake_s;
    window_.poll(window_.minimised() || resting ? kRest_s : 0.0);
    const Clock::time_point now = Clock::now();
    const double elapsed_s = seconds(now - std::exchange(latest_, now));
    if (window_.minimised()) {  // nothing is computed for nobody; the scene goes on where it was
      window_.take_events();
      running_.rest();
      running_.pacer().restart();
      log();
      continue;
    }
    if (pictures_ > 0) longest_gap_ms_ = std::max(longest_gap_ms_, 1e3 * elapsed_s);
    place_scene();
    const bool had_input = window_.has_events();
    handle_input(elapsed_s);
    follow_change();
    const double budget_s = std::clamp(1e-3 * painter_.draw_ms(), kBudgetLeast_s, kBudgetMost_s);
    attempt([&] { running_.advance(elapsed_s, budget_s); });
    if (!pending_ && !running_.changing()) attempt([&] { running_.keep_pace(); });
    if (!running_.paused()) running_.measure();
    attempt([&] { costs_.follow(running_); });
    attempt([&] { find_kernel(elapsed_s); });
    look_at_pictures(elapsed_s);
    const bool draws = picture_due();
    if (draws || had_input) turn_panels(draws);
    log();
    pace();
  }
  if (!options_.screenshot.empty()) {
    view_.screenshot = true;
    attempt([&] { running_.settle(); });  // a change that is refused now takes no picture away
    running_.settle();
    gui_.begin_frame();
    panels_.draw(running_, running_.scene(), facts(), view_);
    paint();
  }
  end_film();
  device_.wait_idle();
}

bool Application::time_to_quit() const {
  return (options_.quit_after_s > 0.0 && seconds(Clock::now() - start_) > options_.quit_after_s) ||
         (options_.quit_after_frames > 0 && pictures_ >= options_.quit_after_frames);
}

/// The part of the window that the panel leaves.
void Application::place_scene() {
  const WindowSize size = window_.framebuffer();
  const double ratio = static_cast<double>(size.width) / std::max(1u, window_.size().width);
  const auto panel = static_cast<std::uint32_t>(std::lround(Panels::kWidth * ui_scale_ * ratio));
  const std::uint32_t left = view_.panels && size.width > panel + 200 ? panel : 0;
  const auto accuracy = static_cast<std::uint32_t>(std::lround(kAccuracyWidth * ui_scale_ * ratio));
  const std::uint32_t right = view_.accuracy && size.width > left + accuracy + 200 ? accuracy : 0;
  const SceneArea area{static_cast<std::int32_t>(left), 0, std::max(1u, size.width - left - right),
                       std::max(1u, size.height)};
  if (area.width == view_.area.width && area.height == view_.area.height) return;
  view_.area = area;
  const Camera home = default_camera(running_.shown(), area.aspect());
  const bool at_home =
      view_.camera.target_m == view_.home.target_m && view_.camera.yaw_rad == view_.home.yaw_rad &&
      view_.camera.pitch_rad == view_.home.pitch_rad && view_.camera.distance_m == view_.home.distance_m;
  view_.home = home;
  if (at_home) view_.camera = home;
}

void Application::handle_input(double elapsed_s) {
  attempt([&] {
    const ControlWishes wishes = controls_.handle(running_, view_, elapsed_s);
    if (controls_.busy() || wishes.open_scene > 0) last_event_ = Clock::now();
    if (wishes.quit) window_.request_close();
    if (wishes.full_screen) window_.toggle_full_screen();
    if (wishes.open_scene > 0) open(std::to_string(wishes.open_scene));
    if (wishes.reload) reload();
    if (wishes.toggle_video) toggle_video();
  });
}

void Application::handle_panels(const PanelWishes& wishes) {
  resolution_slider_ = wishes.resolution_slider;
  attempt([&] {
    if (wishes.open) open(*wishes.open);
    if (wishes.reset) running_.reset();
    if (wishes.restore) running_.restore();
    if (wishes.toggle_pause) running_.set_paused(!running_.paused());
    if (wishes.step) running_.step();
    if (wishes.measure_effects) costs_.start_trial(running_);
    if (wishes.stop_measuring) costs_.cancel_trial();
    if (wishes.speed) running_.pacer().set_speed(*wishes.speed);
    if (wishes.allow_xpbd) running_.stand_in().allow(*wishes.allow_xpbd);
    if (wishes.scale)
      painter_.set_scale(*wishes.scale > 0.0 ? *wishes.scale : painter_.scale(), *wishes.scale <= 0.0);
    if (wishes.kernel) running_.set_kernel(*wishes.kernel);
    if (wishes.present_mode) swapchain_.set_present_mode(*wishes.present_mode);
    if (wishes.material) {
      const std::string text = fmt::format("[cloth]\n[material]\npreset = \"{}\"\n", *wishes.material);
      if (!pending_) pending_ = running_.wanted();
      pending_->material = parse_scene(text, *wishes.material).scene.material;
    }
    if (wishes.scene) pending_ = *wishes.scene;
  });
  apply_pending(wishes.edit_ended || wishes.material);
}

/// The accuracy panel and all it holds exist only while it is open.
void Application::show_accuracy() {
  if (!view_.accuracy) {
    if (accuracy_) running_.stop_watching();
    accuracy_.reset();
    return;
  }
  if (!accuracy_) accuracy_ = std::make_unique<Accuracy>();
  attempt([&] {
    accuracy_->follow(running_);
    AccuracyWishes wishes = draw_accuracy_panel(running_, *accuracy_);
    error_slider_ = wishes.error_slider;
    study_button_ = wishes.study_button;
    if (wishes.close) view_.accuracy = false;
    if (wishes.start_study) accuracy_->start_study(running_);
    if (wishes.cancel_study) accuracy_->cancel_study();
    if (!wishes.setting) wishes.setting = accuracy_->wanted();
    if (!wishes.setting) return;
    Scene next = pending_.value_or(running_.wanted());
    set_setting(*wishes.setting, next);
    pending_.reset();
    running_.apply(next);
    ++rebuilds_;
  });
}

/// A change that is refused counts, too: it is answered.
void Application::follow_change() {
  attempt([&] { running_.follow_change(); });
  if (was_changing_ && !running_.changing()) ++rebuilds_;
  apply_pending(false);
  was_changing_ = running_.changing();
}

/// A slider that is dragged applies at once while that is quick, else when it is let go; one change at a
/// time.
void Application::apply_pending(bool edit_ended) {
  constexpr double kQuick_ms = 150.0;
  edit_ended_ = pending_ && (edit_ended_ || edit_ended);
  const bool waits = running_.changing() || (!edit_ended_ && running_.figures().rebuild_ms > kQuick_ms);
  if (!pending_ || waits) return;
  edit_ended_ = false;
  const Scene next = *std::exchange(pending_, std::nullopt);
  attempt([&] { running_.begin_change(next); });
  was_changing_ = running_.changing();
}

void Application::open(const std::string& which) {
  pending_.reset();
  running_.open(which);
  ++rebuilds_;
  view_.camera = view_.home = default_camera(running_.shown(), view_.area.aspect());
  window_.set_title("Weft: " + running_.scene().title);
  if (!running_.warnings().empty()) view_.say(running_.warnings().front(), 8.0);
}

void Application::reload() {
  const bool new_shaders = !options_.shader_dir.empty();
  if (new_shaders) painter_.reload_shaders(running_);
  running_.reload(new_shaders);
  ++rebuilds_;
  view_.say(new_shaders ? "scene and shaders read again" : "scene read again", 2.0);
}

void Application::toggle_video() {
  if (film_) {
    end_film();
    return;
  }
  film_ = std::make_unique<Film>(free_name(options_.capture_dir, "mp4"));
  film_start_ = Clock::now();
  scale_was_automatic_ = painter_.automatic_scale();
  painter_.set_scale(painter_.scale(), false);  // a film keeps its size
  view_.filming = true;
  view_.say(fmt::format("recording {}; V stops", film_->file().string()), 3.0);
}

void Application::end_film() {
  if (!film_) return;
  const std::unique_ptr<Film> film = std::move(film_);
  view_.filming = false;
  painter_.set_scale(painter_.scale(), scale_was_automatic_);
  attempt([&] {
    film->finish();
    view_.say(fmt::format("saved {}", film->file().string()));
    log_.event(fmt::format("film {} pictures={}", film->file().string(), film->pictures()));
  });
}

void Application::save_screenshot(const Picture& picture) {
  const bool last = !options_.screenshot.empty() && (time_to_quit() || window_.should_close());
  const std::filesystem::path file = last ? options_.screenshot : free_name(options_.capture_dir, "png");
  write_png(file, picture);
  view_.say(fmt::format("saved {}", file.string()));
  log_.event(fmt::format("screenshot {}", file.string()));
}

void Application::paint() {
  const double film_s = seconds(Clock::now() - film_start_);
  const bool screenshot = std::exchange(view_.screenshot, false);
  std::optional<Painted> painted;
  view_.look.stride = device_.info().software
                          ? stride_for(running_.model().grid, std::min(kPictureCells, share_.cells_most()))
                          : std::uint32_t{1};
  const Clock::time_point began = Clock::now();
  // A picture that cannot be drawn is no mistake of a person's: it ends the program with its reason.
  painted = painter_.paint(running_, window_.framebuffer(),
                           {.area = view_.area,
                            .camera = view_.camera,
                            .look = view_.look,
                            .screenshot = screenshot,
                            .film = film_ && film_->wants(film_s)});
  if (!painted) {
    view_.screenshot = screenshot;  // next time
    return;
  }
  ++pictures_;
  const Clock::time_point now = Clock::now();
  if (painter_.idle() || !device_.info().software) note_paint(seconds(now - began));
  const double took_s = std::max(seconds(now - std::exchange(latest_picture_, now)), 1e-4);
  if (pictures_ > 1) longest_picture_gap_ms_ = std::max(longest_picture_gap_ms_, 1e3 * took_s);
  pictures_per_s_ = pictures_per_s_ > 0.0 ? 0.9 * pictures_per_s_ + 0.1 / took_s : 1.0 / took_s;
  attempt([&] {
    if (painted->screenshot) save_screenshot(*painted->screenshot);
  });
  if (!painted->film) return;
  try {
    film_->add(std::move(*painted->film), film_s);
  } catch (const Error& mistake) {
    end_film();
    view_.complain(mistake.what());
  }
}

void Application::find_kernel(double elapsed_s) {
  if (pending_ || running_.changing() || running_.hand().holds()) return;
  const std::string found = finder_.follow(running_, elapsed_s);
  if (!found.empty()) view_.say(found, 6.0);
}

}  // namespace weft
