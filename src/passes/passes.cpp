// The list of passes.
#include "passes/passes.h"

#include <algorithm>
#include <array>

namespace weft {

bool watches(const Pass& pass) { return &pass == &watch || &pass == &judge || &pass == &keep_sound; }

bool serves_self_collision(const Pass& pass) {
  static constexpr std::array kThese{&carry,          &pair_check,   &cell_count,    &cell_scan,
                                     &cell_fill,      &cell_sort,    &patch_near,    &pair_gather,
                                     &surface_gather, &touch_weight, &surface_touch, &surface_contact,
                                     &self_contact};
  return std::ranges::find(kThese, &pass) != kThese.end();
}

std::span<const Pass* const> passes() {
  static constexpr std::array kPasses{&integrate,
                                      &euler_step,
                                      &velocity_verlet_step,
                                      &verlet_step,
                                      &trapezoid_predict,
                                      &trapezoid_correct,
                                      &rk4_first,
                                      &rk4_middle,
                                      &rk4_last,
                                      &xpbd_predict,
                                      &xpbd_spring,
                                      &xpbd_bend,
                                      &xpbd_tethers,
                                      &xpbd_finish,
                                      &present,
                                      &integrate_compensated,
                                      &velocity_verlet_compensated,
                                      &normals,
                                      &aerodynamics,
                                      &aerodynamics_torn,
                                      &solid_contact,
                                      &mesh_contact,
                                      &pin_release,
                                      &pin_place,
                                      &xpbd_pins,
                                      &strain_limit,
                                      &tear,
                                      &integrate_torn,
                                      &integrate_torn_compensated,
                                      &normals_torn,
                                      &torn_mesh,
                                      &watch,
                                      &judge,
                                      &keep_sound,
                                      &carry,
                                      &pair_check,
                                      &cell_count,
                                      &cell_scan,
                                      &cell_fill,
                                      &cell_sort,
                                      &patch_near,
                                      &pair_gather,
                                      &surface_gather,
                                      &touch_weight,
                                      &surface_touch,
                                      &surface_contact,
                                      &self_contact,
                                      &spread_look};
  return kPasses;
}

}  // namespace weft
