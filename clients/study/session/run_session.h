#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "clients/study/report/event.h"
#include "clients/study/session/session_context.h"
#include "clients/study/session/trial_run.h"
#include "common/base/result.h"
#include "common/stream/study.h"

namespace footing::study {

/// The phases of a session in their order, from the first one that is not finished.
class SessionRun {
 public:
  explicit SessionRun(SessionContext context);

  /// Runs until the end of the session. After an error the session can go on with another run.
  Result<void> Run();

 private:
  Result<void> RunPhase(const plan::Phase& phase);
  Result<void> Consent();
  Result<void> Demonstrate(const plan::Phase& phase);
  Result<void> Practise(const plan::Phase& phase);
  /// Waits until the time is up or, where that is allowed, Enter is pressed, which the journal
  /// notes.
  Result<void> CountDown(stream::StudyActivity activity, const std::string& what, double duration_s,
                         bool may_end_early);
  Result<void> Rest(const std::string& what, double duration_s);
  /// Rests before a phase in which the participant moves, once they have moved for long enough.
  Result<void> RestWhereDue(const plan::Phase& next);
  double ActiveS() const;
  double UnrestedMin() const;  ///< Time in motion since the last long rest.
  bool NeedsRest() const;
  std::string RestWarning() const;  ///< Empty: none is due.
  /// Attempts of a trial until one counts; first about the one that an interrupted session has
  /// left.
  Result<void> Trial(const plan::Phase& phase);
  Result<std::string> Attempt(const plan::Phase& phase);
  /// After an attended attempt: undoes failures as asked; true when the trial is to be repeated.
  Result<bool> AskToRepeat(const plan::Phase& phase, const std::string& outcome);
  /// Undoes a failure of the attempt that counts for a phase.
  Result<void> Undo(const plan::Phase& phase, std::uint64_t failure);
  /// The participant's own ranges, until they are measured or the experimenter goes on without.
  Result<void> MeasureRanges(const plan::Phase& phase);
  /// The mapping table of an interface: as the journal says, else the protocol's, which the journal
  /// notes; empty: the built-in one.
  Result<std::string> TableOf(const std::string& interface);
  /// The same with what else the protocol chooses of the interface.
  Result<std::string> TableToSend(const std::string& interface);
  Result<void> NoteTable(const std::string& interface, const std::string& by,
                         const std::string& table, const std::string& reason);
  /// Waits until the devices of an interface are as the protocol asks.
  Result<void> CheckDevices(const std::string& interface);
  /// Shows on every experimenter's screen what goes on in the phase, and what may be pressed; on
  /// the participant's, what `activity` means to them.
  void Show(stream::StudyActivity activity, const std::string& doing, const std::string& keys,
            double left_s = 0);
  /// Prints and notes each warning once a session.
  Result<void> Warn(const std::vector<std::string>& warnings);
  /// Connects to both servers where that is due.
  Result<Servers*> Connect();
  /// Once its devices are ready, makes an interface the one in force.
  Result<Servers*> UseInterface(const std::string& interface);

  /// Key of the rest among the printed warnings.
  static constexpr const char* kRestWarning = "rest";
  static constexpr double kSecondsPerMinute = 60;

  SessionContext context_;
  records::Progress progress_;
  ActiveTime active_;
  bool rests_ = false;  ///< The participant has their rest now.
  std::set<std::string> warned_;
  stream::StudyState shown_;
  std::unique_ptr<Servers> servers_;
  std::unique_ptr<TrialEvents> events_;  ///< Events of the newest attempt, until it is settled.
};

/// Runs or resumes the session of a participant: takes the study's lock, checks the disk, opens the
/// journal. `protocol` must have the participant.
Result<void> RunSession(const SessionOptions& options, const plan::Protocol& protocol);

/// Appends an event to a participant's journal, without servers: a withdrawal, or the correction of
/// a failure that the journal has.
Result<void> AppendToSession(const SessionOptions& options, const plan::Protocol& protocol,
                             records::EventKind kind, nlohmann::ordered_json fields);

}  // namespace footing::study
