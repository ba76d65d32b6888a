#include "clients/ctl/report/pairing.h"

#include <array>

namespace footing::ctl::pairing {
namespace {

constexpr std::array kNames = {"wiimote", "board", "move", "joycon"};
/// As footingd names them.
constexpr std::array kDeviceKinds = {"wiimote", "balance_board", "ps_move",
                                     "joy_con_left or joy_con_right"};

struct NintendoText {
  const char* button;  ///< Where the red button is.
  const char* name;    ///< As bluetoothctl shows it.
  const char* asleep;  ///< How it is woken later.
};

NintendoText TextOf(Kind kind) {
  if (kind == Kind::kBoard) {
    return {"Turn the board over and open the lid of its batteries: the red button is in there",
            "Nintendo RVL-WBC-01", "its power button, at the front edge"};
  }
  return {"Open the lid of its batteries: the red button is below them", "Nintendo RVL-CNT-01",
          "any button"};
}

void AddHost(const Host& host, std::vector<Step>& steps) {
  if (host.bluez_version.empty()) {
    steps.push_back({"bluetoothctl is not there. Install BlueZ first.",
                     "sudo apt install bluez && sudo systemctl enable --now bluetooth",
                     "bluetoothctl --version"});
  }
  if (host.adapter.empty()) {
    steps.push_back({"There is no Bluetooth adapter. Plug one in.", "bluetoothctl list",
                     "Controller ... [default]"});
  }
  if (host.may_fail) {
    steps.push_back(
        {"BlueZ " + host.bluez_version +
             " may switch the device off while it pairs "
             "(https://github.com/bluez/bluez/issues/911). If that happens press the red "
             "button once more at that moment, or use BlueZ 5.66 of Debian 12.",
         "", ""});
  }
}

std::vector<Step> NintendoSteps(Kind kind, const Host& host) {
  const NintendoText text = TextOf(kind);
  std::vector<Step> steps;
  AddHost(host, steps);
  steps.push_back({"Start bluetoothctl in a second terminal. What follows is typed there.",
                   "bluetoothctl", "Agent registered"});
  steps.push_back({"Power on, with an agent, and look for devices.",
                   "power on\nagent on\ndefault-agent\nscan on", "Discovery started"});
  steps.push_back(
      {std::string(text.button) +
           ". Press it once; four lamps blink for 20 s. Only this button makes a bond, so "
           "that the device comes back by itself; if you hold 1+2 instead, it is "
           "forgotten when it is switched off.",
       "", std::string("[NEW] Device ADDRESS ") + text.name});
  steps.push_back(
      {"Pair while it blinks. Do not type a PIN: BlueZ supplies it (the adapter's own "
       "address, backwards). If it asks for one, press the red button again and repeat.",
       "pair ADDRESS", "Pairing successful"});
  steps.push_back(
      {"Connect at once: only then the device keeps the bond. And trust it, so that it may "
       "come back.",
       "connect ADDRESS\ntrust ADDRESS", "Connection successful"});
  steps.push_back({"Leave bluetoothctl. Later " + std::string(text.asleep) + " wakes it.",
                   "scan off\nquit", ""});
  return steps;
}

std::vector<Step> MoveSteps(const Host& host) {
  std::vector<Step> steps;
  if (host.bluez_version.empty() || host.adapter.empty()) AddHost(host, steps);
  steps.push_back(
      {"Connect the Move by its USB cable while footingd runs: its calibration is read and "
       "kept by its serial; over Bluetooth that often fails.",
       "footing-ctl devices", "a device of kind ps_move"});
  steps.push_back(
      {"Write the adapter's address into the Move, over the same cable. BlueZ has no way to "
       "do that for a Move (https://github.com/thp/psmoveapi/issues/489); the program psmove "
       "of the PS Move API has: it writes feature report 5 and registers the Move with BlueZ.",
       "sudo psmove pair", "the address of the Move"});
  steps.push_back({"Start bluetoothctl in a second terminal, and let the Move in.",
                   "bluetoothctl\npower on\nagent on\ndefault-agent\ntrust ADDRESS",
                   "trust succeeded"});
  steps.push_back({"Pull the cable and press the PS button. The red lamp blinks, then stays on.",
                   "connect ADDRESS", "Device ADDRESS Connected: yes"});
  steps.push_back(
      {"If it goes off again BlueZ refuses it without a bond: set this in "
       "/etc/bluetooth/input.conf (any input device nearby may connect then), and press PS "
       "again.",
       "ClassicBondedOnly=false\nsudo systemctl restart bluetooth", ""});
  return steps;
}

std::vector<Step> JoyconSteps(const Host& host) {
  std::vector<Step> steps;
  if (host.bluez_version.empty() || host.adapter.empty()) AddHost(host, steps);
  steps.push_back(
      {"Take the Joy-Con off the console, or switch the console off: a bond with the "
       "computer is lost as soon as it is slid onto a console again. Start bluetoothctl in "
       "a second terminal. What follows is typed there.",
       "bluetoothctl", "Agent registered"});
  steps.push_back({"Power on, with an agent, and look for devices.",
                   "power on\nagent on\ndefault-agent\nscan on", "Discovery started"});
  steps.push_back(
      {"Hold the small round button on the rail, between SL and SR, for 3 s, until the lamps run "
       "to "
       "and fro (Pro Controller: the button beside its USB port).",
       "", "[NEW] Device ADDRESS Joy-Con (L), Joy-Con (R) or Pro Controller"});
  steps.push_back({"Pair, connect and trust it while the lamps run.",
                   "pair ADDRESS\nconnect ADDRESS\ntrust ADDRESS", "Connection successful"});
  steps.push_back(
      {"Leave bluetoothctl. Later any button wakes it; it switches itself off after about "
       "an hour without a button pressed.",
       "scan off\nquit", ""});
  return steps;
}

}  // namespace

std::optional<Kind> KindNamed(const std::string& name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i]) return static_cast<Kind>(i);
  }
  return std::nullopt;
}

const char* Name(Kind kind) { return kNames[static_cast<std::size_t>(kind)]; }

std::vector<Step> Steps(Kind kind, const Host& host) {
  std::vector<Step> steps = kind == Kind::kMove     ? MoveSteps(host)
                            : kind == Kind::kJoycon ? JoyconSteps(host)
                                                    : NintendoSteps(kind, host);
  steps.push_back(
      {"footingd has it as soon as it is connected.", "footing-ctl devices",
       std::string("a live device of kind ") + kDeviceKinds[static_cast<std::size_t>(kind)]});
  return steps;
}

nlohmann::ordered_json ToJson(Kind kind, const Host& host) {
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (const Step& step : Steps(kind, host)) {
    steps.push_back({{"say", step.say}, {"run", step.run}, {"wait_for", step.wait_for}});
  }
  return {{"device", Name(kind)},
          {"adapter", host.adapter},
          {"bluez_version", host.bluez_version},
          {"steps", std::move(steps)}};
}

std::string ToText(Kind kind, const Host& host) {
  std::string text;
  int number = 0;
  for (const Step& step : Steps(kind, host)) {
    text += std::to_string(++number) + ". " + step.say + "\n";
    std::string run = step.run;
    for (std::size_t at = 0; !run.empty();) {
      at = run.find('\n');
      text += "     " + run.substr(0, at) + "\n";
      run = at == std::string::npos ? "" : run.substr(at + 1);
    }
    if (!step.wait_for.empty()) text += "   until: " + step.wait_for + "\n";
  }
  return text;
}

}  // namespace footing::ctl::pairing
