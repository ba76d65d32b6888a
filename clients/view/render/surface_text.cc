#include "clients/view/render/shader_text.h"

namespace footing::render {
namespace {

/// Plain light on the ground; what the birds cast on it is drawn over it, where they are.
std::string SurfaceSharedText() {
  return SharedText() + GrainText() + R"(
in vec3 v_position;
in float v_sun;
out vec4 o_colour;

// The share of a pixel that a line covers; `away` from its middle.
float Line(float away, float half_width, float pixel) {
  return clamp((half_width - away) / pixel + 0.5, 0.0, 1.0) * min(1.0, 2.0 * half_width / pixel);
}
vec2 AwayFromLines(vec2 at, float period) { return abs(fract(at / period + 0.5) - 0.5) * period; }
float AwayFromLines(float at, float period) { return abs(fract(at / period + 0.5) - 0.5) * period; }
vec3 Lit(vec3 colour) {
  vec3 from_eye = v_position - u_eye;
  vec3 lit = colour * (vec3(0.36, 0.43, 0.52) + kSunLight * v_sun * 0.62);
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

namespace {

std::string GroundFragmentText() {
  return SurfaceSharedText() + R"(
uniform int u_studio;
// A light floor with a line every half metre, stronger every two.
vec3 Studio(vec2 p, vec2 pixel) {
  vec2 small = AwayFromLines(p, 0.5), large = AwayFromLines(p, 2.0);
  float grid = max(Line(small.x, 0.003, pixel.x), Line(small.y, 0.003, pixel.y)) * 0.35;
  grid = max(grid, max(Line(large.x, 0.006, pixel.x), Line(large.y, 0.006, pixel.y)) * 0.6);
  float near = 1.0 / (1.0 + 0.035 * dot(p, p));
  vec3 colour = mix(vec3(0.20, 0.215, 0.235), vec3(0.285, 0.29, 0.295), near);
  return mix(colour, vec3(0.46, 0.50, 0.54), grid);
}
void main() {
  vec2 p = v_position.xy;
  vec2 pixel = fwidth(p) + 1e-5;
  if (u_studio != 0) {
    o_colour = WithGrain(ToScreen(Lit(Studio(p, pixel))));
    return;
  }
  // Mown in stripes 5 m wide.
  vec2 stripe = clamp((AwayFromLines(p + 2.5, 10.0) - 2.5) / max(pixel, vec2(0.05)), -0.5, 0.5);
  vec3 colour = mix(vec3(0.150, 0.280, 0.075), vec3(0.190, 0.325, 0.092),
                    0.5 + 0.7 * stripe.x + 0.3 * stripe.y);
  vec2 small = AwayFromLines(p, 1.0), large = AwayFromLines(p, 5.0);
  float grid = max(Line(small.x, 0.01, pixel.x), Line(small.y, 0.01, pixel.y)) * 0.25;
  grid = max(grid, max(Line(large.x, 0.022, pixel.x), Line(large.y, 0.022, pixel.y)) * 0.5);
  o_colour = WithGrain(ToScreen(Lit(mix(colour, vec3(0.52, 0.64, 0.36), grid))));
}
)";
}

std::string RibbonFragmentText() {
  return SurfaceSharedText() + R"(
in vec4 v_track;
uniform vec2 u_fade;  // Along the track: from where to where it fades away; equal: it does not.
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
  // Two tones a metre apart, hardly seen, that show the speed.
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
  colour = kind > 3.5 ? vec3(0.90, 0.62, 0.05) : colour;
  o_colour = WithGrain(ToScreen(Lit(colour)));
  if (u_fade.y > u_fade.x) o_colour.a = 1.0 - smoothstep(u_fade.x, u_fade.y, v_track.x);
}
)";
}

}  // namespace

std::string SurfaceFragmentText(bool ribbon) {
  return ribbon ? RibbonFragmentText() : GroundFragmentText();
}

std::string MarkVertexText() {
  return SharedText() + R"(
uniform vec3 u_centre;
uniform vec3 u_slope;  // Rise a metre along x and y.
uniform float u_span;
out vec3 v_position;
out vec2 v_at;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  v_at = 0.5 + 0.5 * corner;
  vec2 away = 0.5 * u_span * corner;
  v_position = u_centre + vec3(away, dot(away, u_slope.xy) + 0.009);  // Over the paint.
  gl_Position = u_clip_from_world * vec4(v_position, 1.0);
}
)";
}

std::string MarkFragmentText() {
  return SharedText() + R"(
uniform sampler2D u_shadow;
uniform vec4 u_blobs[)" +
         std::to_string(kMaxBlobs) + R"(];  // x, y, radius, darkness
uniform int u_blob_count;
uniform vec4 u_rings[)" +
         std::to_string(kMaxFootholds) + R"(];  // x, y, z
uniform int u_ring_count;
in vec3 v_position;
in vec2 v_at;
out vec4 o_colour;
void main() {
  vec2 inside = min(v_at, 1.0 - v_at);
  float edge = clamp(min(inside.x, inside.y) * 12.0, 0.0, 1.0);
  float shadow = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float weight = (2.0 - abs(float(x))) * (2.0 - abs(float(y)));
      shadow += weight * textureLod(u_shadow, v_at + 0.0095 * vec2(x, y), 2.3).r;
    }
  }
  float light = 1.0 - 0.56 * shadow / 16.0;
  for (int i = 0; i < u_blob_count; ++i) {
    vec2 away = (v_position.xy - u_blobs[i].xy) / u_blobs[i].z;
    light *= 1.0 - u_blobs[i].w * exp(-2.2 * dot(away, away));
  }
  float ring = 0.0;
  for (int i = 0; i < u_ring_count; ++i) {
    float away = distance(v_position.xy, u_rings[i].xy);
    float rim = (away - 0.13) / 0.016;
    ring += exp(-rim * rim) + 0.30 * exp(-100.0 * away * away);
  }
  // The picture holds square roots of light; what lies over it takes a share of it away.
  ring = min(ring, 1.0) * 0.75 * edge;
  float dark = (1.0 - sqrt(light)) * edge;
  o_colour = vec4(vec3(1.0, 0.96, 0.74) * ring, 1.0 - (1.0 - dark) * (1.0 - ring));
}
)";
}

}  // namespace footing::render
