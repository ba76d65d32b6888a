#include "clients/view/render/world.h"

#include <algorithm>

#include "clients/view/scene/part.h"
#include "clients/view/scene/ribbon.h"

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

// Softened once in a small picture: a software renderer pays for every pixel of the mark.
std::string SoftVertexText() {
  return SharedText() + R"(
out vec2 v_at;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  v_at = 0.5 + 0.5 * corner;
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";
}

std::string SoftFragmentText() {
  return SharedText() + R"(
uniform sampler2D u_shadow;
uniform vec3 u_centre;
uniform float u_span;
uniform vec4 u_blobs[)" +
         std::to_string(kMaxBlobs) + R"(];  // x, y, radius, darkness
uniform int u_blob_count;
in vec2 v_at;
out vec4 o_colour;
void main() {
  float shadow = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float weight = (2.0 - abs(float(x))) * (2.0 - abs(float(y)));
      shadow += weight * textureLod(u_shadow, v_at + 0.0095 * vec2(x, y), 1.3).r;
    }
  }
  float light = 1.0 - 0.56 * shadow / 16.0;
  vec2 place = u_centre.xy + u_span * (v_at - 0.5);
  for (int i = 0; i < u_blob_count; ++i) {
    vec2 away = (place - u_blobs[i].xy) / u_blobs[i].z;
    light *= 1.0 - u_blobs[i].w * exp(-2.2 * dot(away, away));
  }
  // The picture holds square roots of light; what lies over it takes a share of it away.
  o_colour = vec4(sqrt(light));
}
)";
}

std::string MarkFragmentText() {
  return SharedText() + R"(
uniform sampler2D u_soft;
uniform vec4 u_rings[)" +
         std::to_string(kMaxFootholds) + R"(];  // x, y, z
uniform int u_ring_count;
in vec3 v_position;
in vec2 v_at;
out vec4 o_colour;
void main() {
  vec2 inside = min(v_at, 1.0 - v_at);
  float edge = clamp(min(inside.x, inside.y) * 12.0, 0.0, 1.0);
  float ring = 0.0;
  for (int i = 0; i < u_ring_count; ++i) {
    float away = distance(v_position.xy, u_rings[i].xy);
    float rim = (away - 0.13) / 0.016;
    ring += exp(-rim * rim) + 0.30 * exp(-100.0 * away * away);
  }
  ring = min(ring, 1.0) * 0.75 * edge;
  float dark = (1.0 - texture(u_soft, v_at).r) * edge;
  o_colour = vec4(vec3(1.0, 0.96, 0.74) * ring, 1.0 - (1.0 - dark) * (1.0 - ring));
}
)";
}

namespace {

constexpr float kStudioLamp = 0.55f;
constexpr float kGhostOpacity = 0.55f;
constexpr float kClearOpacity = 0.38f;
constexpr float kHiddenOpacity = 0.55f;
// The shadow of a bird falls this far beside it: its middle is 0.9 m high.
const Eigen::Vector3f kToShadowM(0.45f, -0.60f, 0);

Eigen::Matrix4f ClipFromWorld(const scene::Picture& picture, int width, int height) {
  const double aspect = static_cast<double>(width) / std::max(height, 1);
  return picture.camera.Projection(aspect) * picture.camera.View();
}

}  // namespace

Result<World> World::Create() {
  const std::string parts = PartVertexText();
  auto part = Program::Create("part", parts, PartFragmentText());
  if (!part) return part.error();
  auto part_id = Program::Create("part id", parts, PartIdFragmentText());
  if (!part_id) return part_id.error();
  auto shadow = Program::Create("shadow", ShadowVertexText(), ShadowFragmentText());
  if (!shadow) return shadow.error();
  auto ground = Program::Create("ground", GroundVertexText(), SurfaceFragmentText(false));
  if (!ground) return ground.error();
  auto ribbon = Program::Create("ribbon", RibbonVertexText(), SurfaceFragmentText(true));
  if (!ribbon) return ribbon.error();
  auto soft = Program::Create("soft shadow", SoftVertexText(), SoftFragmentText());
  if (!soft) return soft.error();
  auto mark = Program::Create("mark", MarkVertexText(), MarkFragmentText());
  if (!mark) return mark.error();
  auto sky = Program::Create("sky", SkyVertexText(), SkyFragmentText());
  if (!sky) return sky.error();
  return World({std::move(*part), std::move(*part_id), std::move(*shadow), std::move(*ground),
                std::move(*ribbon), std::move(*soft), std::move(*mark), std::move(*sky)});
}

World::World(Programs programs) : programs_(std::move(programs)) { sky_.Upload(scene::BuildSky()); }

void World::DrawSky(const Eigen::Vector3f& eye, const Eigen::Matrix4f& clip_from_world) {
  programs_.sky.Use();
  programs_.sky.Set("u_eye", eye);
  programs_.sky.Set("u_clip_from_world", clip_from_world);
  sky_.Draw();
}

void World::DrawGhosts(const scene::PartList& parts, float opacity) {
  programs_.part.Set("u_opacity", opacity);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  shapes_.Draw(programs_.part, parts, false);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  shapes_.Draw(programs_.part, parts, false);
  glDisable(GL_BLEND);
  programs_.part.Set("u_opacity", 1.0f);
}

