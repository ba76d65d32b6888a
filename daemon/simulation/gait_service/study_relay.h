#pragma once

#include <cstdint>
#include <optional>

#include "common/stream/study.h"
#include "common/net/server.h"
#include "footing/v1/command.pb.h"

namespace footing::gait_service {

/// Hands on where a study's session stands, from the client that leads it to everybody's screen. It
/// is forgotten when that client's session ends.
class StudyRelay {
 public:
  /// SetStudy. Refused, with the reason, where a text is too long or a number not finite.
  v1::CommandResult OnSetStudy(const transport::SessionInfo& who, const v1::SetStudy& message);
  void OnSessionEnd(const transport::SessionInfo& who);

  /// The state to publish, once after each change.
  std::optional<stream::StudyState> TakeChange();

 private:
  stream::StudyState study_;
  std::uint64_t session_ = 0;  ///< That sent it; 0: none.
  bool changed_ = false;
};

}  // namespace footing::gait_service
