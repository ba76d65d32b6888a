#pragma once

#include <imgui.h>

#include <string>
#include <string_view>
#include <vector>

#include "clients/view/render/theme.h"

namespace footing::render {

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
  ImTextureID camera_picture = nullptr;  ///< Of the preview; null: there is none.

  /// A dark rounded panel; returns what is left inside its margins.
  Box Panel(const Box& box) const;
  /// Writes at a point, which is the text's upper left corner; returns the text's width.
  float Write(ImFont* font, ImVec2 at, ImU32 colour, std::string_view text) const;
  /// The same with the point at the upper right corner.
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
