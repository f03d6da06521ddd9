// Runs single steps of a plan on the device from given buffers.
#include "sim/pass_runner.h"

#include <algorithm>
#include <cstring>

#include "model/speed_budget.h"

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

template <class T>
void fill_bytes(std::span<std::byte> bytes, T value) {
  for (std::size_t at = 0; at + sizeof value <= bytes.size(); at += sizeof value)
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

template <class T>
void fill_poison(BufferId id, std::span<std::byte> bytes) {
  if (holds_words(id) || holds_floats(id)) return fill_bytes(bytes, kPoison);
  fill_bytes(bytes, poison<T>());
}

/// Whether the model alone says what is in the buffer.
bool is_block(BufferId id) {
  using enum BufferId;
  return id == params || id == constraints || id == collision || id == moved_pins || id == strain_limits ||
         id == distance_grids || id == tethers;
}

/// Of a device's buffer of type E.
template <class T, class E>
std::vector<T> elements_in(std::span<const std::byte> bytes) {
  std::vector<E> elements(bytes.size() / sizeof(E));
  std::memcpy(elements.data(), bytes.data(), bytes.size());
  return {elements.begin(), elements.end()};
}

template <class T>
void take_output(BufferId id, std::span<const std::byte> bytes, HostBuffers<T>& buffers) {
  using Vector = glm::vec<4, T>;
  if (holds_words(id))
    buffers.words_of(id) = elements_in<std::uint32_t, std::uint32_t>(bytes);
  else if (holds_floats(id))
    buffers[id] = elements_in<Vector, glm::vec4>(bytes);
  else if (holds_vectors(id))
    buffers[id] = elements_in<Vector, Vector>(bytes);
}

}  // namespace

PassRunner::PassRunner(gpu::Device& device, const Model& model, const Plan& plan,
                       const Perturbation& perturbation, const std::optional<Kernel>& kernel,
                       std::shared_ptr<GpuPipelines> pipelines)
    : device_(device),
      model_(model),
      plan_(perturbed(plan, perturbation)),
      perturbation_(perturbation),
      buffers_(device, model, plan_, kernel.value_or(Kernel{})),
      program_(device, plan_, buffers_, std::move(pipelines), kernel) {}

PassRunner::Use PassRunner::use_of(std::size_t step, BufferId id) const {
  for (const gpu::Binding& binding : program_.pipeline(step).reflection().bindings)
    if (binding.binding == static_cast<std::uint32_t>(id)) return {binding.reads, binding.writes};
  return {};
}

template <class T>
std::map<BufferId, Bytes> PassRunner::contents(std::size_t step, const HostBuffers<T>& input,
                                               std::span<const KickDrift> rows) const {
  std::map<BufferId, Bytes> contents;
  for (const PlanBuffer& planned : plan_.buffers) {
    const BufferId id = planned.id;
    Bytes& bytes = contents[id];
    bytes.resize(buffers_.at(id).bytes());
    fill_pattern(bytes);
    const auto put = [&](std::span<const std::byte> from) {
      std::memcpy(bytes.data(), from.data(), std::min(bytes.size(), from.size()));
    };
    if (is_block(id))
      put(block_bytes(id, model_, plan_, perturbation_,
                      energy_share_s2_m2(free_mass_ratio(model_), kProbeSpeedAllowed_m_s)));
    else if (id == BufferId::substeps)
      put(table_bytes(model_, plan_, rows, perturbation_));
    else if (const Use use = use_of(step, id); use.writes && !use.reads)
      fill_poison<T>(id, bytes);
    else if (!input.words_of(id).empty())
      put(std::as_bytes(std::span(input.words_of(id))));
    else if (!input[id].empty() && !holds_floats(id))
      put(std::as_bytes(std::span(input[id])));
  }
  return contents;
}

bool PassRunner::queues_settled() {
  if (!buffers_.has(BufferId::queue_heads)) return true;
  Bytes heads(buffers_.at(BufferId::queue_heads).bytes());
  buffers_.at(BufferId::queue_heads).read(heads);
  return std::ranges::all_of(heads, [](std::byte b) { return b == std::byte{0}; });
}

template <class T>
PassResult<T> PassRunner::run(std::size_t step, const HostBuffers<T>& input, std::span<const KickDrift> rows,
                              std::uint32_t row_index, std::uint32_t substeps) {
  const std::map<BufferId, Bytes> before = contents(step, input, rows);
  for (const auto& [id, bytes] : before)
    for (std::uint32_t slot = 0; slot < slot_count(id); ++slot) buffers_.at(id, slot).write(bytes);
  device_.run_once([&](VkCommandBuffer commands) {
    gpu::Recorder recorder(device_, commands);
    recorder.label(plan_.steps[step].pass->name);
    program_.dispatch(recorder, step, 0, 0, row_index, substeps);
    recorder.end_label();
    recorder.finish();
  });
  PassResult<T> result;
  if (!queues_settled()) result.touched.push_back(BufferId::queue_heads);
  for (const auto& [id, bytes] : before) {
    const bool output = use_of(step, id).writes;
    if (output) result.outputs.push_back(id);
    for (std::uint32_t slot = 0; slot < slot_count(id); ++slot) {
      Bytes after(bytes.size());
      buffers_.at(id, slot).read(after);
      if (!output && after != bytes) result.touched.push_back(id);
      if (slot_count(id) == 1) take_output(id, after, result.buffers);
    }
  }
  return result;
}

template PassResult<float> PassRunner::run(std::size_t, const HostBuffers<float>&, std::span<const KickDrift>,
                                           std::uint32_t, std::uint32_t);
template PassResult<double> PassRunner::run(std::size_t, const HostBuffers<double>&,
                                            std::span<const KickDrift>, std::uint32_t, std::uint32_t);

}  // namespace weft
