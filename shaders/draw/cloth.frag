#version 460
#extension GL_GOOGLE_include_directive : require
// Two-sided woven fabric: one tint a side, a printed grid from the flat cloth's coordinates that shows
// the deformation, soft key light with shadow, light shining through, sheen; or strain as colour.
#include "light.glsl"
#include "shadow.glsl"

layout(constant_id = 1) const bool kFlat = false;  // one normal a triangle
layout(constant_id = 2) const bool kHeat = false;  // strain instead of fabric

layout(location = 0) in vec3 world_m;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec2 flat_m;
layout(location = 3) in float strain;
layout(location = 4) flat in uint cloth;
layout(location = 0) out vec4 color;

const vec3 kFront = vec3(0.56, 0.050, 0.042), kFrontPrint = vec3(0.85, 0.60, 0.38);
const vec3 kBack = vec3(0.74, 0.58, 0.36), kBackPrint = vec3(0.42, 0.17, 0.09);

// Of further cloths, by turns.
const vec3 kFurtherFront[3] = {vec3(0.045, 0.16, 0.36), vec3(0.10, 0.30, 0.13), vec3(0.62, 0.36, 0.04)};
const vec3 kFurtherBack[3] = {vec3(0.38, 0.52, 0.66), vec3(0.50, 0.62, 0.40), vec3(0.80, 0.68, 0.42)};

// Blue where compressed, white at rest, red where stretched.
vec3 heat_color(float s) {
  float t = clamp(s / view.heat_full, -1.0, 1.0);
  vec3 rest = vec3(0.80, 0.79, 0.76);
  vec3 warm = mix(rest, vec3(0.95, 0.42, 0.05), smoothstep(0.0, 0.5, t));
  warm = mix(warm, vec3(0.52, 0.01, 0.02), smoothstep(0.5, 1.0, t));
  vec3 cold = mix(rest, vec3(0.03, 0.16, 0.62), smoothstep(0.0, 1.0, -t));
  return t >= 0.0 ? warm : cold;
}

// Share of a pixel covered by lines of half width h around whole numbers of x, with footprint w.
vec2 lines(vec2 x, float h, vec2 w) {
  vec2 d = abs(fract(x + 0.5) - 0.5);
  vec2 soft = max(w, vec2(1e-4));
  return clamp((vec2(h) - d) / soft + 0.5, 0.0, 1.0) * clamp(1.5 - soft, 0.0, 1.0);
}

// Fabric colour at a place of the flat cloth: soft gingham squares, fine printed lines, a hem.
vec3 fabric(bool front) {
  vec3 base = front ? kFront : kBack, ink = front ? kFrontPrint : kBackPrint;
  if (cloth > 0u) base = front ? kFurtherFront[(cloth - 1u) % 3u] : kFurtherBack[(cloth - 1u) % 3u];
  float size = max(view.cloth_m.x, view.cloth_m.y);
  vec2 square = flat_m / (size / 16.0), w = fwidth(square);
  base *= 1.0 + 0.26 * (filtered_checker(square, w) - 0.5);
  vec2 line = lines(square / 2.0, 0.02, 0.5 * w);
  base = mix(base, ink, 0.72 * max(line.x, line.y));
  vec2 edge = min(flat_m, view.cloth_m - flat_m) / (0.014 * size);
  base = mix(ink, base, smoothstep(0.8, 1.2, min(edge.x, edge.y)) * 0.85 + 0.15);
  vec2 thread = flat_m * (140.0 / size), tw = fwidth(thread);
  float visible = clamp(1.0 - 1.6 * max(tw.x, tw.y), 0.0, 1.0);
  return base * (1.0 + visible * 0.15 * (filtered_checker(thread, tw) - 0.5));
}

void main() {
  vec3 to_eye = normalize(view.eye_m - world_m);
  vec3 plane = normalize(cross(dFdx(world_m), dFdy(world_m)));
  plane = dot(plane, to_eye) < 0.0 ? -plane : plane;
  float length_n = length(world_normal);
  vec3 n = kFlat || length_n < 1e-6 ? plane : world_normal / max(length_n, 1e-6);
  n = dot(n, plane) < 0.0 ? -n : n;

  vec3 base = kHeat ? heat_color(strain) : fabric(gl_FrontFacing);
  float towards = dot(n, view.to_light);
  float lit = shadow(world_m, towards < 0.0 ? -n : n, kFlat ? 0.0 : 0.3 * view.spacing_m);
  vec3 h = normalize(view.to_light + to_eye);
  float away = clamp(1.0 - dot(n, to_eye), 0.0, 1.0), grazing = away * away * away;
  float shine = max(dot(n, h), 0.0);
  shine *= shine, shine *= shine, shine *= shine, shine *= shine;  // to the 16th
  float open = ball_occlusion(world_m, n);

  vec3 through = base * base * (0.42 * max(-towards, 0.0));
  vec3 light = kKey * lit * (base * max(towards, 0.0) * 0.56 + through);
  light += base * mix(kFloorFill, kSkyFill, 0.5 + 0.5 * n.y) * (0.35 + 0.65 * open);
  light += kKey * lit * (0.008 + 0.04 * base) * shine * step(0.0, towards);
  light += kRim * grazing * (0.10 + 0.35 * base) * (0.6 + 0.4 * n.y);
  color = to_screen(light);
}
