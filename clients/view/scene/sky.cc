#include "clients/view/scene/sky.h"

#include <array>
#include <cmath>

#include "common/base/units.h"

namespace footing::scene {
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
