#pragma once

#include <vector>

#include "common/model/model.h"
#include "common/base/result.h"
#include "daemon/offline/learning/basis.h"
#include "daemon/offline/train/motions.h"

namespace footing::train {

struct TrainedBasis {
  learning::PoseBasis basis;
  Eigen::Index poses = 0;
};

/// Of the clips and their mirror images, on the ground, all persons as if their roots were 1 m high
/// in the T-pose. All clips must have one layout: the error names the first that has not.
Result<TrainedBasis> TrainBasis(const std::vector<Clip>& clips);

/// The basis' tensors and the height of its people.
void AppendBasis(const learning::PoseBasis& basis, model::Model& model);

}  // namespace footing::train
