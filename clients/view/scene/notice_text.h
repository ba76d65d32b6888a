#pragma once

#include <cstdint>
#include <string>

#include "clients/view/scene/model.h"

namespace footing::scene {

/// What slows a source's server, if it said so within the last 30 s; empty: nothing.
std::string NoticeText(const Model& model, int source, std::int64_t now_ns);

/// Of all servers, at the end of a log's line, for 3 s: a line comes every second.
std::string NoticesOfLogLine(const Model& model, std::int64_t now_ns);

}  // namespace footing::scene
