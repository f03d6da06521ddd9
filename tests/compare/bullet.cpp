// Bullet's soft-body patch, hung by two corners as tests/compare/hung.toml: time a frame and stretch, for
// scripts/compare. Usage: weft_compare_bullet PARTICLES SECONDS ITERATIONS
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

namespace {

constexpr double kSize_m = 1.0, kDensity_kg_m2 = 0.2, kDrag = 0.0;
constexpr double kFrame_s = 1.0 / 60.0;

/// A world without anything but the cloth.
struct World {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  World() {
    world.setGravity({0, btScalar(-9.81), 0});
    world.getWorldInfo().m_gravity = world.getGravity();
    world.getWorldInfo().air_density = btScalar(kDrag);
    world.getWorldInfo().m_sparsesdf.Initialize();
  }
};

/// The ripple that Weft's cloth starts with [m] (imperfection of hung.toml): a perfectly flat one would stay
/// in its plane, where nothing folds. `last` is the greatest i and j.
double lift(int i, int j, int last) {
  constexpr double kPi = std::numbers::pi, kImperfection_m = 0.001;
  return kImperfection_m * std::sin(3.0 * kPi * i / last + 0.4) * std::sin(2.0 * kPi * j / last + 0.9);
}

/// The upper two corners are fixed; as stiff as Bullet goes.
btSoftBody* hung_patch(World& world, int particles, int iterations) {
  const auto side = btScalar(kSize_m);
  btSoftBody* body =
      btSoftBodyHelpers::CreatePatch(world.world.getWorldInfo(), {0, side, 0}, {side, side, 0}, {0, 0, 0},
                                     {side, 0, 0}, particles, particles, 1 + 2, true);
  for (int k = 0; k < body->m_nodes.size(); ++k) {
    btSoftBody::Node& node = body->m_nodes[k];
    node.m_x.setZ(btScalar(lift(k % particles, k / particles, particles - 1)));
    node.m_q = node.m_x;
  }
  body->m_materials[0]->m_kLST = 1;
  body->m_cfg.piterations = iterations;
  body->m_cfg.collisions = 0;
  body->setTotalMass(btScalar(kDensity_kg_m2 * kSize_m * kSize_m));
  body->setMass(0, 0);
  body->setMass(particles - 1, 0);
  world.world.addSoftBody(body);
  return body;
}

/// Stretch of the springs along rows and columns, ascending.
std::vector<double> stretches(const btSoftBody& body, int particles) {
  std::vector<double> all;
  const double rest_m = kSize_m / (particles - 1);
  const auto add = [&](int a, int b) {
    all.push_back(double((body.m_nodes[b].m_x - body.m_nodes[a].m_x).length()) / rest_m - 1.0);
  };
  for (int j = 0; j < particles; ++j)
    for (int i = 0; i < particles; ++i) {
      if (i + 1 < particles) add(j * particles + i, j * particles + i + 1);
      if (j + 1 < particles) add(j * particles + i, (j + 1) * particles + i);
    }
  std::ranges::sort(all);
  return all;
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    fmt::print(stderr, "usage: {} PARTICLES SECONDS ITERATIONS\n", words[0]);
    return 2;
  }
  const int particles = std::atoi(words[1]), frames = static_cast<int>(std::atof(words[2]) / kFrame_s + 0.5);
  World world;
  btSoftBody* const body = hung_patch(world, particles, std::atoi(words[3]));
  const auto began = std::chrono::steady_clock::now();
  for (int f = 0; f < frames; ++f) world.world.stepSimulation(btScalar(kFrame_s), 1, btScalar(kFrame_s));
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
  const std::vector<double> sorted = stretches(*body, particles);
  fmt::print("{:.4g} {:.4g} {:.4g}\n", ms / frames, sorted.back(), sorted[sorted.size() * 99 / 100]);
  world.world.removeSoftBody(body);
  delete body;
}
