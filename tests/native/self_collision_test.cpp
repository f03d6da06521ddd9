// The vector code of self-collision's passes leaves the buffers as the mirrors do, bit by bit: at every width
// that this machine has, in any number of threads, on cloths of odd sizes in every shape.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <utility>

#include "native/engine.h"
#include "native/features.h"
#include "passes/passes.h"
#include "solvers/solver.h"
#include "support/shapes.h"

namespace weft {
namespace {

/// Which of several things that are no number a distance is, nobody says.
std::uint32_t settled(std::uint32_t bits) {
  const float value = std::bit_cast<float>(bits);
  return std::isnan(value) ? std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()) : bits;
}

void expect_same_buffers(HostBuffers<float>&& got, const HostBuffers<float>& expected) {
  std::uint32_t& longest = got.words_of(BufferId::collision_state)[shared::kLongestEdge];
  const std::uint32_t right_longest = expected.words_of(BufferId::collision_state)[shared::kLongestEdge];
  if (settled(longest) == settled(right_longest)) longest = right_longest;
  for (const BufferRow& row : kBufferRows) {
    const auto &words = got.words_of(row.id), &right_words = expected.words_of(row.id);
    ASSERT_EQ(words.size(), right_words.size()) << row.name;
    const auto differs = std::ranges::mismatch(words, right_words);
    ASSERT_TRUE(differs.in1 == words.end()) << row.name << " " << differs.in1 - words.begin();
    const auto &vectors = got[row.id], &right_vectors = expected[row.id];
    ASSERT_EQ(vectors.size(), right_vectors.size()) << row.name;
    for (std::size_t k = 0; k < vectors.size(); ++k)
      for (int axis = 0; axis < 4; ++axis)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(vectors[k][axis]),
                  std::bit_cast<std::uint32_t>(right_vectors[k][axis]))
            << row.name << " " << k << " " << axis;
  }
}

/// One engine for every width, in one thread, and two of the widest in several.
struct NamedEngine {
  std::string name;
  std::unique_ptr<native::Engine> engine;
};
std::vector<NamedEngine> engines_for(const Model& model, const Plan& plan) {
  std::vector<NamedEngine> engines;
  const auto add = [&](const std::string& name, const native::EngineOptions& options) {
    engines.push_back({name, std::make_unique<native::Engine>(model, plan, options)});
  };
  for (const native::Kernels* kernels : native::kernels_here())
    add(kernels->name, {.threads = 1, .vector = kernels->name});
  for (const std::uint32_t threads : {2u, 3u})
    add(fmt::format("{} threads", threads), {.threads = threads, .vector = {}});
  return engines;
}

struct Size {
  int columns, rows;
};
constexpr Size kSizes[] = {{2, 2}, {3, 2}, {5, 7}, {16, 33}, {17, 18}, {33, 37}, {64, 49}};

/// Without the largest, whose scattered particles all look at each other.
constexpr std::span<const Size> kSmallSizes(kSizes, std::size(kSizes) - 2);

/// A second cloth just beneath the first and a third away from both.
constexpr const char* kTwoMore =
    "[[cloths]]\ncenter = [0.02, -0.02, 0.0]\n[[cloths]]\ncenter = [0.5, 0.1, 0.3]\n";

/// Runs the passes for one cloth and for three of every size and shape, after the mirrors of those before it,
/// and calls look(buffers) with what the mirror leaves.
void expect_as_mirror(const std::vector<const Pass*>& passes, const std::vector<const Pass*>& before_them,
                      const std::function<void(const HostBuffers<float>&)>& look,
                      std::span<const Size> sizes = kSizes) {
  std::uint64_t seed = 0;
  const auto expect_for = [&](const Model& model) {
    const Plan plan = compile_plan(model, find_solver("leapfrog"));
    const std::vector<NamedEngine> engines = engines_for(model, plan);
    for (const Shape& shape : shapes()) {
      SCOPED_TRACE(
          fmt::format("{} of {} x {}, {}", model.grid.cloths, model.grid.nx, model.grid.ny, shape.name));
      HostBuffers<float> before = buffers_of(model, plan, shape, ++seed);
      for (const Pass* earlier : before_them) run_mirror(*earlier, model, before);
      HostBuffers<float> expected = before;
      for (const Pass* pass : passes) run_mirror(*pass, model, expected);
      for (const auto& [name, engine] : engines) {
        SCOPED_TRACE(name);
        HostBuffers<float> got = before;
        engine->load(got);
        for (const Pass* pass : passes)
          engine->look(*pass, {.model = model, .constants = {}, .row = kNoTime}, got);
        expect_same_buffers(std::move(got), expected);
      }
      look(expected);
    }
  };
  std::size_t turn = 0;
  for (const auto [columns, rows] : sizes) {
    expect_for(sheet_model(columns, rows, turn % 2 == 0 ? 0.3 : 0.9));
    expect_for(sheet_model(columns, rows, turn++ % 2 == 0 ? 0.9 : 0.3, kTwoMore));
  }
}

