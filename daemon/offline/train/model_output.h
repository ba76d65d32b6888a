#pragma once

#include <string>

#include "common/model/model.h"
#include "common/result/result.h"

namespace footing::train {

/// Writes the model file; an existing one only with `force`.
Result<void> WriteModel(const model::Model& model, const std::string& path, bool force);

}  // namespace footing::train
