#include "clients/ctl/report/parse.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <sstream>

#include "common/base/text.h"

namespace footing::ctl::doctor {
namespace {

std::string Trim(const std::string& text) {
  const std::size_t from = text.find_first_not_of(" \t\r");
  if (from == std::string::npos) return "";
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

/// The lines that are not comments, trimmed.
std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    line = Trim(line);
    if (!line.empty() && line[0] != '#') lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> Tokens(const std::string& line, char separator) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : line + separator) {
    if (c != separator && !(separator == ' ' && c == '\t')) {
      word += c;
    } else if (separator != ' ' || !word.empty()) {
      words.push_back(word);
      word.clear();
    }
  }
  return words;
}

std::uint32_t Number(const std::string& text) {
  std::uint32_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

bool IsAddress(const std::string& text) {
  if (text.size() != 17) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool good =
        i % 3 == 2 ? text[i] == ':' : std::isxdigit(static_cast<unsigned char>(text[i])) != 0;
    if (!good) return false;
  }
  return true;
}

bool IsWiimoteModule(std::string word) {
  std::replace(word.begin(), word.end(), '-', '_');
  return word == "hid_wiimote";
}

}  // namespace

std::map<std::string, std::string> ParseIni(const std::string& text) {
  std::map<std::string, std::string> values;
  for (const std::string& line : Lines(text)) {
    const std::size_t equals = line.find('=');
    if (line[0] == '[' || equals == std::string::npos) continue;
    values[Trim(line.substr(0, equals))] = text::Lower(Trim(line.substr(equals + 1)));
  }
  return values;
}

std::vector<KnownDevice> ParseDevices(const std::string& text) {
  std::vector<KnownDevice> devices;
  for (const std::string& line : Lines(text)) {
    const std::vector<std::string> words = Tokens(line, ' ');
    if (words.size() < 3 || words[0] != "Device" || !IsAddress(words[1])) continue;
    const std::string name = line.substr(line.find(words[1]) + words[1].size() + 1);
    static constexpr std::array kNames = {"Nintendo RVL", "Motion Controller", "Joy-Con (",
                                          "Pro Controller"};
    const bool ours = std::any_of(kNames.begin(), kNames.end(),
                                  [&](const char* known) { return name.rfind(known, 0) == 0; });
    if (ours) devices.push_back({words[1], name});
  }
  return devices;
}

std::string ValueOf(const std::string& text, const std::string& key) {
  for (const std::string& line : Lines(text)) {
    if (line.rfind(key + ":", 0) == 0) return Trim(line.substr(key.size() + 1));
  }
  return "";
}

void AddInfo(const std::string& text, KnownDevice& device) {
  device.paired = ValueOf(text, "Paired") == "yes";
  const std::string bonded = ValueOf(text, "Bonded");
  device.bonded = bonded.empty() ? device.paired : bonded == "yes";
  device.trusted = ValueOf(text, "Trusted") == "yes";
  device.connected = ValueOf(text, "Connected") == "yes";
}

bool BlacklistsWiimote(const std::string& text) {
  for (const std::string& line : Lines(text)) {
    const std::vector<std::string> words = Tokens(line, ' ');
    if (words.size() < 2 || !IsWiimoteModule(words[1])) continue;
    if (words[0] == "blacklist" || words[0] == "install") return true;
  }
  return false;
}

bool IgnoresSpecialDrivers(const std::string& text) {
  for (const std::string& line : Lines(text)) {
    const std::vector<std::string> words = Tokens(line, ' ');
    if (words.size() < 3 || words[0] != "options" || words[1] != "hid") continue;
    for (const std::string& word : words) {
      if (word == "ignore_special_drivers=1" || word == "ignore_special_drivers=Y") return true;
    }
  }
  return false;
}

bool HasRule(const std::string& text) {
  for (const std::string& line : Lines(text)) {
    const std::string lower = text::Lower(line);
    if (lower.find("hidraw") != std::string::npos && lower.find("057e") != std::string::npos) {
      return true;
    }
  }
  return false;
}

bool IsOurs(const std::string& sysfs_id) {
  static constexpr std::array kKinds = {":057E:0306.", ":057E:0330.", ":054C:03D5.", ":054C:0C5E."};
  return IsOfSwitch(sysfs_id) || std::any_of(kKinds.begin(), kKinds.end(), [&](const char* kind) {
           return sysfs_id.find(kind) != std::string::npos;
         });
}

bool IsOfSwitch(const std::string& sysfs_id) {
  static constexpr std::array kIds = {"0005:057E:2006.", "0005:057E:2007.", "0005:057E:2009."};
  return std::any_of(kIds.begin(), kIds.end(),
                     [&](const char* id) { return sysfs_id.rfind(id, 0) == 0; });
}

bool TakesSwitchNodes(const std::string& text) {
  for (const std::string& line : Lines(text)) {
    const std::string lower = text::Lower(line);
    if (lower.find("hidraw") != std::string::npos && lower.find("2009") != std::string::npos &&
        lower.find("mode=\"0600\"") != std::string::npos) {
      return true;
    }
  }
  return false;
}

User ParseProcess(const std::string& status) {
  User user;
  const auto numbers = [&](const char* key) {
    std::string value = ValueOf(status, key);
    std::replace(value.begin(), value.end(), '\t', ' ');
    return Tokens(value, ' ');
  };
  // Real, effective, saved, file system.
  if (const auto uids = numbers("Uid"); uids.size() > 1) user.uid = Number(uids[1]);
  if (const auto gids = numbers("Gid"); gids.size() > 1) user.gids.push_back(Number(gids[1]));
  for (const std::string& gid : numbers("Groups")) user.gids.push_back(Number(gid));
  return user;
}

bool ParseGroup(const std::string& text, const std::string& name, std::uint32_t& gid,
                std::vector<std::string>& members) {
  for (const std::string& line : Lines(text)) {
    const std::vector<std::string> parts = Tokens(line, ':');
    if (parts.size() < 4 || parts[0] != name) continue;
    gid = Number(parts[2]);
    members = Tokens(parts[3], ',');
    return true;
  }
  return false;
}

}  // namespace footing::ctl::doctor
