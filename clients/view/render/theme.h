#pragma once

#include <imgui.h>

#include "clients/view/scene/update.h"
#include "common/stream/device.h"

namespace footing::render {

/// Letters, in pixels of the picture.
struct Fonts {
  ImFont* tiny = nullptr;  ///< Of axes.
  ImFont* small = nullptr;
  ImFont* text = nullptr;
  ImFont* strong = nullptr;
  ImFont* heading = nullptr;
  ImFont* title = nullptr;
  ImFont* count = nullptr;  ///< Digits, the colon and "Go!" alone, very large.
};

/// Loads DejaVu Sans, scaled; where it is not installed, ImGui's own letters.
Fonts LoadFonts(float scale);

/// Colours of the panels.
namespace colour {
inline constexpr ImU32 kPanel = IM_COL32(16, 22, 30, 178);
inline constexpr ImU32 kBehindText = IM_COL32(24, 32, 38, 150);
inline constexpr ImU32 kBehindKeys = IM_COL32(16, 22, 30, 190);  // The list lies over the scene.
inline constexpr ImU32 kPanelEdge = IM_COL32(255, 255, 255, 26);
inline constexpr ImU32 kText = IM_COL32(244, 246, 248, 255);
inline constexpr ImU32 kFaint = IM_COL32(170, 182, 194, 255);
inline constexpr ImU32 kGroove = IM_COL32(255, 255, 255, 34);
inline constexpr ImU32 kGood = IM_COL32(102, 212, 140, 255);
inline constexpr ImU32 kWarning = IM_COL32(255, 190, 70, 255);
inline constexpr ImU32 kBad = IM_COL32(255, 92, 92, 255);
inline constexpr ImU32 kAccent = IM_COL32(96, 190, 236, 255);
inline constexpr ImU32 kSecond = IM_COL32(247, 181, 56, 255);
inline constexpr ImU32 kThird = IM_COL32(240, 100, 73, 255);
}  // namespace colour

ImU32 ColourOf(stream::Gait gait);
ImU32 ColourOf(stream::DeviceState state);
ImU32 ColourOf(scene::LinkState state);
/// Green, amber above 50 ms, red above 150 ms.
ImU32 ColourOfAge(double age_ms);

}  // namespace footing::render
