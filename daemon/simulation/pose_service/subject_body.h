#pragma once

#include "common/body/body.h"
#include "common/base/result.h"
#include "common/runtime/subject.h"

namespace footing::pose_service {

using subject::Subject;

/// The standard person of the subject's height, weight and feet. A weight that is not known is
/// 22.5 kg/m^2 until the T-pose has weighed it.
Result<body::Body> MakeSubjectBody(const Subject& subject);

}  // namespace footing::pose_service
