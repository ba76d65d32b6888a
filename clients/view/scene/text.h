#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clients/view/scene/model.h"
#include "clients/view/scene/update.h"
#include "common/stream/device.h"
#include "common/stream/game.h"
#include "common/stream/study.h"
#include "common/stream/user_interface.h"

namespace footing::scene {

/// A number with that many decimals (0 to 9), as screens show it: "1.5". No locale.
std::string Fixed(double value, int decimals);

/// "falls 3 (curve 2, jump 1), put back by the operator 1": how often the character failed, and
/// why.
std::string FallText(const stream::GaitState& gait);
/// " (curve 2, jump 1)": failures by cause; empty without any.
std::string CauseText(const stream::FailureCounts& failures);
/// A state of a gait controller as a screen shows it: "fall", the second half of a walking step, is
/// "descend", since beside a count of falls it reads like one.
std::string PhaseTitle(const std::string& phase);
/// "WALK"; "-" for kUnspecified.
std::string GaitTitle(stream::Gait gait);

/// Server that one connection waits for and how to start it, in two lines; empty once it is live.
std::vector<std::string> WaitingLines(const LinkReport& link);

/// "slow motion: 1.2 s before the fall", at so many seconds from it, negative before.
std::string ReplayLine(double from_fall_s);

/// The whole state in one screen of plain text, for a terminal.
std::vector<std::string> StatusScreen(const Model& model, std::int64_t now_ns);
/// State of the model in one line, for a log.
std::string StatusLine(const Model& model, std::int64_t now_ns);

/// Notice that the person's devices are silent, for a reader in front of the screen.
struct LostSignal {
  std::string what;    ///< "No signal from the left hand and the right hand".
  std::string effect;  ///< Behaviour of the character meanwhile.
  std::string advice;  ///< Remedy.
};

/// None while all devices of the character's interface are there, and while it follows commands in
/// their place.
std::optional<LostSignal> LostSignalOf(const CharacterPose& pose);

/// All of it in one line; empty: nothing is lost.
std::string LostLine(const CharacterPose& pose);

/// Cause that slows a source's server, if reported within the last 30 s; empty: none.
std::string NoticeText(const Model& model, int source, std::int64_t now_ns);

/// Notices of all servers, at the end of a log line, for 3 s: a line comes every second.
std::string NoticesOfLogLine(const Model& model, std::int64_t now_ns);

// A trial as a person reads it.

/// True for a trial worth showing: somebody named it, or its track has a finish line.
bool ShowsTrial(const stream::TrialState& trial);

/// The trial of a character that the screens show; null: none. While a study's session is led it is
/// the trial of its phase and attempt: what went on before goes on behind the next prompt, but does
/// not belong to it.
const stream::TrialState* ShownTrial(const CharacterPose& pose, const stream::StudyState& study);

/// "trial p07-2 running 12.3 s"; "trial ready".
std::string TrialTitle(const stream::TrialState& trial);

/// Task of the user: "walk to the line, then run: 12 m" before the mark, "now run" behind it, "run:
/// done" at last; empty without a task.
std::string TaskText(const stream::TrialState& trial, const stream::Track& track);

/// "failed attempts 3 (curve 2, jump 1), withdrawn 1, put back by the operator 1".
std::string AttemptText(const stream::TrialState& trial);

/// All of it and the place on the track, a line each.
std::vector<std::string> TrialLines(const stream::TrialState& trial, const stream::Track& track);

// A user interface's belief in words, for screens and logs.

/// "left hand".
std::string RoleText(stream::DeviceRole role);

/// "left hand, head": the roles of these bits.
std::string RolesText(std::uint32_t roles);

/// "hands swing alternately": what the interface believes that the person does.
std::string ActivityText(const stream::InterfaceState& state);

/// Fault of the devices and its remedy; empty when there is none.
std::string ProblemText(const stream::InterfaceState& state);

/// The whole belief in one line; empty without an interface.
std::string InterfaceText(const stream::InterfaceState& state);

/// True while the terrain game is played, and after it until another trial begins. `trial` may be
/// null.
bool ShowsGame(const stream::GameState& game, const stream::TrialState* trial);

/// State of the game: "Round 1 of 2", "Round 2 of 2 begins", "Change the controllers over", "Ben
/// wins".
std::string GameTitle(const stream::GameState& game);

/// Time left, "0:42"; empty where nothing runs out.
std::string GameClock(const stream::GameState& game);

/// Role of the player now, "runs" or "builds"; empty between rounds.
std::string PartText(const stream::GameState& game, std::size_t player);

/// State of the round: "23.4 m, 7 of 9 segments passed, failures 2 (curve 2)"; empty before the
/// first one.
std::string RoundText(const stream::GameState& game);

/// Segment that the builder holds: "next: up 3.2 deg, left 8 deg"; "next: level"; empty without a
/// ghost.
std::string GhostText(const stream::GameState& game);

/// All of it in one line, and a line each.
std::string GameLine(const stream::GameState& game);
std::vector<std::string> GameLines(const stream::GameState& game);

/// A study's session as its experimenter and its participant read it.
bool ShowsStudy(const stream::StudyState& study);

/// "P01, wrist.straight1, attempt 2 (4 of 23)".
std::string StudyTitle(const stream::StudyState& study);

/// Remaining time of a countdown `passed_s` after it was sent, "4:12"; empty without one.
std::string StudyClock(const stream::StudyState& study, double passed_s);

/// "next: wrist.straight2; in motion so far 12.5 min".
std::string StudyNext(const stream::StudyState& study);

/// "keys: s stops it, u undoes the latest failure"; empty without any.
std::string StudyKeys(const stream::StudyState& study);

/// Text for a study's participant on their own screen, or for the players of a game.
struct ParticipantText {
  std::string headline = {};  ///< "Get ready".
  std::string count = {};     ///< Count-in, "3", "2", "1", "Go!", or countdown, "0:42".
  std::string detail = {};    ///< Next step or instruction; may be empty.
  bool aside = false;         ///< The world matters more: a banner at the top.
};

/// Empty while nothing is to be read: in a trial, and where no study says what goes on. `started`:
/// the trial of the phase has begun, so its count-in is over.
std::optional<ParticipantText> ParticipantTextOf(const stream::StudyState& study, double passed_s,
                                                 bool started);

/// Stages of the terrain game for everybody who looks: its title, the countdown, "Go!", the end of
/// a round, the winner. Empty in a round.
std::optional<ParticipantText> GameStage(const stream::GameState& game);

/// Start and finish of a trial with a finish line, where no study and no game has words for them.
std::optional<ParticipantText> TrialStage(const stream::TrialState& trial);

/// The mode of the pose engine and what it leaves out: "paper mode without angular momentum".
std::string ModeText(const BodyState& body);

/// All of it, a line each.
std::vector<std::string> StudyLines(const stream::StudyState& study, double passed_s);

}  // namespace footing::scene
