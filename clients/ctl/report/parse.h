#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/device.h"
#include "common/stream/setup.h"

/// Facts about a host that the doctor examines, as plain values. The caller looks them up.
namespace footing::ctl::doctor {

/// A user of the host, with their groups.
struct User {
  std::string name;
  std::uint32_t uid = 0;
  std::vector<std::uint32_t> gids;
};

/// A HID device of a kind that Footing knows, as the kernel lists it.
struct HidDevice {
  std::string sysfs_id;  ///< "0005:057E:0306.0003": bus, vendor, product, instance.
  std::string name;
  std::string serial;
  std::string driver;  ///< Bound kernel driver; empty when none is.
  std::string node;    ///< "/dev/hidraw3"; empty when there is none.
  bool node_exists = false;
  std::uint32_t node_uid = 0;
  std::uint32_t node_gid = 0;
  std::uint32_t node_mode = 0;  ///< Permission bits.
};

/// A Bluetooth adapter.
struct Adapter {
  std::string name;  ///< "hci0".
  bool blocked_soft = false;
  bool blocked_hard = false;
  std::optional<bool> powered;  ///< As bluetoothctl says; nothing when it was not asked.
  int links = 0;                ///< Active connections.
};

/// A device that BlueZ knows, as bluetoothctl reports it.
struct KnownDevice {
  std::string address;
  std::string name;
  bool paired = false;
  bool bonded = false;
  bool trusted = false;
  bool connected = false;
};

/// Programs and files that keep devices from footingd, or write to them beside it.
struct Others {
  std::vector<std::string> blacklists;  ///< Files that blacklist hid_wiimote.
  bool steam_running = false;
  std::vector<std::string>
      joycond_rules;  ///< Files that shut the nodes of the Switch's controllers.
};

/// All facts that the doctor's checks read.
struct Facts {
  User user;
  /// Running footingd processes: process number and owner.
  std::map<int, User> daemons;
  std::optional<std::uint32_t> footing_gid;  ///< Group "footing", where there is one.
  bool user_listed_in_group = false;  ///< In the group's file, perhaps not yet in the session.

  std::vector<HidDevice> hid;
  std::vector<std::string> udev_rules;  ///< Files with a rule for the hidraw nodes of our devices.
  bool ignore_special_drivers = false;
  Others others;

  std::vector<Adapter> adapters;
  bool bluetoothd_running = false;
  std::string bluez_version;                        ///< "5.66"; empty when unknown.
  std::map<std::string, std::string> input_config;  ///< Keys set in BlueZ's input.conf.
  std::vector<KnownDevice> known;

  bool footingd_reached = false;
  std::string footingd_address;
  std::string footingd_trouble;  ///< Why it was not reached.
  std::string footingd_version;
  std::string own_version;
  std::vector<stream::DeviceStatus> devices;
  std::vector<stream::RigSetup> setup;
};

/// The first process, or the person at the console where none runs: whoever opens the nodes.
const User& OpenerOfNodes(const Facts& facts);

// The texts from which facts come: pure functions of what a file or program said.

/// Keys and values of an INI file as BlueZ reads it; comments and sections are dropped, values in
/// lower case.
std::map<std::string, std::string> ParseIni(const std::string& text);

/// Addresses in the output of "bluetoothctl devices", of devices with a name like ours.
std::vector<KnownDevice> ParseDevices(const std::string& text);

/// Adds what "bluetoothctl info" says. BlueZ before 5.65 says nothing of bonds: there a pairing is
/// taken for one.
void AddInfo(const std::string& text, KnownDevice& device);

/// The value of a "Key: value" line; empty when there is none.
std::string ValueOf(const std::string& text, const std::string& key);

/// A modprobe.d file that keeps hid_wiimote from being loaded.
bool BlacklistsWiimote(const std::string& text);
/// A modprobe.d file with options hid ignore_special_drivers=1.
bool IgnoresSpecialDrivers(const std::string& text);
/// A udev rules file with a rule for the hidraw nodes of Nintendo's devices.
bool HasRule(const std::string& text);

/// "0005:057E:0306.0001" is of a device that Footing knows.
bool IsOurs(const std::string& sysfs_id);
/// The same of a Joy-Con or Switch Pro Controller over Bluetooth.
bool IsOfSwitch(const std::string& sysfs_id);
/// A udev rules file that shuts the nodes of the Switch's controllers, as joycond's does.
bool TakesSwitchNodes(const std::string& text);

/// Who runs a process, from /proc/PID/status; the name is left to the caller.
User ParseProcess(const std::string& status);

/// /etc/group's line of a group: its number and members. False when there is none.
bool ParseGroup(const std::string& text, const std::string& name, std::uint32_t& gid,
                std::vector<std::string>& members);

}  // namespace footing::ctl::doctor
