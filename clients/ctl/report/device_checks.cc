#include <algorithm>

#include "clients/ctl/report/checks.h"

namespace footing::ctl::doctor {
namespace {

using stream::CalibrationOrigin;
using stream::DeviceKind;
using stream::DeviceState;
using stream::DeviceStatus;

constexpr std::uint64_t kEnoughReports = 300;  // Three seconds: statistics mean nothing before.
constexpr double kPoorRateHz = 50;             // All of our devices send 60 or more.
constexpr double kPoorJitterMs = 15;           // A good link has 6, a free hop 2.3.
// Of the intervals: of 1000, a good link has at most one longer than 50 ms, a poor one 30 to 45.
constexpr double kPoorGapsShare = 5e-3;
constexpr double kSomeGapsShare = 1e-3;
constexpr std::uint64_t kStrayGaps = 5;       // Fewer are stalls of the host.
constexpr double kManyReassertsShare = 2e-3;  // One in 5 s at 100 Hz.
constexpr double kPoorClockMs = 5;
constexpr std::uint64_t kManyPlugs = 20;

double Share(std::uint64_t part, const DeviceStatus& device) {
  return static_cast<double>(part) /
         static_cast<double>(std::max<std::uint64_t>(device.reports, 1));
}

bool IsBoard(const DeviceStatus& device) { return device.kind == DeviceKind::kBalanceBoard; }

/// One symptom for each device for which `bad` holds.
template <typename Bad, typename Describe>
std::vector<Symptom> Each(const Facts& facts, Bad bad, Describe describe) {
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (!bad(device)) continue;
    Symptom symptom = describe(device);
    symptom.where = Place(device);
    found.push_back(std::move(symptom));
  }
  return found;
}

std::vector<Symptom> None(const Facts& facts) {
  if (!facts.footingd_reached || std::any_of(facts.devices.begin(), facts.devices.end(), IsThere)) {
    return {};
  }
  return {{Severity::kWarning, "footingd has no device", facts.footingd_address,
           "press a button on a paired one, or pair one: footing-ctl pair wiimote"}};
}

std::vector<Symptom> Silent(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return device.state == DeviceState::kStale; },
      [](const DeviceStatus& device) {
        return Symptom{
            Severity::kError,
            "it is connected, but sends no data" + (device.note.empty() ? "" : ": " + device.note),
            "",
            IsBoard(device)
                ? "a board goes silent on weak batteries: change all four, then press its "
                  "power button"
                : "press a button on it; if it stays silent, remove a battery for 5 s"};
      });
}

std::vector<Symptom> Lost(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return device.state == DeviceState::kLost; },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       "it is lost" + (device.note.empty() ? "" : ": " + device.note), "",
                       IsBoard(device) ? "press the board's power button"
                                       : "press a button on it; it keeps its role"};
      });
}

std::vector<Symptom> BatteryLow(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return IsThere(device) && device.battery_low; },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning, "its battery is low", "",
                       device.kind == DeviceKind::kPsMove ? "charge it by USB"
                       : IsBoard(device)                  ? "change its four AA batteries"
                                                          : "change its two AA batteries"};
      });
}

std::vector<Symptom> Uncalibrated(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && (device.calibration == CalibrationOrigin::kDefaults ||
                                   device.extension_calibration == CalibrationOrigin::kDefaults ||
                                   device.gyroscope_calibration == CalibrationOrigin::kDefaults);
      },
      [](const DeviceStatus& device) {
        const bool move = device.kind == DeviceKind::kPsMove;
        return Symptom{
            Severity::kWarning,
            "its calibration could not be read or is invalid; typical values are used", "",
            move ? "connect it by USB once while footingd runs: its calibration is kept"
                 : "switch it off and on to read it again; if this persists, its numbers are "
                   "only approximate"};
      });
}

bool HasPoorLink(const DeviceStatus& device) {
  if (device.state != DeviceState::kLive || device.reports < kEnoughReports) return false;
  if (device.report_rate_hz < kPoorRateHz) return true;
  if (device.gaps < kStrayGaps) return false;
  const double gaps = Share(device.gaps, device);
  return gaps > kPoorGapsShare || (gaps > kSomeGapsShare && device.jitter_ms > kPoorJitterMs);
}

