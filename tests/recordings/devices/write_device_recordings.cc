#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <fstream>
#include <functional>
#include <memory>
#include <utility>

#include "daemon/sensor/service/hub.h"
#include "tests/recordings/devices/peers.h"
#include "tests/recordings/devices/replay.h"

/// Writes the captures that are made with device models, or what is expected of all there are:
///
///   write_device_recordings FOLDER              FOLDER/*.report of every model
///   write_device_recordings FOLDER --expected   FOLDER/*.expected of every *.report in it
///
/// Captures of real devices are put into the folder by hand and have only the second done to them.
namespace footing::recordings {
namespace {

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
                           [](const sensor::LogLine&) {}, [&now_ns] { return now_ns; },
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
                    {"Firmware", "device model of common/virtual/devices"},
                    {"Motion", plan.motion},
                    {"Date", "2026-11-21"},
                    {"Made", plan.made}};
  if (plan.camera) capture.header.emplace_back("Camera", "on");
  return capture;
}

/// A Nunchuk behind a MotionPlus.
Peer MakeBoth() {
  virtual_devices::Wiimote wiimote(15);
  wiimote.Plug(virtual_devices::Accessory::kMotionPlus, 0);
  return MakeExtended(virtual_devices::Accessory::kNunchuk, wiimote, 1.5);
}

/// wiiuse issue 42: a cell that is stuck.
Report RealBoardReport() {
  Report report = {0x34, 0x00, 0x00, 0x03, 0xd0, 0x19, 0x1a, 0x00,
                   0x17, 0x15, 0x23, 0x19, 0x00, 0x6e, 0x00};
  report.resize(22);
  return report;
}

std::vector<Plan> Plans() {
  using virtual_devices::Accessory;
  using virtual_devices::MoveModel;
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
       [] { return MakeExtended(Accessory::kNunchuk, virtual_devices::Wiimote(13), 1.5); }},
      {"classic",
       kSwung + "; pulled at 1 s",
       kMade + "Wiimote of seed 14 with a Classic Controller",
       false,
       1.6,
       {},
       [] { return MakeExtended(Accessory::kClassic, virtual_devices::Wiimote(14), 1); }},
      {"motion_plus",
       kTurned,
       kMade + "Wiimote of seed 16 with a MotionPlus plugged in",
       false,
       2,
       {},
       [] { return MakeExtended(Accessory::kMotionPlus, virtual_devices::Wiimote(16)); }},
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
       [] { return MakeExtended(Accessory::kNone, virtual_devices::Wiimote(17, {.tr = true})); }},
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
