#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <fstream>
#include <functional>
#include <memory>
#include <utility>

#include "common/device_models/balance_board.h"
#include "common/device_models/ps_move.h"
#include "common/device_models/wiimote.h"
#include "daemon/sensor/service/hub.h"
#include "tests/recordings/devices/replay.h"

/// Writes the captures that are made with device models, or what is expected of all there are:
///
///   write_device_recordings FOLDER              FOLDER/*.report of every model
///   write_device_recordings FOLDER --expected   FOLDER/*.expected of every *.report in it
///
/// Captures of real devices are put into the folder by hand and have only the second done to them.
namespace footing::recordings {
namespace {

using device_models::Report;

/// A device model at the other end of the link.
struct Peer {
  devices::DeviceIdentity identity;
  std::function<std::vector<Report>(double t_s, std::span<const std::uint8_t>)> answer;
  std::function<std::vector<Report>(double t_s)> sample;
  /// The answer to a request for a feature report; a device without them leaves it empty.
  std::function<Report(std::uint8_t id, std::size_t size)> feature = nullptr;
};

struct Plan {
  std::string file;
  std::string motion;
  std::string made;
  bool camera = false;
  double seconds = 0;
  std::vector<Report> at_the_end;  ///< Real packets, sent after the model's.
  std::function<Peer()> peer;
};

constexpr std::int64_t kTickNs = 10'000'000;

/// footingd's hub and the peer talk for as long as the plan says; answers come a tick later.
Capture Record(const Plan& plan) {
  Capture capture;
  Peer peer = plan.peer();
  sensor::Config config;
  config.camera = plan.camera;
  constexpr std::int64_t kStartNs = 1'000'000'000;
  std::int64_t now_ns = kStartNs;
  struct Answer {
    Report report;
    bool feature = false;
  };
  std::deque<Answer> answers;
  const auto seconds = [&now_ns] { return static_cast<double>(now_ns - kStartNs) * 1e-9; };
  const auto note = [&](bool to_device, const Report& bytes, bool feature = false) {
    capture.reports.push_back({now_ns - kStartNs, to_device, feature, bytes});
  };
  sensor::Hub hub(config, {[&](devices::DeviceHandle, const reports::OutputReport& report) {
                             note(true, report);
                             for (auto& one : peer.answer(seconds(), report)) {
                               answers.push_back({one});
                             }
                           },
                           [](const std::string&) {}, [&now_ns] { return now_ns; },
                           [&](devices::DeviceHandle, std::uint8_t id, std::size_t size) {
                             answers.push_back({peer.feature(id, size), true});
                           }});
  constexpr devices::DeviceHandle kHandle = 1;
  const auto send = [&](const Report& report, bool feature = false) {
    note(false, report, feature);
    devices::IncomingReport incoming;
    incoming.received_ns = now_ns;
    incoming.bytes = report;
    incoming.feature = feature;
    hub.OnReport(kHandle, incoming);
  };
  hub.OnAttach(kHandle, peer.identity);
  const auto ticks = static_cast<int>(std::lround(plan.seconds * 1e9 / kTickNs));
  for (int tick = 0; tick < ticks; ++tick) {
    now_ns += kTickNs;
    for (const Answer& one : std::exchange(answers, {})) send(one.report, one.feature);
    for (const Report& report : peer.sample(seconds())) send(report);
    (void)hub.Tick(now_ns);
  }
  for (const Report& report : plan.at_the_end) {
    now_ns += kTickNs;
    send(report);
    (void)hub.Tick(now_ns);
  }
  char identity[32];
  std::snprintf(identity, sizeof identity, "%04x:%04x bluetooth", peer.identity.vendor,
                peer.identity.product);
  capture.header = {{"Device", peer.identity.name},
                    {"Identity", identity},
                    {"Firmware", "device model of common/device_models"},
                    {"Motion", plan.motion},
                    {"Date", "2026-11-21"},
                    {"Made", plan.made}};
  if (plan.camera) capture.header.emplace_back("Camera", "on");
  return capture;
}

devices::DeviceIdentity IdentityOf(const device_models::Identity& own) {
  devices::DeviceIdentity identity;
  identity.bus = devices::Bus::kBluetooth;
  identity.vendor = own.vendor;
  identity.product = own.product;
  identity.name = own.name;
  identity.serial = own.serial;
  return identity;
}

/// Swung forwards and backwards at 2 Hz, +-3 m/s², face up.
Eigen::Vector3d Swing(double t_s) {
  return {0, 3 * std::sin(2 * 3.14159265358979 * 2 * t_s), -9.80665};
}

std::int64_t Nanoseconds(double t_s) { return std::llround(t_s * 1e9); }

constexpr double kTwoPi = 2 * 3.14159265358979;

using Sensors = std::function<device_models::WiimoteSensors(double t_s)>;
using Event = std::function<std::vector<Report>(device_models::Wiimote&, std::int64_t now_ns)>;

/// `at_s`: when `event` happens, once; 0 never.
Peer MakeWiimote(const device_models::Wiimote& fresh, const Sensors& sensors, double at_s = 0,
                 const Event& event = nullptr) {
  auto model = std::make_shared<device_models::Wiimote>(fresh);
  const auto sample = [=, happened = at_s == 0](double t_s) mutable {
    std::vector<Report> reports;
    if (!happened && t_s >= at_s) {
      happened = true;
      reports = event(*model, Nanoseconds(t_s));
    }
    for (auto& report : model->Sample(Nanoseconds(t_s), sensors(t_s))) reports.push_back(report);
    return reports;
  };
  return {IdentityOf(model->identity()),
          [model](double t_s, std::span<const std::uint8_t> report) {
            return model->HandleOutput(Nanoseconds(t_s), report);
          },
          sample};
}

/// Stick in a circle of 1 Hz, C and Z pressed in turn, tilted to and fro.
device_models::NunchukSensors Stick(double t_s) {
  device_models::NunchukSensors sensors;
  sensors.stick_x = 0.9 * std::sin(kTwoPi * t_s);
  sensors.stick_y = 0.9 * std::cos(kTwoPi * t_s);
  sensors.c = std::fmod(t_s, 0.4) < 0.1;
  sensors.z = std::fmod(t_s + 0.2, 0.4) < 0.1;
  const double tilt_rad = 0.5 * std::sin(kTwoPi * 0.5 * t_s);
  sensors.specific_force_S_mps2 = {9.80665 * std::sin(tilt_rad), 0, -9.80665 * std::cos(tilt_rad)};
  return sensors;
}

/// Turned about all three axes, each fast enough in its turn to leave the slow range.
Eigen::Vector3d Turn(double t_s) {
  return {2 * std::sin(kTwoPi * t_s), 12 * std::sin(kTwoPi * t_s + 2),
          20 * std::sin(kTwoPi * 2 * t_s + 4)};
}

device_models::WiimoteSensors Swung(double t_s) {
  device_models::WiimoteSensors sensors;
  sensors.specific_force_S_mps2 = Swing(t_s);
  return sensors;
}

device_models::WiimoteSensors Everything(double t_s) {
  device_models::WiimoteSensors sensors = Swung(t_s);
  sensors.nunchuk = Stick(t_s);
  sensors.angular_velocity_S_radps = Turn(t_s);
  return sensors;
}

Peer MakePlainWiimote() {
  return MakeWiimote(device_models::Wiimote(11), [](double t_s) {
    device_models::WiimoteSensors sensors = Swung(t_s);
    sensors.buttons = std::fmod(t_s, 0.5) < 0.1 ? reports::kA | reports::kUp : 0;
    return sensors;
  });
}

Peer MakeCamera() {
  return MakeWiimote(device_models::Wiimote(20), [](double t_s) {
    device_models::WiimoteSensors sensors = Swung(t_s);
    const int x = static_cast<int>(std::lround(512 + 300 * std::sin(kTwoPi * t_s)));
    sensors.camera[0] = device_models::CameraPoint{x - 100, 300, 3};
    if (t_s < 1.2) sensors.camera[1] = device_models::CameraPoint{x + 100, 310, 4};
    return sensors;
  });
}

Peer MakeExtended(device_models::Accessory accessory, const device_models::Wiimote& fresh,
                  double pulled_at_s = 0) {
  device_models::Wiimote wiimote = fresh;
  wiimote.Plug(accessory, 0);
  return MakeWiimote(wiimote, Everything, pulled_at_s,
                     [](auto& model, std::int64_t now_ns) { return model.Pull(now_ns); });
}

/// A Nunchuk behind a MotionPlus.
Peer MakeBoth() {
  device_models::Wiimote wiimote(15);
  wiimote.Plug(device_models::Accessory::kMotionPlus, 0);
  return MakeExtended(device_models::Accessory::kNunchuk, wiimote, 1.5);
}

Peer MakeMove(std::uint64_t seed, device_models::MoveModel which) {
  auto model = std::make_shared<device_models::PsMove>(seed, which);
  const auto sample = [model](double t_s) {
    device_models::MoveSensors sensors;
    sensors.specific_force_S_mps2 = Swing(t_s);
    sensors.angular_velocity_S_radps = Turn(t_s) / 2;
    sensors.magnetic_field_S_counts = {200 * std::sin(kTwoPi * t_s), 150, -300};
    sensors.trigger = std::max(0.0, std::sin(kTwoPi * t_s));
    sensors.buttons = std::fmod(t_s, 0.5) < 0.1 ? 1u << 19 : 0;
    return model->Sample(Nanoseconds(t_s), sensors);
  };
  return {IdentityOf(model->identity()),
          [model](double t_s, std::span<const std::uint8_t> report) {
            return model->HandleOutput(Nanoseconds(t_s), report);
          },
          sample,
          [model](std::uint8_t id, std::size_t size) {
            return model->Feature(id, size).value_or(Report{});
          }};
}

Peer MakeBoard() {
  auto model = std::make_shared<device_models::BalanceBoard>(12);
  model->set_temperature(0x1f);  // Warmer than at its calibration.
  const auto sample = [model](double t_s) {
    // Nobody for the first 0.8 s, then 60 kg that lean to the left and back.
    const double kg = t_s < 0.8 ? 0 : 60;
    const double lean = 0.3 * std::sin(kTwoPi * t_s);
    const double left_n = kg * 9.80665 / 4 * (1 + lean);
    const double right_n = kg * 9.80665 / 4 * (1 - lean);
    const auto report = model->Sample({left_n, right_n, left_n, right_n});
    return report ? std::vector<Report>{*report} : std::vector<Report>{};
  };
  return {
      IdentityOf(model->identity()),
      [model](double, std::span<const std::uint8_t> report) { return model->HandleOutput(report); },
      sample};
}

/// wiiuse issue 42: a cell that is stuck.
Report RealBoardReport() {
  Report report = {0x34, 0x00, 0x00, 0x03, 0xd0, 0x19, 0x1a, 0x00,
                   0x17, 0x15, 0x23, 0x19, 0x00, 0x6e, 0x00};
  report.resize(22);
  return report;
}

std::vector<Plan> Plans() {
  using device_models::Accessory;
  using device_models::MoveModel;
  const std::string kSwung = "swung to and fro at 2 Hz";
  const std::string kStick = "stick in circles, C and Z pressed in turn, tilted to and fro";
  const std::string kTurned = "turned about all axes, past the slow range";
  const std::string kMade = "write_device_recordings, ";
  std::vector<Plan> plans = {
      {"wiimote",
       kSwung + ", A and up pressed for 0.1 s each 0.5 s",
       kMade + "Wiimote of seed 11",
       false,
       1.6,
       {},
       MakePlainWiimote},
      {"balance_board", "empty, then 60 kg leaning left and right; at the end a real report",
       kMade + "board of seed 12, warm; the last report is from wiiuse issue 42", false, 2,
       std::vector<Report>(3, RealBoardReport()), MakeBoard},
      {"nunchuk",
       kStick + "; pulled at 1.5 s",
       kMade + "Wiimote of seed 13 with a Nunchuk",
       false,
       2,
       {},
       [] { return MakeExtended(Accessory::kNunchuk, device_models::Wiimote(13), 1.5); }},
      {"classic",
       kSwung + "; pulled at 1 s",
       kMade + "Wiimote of seed 14 with a Classic Controller",
       false,
       1.6,
       {},
       [] { return MakeExtended(Accessory::kClassic, device_models::Wiimote(14), 1); }},
      {"motion_plus",
       kTurned,
       kMade + "Wiimote of seed 16 with a MotionPlus plugged in",
       false,
       2,
       {},
       [] { return MakeExtended(Accessory::kMotionPlus, device_models::Wiimote(16)); }},
      {"motion_plus_nunchuk",
       kTurned + "; " + kStick + "; the Nunchuk is pulled at 1.5 s",
       kMade + "Wiimote of seed 15 with a Nunchuk behind a MotionPlus",
       false,
       2.5,
       {},
       MakeBoth},
      {"wiimote_tr",
       kTurned,
       kMade + "Wiimote -TR of seed 17",
       false,
       2,
       {},
       [] { return MakeWiimote(device_models::Wiimote(17, {.tr = true}), Everything); }},
      {"wiimote_camera",
       "two points that move to and fro, one of them gone after 1.2 s",
       kMade + "Wiimote of seed 20",
       true,
       1.6,
       {},
       MakeCamera},
      {"ps_move_zcm1",
       kTurned + ", trigger pulled, Move pressed",
       kMade + "PS Move ZCM1 of seed 18",
       false,
       1.5,
       {},
       [] { return MakeMove(18, MoveModel::kZcm1); }},
      {"ps_move_zcm2",
       kTurned + ", trigger pulled, Move pressed",
       kMade + "PS Move ZCM2 of seed 19",
       false,
       1.5,
       {},
       [] { return MakeMove(19, MoveModel::kZcm2); }},
  };
  return plans;
}

int Run(const std::filesystem::path& folder, bool expected) {
  if (!expected) {
    for (const Plan& plan : Plans()) {
      std::ofstream(folder / (plan.file + ".report")) << Print(Record(plan));
    }
    return 0;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".report") continue;
    const auto capture = ReadCapture(entry.path());
    const auto content =
        capture ? Replay(capture.value()) : Result<sensor::TickContent>(capture.error());
    if (!content) {
      std::fprintf(stderr, "error: %s\n", content.error().message.c_str());
      return 1;
    }
    std::filesystem::path path = entry.path();
    std::ofstream(path.replace_extension(".expected")) << Print(content.value());
  }
  return 0;
}

}  // namespace
}  // namespace footing::recordings

int main(int argc, char** argv) {
  const bool expected = argc == 3 && std::string(argv[2]) == "--expected";
  if (argc != 2 && !expected) {
    std::fprintf(stderr, "error: usage: write_device_recordings FOLDER [--expected]\n");
    return 2;
  }
  return footing::recordings::Run(argv[1], expected);
}
