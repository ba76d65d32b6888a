#include "daemon/sensor/kinds/wiimote_protocol.h"

#include <algorithm>
#include <array>
#include <variant>

#include "daemon/sensor/kinds/balance_board.h"
#include "daemon/sensor/kinds/pro_controller.h"
#include "daemon/sensor/kinds/wiimote.h"

namespace footing::kinds {
namespace {

/// A device that speaks the protocol.
struct Entry {
  const handshake::Plan* plan;
  bool (*matches)(const decode::Product& product);
  std::unique_ptr<Speaker> (*make)(const decode::KindOptions& options);
};

template <typename One>
constexpr Entry EntryOf() {
  return {&One::kPlan, &One::Matches,
          [](const decode::KindOptions& options) -> std::unique_ptr<Speaker> {
            return std::make_unique<One>(options);
          }};
}

/// The first that matches; the last matches everything.
constexpr std::array kEntries = {EntryOf<balance_board::BalanceBoard>(),
                                 EntryOf<pro_controller::ProController>(),
                                 EntryOf<wiimote::Wiimote>()};

constexpr auto kPlans = [] {
  std::array<const handshake::Plan*, kEntries.size()> plans{};
  std::transform(kEntries.begin(), kEntries.end(), plans.begin(),
                 [](const Entry& entry) { return entry.plan; });
  return plans;
}();

const handshake::Plan& PlanOf(const decode::Product& product) {
  return *std::find_if(kEntries.begin(), kEntries.end(), [&](const Entry& entry) {
            return entry.matches(product);
          })->plan;
}

std::unique_ptr<Speaker> MakeSpeaker(const handshake::Plan& plan,
                                     const decode::KindOptions& options) {
  return std::find_if(kEntries.begin(), kEntries.end(),
                      [&](const Entry& entry) { return entry.plan == &plan; })
      ->make(options);
}

}  // namespace

WiimoteProtocol::WiimoteProtocol(const decode::KindOptions& options, const decode::Product& product)
    : options_(options),
      sequencer_(options.handshake, PlanOf(product), kPlans),
      plan_(&sequencer_.plan()),
      speaker_(MakeSpeaker(*plan_, options)) {}

/// Follows the plan: the answer at the port decides which device it is, and blocks may be new.
void WiimoteProtocol::FollowPlan() {
  if (&sequencer_.plan() != plan_) {
    plan_ = &sequencer_.plan();
    speaker_ = MakeSpeaker(*plan_, options_);
  }
  speaker_->TakeBlocks(sequencer_);
}

void WiimoteProtocol::Advance(std::int64_t now_ns, Outputs& outputs) {
  sequencer_.Advance(now_ns, outputs);
  FollowPlan();
}

std::optional<decode::Decoded> WiimoteProtocol::Take(std::int64_t received_ns,
                                                     reports::Bytes report, Outputs& outputs) {
  const reports::InputReport decoded = reports::Decode(report);
  if (std::holds_alternative<reports::Undecodable>(decoded.body)) return std::nullopt;
  sequencer_.Take(received_ns, decoded, outputs);
  FollowPlan();
  return live() ? speaker_->Take(sequencer_, decoded) : decode::Decoded();
}

bool WiimoteProtocol::SetCamera(bool on) {
  if (!speaker_->has_camera()) return false;
  sequencer_.SetCamera(on);
  return true;
}

void WiimoteProtocol::AddTo(stream::DeviceStatus& status) const {
  Kind::AddTo(status);
  status.extension = sequencer_.extension();
  status.mode_reasserts = sequencer_.mode_reasserts();
  speaker_->AddTo(sequencer_, status);
}

std::string WiimoteProtocol::Note(std::int64_t now_ns) const {
  const std::string note = sequencer_.Note(now_ns);
  return !note.empty() || !live() ? note : speaker_->Note();
}

}  // namespace footing::kinds
