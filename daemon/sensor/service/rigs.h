#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/sensor/features/rig_features.h"
#include "daemon/sensor/service/device.h"
#include "daemon/sensor/service/service.h"
#include "daemon/sensor/setup/setup_store.h"

namespace footing::sensor {

/// The devices of the session epoch, lost ones included. A range of std::unique_ptr<Device>.
class DeviceTable {
 public:
  /// Devices known at once. A new one takes the place of the longest lost; a real one, when none is
  /// lost, that of the newest simulated device.
  static constexpr std::size_t kMaxDevices = 64;
  using Drop = std::function<void(const Device&, const std::string& why)>;

  /// Null: there is none.
  Device* Find(devices::DeviceHandle handle) const;
  Device* Numbered(std::uint32_t number) const;
  Device* WithSerial(const std::string& serial) const;
  /// An error when it is not there or lost.
  Result<Device*> Attached(std::uint32_t number) const;
  Result<Device*> Attached(const std::string& serial) const;
  /// A new device; null when all places are taken. `drop` is called with a simulated device that
  /// gives its place, and why.
  Device* Add(bool simulated, const DeviceOptions& options, const Drop& drop);

  std::set<std::string> RigsWithBoards() const;
  std::size_t AttachedBoards(const std::string& rig) const;

  auto begin() const { return devices_.begin(); }
  auto end() const { return devices_.end(); }

 private:
  bool FreePlaceFor(bool simulated, const Drop& drop);

  std::vector<std::unique_ptr<Device>> devices_;
  std::uint32_t last_number_ = 0;
};

/// Which device has which role: as assigned by serial, as it had before, as it asks for, or the
/// first one free.
class RoleAssignment {
 public:
  /// Roles of the config ("rig/role" by serial), which stored ones replace; `log` gets a line for
  /// each stored one that is wrong or differs.
  RoleAssignment(const std::map<std::string, std::string>& configured, const setup::Roles& stored,
                 const std::function<void(const LogLine&)>& log);

  void Assign(const std::string& serial, const Binding& binding) { assigned_[serial] = binding; }
  Binding Choose(const Device& device, const DeviceTable& devices,
                 const std::string& default_rig) const;
  /// A real device that comes back gets its role back from a simulated one that has it in the
  /// meantime, unless it was assigned to that one.
  bool GivesWay(const Device& holder, const Device& device) const;
  /// For a log line, why it has another role than it asked for; empty when it has that one.
  std::string WhyOther(const Device& device) const;

 private:
  std::map<std::string, Binding> assigned_;  ///< By serial; config first, then commands.
};

/// The features of every rig, from the samples of its devices on the body.
class RigTable {
 public:
  explicit RigTable(const features::Config& config) : config_(config) {}
  /// Rigs whose members stayed as they are keep their features. A lost device stays a member of its
  /// rig until its role goes to another.
  void Rebuild(const DeviceTable& devices);
  /// Earlier readings of the rig are in another frame.
  void Restart(const std::string& rig);
  void Add(const std::string& rig, const stream::MotionSample& sample, std::int64_t decoded_ns);
  /// As of `now_ns`, with the time at which each was ready on the clock `computed_ns`.
  std::vector<stream::RigFeatures> Compute(std::int64_t now_ns, const DeviceTable& devices,
                                           const std::function<std::int64_t()>& computed_ns);

 private:
  struct Rig {
    std::vector<features::Member> members;
    std::unique_ptr<features::RigFeatureExtractor> extractor;
    std::int64_t decoded_ns = 0;
  };

  features::Config config_;
  std::map<std::string, Rig> rigs_;
};

}  // namespace footing::sensor
