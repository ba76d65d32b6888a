#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "common/base/result.h"
#include "common/stream/contacts.h"
#include "common/stream/device.h"
#include "common/stream/hands.h"
#include "common/stream/product_ids.h"
#include "daemon/sensor/reports/output_report.h"

/// Where devices come from. Above this line nothing knows whether a device is real.
namespace footing::devices {

/// A device of one source, from its attachment to its detachment; never used twice.
using DeviceHandle = std::uint64_t;

using stream::Bus;
using stream::kProductFirst;
using stream::kProductTr;
using stream::kProductZcm1;
using stream::kProductZcm2;
using stream::kVendorNintendo;
using stream::kVendorSony;

struct DeviceIdentity {
  Bus bus = Bus::kUnknown;
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::string name;    ///< As the device gives it.
  std::string serial;  ///< Bluetooth address; it alone identifies a device.
  std::string place;   ///< "/dev/hidraw3" or "device socket, slot 2".
  std::string driver;  ///< Of the kernel, "wiimote"; empty when unknown.
  bool simulated = false;
  std::string wished_rig;
  stream::DeviceRole wished_role = stream::DeviceRole::kUnspecified;
};

struct IncomingReport {
  std::int64_t received_ns = 0;
  std::span<const std::uint8_t> bytes;  ///< Valid during the call.
  std::int64_t true_ns = 0;             ///< A simulated device's own; for recordings only.
  bool feature = false;                 ///< The answer to RequestFeature.
  std::uint64_t dropped = 0;            ///< Lost so far between the device's reader and here.
  std::uint64_t writes_failed = 0;      ///< So far.
};

/// Called on the io thread.
struct SourceHandlers {
  /// Says why the device is not taken, or nothing; what one sends that is not taken is ignored.
  std::function<std::string(DeviceHandle, const DeviceIdentity&)> on_attach;
  std::function<void(DeviceHandle, const IncomingReport&)> on_report;
  std::function<void(DeviceHandle, const std::string& reason)> on_detach;
  /// What trackers and simulators send without a device, unchecked; null: dropped.
  std::function<void(std::int64_t received_ns, const stream::HandFrame&)> on_hands = {};
  std::function<void(std::int64_t received_ns, const stream::ReferenceFrame&)> on_reference = {};
  std::function<void(std::int64_t received_ns, const stream::ContactFrame&)> on_contacts = {};
  /// One line for a person: something is wrong with this source, and what to do.
  std::function<void(const std::string& line)> on_trouble;
};

class DeviceSource {
 public:
  virtual ~DeviceSource() = default;

  virtual Result<void> Start() = 0;
  /// Writes one output report; the caller keeps to one per 10 ms and device. Unknown handles are
  /// ignored: the device may be gone already.
  virtual void Send(DeviceHandle device, const reports::OutputReport& report) = 0;
  /// Asks for a feature report of `size` bytes, id included. The answer comes through on_report
  /// with `feature` set; a device that refuses gives an empty one.
  virtual void RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) = 0;
  /// A device that was taken is not any more: it hears why, and what it sends is ignored. Only
  /// simulated devices are ever refused.
  virtual void Refuse(DeviceHandle device, const std::string& why) = 0;
  /// What a thread of its devices has been stuck in for longer than the kernel may take; empty:
  /// nothing.
  virtual std::string Stuck() const { return ""; }
  /// Detaches everything without calling the handlers. May be called twice.
  virtual void Stop() = 0;
};

}  // namespace footing::devices
