#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <imgui.h>

#include "clients/view/scene/pointer.h"
#include "clients/view/scene/update.h"
#include "common/stream/device.h"

namespace footing::render {

/// Letters, in pixels of the picture.
struct Fonts {
  ImFont* tiny = nullptr;  ///< Labels of axes.
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

/// Colours of a gait, of a device's state and of a connection's state.
ImU32 ColourOf(stream::Gait gait);
ImU32 ColourOf(stream::DeviceState state);
ImU32 ColourOf(scene::LinkState state);
/// Green, amber above 50 ms, red above 150 ms.
ImU32 ColourOfAge(double age_ms);

/// A rectangle in pixels; y runs down.
struct Box {
  ImVec2 low{0, 0};
  ImVec2 high{0, 0};

  float width() const { return high.x - low.x; }
  float height() const { return high.y - low.y; }
};

/// Draws on one list with one set of letters. Lengths are in units (HudScale); `scale` turns them
/// into pixels.
struct Paint {
  ImDrawList* list = nullptr;
  Fonts fonts;
  float scale = 1;
  ImTextureID camera_picture = nullptr;  ///< Texture of the preview; null: none.
  scene::TimeWindow window = {};         ///< Time that the strips show.
  std::optional<ImVec2> pointer = {};    ///< The mouse, pixels; nothing: nowhere over the picture.

  /// A dark rounded panel; returns what is left inside its margins.
  Box Panel(const Box& box) const;
  /// Writes at a point, which is the text's upper left corner; returns the text's width.
  float Write(ImFont* font, ImVec2 at, ImU32 colour, std::string_view text) const;
  /// Writes with the point at the upper right corner.
  float WriteRight(ImFont* font, ImVec2 at, ImU32 colour, std::string_view text) const;
  float WriteCentred(ImFont* font, ImVec2 at, ImU32 colour, std::string_view text) const;
  float WidthOf(ImFont* font, std::string_view text) const;
  /// The text cut to fit, with an ellipsis.
  std::string Fitting(ImFont* font, const std::string& text, float width) const;
  /// The text in lines of at most that width, broken at blanks.
  std::vector<std::string> Wrapped(ImFont* font, const std::string& text, float width) const;
  /// A filled rounded label; returns its width.
  float Label(ImVec2 at, ImU32 fill, ImU32 letters, std::string_view text) const;
  /// A groove with a filled share in [0, 1].
  void Bar(const Box& box, float share, ImU32 colour) const;
  void Dot(ImVec2 centre, float radius, ImU32 colour) const;
};

/// The colour with another opacity, 0 to 1.
ImU32 Faded(ImU32 colour, float opacity);

}  // namespace footing::render
