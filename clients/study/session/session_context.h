#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clients/study/plan/phases.h"
#include "clients/study/plan/protocol.h"
#include "clients/study/session/console.h"
#include "clients/study/session/journal.h"
#include "clients/study/session/servers.h"
#include "common/net/address.h"

namespace footing::study {

class SurveyScreen;

/// Options of a participant's session.
struct SessionOptions {
  std::string participant;
  std::string study_folder;
  std::string protocol_text;
  bool unattended = false;        ///< Nobody is asked and nothing waits; all is marked synthetic.
  std::uint64_t answer_seed = 1;  ///< Seed of unattended answers.
  std::map<std::string, std::string> tables;  ///< Texts of the protocol's mapping tables.
  transport::Address sensor;
  transport::Address simulation;
  std::optional<transport::Address> survey;  ///< Where the participant's survey screen connects.
  std::string version;
};

/// Context shared by all parts of a running session.
struct SessionContext {
  const SessionOptions& options;
  const plan::Protocol& protocol;
  const plan::SessionPlan& session;
  Console& console;
  journal::Journal& journal;
  SurveyScreen* screen = nullptr;  ///< The participant's, where there is one.
};

/// Oscillation of the character's heading: the standard deviation of its heading error against the
/// track's centre line, rad. The gait paper (section 8.1) compares the "oscillation of the
/// character's orientation" without defining it.
class HeadingOscillation {
 public:
  void Add(double heading_error_rad);
  /// Whether the character stands on its feet: from a failure to the put-back frames are left out.
  void SetUpright(bool upright) { upright_ = upright; }
  /// NaN before the second value.
  double StandardDeviation() const;

 private:
  bool upright_ = true;
  std::size_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;  ///< Sum of squared deviations from the mean (Welford).
};

}  // namespace footing::study
