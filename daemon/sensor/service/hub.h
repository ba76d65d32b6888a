#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/sensor/devices/source.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/device.h"
#include "daemon/sensor/service/rigs.h"
#include "daemon/sensor/service/service.h"
#include "daemon/sensor/service/setup_keeper.h"
#include "daemon/sensor/service/tracker_input.h"
#include "daemon/sensor/setup/setup_store.h"

namespace footing::sensor {

/// All devices of footingd: who is there, on which rig, and what a tick says. It has no socket and
/// no thread; its clock is given, so that a test can run it faster than time.
class Hub {
 public:
  struct Ports {
    std::function<void(devices::DeviceHandle, const reports::OutputReport&)> send;
    std::function<void(const LogLine&)> log;
    std::function<std::int64_t()> now_ns = {};
    /// Asks for a feature report; null: devices are never asked.
    std::function<void(devices::DeviceHandle, std::uint8_t id, std::size_t size)> request_feature =
        {};
    /// Calibrations that can't always be read, by serial; null: none are kept.
    std::function<Device::Stored(const std::string& serial)> load_calibration = {};
    std::function<void(const std::string& serial, const std::vector<std::uint8_t>&)>
        save_calibration = {};
    /// Where the set-up is kept between runs; none: in memory.
    setup::Storage storage = {};
    /// A simulated device that was taken has given way to a real one: its source says so to it and
    /// ignores what it sends from now on. Null: it is not informed.
    std::function<void(devices::DeviceHandle, const std::string& why)> refuse = {};
  };

  Hub(const Config& config, Ports ports);
  Hub(const Hub&) = delete;

  /// As SourceHandlers. A simulated device with the serial of another one that is there is not
  /// taken; a real device takes the place of a simulated one, and its role back from one.
  std::string OnAttach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity);
  /// Decodes a report; reports of handles that were not taken are ignored.
  void OnReport(devices::DeviceHandle handle, const devices::IncomingReport& report);
  void OnDetach(devices::DeviceHandle handle, const std::string& reason);
  /// Frames of the device socket, published with the next tick.
  TrackerInput& trackers() { return trackers_; }
  /// The stored set-up of rigs and devices, and the commands that change it.
  SetupKeeper& setup() { return setup_; }

  /// Once a tick: everything since the last one, and the features as of `now_ns`. The same reports
  /// and the same ticks give the same features bit for bit.
  TickContent Tick(std::int64_t now_ns);

  /// Commands. The motor stops when the lease runs out or the session ends.
  Result<void> SetRumble(std::uint64_t session, std::uint32_t device, bool on, double lease_s);
  /// Lamps, sphere and camera: an error when the device is not there or does not have it.
  Result<void> SetLeds(std::uint32_t device, std::uint8_t leds);
  Result<void> SetSphere(std::uint32_t device, std::uint32_t rgb);
  Result<void> SetCamera(std::uint32_t device, bool on);
  /// At most once a second.
  Result<void> RequestDeviceStatus(std::uint32_t device);
  /// The device that had this role gets the one that this device had.
  Result<void> AssignRole(const std::string& serial, const Binding& binding);
  /// Releases the session's motors and prompts.
  void EndSession(std::uint64_t session);
  /// The config from now on: of Reloaded(), which changes only what a running footingd can take.
  void Reload(const Config& config) { config_ = config; }
  /// Every motor off, at once.
  void StopMotors();

 private:
  struct Lease {
    std::uint64_t session = 0;
    std::int64_t until_ns = 0;
  };

  void DropSimulated(const Device& device, const std::string& why);
  void Bind(Device& device);
  void Rebind(Device& device, const Binding& binding);
  void ApplySetup(Device& device);
  void AddRaw(const Device& device, std::int64_t at_ns, std::span<const std::uint8_t> bytes,
              bool to_device, std::int64_t true_ns, bool feature = false);
  void Flush(Device& device);
  template <typename HasEnded>
  void EndLeases(const HasEnded& has_ended);
  void PublishStatus(std::int64_t now_ns);

  Config config_;
  Ports ports_;
  DeviceTable devices_;
  SetupKeeper setup_;
  RoleAssignment roles_;
  RigTable rigs_;
  TrackerInput trackers_;
  std::map<std::uint32_t, Lease> leases_;  ///< By device.
  TickContent content_;
  std::size_t raw_bytes_ = 0;  ///< Length of its raw reports, together.
  std::vector<stream::DeviceState> last_states_;
  std::int64_t status_ns_ = 0;
  bool status_due_ = true;
};

}  // namespace footing::sensor
