#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

/// How each kind of device is paired, as steps for a person. Pure: what is known of the host comes
/// in.
namespace footing::ctl::pairing {

/// Device that is to be paired.
enum class Kind { kWiimote, kBoard, kMove, kJoycon };

std::optional<Kind> KindNamed(const std::string& name);
const char* Name(Kind kind);

/// Bluetooth of the host, as far as pairing depends on it.
struct Host {
  std::string adapter;        ///< "hci0"; empty when there is none.
  std::string bluez_version;  ///< "5.66"; empty when bluetoothctl is not there.
  bool may_fail = false;      ///< Version known to fail to pair Nintendo's devices.
};

/// One step of a pairing.
struct Step {
  std::string say;       ///< Instruction or remark for the person.
  std::string run;       ///< Input for bluetoothctl or a shell; empty when there is none.
  std::string wait_for;  ///< Output that shows success; empty when there is none to await.
};

/// The whole way from the box to the device in footingd. ADDRESS stands for the device's own, as
/// bluetoothctl shows it.
std::vector<Step> Steps(Kind kind, const Host& host);

/// {device, adapter, bluez_version, steps: [{say, run, wait_for}]}
nlohmann::ordered_json ToJson(Kind kind, const Host& host);
std::string ToText(Kind kind, const Host& host);

}  // namespace footing::ctl::pairing
