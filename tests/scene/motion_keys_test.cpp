// Keys of a motion: what is read, and that every slip in them is refused with its place.
#include "scene/scene_text.h"

namespace weft {
namespace {

const std::string kBall = "[cloth]\n[[spheres]]\nradius = 0.2\n";

TEST(MotionKeys, AreReadInOrder) {
  const Scene scene =
      read(kBall + "keys = [{ time = 0.5, center = [0, 3, 0] },\n {center = [1, 2.5, 0], time = 2}]\n").scene;
  const SphereSection& sphere = scene.spheres.at(0);
  EXPECT_EQ(sphere.keys, (MotionKeys{{0.5, {0, 3, 0}}, {2.0, {1, 2.5, 0}}}));
  EXPECT_EQ(sphere.center_m, glm::dvec3(0, 3, 0)) << "where it is before the first key";
}

TEST(MotionKeys, MayComeFromTheCommandLine) {
  const std::string keys = "keys=[{time=0, center=[0, 3, 0]}]";
  EXPECT_EQ(
      read(kBall + "center = [0, 2, 0]\n", {"spheres=[{radius=0.1, " + keys + "}]"}).scene.spheres.at(0).keys,
      (MotionKeys{{0.0, {0, 3, 0}}}));
  expect_refused(kBall + "center = [0, 2, 0]\n",
                 {"scene.toml:4: spheres.0.center stands beside", "remove center"}, {"spheres.0." + keys});
}

TEST(MotionKeys, TakeThePlaceOfCenterAndVelocity) {
  const std::string moved = kBall + "keys = [{ time = 0, center = [0, 3, 0] }]\n";
  EXPECT_EQ(refusal(moved), "accepted");
  expect_refused(moved + "velocity = [0, 0, 0]\n",
                 {"scene.toml:5: spheres.0.velocity stands beside spheres.0.keys", "one or the other"});
  expect_refused(kBall, {"scene.toml:2: spheres.0.center is missing"});
}

TEST(MotionKeys, ASlipIsRefusedWithItsPlace) {
  const auto with = [](const std::string& keys) { return kBall + "keys = " + keys + "\n"; };
  const std::string first = "{time=1, center=[0, 3, 0]}";
  expect_refused(with("7"), {"scene.toml:4: spheres.0.keys is 7; it must be a list of keys"});
  expect_refused(with("[]"), {"spheres.0.keys has 0 keys", "1 to 10000"});
  expect_refused(with("[" + first + ", {time=1, center=[1, 3, 0]}]"),
                 {"spheres.0.keys.1.time is 1; it must be later than the key before, 1", "order"});
  expect_refused(with("[{time=-1, center=[0, 3, 0]}]"), {"keys.0.time is -1; it must be 0 to 1e+06"});
  expect_refused(with("[{time=nan, center=[0, 3, 0]}]"), {"keys.0.time is nan"});
  expect_refused(with("[{time=0, center=[0, inf, 0]}]"), {"keys.0.center is [0, inf, 0]", "-10000 to 10000"});
  expect_refused(with("[{time=0, center=[0, 3]}]"), {"spheres.0.keys.0 has no center"});
  expect_refused(with("[{center=[0, 3, 0]}]"), {"spheres.0.keys.0 has no time"});
  expect_refused(with("[{time=0, centre=[0, 3, 0]}]"),
                 {"\"centre\" is not a key of spheres.0.keys.0; did you mean center?"});
}

TEST(MotionKeys, APinMovesByOffsets) {
  const std::string pin = "[cloth]\n[[pins]]\nat = [0, 0]\n";
  const Scene scene =
      read(pin + "keys = [{ time = 0, offset = [0, 0, 0] }, {time = 1, offset = [0, 2, 0]}]\n").scene;
  EXPECT_EQ(scene.pins.at(0).keys, (MotionKeys{{0.0, {0, 0, 0}}, {1.0, {0, 2, 0}}}));
  expect_refused(pin + "keys = [{ time = 0, center = [0, 0, 0] }]\n",
                 {"scene.toml:4: \"center\" is not a key of pins.0.keys.0", "time and offset"});
}

TEST(MotionKeys, AtMost64PinsMove) {
  std::string many = "[cloth]\n";
  for (int k = 0; k < 64; ++k) many += "[[pins]]\nat = [0, 0]\nkeys = [{ time = 0, offset = [0, 0, 0] }]\n";
  EXPECT_EQ(refusal(many + "[[pins]]\nat = [1, 1]\n"), "accepted");
  expect_refused(many + "[[pins]]\nat = [1, 1]\nkeys = [{ time = 0, offset = [0, 0, 0] }]\n",
                 {"scene.toml:196: pins.64.keys", "65th", "at most the 64th"});
}

// 10 m in 1/100 s are 1000 m/s, the most there is; a thousandth faster is refused.
TEST(MotionKeys, HaveAHighestSpeed) {
  const auto to = [](const char* z) {
    return kBall + "keys = [{time=0, center=[0, 3, 0]}, {time=0.01, center=[0, 3, " + z + "]}]\n";
  };
  EXPECT_EQ(refusal(to("10")), "accepted");
  expect_refused(to("10.01"), {"keys.1.time is 0.01", "1001 m/s", "at most 1000 m/s", "more time"});
}

TEST(AttachedPins, NameASphereThatThereIs) {
  const std::string sphere =
      "[cloth]\n[[spheres]]\ncenter = [0, 5, 0]\nradius = 0.1\n[[pins]]\nat = [0, 0]\n";
  EXPECT_EQ(refusal(sphere + "attach = \"spheres.0\"\nrelease = 2\n"), "accepted");
  expect_refused(sphere + "attach = \"spheres.1\"\n", {"scene.toml:7", "pins.0.attach", "\"spheres.0\""});
  expect_refused(sphere + "attach = \"sphere\"\n", {"pins.0.attach", "must be"});
  expect_refused("[cloth]\n[[pins]]\nat = [0, 0]\nattach = \"spheres.0\"\n", {"the scene has none"});
  expect_refused(sphere + "attach = \"spheres.0\"\nkeys = [{ time = 0, offset = [0, 0, 0] }]\n",
                 {"beside pins.0.keys"});
  expect_refused(sphere + "release = -1\n", {"pins.0.release is -1"});
}

}  // namespace
}  // namespace weft
