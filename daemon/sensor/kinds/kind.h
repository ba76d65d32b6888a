#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "daemon/sensor/kinds/balance_board.h"
#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/pro_controller.h"
#include "daemon/sensor/kinds/ps_move.h"
#include "daemon/sensor/kinds/wiimote.h"
#include "daemon/sensor/reports/outbox.h"

namespace footing::kinds {

using Outputs = handshake::HandshakeSequencer::Outputs;
/// A calibration read at an earlier time, if any.
using Stored = std::optional<std::vector<std::uint8_t>>;

/// Every kind of device that footingd knows. The first whose Matches() is true takes a device.
///
/// Each has kKind, kPlacement, kTiming, Matches, Take, AddTo (its part of the status) and Note; one
/// that speaks the Wiimote's protocol also a kPlan and a sequencer(). What only some can do (a
/// sphere, a camera, a calibration in feature reports, a second link) is a member that only they
/// have.
using Alternatives = std::variant<balance_board::BalanceBoard, pro_controller::ProController,
                                  ps_move::PsMove, wiimote::Wiimote>;

/// The plans of all kinds that speak the Wiimote's protocol.
std::span<const handshake::Plan* const> Plans();

/// One device as what it is. What answers at its port may show that it is of another kind. A plain
/// value.
class Kind {
 public:
  Kind(const decode::KindOptions& options, const decode::Product& product, const Stored& stored);

  stream::DeviceKind kind() const;
  decode::Placement placement() const;
  decode::Timing timing() const;
  /// Samples may be published: kind and calibration are settled.
  bool live() const;

  /// A new uninterrupted stream begins.
  void Restart();
  /// Time passes: steps of the handshake that are due go to `outputs`.
  void Advance(std::int64_t now_ns, Outputs& outputs);
  /// The samples of one input report, if any; none when it makes no sense.
  std::optional<decode::Decoded> Take(std::int64_t received_ns, reports::Bytes report,
                                      Outputs& outputs);
  /// The next report to write, if one is due.
  std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns, link::Outbox& outbox);
  /// The report that switches the motor off at once.
  reports::OutputReport MotorOff() const;

  /// A second link to the same device is taken too: its calibration may be readable there.
  bool has_second_link() const;
  void TakeSecondLink();
  std::optional<decode::FeatureRequest> NextFeature(std::int64_t now_ns);
  /// A whole calibration to be stored, when this feature report completed it.
  Stored TakeFeature(reports::Bytes feature);

  /// Whether its lamps can show the role.
  bool has_lamps() const;
  /// False for kinds that do not have it.
  bool SetSphere(std::uint32_t rgb);
  bool SetCamera(bool on);
  bool RequestStatus(std::int64_t now_ns);

  /// Adds the kind's part to the status.
  void AddTo(stream::DeviceStatus& status) const;
  /// Text for a person: the problem and what to do; empty when all is well.
  std::string Note(std::int64_t now_ns) const;

  const Alternatives& alternatives() const { return alternatives_; }
  /// Null for a kind that does not speak the Wiimote's protocol.
  const handshake::HandshakeSequencer* sequencer() const;

 private:
  void FollowPlan();

  decode::KindOptions options_;
  Alternatives alternatives_;
};

}  // namespace footing::kinds
