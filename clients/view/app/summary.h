#pragma once

#include <string>

#include "clients/view/scene/model.h"

namespace footing::view {

/// What a run has seen, as one JSON object.
std::string Summary(const scene::Model& model, double seconds);

}  // namespace footing::view
