#pragma once

#include <string>

#include "clients/study/plan/protocol.h"
#include "clients/study/report/measures.h"

namespace footing::study::report {

/// What must be known of the values of a measure before its tests are believed, in sentences;
/// empty: nothing.
std::string NoteOn(const Measure& measure, const plan::Protocol& protocol);

}  // namespace footing::study::report
