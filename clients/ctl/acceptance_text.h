#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/guide/acceptance.h"
#include "common/guide/layout.h"
#include "common/base/result.h"
#include "footing/v1/session.pb.h"

namespace footing::ctl {

/// {x_m, y_m, yaw_rad}
nlohmann::ordered_json BoardPoseJson(const stream::BoardPose& pose);

/// Hands a tick's content to the measurement; the same live and out of a recording.
void TakeTick(const v1::Tick& tick, guide::Acceptance& acceptance);

/// Metadata "acceptance" of a recording: rig, layout, phases and the verdict, so that it can be
/// computed again.
std::map<std::string, std::string> AcceptanceMetadata(const std::string& rig,
                                                      const stream::BoardLayout& layout,
                                                      const std::vector<guide::Span>& spans,
                                                      const std::vector<guide::Check>& checks);

struct AcceptancePlan {
  std::string rig;
  stream::BoardLayout layout;
  std::vector<guide::Span> spans;
};

/// The other way round; InvalidData says what is missing.
Result<AcceptancePlan> ReadAcceptanceMetadata(const std::map<std::string, std::string>& metadata);

}  // namespace footing::ctl
