#include "clients/view/render/shader_text.h"

#include "clients/view/scene/sky.h"

namespace footing::render {

namespace {

std::string Vec3(const scene::Colour& c) {
  return "vec3(" + std::to_string(c.x()) + ", " + std::to_string(c.y()) + ", " +
         std::to_string(c.z()) + ")";
}

}  // namespace

// Software renderers run these for every pixel: no pow and exp where a root or a quotient will do.
std::string SharedText() {
  return "#version 330 core\nconst vec3 kHorizon = " + Vec3(scene::kHorizonLight) +
         ";\nconst vec3 kZenith = " + Vec3(scene::kZenithLight) + R"(;
uniform mat4 u_clip_from_world;
uniform vec3 u_eye;
const vec3 kSun = vec3(-0.40, 0.52, 0.755);  // Of length 1 within 0.1 %.
const vec3 kSunLight = vec3(1.75, 1.55, 1.25);

vec3 SkyLight(vec3 direction) {
  float up = clamp(direction.z, 0.0, 1.0);
  return mix(kHorizon, kZenith, up * (2.0 - up));
}
vec3 InFog(vec3 colour, float distance_squared) {
  float clear = 1.0 / (1.0 + distance_squared * 0.00009);
  return mix(kHorizon, colour, clear * clear);
}
vec4 ToScreen(vec3 colour) { return vec4(sqrt(colour / (1.0 + 0.10 * colour)), 1.0); }
)";
}

std::string GrainText() {
  return R"(
vec4 WithGrain(vec4 colour) {
  // A pattern of two by two pixels, which files of pictures hold in little space.
  ivec2 at = ivec2(gl_FragCoord.xy) & 1;
  float noise = 0.25 * float(2 * (at.x ^ at.y) + at.y) + 0.125;
  return vec4(colour.rgb + (noise - 0.5) / 255.0, colour.a);
}
)";
}

namespace {

std::string InstanceText() {
  return R"(
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_x;
layout(location = 3) in vec4 a_y;
layout(location = 4) in vec4 a_z;
layout(location = 5) in vec4 a_place;
layout(location = 6) in vec4 a_colour_taper;
layout(location = 7) in vec4 a_under_gloss;
vec3 WorldPosition() {
  float narrower = u_kind != 0 ? mix(1.0, a_colour_taper.w, a_position.z) : 1.0;
  vec3 p = vec3(a_position.xy * narrower, a_position.z);
  vec3 world = (mat4(a_x, a_y, a_z, a_place) * vec4(p, 1.0)).xyz;
  // The round end of a limb is as high as the limb is thick, whatever its length.
  float bulge = u_kind == 2 ? a_normal.z * narrower * length(a_x.xyz) : 0.0;
  return world + normalize(a_z.xyz) * bulge;
}
)";
}

}  // namespace

std::string PartVertexText() {
  return SharedText() + "uniform int u_kind;\n" + InstanceText() + R"(
out vec3 v_position;
out vec3 v_normal;
out vec3 v_colour;
out float v_gloss;
void main() {
  vec3 n = a_normal;
  if (u_kind == 1 && n.z > -0.5) n.z = 1.0 - a_colour_taper.w;
  if (u_kind == 2) {
    float across = max(length(n.xy), 0.001);
    n.z = n.z * length(a_z.xyz) / length(a_x.xyz) + (1.0 - a_colour_taper.w) * across;
  }
  // The columns are square to each other, so the inverse transpose is each over its square.
  v_normal = a_x.xyz * (n.x / dot(a_x.xyz, a_x.xyz)) + a_y.xyz * (n.y / dot(a_y.xyz, a_y.xyz)) +
             a_z.xyz * (n.z / dot(a_z.xyz, a_z.xyz));
  v_position = WorldPosition();
  v_colour = mix(a_under_gloss.rgb, a_colour_taper.rgb, smoothstep(-0.75, -0.05, a_normal.z));
  v_gloss = a_under_gloss.w;
  gl_Position = u_clip_from_world * vec4(v_position, 1.0);
}
)";
}

std::string PartFragmentText() {
  return SharedText() + R"(
uniform float u_floor;
uniform float u_opacity;
uniform float u_lamp;   // Light that comes from the eye.
uniform float u_plain;  // 1: its own colour, whatever the light.
in vec3 v_position;
in vec3 v_normal;
in vec3 v_colour;
in float v_gloss;
out vec4 o_colour;
void main() {
  vec3 n = normalize(v_normal);
  vec3 to_eye = u_eye - v_position;
  float distance_squared = dot(to_eye, to_eye);
  to_eye *= inversesqrt(distance_squared);
  vec3 sun = kSun;
  float lit = max((dot(n, sun) + 0.28) / 1.28, 0.0);
  float near_floor = clamp((v_position.z - u_floor) * 1.2 + 0.45, 0.45, 1.0);
  vec3 above = vec3(0.44, 0.56, 0.70), below = vec3(0.34, 0.22, 0.15);
  vec3 ambient = mix(below, above, 0.5 + 0.5 * n.z) * near_floor;
  vec3 colour = v_colour * (ambient + kSunLight * lit * lit * 0.75);
  colour += v_colour * u_lamp * max(dot(n, to_eye), 0.0);
  float rim = pow(1.0 - max(dot(n, to_eye), 0.0), 3.0);
  colour += SkyLight(reflect(-to_eye, n)) * rim * 0.20;
  vec3 half_way = normalize(sun + to_eye);
  colour += kSunLight * v_gloss * pow(max(dot(n, half_way), 0.0), 48.0) * 0.55;
  colour = mix(colour, v_colour * 1.6, u_plain);
  o_colour = vec4(ToScreen(InFog(colour, distance_squared)).rgb, u_opacity);
}
)";
}

std::string PartIdFragmentText() {
  return SharedText() + R"(
uniform int u_id;
out vec4 o_colour;
void main() { o_colour = vec4(float(u_id) / 255.0, 0.0, 0.0, 1.0); }
)";
}

std::string ShadowVertexText() {
  return SharedText() + "uniform int u_kind;\n" + InstanceText() + R"(
uniform vec3 u_centre;
uniform float u_span;
void main() {
  vec3 p = WorldPosition();
  vec3 sun = kSun;
  vec2 on_floor = p.xy - sun.xy * ((p.z - u_centre.z) / sun.z);
  gl_Position = vec4((on_floor - u_centre.xy) / (0.5 * u_span), 0.0, 1.0);
}
)";
}

std::string ShadowFragmentText() {
  return SharedText() + "out vec4 o_colour;\nvoid main() { o_colour = vec4(1.0); }\n";
}

std::string SkyVertexText() {
  return SharedText() + R"(
layout(location = 0) in vec3 a_direction;
layout(location = 1) in vec3 a_colour;
out vec3 v_screen;
void main() {
  v_screen = ToScreen(a_colour).rgb;
  gl_Position = (u_clip_from_world * vec4(u_eye + a_direction, 1.0)).xyww;  // As far as can be.
}
)";
}

std::string SkyFragmentText() {
  return SharedText() + GrainText() + R"(
in vec3 v_screen;
out vec4 o_colour;
void main() { o_colour = WithGrain(vec4(v_screen, 1.0)); }
)";
}

}  // namespace footing::render
