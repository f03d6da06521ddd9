// rk4: the classical fourth-order Runge–Kutta method on the CPU. In double it is the truth that errors are
// measured against. Air is an ordinary force; contact acts after each whole step, swept like a drift.
#include <array>

#include "passes/contact.h"
#include "passes/integrate.h"
#include "passes/parallel.h"
#include "passes/passes.h"
#include "solvers/list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr std::array kSteps{SolverStep{&normals, Block::frame_end}};

/// Positions and velocities, component by component: x y z vx vy vz, each of the grid's length.
template <class T>
using Columns = std::array<std::vector<T>, 6>;

template <class T>
Columns<T> make_columns(std::size_t count) {
  Columns<T> columns;
  for (auto& column : columns) column.assign(count, T(0));
  return columns;
}

/// One stage of the tableau: k is evaluated at `from`; the next stage starts at state + reach·h·k.
struct Stage {
  double reach, weight;  ///< of this stage's k: in the next stage's state, and in the step
};
constexpr std::array<Stage, 4> kTableau{Stage{0.5, 1.0 / 6.0}, Stage{0.5, 1.0 / 3.0}, Stage{1.0, 1.0 / 3.0},
                                        Stage{0.0, 1.0 / 6.0}};
constexpr std::array kStageTimes{0.0, 0.5, 0.5, 1.0};  // in steps

template <class T>
class RungeKutta {
 public:
  RungeKutta(const Model& model, const State& state)
      : model_(model),
        tables_(model.grid, spring_rows<T>(model), force_effects(integrate_constants(model))),
        alpha_(static_cast<T>(drag_rate(model))) {
    const std::size_t count = model.grid.count();
    for (Columns<T>* columns : {&state_, &stage_, &next_, &sum_}) *columns = make_columns<T>(count);
    for (std::size_t p = 0; p < count; ++p) {
      for (int d = 0; d < 3; ++d) {
        state_[d][p] = static_cast<T>(state.position[p][d]);
        state_[3 + d][p] = static_cast<T>(state.velocity[p][d]);
      }
    }
  }

  /// One step of h from time t, contact included.
  void step(double time_s, double h_s) {
    stage_ = state_;
    sum_ = state_;
    for (std::size_t s = 0; s < kTableau.size(); ++s) {
      evaluate(kTableau[s], time_s + kStageTimes[s] * h_s, h_s);
      std::swap(stage_, next_);
    }
    std::swap(state_, sum_);
    if (model_.scene.floor || !model_.scene.spheres.empty()) touch(time_s, h_s);
  }

  void store(State& state) const {
    for (std::size_t p = 0; p < state.position.size(); ++p) {
      for (int d = 0; d < 3; ++d) {
        state.position[p][d] = static_cast<double>(state_[d][p]);
        state.velocity[p][d] = static_cast<double>(state_[3 + d][p]);
      }
    }
  }

 private:
  /// k at stage_: adds weight·h·k to sum_ and writes state_ + reach·h·k to next_.
  void evaluate(const Stage& tableau, double time_s, double h_s) {
    const glm::dvec3 gravity =
        model_.scene.gravity ? model_.scene.gravity->acceleration_m_s2 : glm::dvec3(0.0);
    const glm::vec<3, T> constant(gravity + drag_rate(model_) * wind_at(model_.scene, time_s));
    const auto reach = static_cast<T>(tableau.reach * h_s), weight = static_cast<T>(tableau.weight * h_s);
    const auto inverse_mass = static_cast<T>(1.0 / model_.interior_mass_kg);
    const std::size_t nx = model_.grid.nx;
    const auto row_at = [&](std::size_t j) {
      RowPointers<T> row;
      for (std::size_t d = 0; d < 6; ++d) row[d] = stage_[d].data() + j * nx;
      return row;
    };
    parallel_rows(model_.grid.ny, nx, [&](std::uint32_t begin, std::uint32_t end) {
      ForceSweep<T> sweep(tables_);
      sweep.run(begin, end, row_at, [&](std::size_t j, const std::array<T*, 3>& force) {
        for (std::size_t i = 0; i < nx; ++i) {
          const std::size_t p = j * nx + i;
          const T w = static_cast<T>(model_.relative_inverse_mass[p]) * inverse_mass;
          for (int d = 0; d < 3; ++d) {
            const auto axis = static_cast<std::size_t>(d);
            const T v = w != T(0) ? stage_[3 + axis][p] : T(0);
            const T a = w != T(0) ? force[axis][i] * w + constant[d] - alpha_ * v : T(0);
            sum_[axis][p] += weight * v;
            sum_[3 + axis][p] += weight * a;
            next_[axis][p] = state_[axis][p] + reach * v;
            next_[3 + axis][p] = state_[3 + axis][p] + reach * a;
          }
        }
      });
    });
  }

  /// Contact as after a drift from the step's start to its end; stage_ and next_ are free by then, sum_ holds
  /// where the step began.
  void touch(double time_s, double h_s) {
    const SubstepRow<T> row = substep_row<T>(model_, {h_s, h_s, time_s, time_s});
    for (std::size_t p = 0; p < model_.grid.count(); ++p) {
      if (model_.relative_inverse_mass[p] == 0.0) continue;
      const glm::vec<3, T> x0(sum_[0][p], sum_[1][p], sum_[2][p]);
      glm::vec<3, T> x1(state_[0][p], state_[1][p], state_[2][p]),
          v(state_[3][p], state_[4][p], state_[5][p]);
      for (const SphereRow<T>& sphere : row.spheres) sphere_contact(sphere, x0, x1, v);
      if (model_.scene.floor) floor_contact(floor_row<T>(model_), x1, v);
      for (int d = 0; d < 3; ++d) {
        state_[static_cast<std::size_t>(d)][p] = x1[d];
        state_[static_cast<std::size_t>(d) + 3][p] = v[d];
      }
    }
  }

  const Model& model_;
  SweepTables<T> tables_;
  T alpha_;
  Columns<T> state_, stage_, next_, sum_;
};

template <class T>
void frame(const Model& model, State& state, double frame_s, std::uint32_t substeps) {
  RungeKutta<T> method(model, state);
  const double h_s = frame_s / substeps;
  for (std::uint32_t k = 0; k < substeps; ++k) method.step(state.time_s + k * h_s, h_s);
  method.store(state);
  state.time_s += frame_s;
}

}  // namespace

const Solver rk4{
    .name = "rk4",
    .about = "classical Runge-Kutta, fourth order; in double the converged truth",
    .source =
        "Kutta, Beitrag zur naeherungsweisen Integration totaler Differentialgleichungen (1901); "
        "Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, table II.1.2",
    .order = 4,
    .on_gpu = false,
    .steps = kSteps,
    .step_max_s = [](const StepBound& bound) { return step_max(bound, 5.2, 4.0); },
    .schedule = leapfrog_schedule,
    .frame_f32 = frame<float>,
    .frame_f64 = frame<double>,
    .force_evaluations_per_substep = 4,
};

}  // namespace weft