std::vector<Symptom> PoorLink(const Facts& facts) {
  return Each(facts, HasPoorLink, [](const DeviceStatus& device) {
    return Symptom{Severity::kWarning,
                   "its link is poor: " + std::to_string(static_cast<int>(device.report_rate_hz)) +
                       " reports/s, jitter " + std::to_string(static_cast<int>(device.jitter_ms)) +
                       " ms, " + std::to_string(device.gaps) + " gaps",
                   "",
                   "bring the adapter nearer (a USB extension, away from Wi-Fi and USB 3 plugs), "
                   "or move Wi-Fi to 5 GHz"};
  });
}

std::vector<Symptom> ModeStolen(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && device.mode_reasserts >= 5 &&
               Share(device.mode_reasserts, device) > kManyReassertsShare;
      },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       "its report mode had to be set again " +
                           std::to_string(device.mode_reasserts) +
                           " times: another program or driver changes it",
                       "",
                       "end other programs that use it (sudo fuser -v " +
                           (device.place.empty() ? "/dev/hidraw*" : device.place) +
                           "); against hid_wiimote: " + kIgnoreSpecialDrivers};
      });
}

std::vector<Symptom> Dropped(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return device.queue_drops > 0; },
      [](const DeviceStatus& device) {
        return Symptom{
            Severity::kWarning,
            std::to_string(device.queue_drops) + " reports were lost because the host was busy", "",
            "end what takes the processor (top), or give footingd a core of its own"};
      });
}

std::vector<Symptom> WritesFailed(const Facts& facts) {
  return Each(
      facts, [](const DeviceStatus& device) { return IsThere(device) && device.writes_failed > 0; },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       std::to_string(device.writes_failed) + " writes to it failed", "",
                       "switch it off and on; if that does not help: footing-ctl pair"};
      });
}

std::vector<Symptom> Undecodable(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return device.reports >= kEnoughReports && Share(device.undecodable, device) > 0.01;
      },
      [&facts](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       std::to_string(device.undecodable) +
                           " of its reports make no sense: it may be a counterfeit",
                       "",
                       "record it for a report: footing-log record --connect " +
                           facts.footingd_address + " --seconds 10 --out odd.mcap"};
      });
}

std::vector<Symptom> LoosePlug(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && device.extension_changes >= kManyPlugs;
      },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning,
                       "its extension was plugged in or out " +
                           std::to_string(device.extension_changes) +
                           " times: a loose plug or a clone",
                       "", "press the plug in, clean its contacts, or try another one"};
      });
}

std::vector<Symptom> UnknownExtension(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && device.extension == stream::Extension::kUnknown;
      },
      [](const DeviceStatus&) {
        return Symptom{Severity::kNote, "something is plugged in that Footing does not know", "",
                       "pull it out if the Nunchuk or MotionPlus is meant to work"};
      });
}

std::vector<Symptom> ClockUncertain(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return device.state == DeviceState::kLive && device.clock_offset_sd_ms > kPoorClockMs;
      },
      [](const DeviceStatus&) {
        return Symptom{Severity::kWarning, "its sampling times are uncertain", "",
                       "wait 10 s; if this persists, fix its link first (see poor_link)"};
      });
}

std::vector<Symptom> NoRole(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return IsThere(device) && device.role == stream::DeviceRole::kUnspecified;
      },
      [](const DeviceStatus& device) {
        return Symptom{Severity::kWarning, "it has no role, so nothing uses it", "",
                       "footing-ctl assign " + device.serial + " main/left_hand (or another role)"};
      });
}

std::vector<Symptom> Notes(const Facts& facts) {
  return Each(
      facts,
      [](const DeviceStatus& device) {
        return !device.note.empty() &&
               (device.state == DeviceState::kLive || device.state == DeviceState::kConnecting);
      },
      [](const DeviceStatus& device) {
        return Symptom{device.state == DeviceState::kLive ? Severity::kNote : Severity::kWarning,
                       device.note, "", "footing-ctl watch shows whether it persists"};
      });
}

}  // namespace

std::vector<Check> DeviceChecks() {
  return {{"no_device", None},
          {"device_silent", Silent},
          {"device_lost", Lost},
          {"battery_low", BatteryLow},
          {"uncalibrated", Uncalibrated},
          {"poor_link", PoorLink},
          {"mode_stolen", ModeStolen},
          {"reports_dropped", Dropped},
          {"writes_failed", WritesFailed},
          {"undecodable", Undecodable},
          {"loose_plug", LoosePlug},
          {"unknown_extension", UnknownExtension},
          {"clock_uncertain", ClockUncertain},
          {"no_role", NoRole},
          {"device_note", Notes}};
}

}  // namespace footing::ctl::doctor
