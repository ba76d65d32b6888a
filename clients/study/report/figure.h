#pragma once

#include <string>
#include <vector>

#include "clients/study/report/measures.h"

namespace footing::study::report {

/// Marks of an axis, evenly spaced at 1, 2 or 5 times a power of ten, that enclose both values.
std::vector<double> Ticks(double least, double greatest);

/// A measure as SVG: a point for each value, a box from the lower to the upper quartile with the
/// median for each interface, and a line that joins the values of each participant.
std::string Figure(const Measure& measure, const plan::Protocol& protocol);

/// With the characters that HTML reserves replaced.
std::string Escaped(const std::string& text);

}  // namespace footing::study::report
