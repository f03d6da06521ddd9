// The kernels of `integrate`: one result to the bit, honest counts, and a choice that is remembered.
#include "sim/kernels.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "core/file.h"
#include "gpu_fixture.h"
#include "scenes.h"
#include "sim/gpu_simulation.h"
#include "sim/kernel_memory.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

constexpr const char* kOthers[] = {"texel", "strip", "steal", "bands"};

class KernelsTest : public GpuTest {
 protected:
  /// Pipelines stay between the tests: compiling them is what takes the time.
  static std::unique_ptr<GpuSimulation> with(const Model& model, const std::string& kernel) {
    return GpuSimulation::create(device(), model, find_solver("leapfrog"),
                                 {.pipelines = pipelines(), .kernel = kernel});
  }
  /// Whole and short frames: every remainder of the substeps a dispatch takes, and both parities.
  static State ran(GpuSimulation& simulation) {
    const std::uint32_t n = simulation.plan().substeps;
    const double frame_s = simulation.model().scene.solver.frame_s;
    for (const std::uint32_t k : {13u, 1u, 6u, 7u, 8u})
      if (k <= n) simulation.advance(frame_s * k / n, k);
    return simulation.read();
  }
  static void expect_equal_kernels(const Model& model, const std::string& what) {
    const auto direct = with(model, "direct");
    const State expected = ran(*direct);
    for (const char* kernel : kOthers) {
      const auto simulation = with(model, kernel);
      expect_same(ran(*simulation), expected, what + " with " + kernel);
    }
  }
  static void TearDownTestSuite() {
    pipelines().reset();
    GpuTest::TearDownTestSuite();
  }
  static std::shared_ptr<GpuPipelines>& pipelines() {
    static std::shared_ptr<GpuPipelines> kept = std::make_shared<GpuPipelines>(device());
    return kept;
  }
};

Model scene_of_shape(const std::string& file, std::uint32_t resolution, double height_m) {
  SceneOverrides overrides;
  overrides.set = {fmt::format("cloth.resolution={}", resolution), "cloth.width=1.0",
                   fmt::format("cloth.height={:.4f}", height_m)};
  return build_model(load_scene(file, overrides).scene);
}

// docs/float-form.md: f(b→a) = −f(a→b) to the bit, so a spring may be evaluated once or twice.
TEST_F(KernelsTest, equal_the_direct_one_on_every_scene) {
  for (const AssetInfo& asset : numbered_scenes())
    expect_equal_kernels(scene_of_shape(asset.file, 33, 1.0), asset.name);
}

// Three spheres or more are looked at once a strip is done, in the rows that came near one.
TEST_F(KernelsTest, equal_the_direct_one_with_spheres_all_about_it) {
  SceneOverrides overrides;
  overrides.set = {
      "cloth.resolution=40", "cloth.center=[0, 0.3, 0]",
      "spheres=[{center=[0, 0.1, 0], radius=0.2, friction=0.3}, {center=[0.4, 0.4, 0.4], radius=0.12, "
      "velocity=[0, -20, 0]}, {center=[-0.4, 0.2, 0.1], radius=0.1, friction=1}]"};
  const Model model = build_model(load_scene(find_scene("5"), overrides).scene);
  const auto direct = with(model, "direct");
  const State expected = ran(*direct);
  overrides.set.back() = "spheres=[]";
  const auto without = with(build_model(load_scene(find_scene("5"), overrides).scene), "direct");
  EXPECT_NE(state_hash(ran(*without)), state_hash(expected)) << "nothing was touched";
  for (const char* kernel : {"strip", "steal"}) expect_same(ran(*with(model, kernel)), expected, kernel);
}

TEST_F(KernelsTest, equal_the_direct_one_with_every_effect_in_contact) {
  const Model model = full_model("\n[solver]\nsubsteps = 60\n");
  const auto direct = with(model, "direct");
  for (int frame = 0; frame < 6; ++frame) direct->advance(model.scene.solver.frame_s, 60);
  const State expected = direct->read();
  ASSERT_TRUE(all_finite(expected));
  for (const char* kernel : kOthers) {
    const auto simulation = with(model, kernel);
    for (int frame = 0; frame < 6; ++frame) simulation->advance(model.scene.solver.frame_s, 60);
    expect_same(simulation->read(), expected, kernel);
  }
}

