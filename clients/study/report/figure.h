#pragma once

#include <string>
#include <vector>

#include "clients/study/report/measures.h"

/// Figures as SVG that stands in an HTML page: classes take their colours from the page's style.
namespace footing::study::report {

/// Marks of an axis, evenly spaced at 1, 2 or 5 times a power of ten, that enclose both values; of
/// counts at whole numbers.
std::vector<double> Ticks(double least, double greatest, bool counts = false);

/// The box of an interface: between the lower and the upper quartile.
struct Quartiles {
  double low = 0;
  double median = 0;
  double high = 0;
};
/// `values` has one at least.
Quartiles QuartilesOf(const std::vector<double>& values);

/// A measure: a point for each value, a box with the median for each interface, and a line that
/// joins the values of each participant.
std::string Figure(const Measure& measure, const plan::Protocol& protocol);

/// The opening of a figure of this size, px; `title` is read out to those who do not see it.
std::string OpenSvg(double width, double height, const std::string& title);
/// `anchor` is "start", "middle" or "end".
std::string Label(double x, double y, const std::string& anchor, const std::string& text);
/// With the characters that HTML reserves replaced.
std::string Escaped(const std::string& text);

}  // namespace footing::study::report
