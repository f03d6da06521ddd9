// What `--out` of a simulation writes: the final state, or every frame's positions.
#pragma once
#include <filesystem>
#include <memory>

#include "model/model.h"
#include "model/state_io.h"

namespace weft::cli {

/// Proves, without leaving a trace, that a file can be written: its folder exists and takes a new file, and a
/// file of that name is not write-protected.
/// @throws Error(Exit::io) naming the place and the cure
void require_writable(const std::filesystem::path& target);

class StateOutput {
 public:
  /// @throws Error(Exit::usage) for an unknown extension, Error(Exit::io) when the file cannot be written
  StateOutput(const std::filesystem::path& target, const Model& model);
  /// Whether frame() must be called for every frame; otherwise finish() has all it needs.
  bool takes_every_frame() const { return cache_ != nullptr; }
  void frame(const State&);   ///< the start and every frame after it
  void finish(const State&);  ///< the file appears under its name

 private:
  std::filesystem::path target_;
  const Model& model_;
  std::unique_ptr<PointCache> cache_;  ///< .pc2 only
};

}  // namespace weft::cli
