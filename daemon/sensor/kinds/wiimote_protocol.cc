#include "daemon/sensor/kinds/wiimote_protocol.h"

#include <algorithm>
#include <iterator>
#include <variant>

#include "daemon/sensor/kinds/balance_board.h"
#include "daemon/sensor/kinds/pro_controller.h"
#include "daemon/sensor/kinds/wiimote.h"

namespace footing::kinds {
namespace {

using balance_board::BalanceBoard;
using pro_controller::ProController;
using wiimote::Wiimote;

template <typename One>
std::unique_ptr<Speaker> Make(const decode::KindOptions& options) {
  return std::make_unique<One>(options);
}

constexpr const handshake::Plan* kPlans[] = {&BalanceBoard::kPlan, &ProController::kPlan,
                                             &Wiimote::kPlan};

}  // namespace

struct WiimoteProtocol::Entry {
  const handshake::Plan* plan;
  bool (*matches)(const decode::Product& product);
  std::unique_ptr<Speaker> (*make)(const decode::KindOptions& options);
};

/// The first that matches; the last matches everything.
const WiimoteProtocol::Entry WiimoteProtocol::kEntries[] = {
    {&BalanceBoard::kPlan, &BalanceBoard::Matches, &Make<BalanceBoard>},
    {&ProController::kPlan, &ProController::Matches, &Make<ProController>},
    {&Wiimote::kPlan, &Wiimote::Matches, &Make<Wiimote>}};

const WiimoteProtocol::Entry& WiimoteProtocol::EntryOf(const decode::Product& product) {
  return *std::find_if(std::begin(kEntries), std::end(kEntries),
                       [&](const Entry& entry) { return entry.matches(product); });
}

WiimoteProtocol::WiimoteProtocol(const decode::KindOptions& options, const decode::Product& product)
    : WiimoteProtocol(options, EntryOf(product)) {}

WiimoteProtocol::WiimoteProtocol(const decode::KindOptions& options, const Entry& entry)
    : options_(options),
      entry_(&entry),
      sequencer_(options.handshake, *entry.plan, kPlans),
      speaker_(entry.make(options)) {}

/// Follows the plan: the answer at the port decides which device it is, and blocks may be new.
void WiimoteProtocol::FollowPlan() {
  if (&sequencer_.plan() != entry_->plan) {
    entry_ = std::find_if(std::begin(kEntries), std::end(kEntries),
                          [&](const Entry& entry) { return entry.plan == &sequencer_.plan(); });
    speaker_ = entry_->make(options_);
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
