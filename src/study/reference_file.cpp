// A reference on disk: a line of JSON, the states in double, a checksum over both. Whatever does not fit to
// the last byte is taken for damaged and computed anew.
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/cache.h"
#include "core/error.h"
#include "core/file.h"
#include "study/identity.h"
#include "study/json_number.h"
#include "study/reference.h"

namespace weft::study {
namespace {

using Json = nlohmann::ordered_json;

std::string identity_of(const Model& model, double time_s) {
  return fmt::format("reference {}\ntime={:.17g}\n{}", kFormatVersion, time_s, canonical_scene(model.scene));
}

void append(std::string& bytes, const void* data, std::size_t size) {
  bytes.append(static_cast<const char*>(data), size);
}

Json head_of(const Reference& reference, std::string_view identity) {
  return {{"identity", identity},
          {"solver", reference.solver},
          {"substeps", reference.substeps},
          {"agreement_m", json_of(reference.agreement_m)},
          {"ending", static_cast<int>(reference.ending)},
          {"twin_m", json_of(reference.twin_m)},
          {"float_floor_m", json_of(reference.float_floor_m)},
          {"discretisation_m", json_of(reference.discretisation_m)},
          {"fine_nx", reference.fine_nx},
          {"allowed_s", reference.allowed_s},
          {"frames", reference.frames.size()},
          {"particles", reference.frames.empty() ? 0 : reference.frames[0].position.size()}};
}

Reference from_head(const Json& head) {
  Reference reference;
  reference.solver = head.value("solver", "rk4");
  reference.substeps = head.at("substeps");
  reference.agreement_m = number_of(head.at("agreement_m"));
  reference.ending = static_cast<Ending>(head.at("ending").get<int>());
  reference.twin_m = number_of(head.at("twin_m"));
  reference.float_floor_m = number_of(head.at("float_floor_m"));
  reference.discretisation_m = number_of(head.at("discretisation_m"));
  reference.fine_nx = head.at("fine_nx");
  reference.allowed_s = head.at("allowed_s");
  return reference;
}

/// Takes `count` vectors off the front of `bytes`.
std::vector<glm::dvec3> take_vectors(std::string_view& bytes, std::size_t count) {
  std::vector<glm::dvec3> vectors(count);
  std::memcpy(vectors.data(), bytes.data(), count * sizeof(glm::dvec3));
  bytes.remove_prefix(count * sizeof(glm::dvec3));
  return vectors;
}

/// @throws Json::exception when the head lacks something
std::optional<Reference> from_parts(const Json& head, std::string_view bytes) {
  const std::size_t frames = head.at("frames"), particles = head.at("particles");
  if (bytes.size() != frames * (sizeof(double) + 2 * particles * sizeof(glm::dvec3))) return {};
  Reference reference = from_head(head);
  for (std::size_t f = 0; f < frames; ++f) {
    State state;
    std::memcpy(&state.time_s, bytes.data(), sizeof state.time_s);
    bytes.remove_prefix(sizeof state.time_s);
    state.position = take_vectors(bytes, particles);
    state.velocity = take_vectors(bytes, particles);
    reference.frames.push_back(std::move(state));
  }
  return reference;
}

std::optional<Reference> load(const std::filesystem::path& file, const std::string& identity) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure)) return {};
  try {
    return from_bytes(read_file(file), identity);
  } catch (const Error&) {
    return {};
  }
}

bool good_enough(const Model& model, const Reference& reference, const ReferenceOptions& options) {
  if (reference.ending == Ending::out_of_time && reference.allowed_s >= options.seconds)
    return true;  // no better one would come of trying again
  const Solver& solver = reference_solver(model);
  if (reference.solver != solver.name) return false;
  const std::uint32_t first = substeps_per_frame(with_setting(model, {reference.solver, "f64", 0}), solver);
  const bool agreed =
      reference.agreement_m <= options.tolerance_m && reference.substeps >= first << (options.levels_min - 1);
  const bool settled = reference.ending == Ending::no_gain || agreed;
  return settled && (reference.discretisation_m >= 0.0 || !options.discretisation);
}

}  // namespace

std::filesystem::path reference_file(const Model& model, double time_s) {
  const std::filesystem::path folder = cache_folder();
  return folder.empty() ? folder : folder / "references" / (name_of(identity_of(model, time_s)) + ".ref");
}

std::string to_bytes(const Reference& reference, std::string_view identity) {
  std::string bytes = head_of(reference, identity).dump() + '\n';
  for (const State& state : reference.frames) {
    append(bytes, &state.time_s, sizeof state.time_s);
    append(bytes, state.position.data(), state.position.size() * sizeof(glm::dvec3));
    append(bytes, state.velocity.data(), state.velocity.size() * sizeof(glm::dvec3));
  }
  const std::uint64_t checksum = hash_of(bytes);
  append(bytes, &checksum, sizeof checksum);
  return bytes;
}

std::optional<Reference> from_bytes(std::string_view bytes, std::string_view identity) {
  std::uint64_t checksum = 0;
  const std::size_t line = bytes.find('\n');
  if (line == std::string_view::npos || bytes.size() < line + 1 + sizeof checksum) return {};
  std::memcpy(&checksum, bytes.data() + bytes.size() - sizeof checksum, sizeof checksum);
  bytes.remove_suffix(sizeof checksum);
  if (hash_of(bytes) != checksum) return {};
  const Json head = Json::parse(bytes.substr(0, line), nullptr, false);
  if (head.is_discarded()) return {};
  try {
    if (head.at("identity") != identity) return {};
    return from_parts(head, bytes.substr(line + 1));
  } catch (const Json::exception&) {
    return {};
  }
}

std::optional<Reference> kept_reference(const Model& model, double time_s) {
  const std::filesystem::path file = reference_file(model, time_s);
  return file.empty() ? std::nullopt : load(file, identity_of(model, time_s));
}

Reference find_reference(const Model& model, double time_s, const ReferenceOptions& options, const Stop& stop,
                         const std::function<void(const std::string&)>& note) {
  if (auto kept = kept_reference(model, time_s); kept && good_enough(model, *kept, options))
    return std::move(*kept);
  const std::string identity = identity_of(model, time_s);
  const std::filesystem::path file = reference_file(model, time_s);
  Reference reference = make_reference(model, time_s, options, stop, note);
  if (file.empty() || !make_folder(file.parent_path())) return reference;
  try {
    write_file(file, to_bytes(reference, identity));
  } catch (const Error& failure) {
    note(fmt::format("the reference is not kept: {}", failure.what()));
  }
  return reference;
}

}  // namespace weft::study
