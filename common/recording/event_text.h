#pragma once

#include <string>

#include "footing/v1/session.pb.h"

namespace footing::recording {

/// An event as one text, such as "KIND_TRIAL: text"; a client's marker as its text alone, with its
/// value behind it.
std::string EventText(const v1::Event& event);

}  // namespace footing::recording
