// A change of the running scene that a thread of its own prepares while the scene goes on: the model, what
// computes it, and the state carried over.
#pragma once
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "model/model.h"
#include "sim/drawn_simulation.h"

namespace weft {

/// What computes a scene in the window.
struct MadeSimulation {
  std::unique_ptr<DrawnSimulation> simulation;
  std::string native_lacks;  ///< why native does not, where that was asked for
};

/// Its parts follow one another, each begun by whoever looks after it: only between two of them is the
/// running scene touched. Ends with the part under way.
class SceneChange {
 public:
  using Clock = std::chrono::steady_clock;
  using Maker = std::function<MadeSimulation(const Model&)>;
  enum class Part { model, simulation, state };

  /// Begins with the model.
  /// @param next   the scene as it is asked for
  /// @param whole  the same with the pins made by hand
  SceneChange(Scene next, Scene whole);
  SceneChange(const SceneChange&) = delete;  // the thread works on this one
  SceneChange& operator=(const SceneChange&) = delete;
  /// Once the model is there: what computes it. Makers may be called on any thread.
  void make_simulation(Maker maker);
  /// Once that is there: the state, as it is now on `from`, which must stay as it is meanwhile.
  void carry(const Model& from, State state);

  Part part() const { return part_; }
  /// Waits until then at most. Returns whether the part is done.
  bool done_by(Clock::time_point until) const { return work_.wait_until(until) == std::future_status::ready; }
  /// Waits for the part under way.
  /// @throws whatever it threw
  void finish() { work_.get(); }

  const Scene& next() const { return next_; }
  const Model& model() const { return model_; }  ///< after its part
  MadeSimulation take() { return std::move(made_); }
  Clock::time_point since() const { return since_; }

 private:
  Clock::time_point since_ = Clock::now();
  Scene next_;
  Model model_;
  MadeSimulation made_;
  Part part_ = Part::model;
  std::future<void> work_;  // last: it ends before what it works on
};

}  // namespace weft
