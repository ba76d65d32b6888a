#include "clients/view/scene/part.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr float kShortestM = 1e-5f;

/// Three axes of length 1 with z along `direction`.
Eigen::Matrix3f AxesAlong(const Eigen::Vector3f& direction) {
  Eigen::Matrix3f axes;
  axes.col(2) = direction.normalized();
  axes.col(0) = axes.col(2).unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

float Linear(std::uint32_t byte) {
  const float value = static_cast<float>(byte) / 255;
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

Eigen::Matrix4f Ellipsoid(const Eigen::Vector3f& centre, const Eigen::Matrix3f& axes,
                          const Eigen::Vector3f& half_axes) {
  Eigen::Matrix4f X = Eigen::Matrix4f::Identity();
  X.topLeftCorner<3, 3>() = axes * half_axes.asDiagonal();
  X.topRightCorner<3, 1>() = centre;
  return X;
}

void PartList::AddBall(const Eigen::Matrix4f& X_WP, const Colour& colour, const Colour& under,
                       float gloss) {
  balls.push_back({X_WP, colour, 1, under, gloss});
}

void PartList::AddRod(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a,
                      float radius_b, const Colour& colour, float gloss) {
  const float length = (b - a).norm();
  if (length < kShortestM) return;
  const Eigen::Matrix4f X = Ellipsoid(a, AxesAlong(b - a), {radius_a, radius_a, length});
  rods.push_back({X, colour, radius_b / radius_a, colour, gloss});
}

void PartList::AddBox(const Eigen::Vector3f& middle, const Eigen::Matrix3f& axes,
                      const Eigen::Vector3f& sides_m, const Colour& colour, float gloss) {
  boxes.push_back({Ellipsoid(middle, axes, sides_m), colour, 1, 0.8f * colour, gloss});
}

void PartList::AddDisc(const Eigen::Vector3f& centre, const Eigen::Vector2f& half_axes_m,
                       float yaw_rad, const Colour& colour) {
  constexpr float kHalfThicknessM = 0.0015f;
  const Eigen::Matrix3f axes =
      Eigen::AngleAxisf(yaw_rad, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  balls.push_back({Ellipsoid(centre, axes, {half_axes_m.x(), half_axes_m.y(), kHalfThicknessM}),
                   colour, 1, colour, 0});
}

void PartList::AddLimb(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a,
                       float radius_b, const Colour& colour, float gloss) {
  const float length = (b - a).norm();
  if (length < kShortestM) return;
  const Eigen::Matrix4f X = Ellipsoid(a, AxesAlong(b - a), {radius_a, radius_a, length});
  limbs.push_back({X, colour, radius_b / radius_a, colour, gloss});
}

void PartList::AddOvalLimb(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                           const Eigen::Vector3f& x_axis, float radius_a, float radius_b,
                           float oval, const Colour& colour, float gloss) {
  const float length = (b - a).norm();
  if (length < kShortestM) return;
  Eigen::Matrix3f axes;
  axes.col(2) = (b - a) / length;
  axes.col(1) = axes.col(2).cross(x_axis).normalized();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  const Eigen::Matrix4f X = Ellipsoid(a, axes, {radius_a, oval * radius_a, length});
  limbs.push_back({X, colour, radius_b / radius_a, colour, gloss});
}

Colour Rgb(std::uint32_t hex) {
  return {Linear((hex >> 16) & 0xff), Linear((hex >> 8) & 0xff), Linear(hex & 0xff)};
}

namespace {

constexpr double kThickM = 0.08;
/// Above the ground that it begins at, so that both faces do not fight for the same pixels.
constexpr double kOverM = 0.01;

}  // namespace

void AddGhostSegment(const stream::GameState& game, PartList& ghosts) {
  if (!game.ghost) return;
  const stream::TrackSegment& segment = *game.ghost;
  const Eigen::Matrix3d axes = (Eigen::AngleAxisd(segment.heading_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-segment.slope_rad, Eigen::Vector3d::UnitY()))
                                   .toRotationMatrix();
  const Eigen::Vector3d middle =
      segment.start_m + 0.5 * segment.length_m * axes.col(0) + (kOverM - kThickM / 2) * axes.col(2);
  const Eigen::Vector3d sides(segment.length_m, segment.width_m, kThickM);
  ghosts.AddBox(middle.cast<float>(), axes.cast<float>(), sides.cast<float>(),
                Rgb(segment.pit ? 0xD83A2E : 0xF7B538));
}

namespace {

constexpr int kColumns = 144;

/// Height of a ridge over the horizon, 0 to 1, by azimuth. Whole numbers of waves, so it closes.
float Ridge(float azimuth_rad, float seed) {
  return 0.5f + 0.26f * std::sin(3 * azimuth_rad + seed) +
         0.15f * std::sin(7 * azimuth_rad + 2.1f * seed) +
         0.07f * std::sin(17 * azimuth_rad + 3.7f * seed) +
         0.02f * std::sin(41 * azimuth_rad + 1.3f * seed);
}

Colour SkyAt(float elevation) {
  const float share = 1 - std::exp(-4.2f * std::max(elevation, 0.0f));
  return kHorizonLight + share * (kZenithLight - kHorizonLight);
}

float AzimuthOf(int column) {
  return static_cast<float>(2 * kPi) * static_cast<float>(column) / kColumns;
}

SkyVertex VertexAt(float azimuth_rad, float elevation, const Colour& colour) {
  const float level = std::sqrt(std::max(0.0f, 1 - elevation * elevation));
  return {{level * std::cos(azimuth_rad), level * std::sin(azimuth_rad), elevation}, colour};
}

/// Joins the last two rows of vertices.
void JoinRows(SkyMesh& mesh) {
  const auto row = static_cast<std::uint32_t>(kColumns + 1);
  const auto upper = static_cast<std::uint32_t>(mesh.vertices.size()) - row, lower = upper - row;
  for (std::uint32_t i = 0; i + 1 < row; ++i) {
    mesh.indices.insert(mesh.indices.end(), {lower + i, lower + i + 1, upper + i + 1, lower + i,
                                             upper + i + 1, upper + i});
  }
}

void AddDome(SkyMesh& mesh) {
  constexpr std::array<float, 11> kRows{-0.1f, 0,     0.03f, 0.07f, 0.12f, 0.18f,
                                        0.26f, 0.36f, 0.5f,  0.75f, 1};
  for (std::size_t row = 0; row < kRows.size(); ++row) {
    for (int column = 0; column <= kColumns; ++column) {
      mesh.vertices.push_back(VertexAt(AzimuthOf(column), kRows[row], SkyAt(kRows[row])));
    }
    if (row > 0) JoinRows(mesh);
  }
}

/// Pale at its foot, where the haze is, and of its own colour along the ridge.
void AddHills(SkyMesh& mesh, float height, float seed, const Colour& colour) {
  const Colour foot = kHorizonLight;
  for (const float share : {-0.3f, 0.15f, 1.0f}) {
    for (int column = 0; column <= kColumns; ++column) {
      const float azimuth_rad = AzimuthOf(column);
      const float top = height * Ridge(azimuth_rad, seed);
      mesh.vertices.push_back(VertexAt(azimuth_rad, share < 0 ? share * height : share * top,
                                       share < 0.5f ? foot : colour));
    }
    if (share > 0) JoinRows(mesh);
  }
}

}  // namespace

SkyMesh BuildSky() {
  SkyMesh mesh;
  AddDome(mesh);
  AddHills(mesh, 0.100f, 1, kHorizonLight + 0.55f * (Colour(0.24f, 0.42f, 0.58f) - kHorizonLight));
  AddHills(mesh, 0.055f, 4, kHorizonLight + 0.62f * (Colour(0.16f, 0.34f, 0.30f) - kHorizonLight));
  return mesh;
}

}  // namespace footing::scene