TEST(NativeSelfCollision, CountsCellsAsTheMirror) {
  std::size_t bends = 0, close = 0;
  expect_as_mirror({&cell_count}, {&carry, &pair_check}, [&](const HostBuffers<float>& buffers) {
    const auto& boxes = buffers[BufferId::patches];
    for (std::size_t p = 0; p < boxes.size(); p += 2) {
      bends += boxes[p + 1].w != 0.0f;
      close += boxes[p].w == 0.0f;
    }
  });
  EXPECT_GT(bends, 1000u);  // of some 13000 patches
  EXPECT_GT(close, 1000u);
}

// The lists are those of the mirrors, and contacts are looked at where they were made. Some 4 million entries
// of all 36 pairs of edges and 6 triangles, in every region of a triangle and of two edges.
TEST(NativeSelfCollision, TouchesAndRespondsAsTheMirrors) {
  std::size_t entries = 0, touching = 0;
  std::uint64_t seed = 100;
  for (const auto [columns, rows] : {Size{5, 7}, Size{17, 18}, Size{33, 37}}) {
    const Model model = sheet_model(columns, rows, seed % 2 == 0 ? 0.3 : 0.9);
    const Plan plan = compile_plan(model, find_solver("leapfrog"));
    const std::vector<NamedEngine> engines = engines_for(model, plan);
    for (const Shape& shape : shapes()) {
      SCOPED_TRACE(fmt::format("{} x {}, {}", columns, rows, shape.name));
      HostBuffers<float> before = buffers_of(model, plan, shape, ++seed);
      std::mt19937_64 random(seed);
      std::normal_distribution<float> speed(0.0f, 2.0f);
      for (glm::vec4& v : before[BufferId::velocity]) v = {speed(random), speed(random), speed(random), 0};
      for (const Pass* earlier :
           {&carry, &pair_check, &cell_count, &cell_scan, &cell_fill, &cell_sort, &patch_near})
        run_mirror(*earlier, model, before);
      HostBuffers<float> expected = before;
      for (const Pass* pass : {&pair_gather, &surface_gather, &touch_weight, &surface_touch})
        run_mirror(*pass, model, expected);
      const std::vector<std::uint32_t> nothing = expected.words_of(BufferId::surface_sums);
      run_mirror(surface_contact, model, expected);
      for (const auto& [name, engine] : engines) {
        SCOPED_TRACE(name);
        const MirrorContext context{.model = model, .constants = {}, .row = kNoTime};
        HostBuffers<float> got = before;
        engine->load(got);
        engine->look(pair_gather, context, got);
        engine->look(surface_gather, context, got);
        run_mirror(touch_weight, model, got);
        engine->look(surface_touch, context, got);
        engine->look(surface_contact, context, got);
        expect_same_buffers(std::move(got), expected);
      }
      for (const std::uint32_t count : expected.words_of(BufferId::surface_count)) entries += count;
      touching += expected.words_of(BufferId::surface_sums) != nothing;
    }
  }
  EXPECT_GT(entries, 1'000'000u);
  EXPECT_GT(touching, 12u);  // of 27 shapes
  RecordProperty("entries", std::to_string(entries));
  RecordProperty("touching", std::to_string(touching));
}

TEST(NativeSelfCollision, LooksNearAsTheMirror) {
  std::size_t far = 0, beside = 0, neither = 0;
  expect_as_mirror({&patch_near}, {&carry, &pair_check, &cell_count, &cell_scan, &cell_fill, &cell_sort},
                   [&](const HostBuffers<float>& buffers) {
                     for (const std::uint32_t looks : buffers.words_of(BufferId::patch_listed)) {
                       far += (looks & shared::kLooksFar) != 0;
                       beside += looks > shared::kLooksFar;
                       neither += looks == 0;
                     }
                   });
  for (const std::size_t count : {far, beside, neither}) EXPECT_GT(count, 1000u);
}

