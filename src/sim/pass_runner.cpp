// Runs single steps of a plan on the device from given buffers.
#include "sim/pass_runner.h"

#include <algorithm>
#include <cstring>

#include "passes/collision.h"
#include "passes/tables.h"
#include "passes/xpbd.h"

namespace weft {
namespace {

Plan perturbed(Plan plan, const Perturbation& perturbation) {
  perturbation.apply(plan);
  return plan;
}

/// Finite, different in every word, and unlike any state.
void fill_pattern(std::span<std::byte> bytes) {
  for (std::size_t word = 0; word < bytes.size() / sizeof(float); ++word) {
    const float value = 1000.0f + static_cast<float>(word % 4093) * 0.25f;
    std::memcpy(bytes.data() + word * sizeof(float), &value, sizeof(float));
  }
}

void fill_poison(std::span<std::byte> bytes) {
  for (std::size_t word = 0; word < bytes.size() / sizeof kPoison; ++word)
    std::memcpy(bytes.data() + word * sizeof kPoison, &kPoison, sizeof kPoison);
}

}  // namespace

PassRunner::PassRunner(gpu::Device& device, const Model& model, const Plan& plan,
                       const Perturbation& perturbation)
    : device_(device),
      model_(model),
      plan_(perturbed(plan, perturbation)),
      perturbation_(perturbation),
      buffers_(device, model, plan_),
      program_(device, plan_, buffers_) {}

PassRunner::Use PassRunner::use_of(std::size_t step, BufferId id) const {
  for (const gpu::Binding& binding : program_.pipeline(step).reflection().bindings)
    if (binding.binding == static_cast<std::uint32_t>(id)) return {binding.reads, binding.writes};
  return {};
}

std::map<BufferId, PassRunner::Bytes> PassRunner::contents(std::size_t step, const HostBuffers<float>& input,
                                                           std::span<const KickDrift> rows) const {
  std::map<BufferId, Bytes> contents;
  for (const PlanBuffer& planned : plan_.buffers) {
    const BufferId id = planned.id;
    Bytes& bytes = contents[id];
    bytes.resize(buffers_.at(id).bytes());
    fill_pattern(bytes);
    if (id == BufferId::params) {
      shared::Params params = make_params(model_);
      perturbation_.apply(model_, params);
      std::memcpy(bytes.data(), &params, sizeof params);
    } else if (id == BufferId::substeps) {
      std::vector<shared::vec4> table;
      fill_substep_rows(model_, rows, table);
      perturbation_.apply(table, substep_row_stride(model_));
      std::memcpy(bytes.data(), table.data(), std::min(bytes.size(), table.size() * sizeof table[0]));
    } else if (id == BufferId::constraints) {
      ConstraintRows<float> constraints = constraint_rows<float>(model_);
      perturbation_.apply(constraints);
      std::memcpy(bytes.data(), constraints.data(), bytes.size());
    } else if (id == BufferId::collision) {
      const shared::Collision collision = make_collision(model_);
      std::memcpy(bytes.data(), &collision, sizeof collision);
    } else if (const Use use = use_of(step, id); use.writes && !use.reads) {
      fill_poison(bytes);
    } else if (!input.words_of(id).empty()) {
      std::memcpy(bytes.data(), input.words_of(id).data(), bytes.size());
    } else if (!input[id].empty()) {
      std::memcpy(bytes.data(), input[id].data(), bytes.size());
    }
  }
  return contents;
}

PassResult PassRunner::run(std::size_t step, const HostBuffers<float>& input, std::span<const KickDrift> rows,
                           std::uint32_t row_index) {
  const std::map<BufferId, Bytes> before = contents(step, input, rows);
  for (const auto& [id, bytes] : before)
    for (std::uint32_t slot = 0; slot < slot_count(id); ++slot) buffers_.at(id, slot).write(bytes);
  device_.run_once([&](VkCommandBuffer commands) {
    gpu::Recorder recorder(device_, commands);
    recorder.label(plan_.steps[step].pass->name);
    program_.dispatch(recorder, step, 0, 0, row_index);
    recorder.end_label();
    recorder.finish();
  });
  PassResult result;
  for (const auto& [id, bytes] : before) {
    const bool output = use_of(step, id).writes;
    if (output) result.outputs.push_back(id);
    for (std::uint32_t slot = 0; slot < slot_count(id); ++slot) {
      Bytes after(bytes.size());
      buffers_.at(id, slot).read(after);
      if (!output && after != bytes) result.touched.push_back(id);
      if (slot_count(id) > 1) continue;
      if (holds_words(id)) {
        result.buffers.words_of(id).resize(after.size() / sizeof(std::uint32_t));
        std::memcpy(result.buffers.words_of(id).data(), after.data(), after.size());
      } else if (row_of(id).element == "vec4") {
        result.buffers[id].resize(after.size() / sizeof(glm::vec4));
        std::memcpy(result.buffers[id].data(), after.data(), after.size());
      }
    }
  }
  return result;
}

}  // namespace weft
