#pragma once

#include <cstdint>
#include <string>

#include "common/virtual/devices/controller.h"

typedef struct _UMockdevTestbed UMockdevTestbed;

namespace footing::device_faults {

/// The sysfs tree and udev of a machine that exists only for the programs started from here: each
/// gets it through LD_PRELOAD.
class Testbed {
 public:
  Testbed();
  ~Testbed();
  Testbed(const Testbed&) = delete;
  Testbed& operator=(const Testbed&) = delete;

  /// Adds a HID device and its hidraw child, with a uevent for each. `with_identity` false leaves
  /// out name and serial, as for a moment at a real plug.
  void Add(int number, const virtual_devices::Identity& identity, const std::string& driver,
           bool with_identity = true);
  /// Name and serial of a device that was added without, and the uevent that says so.
  void Identify(int number, const virtual_devices::Identity& identity);
  /// The kernel is taking the HID device away: its description is listed, and cannot be read.
  void HalfRemove(int number, const virtual_devices::Identity& identity);
  void Remove(int number, const virtual_devices::Identity& identity);
  /// A uevent of the hidraw node.
  void Announce(int number, const virtual_devices::Identity& identity, const std::string& action);

 private:
  UMockdevTestbed* testbed_;
};

}  // namespace footing::device_faults