void World::DrawClear(const scene::PartList& parts) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  programs_.part.Set("u_opacity", kClearOpacity);
  programs_.part.Set("u_plain", 1.0f);
  shapes_.Draw(programs_.part, parts, false);
  programs_.part.Set("u_plain", 0.0f);
  programs_.part.Set("u_opacity", 1.0f);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void World::DrawSigns(const scene::PartList& parts) {
  programs_.part.Set("u_plain", 0.6f);
  shapes_.Draw(programs_.part, parts, true);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  programs_.part.Set("u_opacity", kHiddenOpacity);
  shapes_.Draw(programs_.part, parts, true);
  programs_.part.Set("u_opacity", 1.0f);
  programs_.part.Set("u_plain", 0.0f);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_BLEND);
}

// Over the finished ground, where the birds are: a software renderer pays for every pixel.
void World::DrawMarks(const scene::Picture& picture, const Eigen::Vector3f& eye,
                      const Eigen::Matrix4f& clip_from_world) {
  std::vector<Eigen::Vector4f> blobs, rings;
  for (const scene::Blob& blob : picture.blobs) {
    if (blobs.size() < kMaxBlobs) {
      blobs.emplace_back(blob.position_m.x(), blob.position_m.y(), blob.radius_m, blob.darkness);
    }
  }
  for (const Eigen::Vector3f& p : picture.footholds) {
    if (rings.size() < kMaxFootholds) rings.emplace_back(p.x(), p.y(), p.z(), 0);
  }
  for (const scene::Spot& spot : picture.spots) {
    const Eigen::Vector3f beside(kToShadowM.x(), kToShadowM.y(),
                                 kToShadowM.head<2>().dot(spot.slope));
    const Eigen::Vector3f centre = spot.centre_m + beside;
    shadow_map_.Draw(programs_.shadow, shapes_, picture.figures, centre);
    glBindVertexArray(nothing_.name());
    shadow_map_.Soften(programs_.soft, blobs, centre);
    const Program& program = programs_.mark;
    program.Use();
    program.Set("u_clip_from_world", clip_from_world);
    program.Set("u_eye", eye);
    program.Set("u_centre", centre);
    program.Set("u_slope", Eigen::Vector3f(spot.slope.x(), spot.slope.y(), 0));
    program.Set("u_span", kMarkSpanM);
    program.Set("u_soft", 0);
    program.Set("u_rings", rings);
    program.Set("u_ring_count", static_cast<int>(rings.size()));
    shadow_map_.Bind();
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
  }
}

void World::DrawTrack(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world) {
  if (track_.empty()) return;
  const Program& program = programs_.ribbon;
  program.Use();
  program.Set("u_clip_from_world", clip_from_world);
  program.Set("u_eye", Eigen::Vector3f(picture.camera.eye_m.cast<float>()));
  program.Set("u_fade", Eigen::Vector2f(fade_.from_m, fade_.to_m));
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  if (Fades()) glEnable(GL_BLEND);
  track_.Draw();
  glDisable(GL_BLEND);
}

void World::DrawGround(const scene::Picture& picture, const Eigen::Matrix4f& clip_from_world) {
  const Program& program = programs_.ground;
  program.Use();
  program.Set("u_clip_from_world", clip_from_world);
  program.Set("u_eye", Eigen::Vector3f(picture.camera.eye_m.cast<float>()));
  program.Set("u_ground", picture.ground_m);
  program.Set("u_studio", picture.studio ? 1 : 0);
  glBindVertexArray(nothing_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void World::Draw(const scene::Picture& picture, const stream::Track& track,
                 std::uint64_t track_version, int width, int height, int left, int bottom) {
  if (track_version != track_version_) {
    track_version_ = track_version;
    track_.Upload(scene::BuildRibbon(track));
    fade_ = scene::FadeOf(track);
  }
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glViewport(left, bottom, width, height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glClear(GL_DEPTH_BUFFER_BIT);

  // Front to back: birds, track, ground, and the sky where nothing else is.
  const Eigen::Matrix4f clip_from_world = ClipFromWorld(picture, width, height);
  const Eigen::Vector3f eye = picture.camera.eye_m.cast<float>();
  programs_.part.Use();
  programs_.part.Set("u_clip_from_world", clip_from_world);
  programs_.part.Set("u_eye", eye);
  programs_.part.Set("u_floor", picture.floor_m);
  programs_.part.Set("u_opacity", 1.0f);
  programs_.part.Set("u_plain", 0.0f);
  programs_.part.Set("u_lamp", picture.studio ? kStudioLamp : 0.0f);
  shapes_.Draw(programs_.part, picture.figures, false);
  shapes_.Draw(programs_.part, picture.forces, true);
  // A track that fades shows the ground behind it.
  if (!Fades()) DrawTrack(picture, clip_from_world);
  DrawGround(picture, clip_from_world);
  if (Fades()) DrawTrack(picture, clip_from_world);
  DrawSky(eye, clip_from_world);
  DrawMarks(picture, eye, clip_from_world);
  programs_.part.Use();
  DrawClear(picture.clear);
  DrawGhosts(picture.ghosts, kGhostOpacity);
  DrawSigns(picture.signs);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
}

void World::DrawIds(const scene::Picture& picture, int width, int height) {
  glViewport(0, 0, width, height);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  programs_.part_id.Use();
  programs_.part_id.Set("u_clip_from_world", ClipFromWorld(picture, width, height));
  programs_.part_id.Set("u_id", static_cast<int>(scene::PartId::kBird));
  shapes_.Draw(programs_.part_id, picture.figures, true);
  programs_.part_id.Set("u_id", static_cast<int>(scene::PartId::kForce));
  shapes_.Draw(programs_.part_id, picture.forces, true);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace footing::render
