#pragma once

#include <string>

#include "common/model/model.h"
#include "common/base/result.h"
#include "daemon/simulation/cascade/network.h"

namespace footing::cascade {

/// Appends the network's tensors, each name behind `prefix` ("x." and "y." where a model holds
/// several): sizes [4] {inputs, hidden, outputs, 1 if outputs are sigmoid}, input_mean,
/// input_scale, hidden_weights, output_weights, output_mean, output_scale.
void AppendTensors(const CascadeNetwork& network, const std::string& prefix, model::Model& model);

/// The network whose tensors stand behind `prefix`, checked; `origin` names the file.
Result<CascadeNetwork> FromTensors(const model::Model& model, const std::string& prefix,
                                   const std::string& origin);

}  // namespace footing::cascade
