#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hidapi/hidapi.h>

#include "common/base/result.h"
#include "common/stream/contacts.h"
#include "common/stream/device.h"
#include "common/stream/hands.h"
#include "common/stream/product_ids.h"
#include "daemon/sensor/reports/output_report.h"
#include "footing/v1/device.pb.h"

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

/// Names and numbers by which a device is known.
struct DeviceIdentity {
  Bus bus = Bus::kUnknown;
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::string name;    ///< As the device gives it.
  std::string serial;  ///< Bluetooth address; it alone identifies a device.
  std::string place;   ///< "/dev/hidraw3" or "device socket, slot 2".
  std::string driver;  ///< Driver in the kernel, "wiimote"; empty when unknown.
  bool simulated = false;
  std::string wished_rig;
  stream::DeviceRole wished_role = stream::DeviceRole::kUnspecified;
};

/// One report of a device, as received.
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
  /// Frames of trackers and simulators without a device, unchecked; null: dropped.
  std::function<void(std::int64_t received_ns, const stream::HandFrame&)> on_hands = {};
  std::function<void(std::int64_t received_ns, const stream::ReferenceFrame&)> on_reference = {};
  std::function<void(std::int64_t received_ns, const stream::ContactFrame&)> on_contacts = {};
  /// One line for a person: something is wrong with this source, and what to do.
  std::function<void(const std::string& line)> on_trouble;
};

/// A source of devices: hidraw nodes, or the device socket. Calls the handlers on the I/O thread.
class DeviceSource {
 public:
  virtual ~DeviceSource() = default;

  /// Looks for devices from now on; an error says what cannot be opened.
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
  /// Name of a thread that has been stuck in a call for longer than the kernel may take; empty:
  /// none.
  virtual std::string Stuck() const { return ""; }
  /// Detaches everything without calling the handlers. May be called twice.
  virtual void Stop() = 0;
};

}  // namespace footing::devices

struct udev;
struct udev_monitor;

namespace footing::devices {

struct UdevRelease {
  void operator()(udev* context) const;
  void operator()(udev_monitor* monitor) const;
};

/// A hidraw node as the kernel describes it.
struct HidNode {
  std::string path;  ///< "/dev/hidraw3"
  Bus bus = Bus::kUnknown;
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::string name;    ///< Both may be empty for a moment after it appeared.
  std::string serial;  ///< Over Bluetooth the device's address.
  std::string driver;  ///< The kernel's, e.g. "wiimote"; empty when unknown.
};

/// Watches udev for hidraw nodes: that something changed, and which there are. Without a running
/// udev (a sandbox, a container) nothing is ever reported, and the nodes have to be looked at from
/// time to time.
class NodeMonitor {
 public:
  NodeMonitor();

  /// For poll(2); -1 when udev reports nothing here.
  int descriptor() const;
  /// Takes everything that was reported; true when there was something.
  bool Clear();
  /// Every node there is now. Not hid_enumerate: that of hidapi 0.13 crashes at a node that goes
  /// while it looks (strdup of an absent uevent), and opens every HID device of the machine.
  std::vector<HidNode> Nodes() const;

 private:
  std::unique_ptr<udev, UdevRelease> udev_;
  std::unique_ptr<udev_monitor, UdevRelease> monitor_;
};

/// Closes a device and gives up its lock.
struct HidClose {
  int lock = -1;
  void operator()(hid_device* device) const;
};
using HidHandle = std::unique_ptr<hid_device, HidClose>;

/// Outcome of opening a node.
struct HidOpening {
  enum class Outcome {
    kOpen,
    kUnidentified,  ///< udev does not know its serial yet.
    kDenied,        ///< EACCES: the udev rule is missing, or was not applied yet.
    kInUse,         ///< Another footingd holds it.
    kNobodyThere,   ///< An adapter's slot without a device.
    kFailed,
  };
  Outcome outcome = Outcome::kFailed;
  HidHandle device;
  DeviceIdentity identity;
  std::string reason;  ///< The kernel's words, of kFailed.
};

/// Opens the node and locks it against other instances of this program with flock(2), across users
/// and for as long as the handle lives. Blocks up to 0.2 s on a USB adapter's slot, which has to
/// answer first: the Mayflash DolphinBar shows four whether a Wiimote is there or not. A PS Move on
/// USB has the serial that it has over Bluetooth.
HidOpening OpenHid(const HidNode& node);

/// Error in a simulated device's attachment, or nothing.
std::string WhatIsWrong(const v1::DeviceAttach& attach);

/// The identity that the attachment states.
DeviceIdentity IdentityOf(const v1::DeviceAttach& attach);

}  // namespace footing::devices
