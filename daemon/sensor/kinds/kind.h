#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/reports/outbox.h"
#include "daemon/sensor/reports/sequencer.h"

namespace footing::kinds {

using Outputs = handshake::HandshakeSequencer::Outputs;
/// A calibration read at an earlier time, if any.
using Stored = std::optional<std::vector<std::uint8_t>>;

/// One device as the kind that it is: from its reports to samples in SI units, and from
/// commands to its reports. The defaults suit a device that only sends samples; a kind overrides
/// what it has beyond that (a sphere, a camera, a calibration in feature reports, a second link).
/// Pure: time is an argument, reports come and go as bytes. Docs:
/// docs/devices.md, "To add a kind of device".
class Kind {
 public:
  virtual ~Kind() = default;

  virtual stream::DeviceKind kind() const = 0;
  virtual decode::Placement placement() const = 0;
  /// Typical intervals, before they are estimated.
  virtual decode::Timing timing() const = 0;
  /// The role that it gets of itself while that is free; else the first free one.
  virtual stream::DeviceRole own_role() const { return stream::DeviceRole::kUnspecified; }
  /// Samples may be published: kind and calibration are settled.
  virtual bool live() const = 0;

  /// A new uninterrupted stream begins.
  virtual void Restart() {}
  /// Time passes: appends the reports to be sent. Call at least every 10 ms.
  virtual void Advance(std::int64_t /*now_ns*/, Outputs& /*outputs*/) {}
  /// The samples of one input report, if any; none when it makes no sense. Appends the reports to
  /// be sent.
  virtual std::optional<decode::Decoded> Take(std::int64_t received_ns, reports::Bytes report,
                                              Outputs& outputs) = 0;
  /// How it is written to.
  virtual link::Writing writing() const { return {}; }
  /// The next report to write, if one is due.
  virtual std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns,
                                                          link::Outbox& outbox) {
    return outbox.Next(now_ns);
  }
  virtual reports::OutputReport MotorOff() const { return reports::RumbleOnly(); }

  virtual bool has_second_link() const { return false; }
  /// The device appeared on its second link.
  virtual void OnSecondLink() {}
  virtual std::optional<decode::FeatureRequest> NextFeature(std::int64_t /*now_ns*/) { return {}; }
  /// A whole calibration to be stored, when this feature report completed it.
  virtual Stored TakeFeature(reports::Bytes /*feature*/) { return {}; }

  /// Each of these is false for kinds that do not have it.
  virtual bool SetSphere(std::uint32_t /*rgb*/) { return false; }
  virtual bool SetCamera(bool /*on*/) { return false; }
  virtual bool RequestStatus(std::int64_t /*now_ns*/) { return false; }

  /// The handshake of a device that speaks the Wiimote's protocol; else null.
  virtual const handshake::HandshakeSequencer* sequencer() const { return nullptr; }
  virtual bool has_lamps() const { return sequencer() != nullptr; }
  /// Lights lamps, bits 0 to 3; appends the reports to be sent.
  virtual void SetLamps(std::uint8_t leds, Outputs& outputs) {
    if (has_lamps()) outputs.push_back(reports::SetLeds(leds));
  }

  /// Fills in the kind's part of the status.
  virtual void AddTo(stream::DeviceStatus& status) const { status.kind = kind(); }
  /// The fault and its remedy, for a person; empty when all is well.
  virtual std::string Note(std::int64_t now_ns) const = 0;
};

/// The kind of a device by how it presents itself. What answers at the port of one that speaks the
/// Wiimote's protocol may show later that it is another.
std::unique_ptr<Kind> MakeKind(const decode::KindOptions& options, const decode::Product& product,
                               const Stored& stored);

}  // namespace footing::kinds
