#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clients/study/session/journal.h"
#include "clients/study/plan/phases.h"
#include "clients/study/plan/protocol.h"
#include "clients/study/session/console.h"
#include "clients/study/session/servers.h"
#include "common/net/address.h"

namespace footing::study {

class SurveyScreen;

struct SessionOptions {
  std::string participant;
  std::string study_folder;
  std::string protocol_text;
  bool unattended = false;        ///< Nobody is asked and nothing waits; all is marked synthetic.
  std::uint64_t answer_seed = 1;  ///< Of unattended answers.
  std::map<std::string, std::string> tables;  ///< Texts of the protocol's mapping tables.
  transport::Address sensor;
  transport::Address simulation;
  std::optional<transport::Address> survey;  ///< Where the participant's survey screen connects.
  std::string version;
};

/// What every part of a running session works with.
struct SessionContext {
  const SessionOptions& options;
  const plan::Protocol& protocol;
  const plan::Session& session;
  Console& console;
  journal::Journal& journal;
  SurveyScreen* screen = nullptr;  ///< The participant's, where there is one.
};

}  // namespace footing::study
