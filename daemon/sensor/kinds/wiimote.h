#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/kind_options.h"
#include "daemon/sensor/reports/sequencer.h"
#include "daemon/sensor/kinds/wiimote_decoder.h"

namespace footing::wiimote {

/// A Wiimote and what is plugged into it. Of the devices that speak its protocol it is the one that
/// nothing else is recognised by.
class Wiimote {
 public:
  static constexpr stream::DeviceKind kKind = stream::DeviceKind::kWiimote;
  static constexpr decode::Placement kPlacement = decode::Placement::kOnBody;
  static constexpr decode::Timing kTiming = {0.01, 0.01};
  static constexpr handshake::Plan kPlan = {true, 0x31};

  static bool Matches(const decode::Product&) { return true; }

  Wiimote(const decode::KindOptions&, handshake::HandshakeSequencer sequencer)
      : sequencer_(std::move(sequencer)) {}

  handshake::HandshakeSequencer& sequencer() { return sequencer_; }
  const handshake::HandshakeSequencer& sequencer() const { return sequencer_; }
  /// A new uninterrupted stream begins.
  void Restart() { decoder_ = Decoder(); }
  decode::Decoded Take(const reports::InputReport& report);

  void SetCamera(bool on) { sequencer_.SetCamera(on); }
  void AddTo(stream::DeviceStatus& status) const;
  std::string Note() const { return ""; }

 private:
  handshake::HandshakeSequencer sequencer_;
  Decoder decoder_;
};

}  // namespace footing::wiimote