// Sizes that strips of 4, rows of 16 and four bands do not divide; cloths smaller than any of them.
TEST_F(KernelsTest, equal_the_direct_one_on_odd_shapes) {
  for (const auto& [nx, ny] : {std::pair{2u, 2u}, {3u, 5u}, {5u, 3u}, {17u, 33u}, {64u, 64u}, {65u, 130u}}) {
    const Model model = build_model(
        parse_scene(fmt::format("[cloth]\nresolution = {}\nwidth = 1.0\nheight = {:.6f}\nimperfection = "
                                "0.02\n[material]\nbend = 1e-5\n[gravity]\n[air]\ndrag = 0.1\n[[pins]]\nat = "
                                "[0.0, 0.0]\n[solver]\nsubsteps = 200\n",
                                nx, (ny - 1.0) / (nx - 1.0)),
                    "shape.toml")
            .scene);
    ASSERT_EQ(model.grid.ny, ny);
    expect_equal_kernels(model, fmt::format("{}x{}", nx, ny));
  }
}

TEST_F(KernelsTest, equal_the_direct_one_without_shear_flex_bending_or_damping) {
  for (const char* material :
       {"shear = 0.0", "flex = 0.0\nbend = 1e-5", "shear = 0.0\nflex = 0.0\ndamping = 0.0"}) {
    const Model model = build_model(
        parse_scene(fmt::format("[cloth]\nresolution = 21\nimperfection = 0.02\n[material]\n{}\n[gravity]\n"
                                "[solver]\nsubsteps = 200\n",
                                material),
                    "material.toml")
            .scene);
    expect_equal_kernels(model, material);
  }
}

// Every strip there is, not only the first of its kind.
TEST_F(KernelsTest, equal_the_direct_one_for_every_candidate) {
  const Model model = full_model("\n[solver]\nsubsteps = 60\n");
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  const State expected = ran(*with(model, "direct"));
  const fs::path file = fs::path(WEFT_BINARY_DIR) / "test-cache" / "candidates.json";
  for (const KernelCandidate& candidate : kernel_candidates(device(), plan)) {
    ASSERT_EQ(candidate.unfit, "");
    remember_kernel(file, kernel_memory_key(plan), candidate.kernel);
    const KernelChoice choice = choose_kernel(device(), model, plan, pipelines(), "auto", file);
    EXPECT_EQ(choice.how, "remembered");
    EXPECT_EQ(choice.kernel, candidate.kernel) << describe(candidate.kernel);
    fs::remove(kernel_memory_file(device()));
    remember_kernel(kernel_memory_file(device()), kernel_memory_key(plan), candidate.kernel);
    const auto simulation = with(model, "auto");
    EXPECT_EQ(simulation->kernel().kernel, candidate.kernel);
    expect_same(ran(*simulation), expected, describe(candidate.kernel));
  }
  fs::remove(kernel_memory_file(device()));
  fs::remove(file);
}

TEST_F(KernelsTest, record_and_allocate_what_they_say) {
  const Model model = full_model("\n[solver]\nsubsteps = 57\n");
  for (const char* kernel : {"direct", "texel", "strip", "steal", "bands"}) {
    const auto simulation = with(model, kernel);
    const Plan& plan = simulation->plan();
    const FrameStats stats = simulation->advance(model.scene.solver.frame_s, 57);
    EXPECT_EQ(stats.dispatches, simulation->dispatches_expected(57)) << kernel;
    EXPECT_EQ(simulation->bytes_allocated(), simulation->bytes_expected()) << kernel;
    EXPECT_EQ(stats.spring_evaluations, 58 * model.spring_count) << kernel;
    EXPECT_EQ(simulation->kernel().how, "forced");
    if (kernel == std::string("bands")) {
      EXPECT_EQ(stats.dispatches, 15u + 5u);  // ceil(57 / 4), closing kick, normals, three that watch
      EXPECT_GT(simulation->bytes_expected(), plan.bytes());
    } else if (kernel == std::string("steal")) {
      EXPECT_EQ(stats.dispatches, plan.dispatches());
      EXPECT_EQ(simulation->bytes_expected(),
                plan.bytes() + 64 * (simulation->kernel().kernel.queues + 1));  // a cache line a head
    } else {
      EXPECT_EQ(stats.dispatches, plan.dispatches()) << kernel;
      EXPECT_EQ(simulation->bytes_expected(), plan.bytes()) << kernel;
    }
  }
}

