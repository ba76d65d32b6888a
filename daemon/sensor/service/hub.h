#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "common/base/result.h"
#include "daemon/sensor/devices/source.h"
#include "daemon/sensor/features/rig_features.h"
#include "daemon/sensor/mounting/hands.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/device.h"
#include "daemon/sensor/service/service.h"
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

  /// Measurement by a command.
  struct Measured {
    double residual = 0;
    std::string unit;
    std::string message;
  };

  /// Devices known at once, lost ones included. A new one takes the place of the longest lost; a
  /// real one, when none is lost, that of the newest simulated device.
  static constexpr std::size_t kMaxDevices = 64;

  Hub(const Config& config, Ports ports);

  /// As SourceHandlers. A simulated device with the serial of another one that is there is not
  /// taken; a real device takes the place of a simulated one, and its role back from one.
  std::string OnAttach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity);
  /// Decodes a report; reports of handles that were not taken are ignored.
  void OnReport(devices::DeviceHandle handle, const devices::IncomingReport& report);
  void OnDetach(devices::DeviceHandle handle, const std::string& reason);
  /// Published with the next tick; what makes no sense is refused, counted and said now and then.
  void OnHands(std::int64_t received_ns, const stream::HandFrame& frame);
  void OnReference(std::int64_t received_ns, const stream::ReferenceFrame& frame);
  void OnContacts(std::int64_t received_ns, const stream::ContactFrame& frame);
  /// Hand, reference and contact frames refused so far.
  std::uint64_t refused_frames() const { return refusals_.total(); }

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
  /// Commands of the set-up. What they change is saved at once and holds from the
  /// end of the next tick on, so that a recording's reports and set-up give the same features
  /// again.
  ///
  /// The mean of the board's newest `window_s` (0: 2 s) becomes its zero; or it is forgotten.
  Result<Measured> Tare(const std::string& serial, double window_s, bool clear);
  /// Rotation from S to M of a device on the body, residual in degrees; an error when unusable.
  Result<Measured> SolveMounting(const std::string& serial, const MountingStretches& stretches);
  Result<Measured> ClearMounting(const std::string& serial);
  /// Places of a rig's boards on the floor; an error names what does not fit.
  Result<Measured> SetBoardLayout(stream::BoardLayout layout);
  /// Notes that a step of the set-up was done, or forgets it.
  Result<void> RecordSetup(const std::string& rig, const stream::SetupItem& item, bool forget);
  /// Published with the rig's set-up until the session ends; nothing: no more is asked for.
  Result<void> ShowPrompt(std::uint64_t session, const std::string& rig,
                          const std::optional<stream::SetupPrompt>& prompt);
  /// A mounting of a recording, found for this role.
  void TakeMounting(const Binding& binding, const stream::DeviceMounting& mounting);
  /// Releases the session's motors and prompts.
  void EndSession(std::uint64_t session);
  /// The config from now on: of Reloaded(), which changes only what a running footingd can take.
  void Reload(const Config& config) { config_ = config; }
  /// Every motor off, at once.
  void StopMotors();

 private:
  struct Rig {
    std::vector<features::Member> members;
    std::unique_ptr<features::RigFeatureExtractor> extractor;
    std::int64_t decoded_ns = 0;
  };
  struct Lease {
    std::uint64_t session = 0;
    std::int64_t until_ns = 0;
  };

  struct ShownPrompt {
    std::uint64_t session = 0;
    stream::SetupPrompt prompt;
  };

  Device* Find(devices::DeviceHandle handle);
  Device* Numbered(std::uint32_t number);
  Device* WithSerial(const std::string& serial);
  Result<Device*> Attached(std::uint32_t number);
  Result<Device*> Attached(const std::string& serial);
  Result<Device*> AttachedOnBody(const std::string& serial);
  Device* AddDevice(bool simulated);
  bool FreePlaceFor(bool simulated);
  void DropSimulated(const Device& device, const std::string& why);
  void Bind(Device& device);
  bool GivesWay(const Device& holder, const Device& device) const;
  Binding ChooseBinding(const Device& device) const;
  /// For a log line, why it has another role than it asked for; empty when it has that one.
  std::string WhyOtherRole(const Device& device) const;
  void Rebind(Device& device, const Binding& binding);
  void RebuildRigs();
  void KeepRole(const std::string& serial, const Binding& binding);
  void ApplySetup(Device& device);
  void ApplySetupToAll();
  void WatchSetup();
  void AddSetupTo(decode::Placement placement, stream::DeviceStatus& status) const;
  std::string BoardNote(const stream::DeviceStatus& status) const;
  std::set<std::string> RigsWithBoards() const;
  std::size_t AttachedBoards(const std::string& rig) const;
  void WatchLayouts();
  std::vector<stream::RigSetup> SetupInForce() const;
  void AddToRig(const Device& device, const stream::MotionSample& sample);
  void TakeRaw(const Device& device, std::int64_t at_ns, std::span<const std::uint8_t> bytes,
               bool to_device, std::int64_t true_ns, bool feature = false);
  void Flush(Device& device);
  void Refuse(const std::string& what, const std::string& why);
  /// Key of one exposure clock: kind of frame, rig, name of the sender, and which part of a body.
  using Exposed = std::tuple<char, std::string, std::string, int>;
  hands::ExposureClock::Exposure Expose(const Exposed& what, const hands::FrameTimes& times);
  void PublishExposures();
  void EndLeases(std::int64_t now_ns);
  void PublishStatus(std::int64_t now_ns);

  Config config_;
  Ports ports_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::uint32_t last_number_ = 0;
  std::map<std::string, Binding> assigned_;  // By serial; config first, then commands.
  std::map<std::string, Rig> rigs_;
  std::map<std::uint32_t, Lease> leases_;       // By device.
  std::map<std::string, ShownPrompt> prompts_;  // By rig.
  std::uint64_t last_prompt_ = 0;
  setup::SetupStore store_;
  std::uint64_t published_revision_ = 0;
  std::set<std::string> published_board_rigs_;
  std::set<std::string> crowded_rigs_;  ///< With more boards than their layout has places.
  TickContent content_;
  std::vector<stream::DeviceState> last_states_;
  hands::Refusals refusals_;
  std::map<Exposed, hands::ExposureClock> exposures_;
  std::int64_t status_ns_ = 0;
  bool status_due_ = true;
};

}  // namespace footing::sensor
