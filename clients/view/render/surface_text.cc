#include "clients/view/render/shader_text.h"

namespace footing::render {
namespace {

/// Light on the ground: the bird's shadow, soft spots under it, the ring of the next foothold.
std::string SurfaceSharedText() {
  return SharedText() + R"(
uniform sampler2D u_shadow;
uniform vec3 u_focus;
uniform float u_floor;
uniform float u_span;
uniform vec4 u_blobs[)" +
         std::to_string(kMaxBlobs) + R"(];  // x, y, radius, darkness
uniform int u_blob_count;
uniform vec4 u_rings[)" +
         std::to_string(kMaxFootholds) + R"(];  // x, y, z
uniform int u_ring_count;
in vec3 v_position;
in vec3 v_normal;
out vec4 o_colour;

float Hash(vec2 cell) { return fract(sin(dot(cell, vec2(127.1, 311.7))) * 43758.5453); }
float Noise(vec2 p) {
  vec2 cell = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(Hash(cell), Hash(cell + vec2(1, 0)), f.x),
             mix(Hash(cell + vec2(0, 1)), Hash(cell + vec2(1, 1)), f.x), f.y);
}
// 1 on a line of that width every `period` metres, fading where lines would flicker.
float Lines(float at, float period, float width, float pixel) {
  float away = abs(fract(at / period + 0.5) - 0.5) * period;
  float line = 1.0 - smoothstep(0.5 * width - pixel, 0.5 * width + pixel, away);
  return line * clamp(1.4 - pixel / (0.35 * period), 0.0, 1.0) * min(1.0, width / (1.5 * pixel));
}
float Band(float away, float half_width, float pixel) {
  return 1.0 - smoothstep(half_width - pixel, half_width + pixel, away);
}
float Shadow() {
  vec2 at = (v_position.xy - u_focus.xy) / u_span + 0.5;
  vec2 inside = min(at, 1.0 - at);
  float edge = min(inside.x, inside.y);
  if (edge <= 0.0 || abs(v_position.z - u_floor) > 0.4) return 0.0;
  float sum = 0.0, reach = 0.0055;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) sum += texture(u_shadow, at + reach * vec2(x, y)).r;
  }
  return sum / 9.0 * smoothstep(0.0, 0.08, edge);
}
vec3 Lit(vec3 colour, float distance_m) {
  float open = 1.0;
  for (int i = 0; i < u_blob_count; ++i) {
    vec2 away = (v_position.xy - u_blobs[i].xy) / u_blobs[i].z;
    open *= 1.0 - u_blobs[i].w * exp(-2.2 * dot(away, away));
  }
  vec3 n = normalize(v_normal);
  float sun = max(dot(n, normalize(kSun)), 0.0) * (1.0 - 0.85 * Shadow());
  vec3 ambient = vec3(0.36, 0.43, 0.52) * (0.75 + 0.25 * n.z);
  vec3 lit = colour * (ambient + kSunLight * sun * 0.62) * open;
  for (int i = 0; i < u_ring_count; ++i) {
    float away = distance(v_position.xy, u_rings[i].xy);
    float near = 1.0 - smoothstep(0.3, 0.6, abs(v_position.z - u_rings[i].z));
    float ring = exp(-pow((away - 0.13) / 0.016, 2.0)) + 0.30 * exp(-pow(away / 0.10, 2.0));
    lit = mix(lit, vec3(1.0, 0.93, 0.55), min(ring, 1.0) * 0.75 * near);
  }
  return InFog(lit, distance_m);
}
)";
}

}  // namespace

std::string GroundVertexText() {
  return SharedText() + R"(
uniform float u_ground;
out vec3 v_position;
out vec3 v_normal;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  v_position = vec3(u_eye.xy + 200.0 * corner, u_ground);
  v_normal = vec3(0.0, 0.0, 1.0);
  gl_Position = u_clip_from_world * vec4(v_position, 1.0);
}
)";
}

std::string RibbonVertexText() {
  return SharedText() + R"(
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_along_sideways_half_kind;
out vec3 v_position;
out vec3 v_normal;
out vec4 v_track;
void main() {
  v_position = a_position;
  v_normal = a_normal;
  v_track = a_along_sideways_half_kind;
  gl_Position = u_clip_from_world * vec4(a_position, 1.0);
}
)";
}

std::string SurfaceFragmentText(bool ribbon) {
  if (!ribbon) {
    return SurfaceSharedText() + R"(
void main() {
  float distance_m = distance(u_eye, v_position);
  vec2 p = v_position.xy;
  vec2 pixel = fwidth(p) + 1e-5;
  float patch_ = Noise(p * 0.35) * 0.6 + Noise(p * 1.7) * 0.4 * clamp(2.0 - distance_m * 0.05, 0.0, 1.0);
  vec3 colour = mix(vec3(0.150, 0.275, 0.075), vec3(0.225, 0.350, 0.105), patch_);
  float grid = max(Lines(p.x, 1.0, 0.02, pixel.x), Lines(p.y, 1.0, 0.02, pixel.y)) * 0.30;
  grid = max(grid, max(Lines(p.x, 5.0, 0.05, pixel.x), Lines(p.y, 5.0, 0.05, pixel.y)) * 0.45);
  colour = mix(colour, vec3(0.52, 0.64, 0.36), grid * exp(-distance_m * 0.03));
  o_colour = ToScreen(Lit(colour, distance_m));
}
)";
  }
  return SurfaceSharedText() + R"(
in vec4 v_track;
vec3 Painted(vec3 colour) {
  float along = v_track.x, aside = v_track.y, half_width = v_track.z;
  float pixel_along = fwidth(along) + 1e-5, pixel_aside = fwidth(aside) + 1e-5;
  float from_edge = half_width - abs(aside);
  vec3 white = vec3(0.88, 0.86, 0.82);
  float edge = Band(abs(from_edge - 0.12), 0.045, pixel_aside);
  float lane = Band(abs(abs(aside) - half_width / 3.0), 0.012, pixel_aside) * 0.25;
  float tick = Lines(along, 1.0, 0.04, pixel_along) * step(from_edge, 0.42) * step(0.12, from_edge);
  float five = Lines(along, 5.0, 0.05, pixel_along) * 0.40 * step(0.12, from_edge);
  float ten = Lines(along, 10.0, 0.09, pixel_along) * 0.85 * step(0.12, from_edge);
  return mix(colour, white, max(max(edge, lane), max(tick * 0.8, max(five, ten))));
}
void main() {
  float distance_m = distance(u_eye, v_position);
  float kind = v_track.w;
  vec3 clay = vec3(0.470, 0.150, 0.078);
  if (kind < 0.5) {
    float near = clamp(1.6 - distance_m * 0.09, 0.0, 1.0);
    float grain = Noise(v_position.xy * 0.8) * 0.5 + Noise(v_position.xy * 34.0) * 0.5 * near;
    vec3 colour = Painted(clay * (0.88 + 0.24 * grain));
    o_colour = ToScreen(Lit(colour, distance_m));
  } else if (kind < 1.5) {
    o_colour = ToScreen(Lit(vec3(0.020, 0.022, 0.028), distance_m));
  } else if (kind < 2.5) {
    o_colour = ToScreen(Lit(clay * 0.45, distance_m));
  } else {
    o_colour = ToScreen(Lit(vec3(0.86, 0.84, 0.80), distance_m));
  }
}
)";
}

}  // namespace footing::render