TEST_F(KernelsTest, do_not_depend_on_the_submits) {
  const Model model = full_model("\n[solver]\nsubsteps = 57\n");
  const State whole = ran(*with(model, "bands"));
  for (const std::uint32_t dispatches : {1u, 2u, 5u}) {
    const auto simulation = GpuSimulation::create(
        device(), model, find_solver("leapfrog"),
        {.dispatches_per_submit = dispatches, .pipelines = pipelines(), .kernel = "bands"});
    expect_same(ran(*simulation), whole, fmt::format("{} dispatches a submit", dispatches));
  }
}

class KernelChoiceTest : public KernelsTest {
 protected:
  void SetUp() override {
    KernelsTest::SetUp();
    fs::remove(file_);
  }
  KernelChoice choose(const std::string& name, KernelTrial trial = KernelTrial::allowed) {
    return choose_kernel(device(), model_, plan_, pipelines(), name, file_, trial);
  }
  fs::path file_ = fs::path(WEFT_BINARY_DIR) / "test-cache" / "kernel-choice.json";
  Model model_ = full_model();
  Plan plan_ = compile_plan(model_, find_solver("leapfrog"));
};

TEST_F(KernelChoiceTest, tries_nothing_where_no_trial_is_allowed) {
  const Kernel untried = untried_kernel(device(), plan_);
  EXPECT_EQ(untried.kind, KernelKind::texel);  // of a software device: nothing must wait for a compiler
  EXPECT_EQ(choose("", KernelTrial::when_named).how, "default");
  EXPECT_EQ(choose("", KernelTrial::when_named).kernel, untried);
  EXPECT_EQ(choose("auto", KernelTrial::never).kernel, untried);
  const ScopedEnvironment wish("WEFT_KERNEL", "texel");
  EXPECT_EQ(choose("", KernelTrial::when_named).kernel.kind, KernelKind::texel);
  EXPECT_EQ(choose("strip").kernel.kind, KernelKind::strip);  // a name given wins
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(KernelChoiceTest, without_a_name_is_what_an_earlier_trial_found) {
  const Kernel texel = named_kernel(device(), plan_, "texel");
  remember_kernel(file_, kernel_memory_key(plan_), texel);
  for (const KernelTrial trial : {KernelTrial::allowed, KernelTrial::when_named, KernelTrial::never}) {
    EXPECT_EQ(choose("", trial).how, "remembered");
    EXPECT_EQ(choose("", trial).kernel, texel);
  }
  fs::remove(file_);
  EXPECT_EQ(choose("", KernelTrial::allowed).how, "trial");
}

// llvmpipe ends all loops of an invocation after 65 535 turns: no workgroup may take so many tiles, and all
// together must be able to take every one. With three spheres or more every particle may be looked at once
// more, and beside each of at most 64 spheres.
TEST_F(KernelChoiceTest, lets_no_workgroup_of_steal_run_into_the_limit_of_loops) {
  std::string three;
  for (const int x : {-9, 0, 9}) three += fmt::format("[[spheres]]\ncenter = [{}, 0, 0]\nradius = 0.2\n", x);
  for (const auto& [n, spheres] : {std::pair{2u, ""s},
                                   {64u, ""s},
                                   {700u, ""s},
                                   {2896u, ""s},
                                   {64u, three},
                                   {700u, three},
                                   {2896u, three}}) {
    const Model model = build_model(
        parse_scene(fmt::format("[cloth]\nresolution = {}\n[solver]\nsubsteps = 9\n{}", n, spheres), "n.toml")
            .scene);
    const Plan plan = compile_plan(model, find_solver("leapfrog"));
    for (const KernelCandidate& candidate : kernel_candidates(device(), plan)) {
      const Kernel& kernel = candidate.kernel;
      if (kernel.kind != KernelKind::steal) continue;
      const std::uint64_t wide = kernel.columns * device().info().subgroup_size;
      const std::uint64_t tiles = (n + wide - 1) / wide * ((n + kernel.rows - 1) / kernel.rows);
      const std::uint64_t in_queue = (tiles + kernel.queues - 1) / kernel.queues;
      const std::uint64_t looks = spheres.empty() ? 0 : kernel.rows * kernel.columns * (1 + 64);
      EXPECT_LT(2 * in_queue * (kernel.rows + 1 + looks) + 2 * kernel.queues, 65'535u)
          << describe(kernel) << ", " << n;
      EXPECT_GE(kernel.queues * 2 * in_queue, tiles);
    }
  }
}

TEST_F(KernelChoiceTest, is_tried_once_and_then_remembered) {
  const KernelChoice first = choose("auto");
  EXPECT_EQ(first.how, "trial");
  ASSERT_FALSE(first.trial.empty());
  for (const TimedKernel& timed : first.trial) EXPECT_GT(timed.ns, 0.0) << describe(timed.kernel);
  EXPECT_EQ(first.trial.size() + first.out.size(), kernel_candidates(device(), plan_).size());
  const KernelChoice second = choose("auto");
  EXPECT_EQ(second.how, "remembered");
  EXPECT_EQ(second.kernel, first.kernel);
  EXPECT_TRUE(second.trial.empty());
}

TEST_F(KernelChoiceTest, does_not_trust_a_file_that_is_damaged_or_names_what_is_not_there) {
  const std::string key = kernel_memory_key(plan_);
  for (const std::string& damaged :
       {std::string("{"), std::string(), std::string("[1, 2]"), std::string("{\"version\": 99}"),
        std::string("{\"version\": \"2\", \"kernels\": 5}"),
        "{\"version\": 2, \"kernels\": {\"" + key + "\": {\"kind\": \"fast\"}}}"}) {
    write_file(file_, damaged);
    EXPECT_EQ(remembered_kernel(file_, key), std::nullopt) << damaged;
  }
  remember_kernel(file_, key, {.kind = KernelKind::strip, .columns = 3, .rows = 5});  // no candidate
  EXPECT_EQ(choose("auto").how, "trial");
  EXPECT_EQ(choose("auto").how, "remembered");
}

TEST_F(KernelChoiceTest, keeps_the_entries_of_other_plans) {
  const Kernel strip{.kind = KernelKind::strip, .columns = 4, .rows = 16};
  remember_kernel(file_, "another", strip);
  remember_kernel(file_, "one more", {});
  EXPECT_EQ(remembered_kernel(file_, "another"), strip);
  EXPECT_EQ(remembered_kernel(file_, "one more"), Kernel{});
  EXPECT_EQ(remembered_kernel(file_, "a third"), std::nullopt);
}

TEST_F(KernelChoiceTest, refuses_what_there_is_not_and_what_does_not_fit) {
  try {
    choose("fastest");
    FAIL() << "accepted";
  } catch (const Error& refusal) {
    EXPECT_EQ(refusal.code(), Exit::usage);
    EXPECT_NE(std::string(refusal.what()).find("direct, texel, strip, steal, bands or auto"),
              std::string::npos);
  }
  const Model large = build_model(parse_scene("[cloth]\nresolution = 400\n", "large.toml").scene);
  const Plan plan = compile_plan(large, find_solver("leapfrog"));
  EXPECT_THROW(named_kernel(device(), plan, "bands"), Error);
  if (device().limits().maxTexelBufferElements >= large.grid.count())
    EXPECT_EQ(named_kernel(device(), plan, "strip").kind, KernelKind::strip);
  else  // SwiftShader reads 65 536 texels of a buffer
    EXPECT_THROW(named_kernel(device(), plan, "strip"), Error);
  bool left_out = false;
  for (const KernelCandidate& candidate : kernel_candidates(device(), plan))
    if (candidate.kernel.kind == KernelKind::bands)
      left_out = candidate.unfit.find("160000") != std::string::npos;
  EXPECT_TRUE(left_out);
}

// A trial works in buffers of its own; a simulation chosen by it starts where any other does.
TEST_F(KernelChoiceTest, leaves_the_state_as_it_was) {
  const ScopedEnvironment cache("WEFT_KERNEL", "auto");
  const auto simulation = with(model_, "");
  expect_same(simulation->read(), with(model_, "direct")->read(), "at the start");
  EXPECT_EQ(simulation->time_s(), 0.0);
}

}  // namespace
}  // namespace weft::test
