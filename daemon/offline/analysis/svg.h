#pragma once

#include <array>
#include <string>

/// Plots as SVG text.
namespace footing::plot {

inline constexpr std::array kColours{"#1f5fa8", "#c2571a", "#3d8b37",
                                     "#8a4fa0", "#7a7a7a", "#b8860b"};
inline constexpr const char* kReferenceColour = "#222";

std::string Number(double value);

/// The opening of an SVG of this size, white.
std::string Open(double width, double height);

/// Text with its special characters escaped; `more` are further attributes.
std::string Label(double x, double y, const std::string& anchor, const std::string& text,
                  const std::string& more = "");

std::string Line(double x1, double y1, double x2, double y2, const std::string& colour,
                 const std::string& more = "");

}  // namespace footing::plot
