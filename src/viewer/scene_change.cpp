// Each part is one task on a thread of its own.
#include "viewer/scene_change.h"

#include <utility>

#include "model/carry.h"

namespace weft {

SceneChange::SceneChange(Scene next, Scene whole) : next_(std::move(next)) {
  work_ = std::async(std::launch::async, [this, whole = std::move(whole)] { model_ = build_model(whole); });
}

void SceneChange::make_simulation(Maker maker) {
  part_ = Part::simulation;
  work_ = std::async(std::launch::async, [this, maker = std::move(maker)] { made_ = maker(model_); });
}

void SceneChange::carry(const Model& from, State state) {
  part_ = Part::state;
  work_ = std::async(std::launch::async, [this, &from, state = std::move(state)] {
    made_.simulation->write(carry_state(from, state, model_));
  });
}

}  // namespace weft
