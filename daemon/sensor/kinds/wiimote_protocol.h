#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/kind.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/sequencer.h"

namespace footing::kinds {

/// Special part of one of the devices that speak the Wiimote's protocol. It reads the handshake
/// that the protocol has carried out. A new one also gets a line in wiimote_protocol.cc.
class Speaker {
 public:
  virtual ~Speaker() = default;

  virtual stream::DeviceKind kind() const = 0;
  virtual decode::Placement placement() const = 0;
  virtual decode::Timing timing() const = 0;
  virtual bool has_camera() const { return false; }

  /// A new uninterrupted stream begins.
  virtual void Restart() = 0;
  /// The handshake advanced: the plan's blocks may be there now.
  virtual void TakeBlocks(const handshake::HandshakeSequencer& /*sequencer*/) {}
  /// The samples of a report of a device whose handshake is done.
  virtual decode::Decoded Take(const handshake::HandshakeSequencer& sequencer,
                               const reports::InputReport& report) = 0;
  virtual void AddTo(const handshake::HandshakeSequencer& sequencer,
                     stream::DeviceStatus& status) const = 0;
  virtual std::string Note() const { return ""; }
};

/// A device that speaks the Wiimote's protocol. Its name, else what answers at its port, decides
/// which one it is.
class WiimoteProtocol : public Kind {
 public:
  WiimoteProtocol(const decode::KindOptions& options, const decode::Product& product);

  stream::DeviceKind kind() const override { return speaker_->kind(); }
  decode::Placement placement() const override { return speaker_->placement(); }
  decode::Timing timing() const override { return speaker_->timing(); }
  bool live() const override { return sequencer_.live(); }

  void Restart() override { speaker_->Restart(); }
  void Advance(std::int64_t now_ns, Outputs& outputs) override;
  std::optional<decode::Decoded> Take(std::int64_t received_ns, reports::Bytes report,
                                      Outputs& outputs) override;

  bool SetCamera(bool on) override;
  bool RequestStatus(std::int64_t now_ns) override { return sequencer_.RequestStatus(now_ns); }

  const handshake::HandshakeSequencer* sequencer() const override { return &sequencer_; }
  void AddTo(stream::DeviceStatus& status) const override;
  std::string Note(std::int64_t now_ns) const override;

 private:
  void FollowPlan();

  decode::KindOptions options_;
  handshake::HandshakeSequencer sequencer_;
  const handshake::Plan* plan_;  ///< Plan of `speaker_`; the sequencer's may be another already.
  std::unique_ptr<Speaker> speaker_;
};

}  // namespace footing::kinds
