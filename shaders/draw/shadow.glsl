// Soft shadows from the one shadow map: near the caster they are sharp, further away wide (percentage
// closer soft shadows, Fernando 2005).
layout(set = 0, binding = 1) uniform sampler2DShadow shadow_compare;
layout(set = 0, binding = 2) uniform sampler2D shadow_depth;

layout(constant_id = 0) const int kShadowTaps = 16;
const int kBlockerTaps = 10;
const float kLightSize = 0.07;        // tangent of the light's angular diameter
const float kWidestTexels = 14.0;

// Taps lie on Vogel's spiral: each direction is the one before turned by the golden angle, and point k of n
// has the radius sqrt((k + ½)/n).
const mat2 kGoldenTurn = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);
float spiral_radius(int k, int n) { return sqrt((float(k) + 0.5) / float(n)); }

// 1 = lit, 0 = in shadow. `n` faces the light; the lookup starts `lift_m` above the surface, so that a coarse
// mesh does not shade its own smooth curve.
// Loops of zero turns, not branches: a software driver runs both sides of a branch, but skips a loop.
float shadow(vec3 p, vec3 n, float lift_m) {
  float slope = sqrt(clamp(1.0 - dot(n, view.to_light) * dot(n, view.to_light), 0.0, 1.0));
  vec4 s = view.shadow_clip * vec4(p + n * (view.shadow_texel_m * (1.0 + 1.5 * slope) + lift_m * slope), 1.0);
  vec2 at = s.xy * 0.5 + 0.5;
  float texel = 1.0 / float(textureSize(shadow_depth, 0).x);
  bool inside = all(lessThan(abs(s.xyz - vec3(0, 0, 0.5)), vec3(1.0, 1.0, 0.5)));
  float turn = 6.2831853 * pixel_noise(gl_FragCoord.xy);
  vec2 direction = vec2(cos(turn), sin(turn));

  float depth_sum = 0.0, blockers = 0.0;
  int search = inside ? kBlockerTaps : 0;
  for (int k = 0; k < search; ++k) {
    vec2 place = at + direction * (spiral_radius(k, kBlockerTaps) * kWidestTexels * texel);
    float d = textureLod(shadow_depth, place, 0.0).r;
    direction = kGoldenTurn * direction;
    float blocks = d < s.z ? 1.0 : 0.0;
    depth_sum += blocks * d;
    blockers += blocks;
  }
  float gap_m = (s.z - depth_sum / max(blockers, 1.0)) * view.shadow_depth_m;
  float radius = clamp(0.5 * kLightSize * gap_m / view.shadow_texel_m, 1.2, kWidestTexels) * texel;
  int taps = blockers > 0.0 ? kShadowTaps : 0;
  float lit = 0.0;
  for (int k = 0; k < taps; ++k) {
    vec2 place = at + direction * (spiral_radius(k, kShadowTaps) * radius);
    lit += textureLod(shadow_compare, vec3(place, s.z), 0.0);
    direction = kGoldenTurn * direction;
  }
  return taps > 0 ? lit / float(kShadowTaps) : 1.0;
}
