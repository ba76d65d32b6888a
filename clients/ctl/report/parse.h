#pragma once

#include <map>
#include <string>
#include <vector>

#include "clients/ctl/report/facts.h"

/// The texts from which facts come: pure functions of what a file or program said.
namespace footing::ctl::doctor {

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

/// Who runs a process, from /proc/PID/status; the name is left to the caller.
User ParseProcess(const std::string& status);

/// /etc/group's line of a group: its number and members. False when there is none.
bool ParseGroup(const std::string& text, const std::string& name, std::uint32_t& gid,
                std::vector<std::string>& members);

}  // namespace footing::ctl::doctor