// In the mirrors' order, and with lists that overflow where particles are scattered.
TEST(NativeSelfCollision, GathersAsTheMirrors) {
  std::size_t pairs = 0, surfaces = 0, dropped = 0;
  expect_as_mirror(
      {&pair_gather, &surface_gather},
      {&carry, &pair_check, &cell_count, &cell_scan, &cell_fill, &cell_sort, &patch_near},
      [&](const HostBuffers<float>& buffers) {
        for (const std::uint32_t count : buffers.words_of(BufferId::pair_count)) pairs += count;
        for (const std::uint32_t count : buffers.words_of(BufferId::surface_count)) surfaces += count;
        dropped += buffers.words_of(BufferId::collision_state)[shared::kPairsDropped];
      },
      kSmallSizes);
  for (const std::size_t count : {pairs, surfaces, dropped}) EXPECT_GT(count, 10'000u);
}

/// Lists as if they had been made and contacts looked at: particles have moved since by up to 1.5 of their
/// room, where something is listed some have a surface near, and one is no number.
void pretend_lists(const Model& model, std::uint64_t seed, HostBuffers<float>& buffers) {
  std::mt19937_64 random(seed);
  const CollisionView<float> view(model);
  std::uniform_real_distribution<float> share(-0.9f, 0.9f), bound(0.0f, 2.0f * view.surface_limit);
  const bool listed = random() % 2 == 0;
  buffers.words_of(BufferId::collision_state)[shared::kListsArmed] = 1;
  buffers.words_of(BufferId::collision_state)[shared::kPairsListed] = listed ? 1 : 0;
  const auto elsewhere = [&](const glm::vec4& x) {
    const float most = 0.7f * view.roam_max * std::abs(share(random));
    return x + most * glm::vec4(share(random), share(random), share(random), 0.0f);
  };
  auto& position = buffers[BufferId::position];
  for (const BufferId id : {BufferId::built_position, BufferId::near_position}) {
    buffers[id] = position;
    for (glm::vec4& x : buffers[id]) x = elsewhere(x);
  }
  for (glm::vec4& v : buffers[BufferId::velocity])
    v = glm::vec4(share(random), share(random), share(random), 0.0f);
  auto& bounds = buffers.words_of(BufferId::surface_bound);
  bounds.resize(position.size());
  for (std::uint32_t& bits : bounds)
    bits = !listed || share(random) < 0.6f ? shared::kInfinity : std::bit_cast<std::uint32_t>(bound(random));
  if (seed % 5 == 0) position[position.size() / 2].y = std::nanf("");
}

/// Positions and velocities of the engine's rows, in the buffers.
void fetch_rows(native::Engine& engine, HostBuffers<float>& buffers) {
  const auto floats = [&](BufferId id) { return &buffers[id][0].x; };
  engine.write_surface({floats(BufferId::position), nullptr, floats(BufferId::velocity)});
}

TEST(NativeSelfCollision, ChecksMotionAsTheMirror) {
  std::uint64_t seed = 0;
  std::uint32_t held = 0, stale = 0, sound = 0;
  for (const auto [columns, rows] : kSizes)
    for (const char* pins : {"", "[[pins]]\nat = [0.0, 0.0]\n"}) {
      const Model model = sheet_model(columns, rows, 0.4, pins);
      const Plan plan = compile_plan(model, find_solver("leapfrog"));
      const std::vector<NamedEngine> engines = engines_for(model, plan);
      for (int state = 0; state < 3; ++state) {
        SCOPED_TRACE(fmt::format("{} x {}, state {} {}", columns, rows, state, pins));
        HostBuffers<float> before = buffers_of(model, plan, rolled(0.2, 0.05), ++seed);
        pretend_lists(model, seed, before);
        if (state == 2) before[BufferId::built_position] = before[BufferId::position];
        HostBuffers<float> expected = before;
        for (const Pass* pass : {&carry, &pair_check})
          pass->mirror_f32({.model = model, .constants = {}, .row = kNoTime, .row_index = 1}, expected);
        const auto& words = expected.words_of(BufferId::collision_state);
        held += words[shared::kHeldBack];
        (words[shared::kListGroups] != 0 ? stale : sound) += 1;
        for (const auto& [name, engine] : engines) {
          SCOPED_TRACE(name);
          HostBuffers<float> got = before;
          engine->load(got);
          for (const Pass* pass : {&carry, &pair_check})
            engine->look(*pass, {.model = model, .constants = {}, .row = kNoTime, .row_index = 1}, got);
          fetch_rows(*engine, got);
          expect_same_buffers(std::move(got), expected);
        }
      }
    }
  EXPECT_GT(held, 500u);
  EXPECT_GT(stale, 3u);
  EXPECT_GT(sound, 3u);
}

}  // namespace
}  // namespace weft
