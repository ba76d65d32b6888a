#pragma once

#include <string>
#include <vector>

#include "clients/study/report/analysis.h"

namespace footing::study::report {

/// The report as one HTML page that needs no other file: for each measure its figure, its numbers
/// and its tests, then the free-text answers.
std::string Page(const Analysis& analysis, const plan::Protocol& protocol,
                 const std::vector<records::Records>& people);

/// The same numbers as lines of text.
std::string Summary(const Analysis& analysis);

}  // namespace footing::study::report
