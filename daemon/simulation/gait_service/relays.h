#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/net/server.h"
#include "common/stream/game.h"
#include "common/stream/study.h"
#include "footing/v1/command.pb.h"

namespace footing::gait_service {

/// Hands on where a study's session stands, from the client that leads it to everybody's screen. It
/// is forgotten when that client's session ends. A countdown is sent again each second with what is
/// left of it, since a screen that joins gets what was sent last.
class StudyRelay {
 public:
  /// SetStudy. Refused, with the reason, where a text is too long or a number not finite.
  v1::CommandResult OnSetStudy(const transport::SessionInfo& who, const v1::SetStudy& message);
  void OnSessionEnd(const transport::SessionInfo& who);

  /// The state to publish: after each change, and as a countdown goes on.
  std::optional<stream::StudyState> TakeChange(std::int64_t now_ns);

 private:
  stream::StudyState study_;
  std::uint64_t session_ = 0;  ///< That sent it; 0: none.
  bool changed_ = false;
  std::int64_t begun_ns_ = 0;  ///< When the state was published first, and
  std::int64_t sent_ns_ = 0;   ///< when last.
};

/// Hands the terrain game's state on from the client that leads it to everybody, and keeps all
/// others from changing the track meanwhile. The lead is a session's: it ends with it.
class GameRelay {
 public:
  /// SetGame. Refused, with the reason, for a state that cannot be and while another session leads.
  v1::CommandResult OnSetGame(const transport::SessionInfo& who, const v1::SetGame& message);
  void OnSessionEnd(const transport::SessionInfo& who);

  /// The refusal of a command that would change the track of a game that another session leads;
  /// nothing when it may be carried out.
  std::optional<v1::CommandResult> Refuse(const transport::SessionInfo& who,
                                          const v1::Command& command) const;

  /// True once after a game that was under way has lost its leader: nobody adds to its track any
  /// more, so its trial is to be stopped.
  bool TakeLeft();

  /// The state to publish, once after each change.
  std::optional<stream::GameState> TakeChange();

 private:
  void Leave();

  stream::GameState game_;
  std::uint64_t leader_ = 0;  ///< Its session; 0: nobody.
  bool changed_ = false;
  bool left_ = false;
};

}  // namespace footing::gait_service
