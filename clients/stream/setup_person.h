#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clients/stream/plan.h"
#include "clients/stream/setup_body.h"
#include "common/stream/setup.h"
#include "common/runtime/timer.h"
#include "footing/v1/session.pb.h"

namespace footing::stream_client {

/// Who performs a guided setup, and with which devices.
struct SetupPersonOptions {
  std::string interface = {};  ///< Whose devices; empty: two held remotes and two boards.
  std::optional<int> boards = std::nullopt;  ///< 0 to 2; nothing: those of the interface.
  double mass_kg = 70;
  std::string rig = "main";
  bool strapped = false;  ///< Remotes of hands are strapped on the wrists askew, not held.
  bool jumbled = false;   ///< The devices ask for the roles of the other side.
  bool once = false;      ///< One setup only.
};

/// What a guided setup asked for.
struct SetupRecord {
  struct Asked {
    stream::SetupPrompt prompt;
    bool performed = false;  ///< The prompt says which gesture it is about.
  };
  std::vector<Asked> asked;
  int setups = 0;  ///< Ended so far.
};

/// Performs what a guided setup asks for. It follows the prompt that footingd publishes with the
/// rig's set-up, so it does nothing before it is asked, and again what is asked for again.
class SetupPerson {
 public:
  /// `on_end` is called when a setup has ended, and nothing was asked for a while.
  SetupPerson(boost::asio::io_context& io, std::shared_ptr<SetupBody> body, std::string rig,
              std::shared_ptr<SetupRecord> record, std::function<void()> on_end);

  /// What footingd publishes.
  void See(const v1::Tick& tick);

 private:
  void Follow(const stream::RigSetup& setup);
  bool Perform(const stream::SetupPrompt& prompt);
  void End();

  std::shared_ptr<SetupBody> body_;
  const std::string rig_;
  const std::shared_ptr<SetupRecord> record_;
  const std::function<void()> on_end_;
  timer::Timer steps_;  ///< Until the three steps are over.
  timer::Timer over_;
  std::uint64_t number_ = 0;  ///< Of the newest prompt.
  std::string item_;          ///< Of the newest prompt; empty: no setup is under way.
};

/// The devices of the person and the body that moves them.
struct SetupPersonPlan {
  Plan plan;
  std::shared_ptr<SetupBody> body;
};
Result<SetupPersonPlan> PlanSetupPerson(const SetupPersonOptions& options, const Common& common);

}  // namespace footing::stream_client
