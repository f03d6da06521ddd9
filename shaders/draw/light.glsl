// For the fragment shaders: the palette, the sky, filtered patterns and the way to the screen.
#include "view.glsl"

// Colours are linear; the palette lives here so that a picture can be retuned in one place.
const vec3 kHorizon = vec3(0.90, 0.88, 0.84);
const vec3 kZenith = vec3(0.10, 0.23, 0.42);
const vec3 kGround = vec3(0.13, 0.16, 0.21);  // below the horizon where there is no floor
const vec3 kKey = vec3(3.00, 2.74, 2.38);     // the sun, slightly warm
const vec3 kSkyFill = vec3(0.47, 0.54, 0.63);
const vec3 kFloorFill = vec3(0.30, 0.26, 0.23);
const vec3 kRim = vec3(0.55, 0.66, 0.80);

vec3 sky(vec3 direction) {
  float up = direction.y;
  vec3 above = mix(kZenith, kHorizon, exp(-5.0 * max(up, 0.0)));
  vec3 below = mix(kGround, kHorizon, exp(-5.5 * max(-up, 0.0)));
  return up > 0.0 ? above : below;
}

// Interleaved gradient noise, 0…1. Source: Jimenez 2014, "Next generation post processing in Call of Duty".
float pixel_noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// Filmic curve (Narkowicz 2015, ACES fit), then sRGB; half a step of noise keeps gradients free of bands.
vec4 to_screen(vec3 light) {
  vec3 x = light * 0.62;
  vec3 film = clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  // sRGB's curve within 1 % of white, by roots, which are cheaper than powers.
  // Source: Chilliant 2012, "sRGB approximations for HLSL".
  vec3 s1 = sqrt(film), s2 = sqrt(s1), s3 = sqrt(s2);
  vec3 code = 0.585122381 * s1 + 0.783140355 * s2 - 0.368262736 * s3;
  return vec4(code + (pixel_noise(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
}

// Share of an area of the floor's or a cloth's square pattern, filtered over a pixel's footprint `w`.
// Source: Quilez, "filtering the checker pattern" (box filter of a triangle wave's derivative).
float filtered_checker(vec2 p, vec2 w) {
  w = max(w, vec2(1e-4));
  vec2 s = 2.0 * (abs(fract((p - 0.5 * w) * 0.5) - 0.5) - abs(fract((p + 0.5 * w) * 0.5) - 0.5)) / w;
  return 0.5 - 0.5 * s.x * s.y;
}

// How much balls darken a surface they stand near: cosine times solid angle, summed.
float ball_occlusion(vec3 p, vec3 n) {
  float open = 1.0;
  for (uint k = 0u; k < view.sphere_count; ++k) {
    vec3 d = view.balls[k].xyz - p;
    float l2 = dot(d, d), r = view.balls[k].w;
    float cosine = max(dot(n, d) * inversesqrt(l2), 0.0);
    open *= 1.0 - min(cosine * r * r / l2, 1.0);
  }
  return open;
}
