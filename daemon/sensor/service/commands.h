#pragma once

#include <cstdint>

#include "common/base/result.h"
#include "common/net/lease.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/hub.h"
#include "footing/v1/command.pb.h"

namespace footing::sensor {

/// Carries out one command of a session that may give commands, unless another session has the
/// lease, and says how that went.
v1::CommandResult CarryOut(Hub& hub, lease::LeaseControl& lease, const Config& config,
                           std::uint64_t session, const v1::Command& command, std::int64_t now_ns);

/// The answer to a command that was done, or the reason why not.
inline v1::CommandResult Answer(const v1::Command& command, const Result<void>& done) {
  v1::CommandResult result;
  result.set_id(command.id());
  result.set_ok(done.ok());
  if (!done) result.set_message(done.error().message);
  return result;
}

/// The same with what the command measured.
inline v1::CommandResult AnswerMeasured(const v1::Command& command,
                                        const Result<Measured>& measured) {
  if (!measured) return Answer(command, Result<void>(measured.error()));
  v1::CommandResult result = Answer(command, Result<void>());
  result.set_message(measured->message);
  result.set_residual(measured->residual);
  result.set_unit(measured->unit);
  return result;
}

}  // namespace footing::sensor
