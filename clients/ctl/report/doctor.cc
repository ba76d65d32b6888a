#include "clients/ctl/report/doctor.h"

#include <algorithm>

#include "clients/ctl/report/checks.h"

namespace footing::ctl::doctor {
namespace {

std::vector<Check> AllChecks() {
  std::vector<Check> all;
  for (const auto& some : {HostChecks(), BluetoothChecks(), DeviceChecks(), SetupChecks()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace

const char* Name(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    case Severity::kNote:
      return "note";
  }
  return "note";
}

const User& OpenerOfNodes(const Facts& facts) {
  return facts.daemons.empty() ? facts.user : facts.daemons.begin()->second;
}

bool IsThere(const stream::DeviceStatus& device) {
  return device.state != stream::DeviceState::kLost;
}

bool AnyRealDeviceLives(const Facts& facts) {
  return std::any_of(facts.devices.begin(), facts.devices.end(), [](const auto& device) {
    return !device.simulated && device.state == stream::DeviceState::kLive;
  });
}

std::string Place(const stream::DeviceStatus& device) {
  if (device.role == stream::DeviceRole::kUnspecified) return device.serial;
  return std::string(stream::Name(device.role)) + " " + device.serial;
}

std::vector<Finding> Examine(const Facts& facts) {
  std::vector<Finding> findings;
  for (const Check& check : AllChecks()) {
    for (Symptom& symptom : check.find(facts)) {
      findings.push_back({check.id, symptom.severity, std::move(symptom.what),
                          std::move(symptom.where), std::move(symptom.remedy)});
    }
  }
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return static_cast<int>(a.severity) < static_cast<int>(b.severity);
  });
  return findings;
}

bool Healthy(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& one) { return one.severity == Severity::kError; });
}

nlohmann::ordered_json ToJson(const std::vector<Finding>& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& one : findings) {
    list.push_back({{"id", one.id},
                    {"severity", Name(one.severity)},
                    {"what", one.what},
                    {"where", one.where},
                    {"remedy", one.remedy}});
  }
  return {{"ok", Healthy(findings)}, {"findings", std::move(list)}};
}

std::string ToText(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& one : findings) {
    text += std::string(Name(one.severity)) + ": " + one.what +
            (one.where.empty() ? "" : " (" + one.where + ")") + "\n  -> " + one.remedy + "\n";
  }
  if (findings.empty()) return "all is well";
  return text + (Healthy(findings) ? "no error" : "fix the errors first, from the top");
}

std::vector<std::string> CheckIds() {
  std::vector<std::string> ids;
  for (const Check& check : AllChecks()) ids.emplace_back(check.id);
  return ids;
}

}  // namespace footing::ctl::doctor
