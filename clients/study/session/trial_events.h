#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "clients/study/session/anticipation.h"
#include "clients/study/session/heading.h"
#include "clients/study/session/servers.h"
#include "clients/study/session/session_context.h"
#include "clients/study/session/trial_tracker.h"
#include "common/base/result.h"

namespace footing::study {

/// What footing-sim publishes during a trial: failures, corrections and responses go into the
/// journal as they come, the rest adds up to the figures of the trial's end.
class TrialEvents {
 public:
  TrialEvents(SessionContext& context, Servers& servers, std::string id);
  ~TrialEvents();
  TrialEvents(const TrialEvents&) = delete;
  TrialEvents& operator=(const TrialEvents&) = delete;

  /// Listens from here on.
  void Begin();
  /// From here on to corrections alone.
  void End() { ended_ = true; }
  const std::string& trial() const { return id_; }

  const TrialTracker& tracker() const { return tracker_; }
  /// The first event that could not be written.
  const Result<void>& written() const { return written_; }

  /// For the event that ends the trial.
  nlohmann::ordered_json Figures() const;

 private:
  void OnFrame(const SimulationFrame& frame);
  void OnEvent(const v1::Event& event);
  void OnCorrection(const v1::Failure& failure);
  void OnFailure(const v1::Event& event);
  void OnResponse(const v1::ResponseStages& response);
  void Append(records::EventKind kind, nlohmann::ordered_json fields);

  SessionContext& context_;
  Servers& servers_;
  std::string id_;
  TrialTracker tracker_;
  HeadingOscillation heading_;
  Anticipation anticipation_;
  bool ended_ = false;
  Result<void> written_;
};

}  // namespace footing::study
