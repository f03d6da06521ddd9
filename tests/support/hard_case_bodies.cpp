// Hard cases with capsules, boxes, meshes and a tilted floor.
#include "support/hard_case_parts.h"

namespace weft::hard {
namespace {

using Words = std::vector<std::string>;

/// A body shot along z through the hanging cloth of `shot`, slowly and fast.
/// @param text  the body's section as `--set` takes it, with {} for its velocity
void add_shots(const char* what, const char* article, const char* section, const char* text,
               std::vector<HardCase>& list) {
  for (const int speed_m_s : {10, 100}) {
    const std::string body =
        fmt::format("{}=[{}]", section, fmt::format(fmt::runtime(text), fmt::format("[0,0,{}]", speed_m_s)));
    Words set{"spheres=[]", body};
    if (speed_m_s == 100) set.push_back("solver.frame=0.0002");
    list.push_back({.name = fmt::format("{}-{}", what, speed_m_s),
                    .about = fmt::format("{} {} shot through it at {} m/s", article, what, speed_m_s),
                    .scene = "shot",
                    .set = set,
                    .time_s = speed_m_s == 10 ? 0.15 : 0.015,
                    .one_collider = true});
  }
}

}  // namespace

std::vector<HardCase> body_cases() {
  std::vector<HardCase> list;
  add_shots("capsule", "a", "capsules", "{{a=[-0.2,1.1,-0.5],b=[0.25,0.95,-0.5],radius=0.1,velocity={}}}",
            list);
  add_shots("box", "a", "boxes",
            "{{center=[0.03,1,-0.5],size=[0.3,0.2,0.25],rotation=[20,30,40],velocity={}}}", list);
  add_shots("ring", "a", "meshes",
            "{{file=\"../../assets/meshes/ring.obj\",center=[0.03,1,-0.5],scale=0.6,rotation=[70,0,0],"
            "resolution=24,velocity={}}}",
            list);
  const std::string ring =
      "meshes=[{file=\"../../assets/meshes/ring.obj\",center=[0,0.9,0],rotation=[10,0,0],resolution=24,"
      "friction=0.3}]";
  const std::vector<HardCase> rest{
      {.name = "drop-ball",
       .about = "falls on a small slippery sphere at 30 m/s, which pulls it far down round the sphere",
       .scene = "drop",
       .set = {"spheres=[{center=[0.01,0.9,0.02],radius=0.1}]"},
       .time_s = 0.1,
       .start = Start::falling_30,
       .closed = true,
       .one_collider = true},
      {.name = "drop-capsule",
       .about = "falls on a capsule at 30 m/s",
       .scene = "drop",
       .set = {"spheres=[]", "capsules=[{a=[-0.5,0.7,0],b=[0.5,0.8,0.1],radius=0.1,friction=0.3}]"},
       .time_s = 0.1,
       .start = Start::falling_30,
       .closed = true,
       .one_collider = true},
      {.name = "drop-box",
       .about = "falls on an edge of a box at 30 m/s",
       .scene = "drop",
       .set = {"spheres=[]", "boxes=[{center=[0,0.8,0],size=[0.5,0.3,0.4],rotation=[45,0,20]}]"},
       .time_s = 0.1,
       .start = Start::falling_30,
       .closed = true,
       .one_collider = true},
      {.name = "drop-ring",
       .about = "falls on a triangle mesh at 30 m/s",
       .scene = "drop",
       .set = {"spheres=[]", ring},
       .time_s = 0.1,
       .start = Start::falling_30,
       .closed = true,
       .one_collider = true},
      {.name = "drop-slope",
       .about = "falls on a floor that leans 35 degrees at 30 m/s",
       .scene = "drop",
       .set = {"spheres=[]", "floor.normal=[0.7,1,0]"},
       .time_s = 0.1,
       .start = Start::falling_30,
       .closed = true,
       .one_collider = true},
      {.name = "mill",
       .about = "a box turns ten times a second in it",
       .scene = "drop",
       .set = {"spheres=[]",
               "boxes=[{size=[0.8,0.1,0.1],friction=0.5,keys=[{time=0,center=[0,1.3,0]},"
               "{time=1,center=[0,1.3,0],rotation=[0,0,3600]}]}]"},
       .time_s = 0.5,
       .one_collider = true},
      {.name = "solid-wedge",
       .about = "falls on a capsule, a box and a ring that overlap each other and a tilted floor",
       .scene = "spheres",
       .set = {"spheres=[]", "floor.normal=[0.2,1,0]",
               "capsules=[{a=[-0.4,0.2,0],b=[0.4,0.3,0],radius=0.15}]",
               "boxes=[{center=[0.1,0.2,0.1],size=[0.4,0.4,0.4],rotation=[30,0,45]}]",
               "meshes=[{file=\"../../assets/meshes/ring.obj\",center=[0,0.3,0],resolution=24}]"},
       .time_s = 0.6,
       .closed = true},
      {.name = "begins-inside",
       .about = "begins halfway inside a capsule, a box and a ring",
       .scene = "free",
       .set =
           {"capsules=[{a=[-0.4,1.3,0.02],b=[-0.1,1.3,0],radius=0.1}]",
            "boxes=[{center=[0.3,1.3,0.03],size=[0.3,0.3,0.3]}]",
            "meshes=[{file=\"../../assets/meshes/ring.obj\",center=[0,0.8,0.01],scale=0.7,resolution=24}]"},
       .time_s = 0.3},
  };
  list.insert(list.end(), rest.begin(), rest.end());
  return list;
}

}  // namespace weft::hard
