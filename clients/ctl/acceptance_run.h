#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "clients/ctl/commands.h"
#include "common/base/result.h"
#include "common/guide/acceptance.h"
#include "common/guide/recent.h"
#include "footing/v1/session.pb.h"

namespace footing::ctl {

/// Options of an acceptance run.
struct AcceptanceOptions {
  std::string rig = "main";
  double minutes = 10;
  std::string out;  ///< The recording.
  bool replace = false;
  bool script = false;
};

/// Result of an acceptance run: its checks and the recording they were made on.
struct AcceptanceVerdict {
  std::vector<guide::Check> checks;
  std::string recording;
};

/// Leads through the phases, records everything that footingd sends meanwhile and keeps the verdict
/// in the recording's metadata "acceptance".
Result<AcceptanceVerdict> RunAcceptance(Connection& session, const AcceptanceOptions& options);

/// Computes the checks again from a recording that RunAcceptance made. InvalidData when it is none.
Result<AcceptanceVerdict> ReplayAcceptance(const std::string& path);

/// {x_m, y_m, yaw_rad}
nlohmann::ordered_json BoardPoseJson(const stream::BoardPose& pose);

/// Metadata "acceptance" of a recording: rig, layout, phases and the verdict, so that it can be
/// computed again.
std::map<std::string, std::string> AcceptanceMetadata(const std::string& rig,
                                                      const stream::BoardLayout& layout,
                                                      const std::vector<guide::Span>& spans,
                                                      const std::vector<guide::Check>& checks);

/// Plan of an acceptance run: rig, layout of the boards and spans of the motions.
struct AcceptancePlan {
  std::string rig;
  stream::BoardLayout layout;
  std::vector<guide::Span> spans;
};

/// The other way round; InvalidData says what is missing.
Result<AcceptancePlan> ReadAcceptanceMetadata(const std::map<std::string, std::string>& metadata);

}  // namespace footing::ctl
