// Hard cases of what holds, drives and tears the cloth: air by triangle, limits, links, tethers, pins that
// ride and let go.
#include "support/hard_case_parts.h"

namespace weft::hard {
namespace {

std::vector<HardCase> pin_cases() {
  return {
      {.name = "ride-100",
       .about = "its pins ride to and fro on spheres at 100 m/s, and one lets go on the way",
       .scene = "ridden",
       .time_s = 0.15},
      {.name = "let-go",
       .about = "its pins let go where they have pulled it to three times its width",
       .scene = "parted",
       .set = {"pins.0.release=0.5", "pins.1.release=0.5"},
       .time_s = 0.7},
      {.name = "tethered-yank",
       .about = "tethered, and its pins yanked 10 m away within one frame",
       .scene = "yanked",
       .set = {"tethers={slack=0}"},
       .time_s = 0.3,
       .solver = "xpbd"},
  };
}

std::vector<HardCase> limit_cases() {
  return {
      {.name = "limited-yank",
       .about = "a strain limit of 2 %, and its pins yanked 10 m away within one frame",
       .scene = "yanked",
       .set = {"material.strain_limit=0.02"},
       .time_s = 0.3},
      {.name = "limited-part",
       .about = "a strain limit of 5 %, and its pins pulled apart to three times its width",
       .scene = "parted",
       .set = {"material.strain_limit=0.05"},
       .time_s = 0.6},
      {.name = "limited-soft",
       .about = "a strain limit of 1 % on cloth that its weight would stretch to twice its length",
       .scene = "hung",
       .set = {"material.strain_limit=0.01", "material.membrane=10"},
       .time_s = 0.5,
       .closed = true,
       .energy_tolerance = 0.05},  // pulling back lifts what hangs (docs/physics.md "Strain limit")
      {.name = "limited-heavy",
       .about = "a strain limit of 1 % under 100 times the gravity of Earth",
       .scene = "hung",
       .set = {"material.strain_limit=0.01", "gravity.acceleration=[0,-1000,0]"}},
      {.name = "self-box",
       .about = "collides with itself, and starts with particles anywhere in a box of its size",
       .scene = "free",
       .set = {"self_collision.thickness=0.03"},
       .start = Start::box},
      {.name = "self-drop",
       .about = "collides with itself, and falls on a sphere at 30 m/s",
       .scene = "drop",
       .set = {"self_collision.thickness=0.02"},
       .time_s = 0.1,
       .start = Start::falling_30},
  };
}

std::vector<HardCase> torn_cases() {
  return {
      {.name = "torn-heavy",
       .about = "links that break at 2 % under 100 times the gravity of Earth",
       .scene = "hung",
       .set = {"tearing={strain=0.02}", "gravity.acceleration=[0,-1000,0]"},
       .time_s = 0.3,
       .closed = true},
      {.name = "torn-box",
       .about = "links that break at 5 %, and particles anywhere in a box of its size at the start",
       .scene = "free",
       .set = {"tearing={strain=0.05}"},
       .start = Start::box,
       .closed = true},
      {.name = "torn-shot",
       .about = "links that break at 5 %, and a sphere shot through it at 100 m/s",
       .scene = "shot",
       .set = {"tearing={strain=0.05}", "spheres.0.velocity=[0,0,100]", "solver.frame=0.0002"},
       .time_s = 0.015,
       .one_collider = true},
      {.name = "torn-storm",
       .about = "links that break at 10 % in wind of 100 m/s with gusts to 200 m/s",
       .scene = "wind",
       .set = {"tearing={strain=0.1}"},
       .time_s = 0.5},
  };
}

std::vector<HardCase> air_cases() {
  return {
      {.name = "gale",
       .about = "drag and lift by triangle in wind of 100 m/s, gusts and eddies of 50 m/s",
       .scene = "wind",
       .set = {"aerodynamics={}", "wind.noise=50", "wind.noise_scale=0.2", "wind.noise_period=0.05"},
       .time_s = 0.5},
      {.name = "under-water",
       .about = "drag and lift by triangle in water, at 100 m/s",
       .scene = "wind",
       .set = {"aerodynamics={density=1000,drag=10,lift=10}", "wind.gust=0"},
       .time_s = 0.1},
      {.name = "still-water",
       .about = "every particle at a velocity of its own in water at rest",
       .scene = "free",
       .set = {"aerodynamics={density=1000,drag=10,lift=0}"},
       .start = Start::swinging,
       .closed = true},
  };
}

}  // namespace

std::vector<HardCase> holding_cases() {
  std::vector<HardCase> list;
  for (auto* part : {air_cases, pin_cases, limit_cases, torn_cases})
    for (HardCase& c : part()) list.push_back(std::move(c));
  return list;
}

}  // namespace weft::hard
