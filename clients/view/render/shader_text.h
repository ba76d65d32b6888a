#pragma once

#include <string>

/// The shaders' texts. World frame W; light and colours are linear until the last line.
namespace footing::render {

inline constexpr int kMaxBlobs = 16;
inline constexpr int kMaxFootholds = 4;
inline constexpr float kMarkSpanM = 3.6f;  ///< Side of the square of ground that a bird marks.

std::string PartVertexText();
std::string PartFragmentText();
std::string PartIdFragmentText();
/// Parts projected along the sun onto the floor: the bird's shadow.
std::string ShadowVertexText();
std::string ShadowFragmentText();
std::string GroundVertexText();
std::string RibbonVertexText();
/// Ground and track alike; `ribbon` chooses.
std::string SurfaceFragmentText(bool ribbon);
/// Shadow, soft spots and rings: a square laid over the ground, with alpha.
std::string MarkVertexText();
std::string MarkFragmentText();
std::string SkyVertexText();
std::string SkyFragmentText();

/// Shared by the texts above: version, frame uniforms, sky, fog, output.
std::string SharedText();
/// For fragment shaders of wide areas: a pattern of one step of eight bits, so that a slow change
/// of tone shows no bands.
std::string GrainText();

}  // namespace footing::render
