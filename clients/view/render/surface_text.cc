#include "clients/view/render/shader_text.h"

namespace footing::render {
namespace {

/// Light on the ground: the bird's shadow, soft spots under it, the ring of the next foothold.
///
/// A software renderer runs both sides of every `if` but leaves a loop when no pixel of a group
/// needs it: hence loops whose count is 0 far from the birds.
std::string SurfaceSharedText() {
  return SharedText() + R"(
uniform sampler2D u_shadow;
uniform vec3 u_focus;
uniform float u_floor;
uniform float u_span;
uniform int u_shadow_taps;
uniform vec4 u_near;  // x, y, radius: where blobs and rings are
uniform vec4 u_blobs[)" +
         std::to_string(kMaxBlobs) + R"(];  // x, y, radius, darkness
uniform int u_blob_count;
uniform vec4 u_rings[)" +
         std::to_string(kMaxFootholds) + R"(];  // x, y, z
uniform int u_ring_count;
in vec3 v_position;
in float v_sun;
out vec4 o_colour;

// The share of a pixel that a line covers; `away` from its middle.
float Line(float away, float half_width, float pixel) {
  return clamp((half_width - away) / pixel + 0.5, 0.0, 1.0) * min(1.0, 2.0 * half_width / pixel);
}
vec2 AwayFromLines(vec2 at, float period) { return abs(fract(at / period + 0.5) - 0.5) * period; }
float AwayFromLines(float at, float period) { return abs(fract(at / period + 0.5) - 0.5) * period; }
float Shadow() {
  vec2 at = (v_position.xy - u_focus.xy) / u_span + 0.5;
  vec2 inside = min(at, 1.0 - at);
  float edge = clamp(min(inside.x, inside.y) * 12.0, 0.0, 1.0);
  edge *= clamp(4.0 - 10.0 * abs(v_position.z - u_floor), 0.0, 1.0);
  int taps = edge > 0.0 ? u_shadow_taps : 0;
  float sum = 0.0;
  for (int i = 0; i < taps; ++i) {
    vec2 step_ = vec2(i % 3, i / 3) - 1.0;
    sum += textureLod(u_shadow, at + 0.0055 * step_, 0.0).r;
  }
  return sum / 9.0 * edge;
}
vec3 Lit(vec3 colour) {
  vec3 from_eye = v_position - u_eye;
  vec2 from_near = v_position.xy - u_near.xy;
  bool near = dot(from_near, from_near) < u_near.z * u_near.z;
  float open = 1.0;
  for (int i = 0; i < (near ? u_blob_count : 0); ++i) {
    vec2 away = (v_position.xy - u_blobs[i].xy) / u_blobs[i].z;
    open *= 1.0 - u_blobs[i].w * exp(-2.2 * dot(away, away));
  }
  float sun = v_sun * (1.0 - 0.85 * Shadow());
  vec3 lit = colour * (vec3(0.36, 0.43, 0.52) + kSunLight * sun * 0.62) * open;
  for (int i = 0; i < (near ? u_ring_count : 0); ++i) {
    float away = distance(v_position.xy, u_rings[i].xy);
    float level = 1.0 - smoothstep(0.3, 0.6, abs(v_position.z - u_rings[i].z));
    float rim = (away - 0.13) / 0.016;
    float ring = exp(-rim * rim) + 0.30 * exp(-100.0 * away * away);
    lit = mix(lit, vec3(1.0, 0.93, 0.55), min(ring, 1.0) * 0.75 * level);
  }
  return InFog(lit, dot(from_eye, from_eye));
}
)";
}

}  // namespace

std::string GroundVertexText() {
  return SharedText() + R"(
uniform float u_ground;
out vec3 v_position;
out float v_sun;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  v_position = vec3(u_eye.xy + 200.0 * corner, u_ground);
  v_sun = kSun.z;
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
out float v_sun;
out vec4 v_track;
void main() {
  v_position = a_position;
  v_sun = max(dot(a_normal, kSun), 0.0);
  v_track = a_along_sideways_half_kind;
  gl_Position = u_clip_from_world * vec4(a_position, 1.0);
}
)";
}

std::string SurfaceFragmentText(bool ribbon) {
  if (!ribbon) {
    return SurfaceSharedText() + R"(
void main() {
  vec2 p = v_position.xy;
  vec2 pixel = fwidth(p) + 1e-5;
  // Mown in stripes 5 m wide.
  vec2 stripe = clamp((AwayFromLines(p + 2.5, 10.0) - 2.5) / max(pixel, vec2(0.05)), -0.5, 0.5);
  vec3 colour = mix(vec3(0.150, 0.280, 0.075), vec3(0.190, 0.325, 0.092),
                    0.5 + 0.7 * stripe.x + 0.3 * stripe.y);
  vec2 small = AwayFromLines(p, 1.0), large = AwayFromLines(p, 5.0);
  float grid = max(Line(small.x, 0.01, pixel.x), Line(small.y, 0.01, pixel.y)) * 0.25;
  grid = max(grid, max(Line(large.x, 0.022, pixel.x), Line(large.y, 0.022, pixel.y)) * 0.5);
  o_colour = ToScreen(Lit(mix(colour, vec3(0.52, 0.64, 0.36), grid)));
}
)";
  }
  return SurfaceSharedText() + R"(
in vec4 v_track;
vec3 Clay() {
  float along = v_track.x, aside = v_track.y, half_width = v_track.z;
  float pixel_along = fwidth(along) + 1e-5, pixel_aside = fwidth(aside) + 1e-5;
  float from_edge = half_width - abs(aside);
  float inside = step(0.12, from_edge);
  float edge = Line(abs(from_edge - 0.12), 0.045, pixel_aside);
  float lane = Line(abs(abs(aside) - half_width / 3.0), 0.012, pixel_aside) * 0.25;
  float tick = Line(AwayFromLines(along, 1.0), 0.02, pixel_along) * inside * step(from_edge, 0.42);
  float five = Line(AwayFromLines(along, 5.0), 0.025, pixel_along) * 0.40 * inside;
  float ten = Line(AwayFromLines(along, 10.0), 0.045, pixel_along) * 0.85 * inside;
  // Two tones a metre apart, hardly seen, that tell the speed.
  float tone = 0.97 + 0.06 * step(0.5, fract(along * 0.5));
  return mix(vec3(0.470, 0.150, 0.078) * mix(tone, 1.0, min(1.0, 2.0 * pixel_along)),
             vec3(0.88, 0.86, 0.82), max(max(edge, lane), max(tick * 0.8, max(five, ten))));
}
void main() {
  float kind = v_track.w;
  vec3 colour = Clay();
  colour = kind > 0.5 ? vec3(0.020, 0.022, 0.028) : colour;
  colour = kind > 1.5 ? vec3(0.210, 0.068, 0.035) : colour;
  colour = kind > 2.5 ? vec3(0.86, 0.84, 0.80) : colour;
  o_colour = ToScreen(Lit(colour));
}
)";
}

}  // namespace footing::render
