// The unit sphere as a latitude–longitude mesh made from the vertex number alone.
const uint kBallSegments = 64u, kBallRings = 32u;

vec3 ball_direction(uint vertex) {
  uint ring = vertex / (kBallSegments + 1u), segment = vertex - ring * (kBallSegments + 1u);
  float polar = 3.14159265 * float(ring) / float(kBallRings);
  float around = 6.28318531 * float(segment) / float(kBallSegments);
  return vec3(sin(polar) * sin(around), cos(polar), sin(polar) * cos(around));
}
