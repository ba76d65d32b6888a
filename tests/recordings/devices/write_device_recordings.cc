#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <fstream>
#include <functional>
#include <memory>

#include "common/device_models/balance_board.h"
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
  std::function<std::vector<Report>(std::span<const std::uint8_t>)> answer;
  std::function<std::vector<Report>(double t_s)> sample;
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
  std::deque<Report> answers;
  const auto note = [&](bool to_device, const Report& bytes) {
    capture.reports.push_back({now_ns - kStartNs, to_device, false, bytes});
  };
  sensor::Hub hub(config, {[&](devices::DeviceHandle, const reports::OutputReport& report) {
                             note(true, report);
                             for (auto& one : peer.answer(report)) answers.push_back(one);
                           },
                           [](const std::string&) {}, [&now_ns] { return now_ns; }});
  constexpr devices::DeviceHandle kHandle = 1;
  const auto send = [&](const Report& report) {
    note(false, report);
    hub.OnReport(kHandle, {now_ns, report});
  };
  hub.OnAttach(kHandle, peer.identity);
  const auto ticks = static_cast<int>(std::lround(plan.seconds * 1e9 / kTickNs));
  for (int tick = 0; tick < ticks; ++tick) {
    now_ns += kTickNs;
    for (const Report& report : std::exchange(answers, {})) send(report);
    const double t_s = static_cast<double>(now_ns - kStartNs) * 1e-9;
    for (const Report& report : peer.sample(t_s)) send(report);
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

Peer MakeWiimote() {
  auto model = std::make_shared<device_models::Wiimote>(11);
  const auto sample = [model](double t_s) {
    const std::uint16_t buttons = std::fmod(t_s, 0.5) < 0.1 ? reports::kA | reports::kUp : 0;
    const auto report = model->Sample(Swing(t_s), buttons);
    return report ? std::vector<Report>{*report} : std::vector<Report>{};
  };
  return {IdentityOf(model->identity()),
          [model](std::span<const std::uint8_t> report) { return model->HandleOutput(report); },
          sample};
}

Peer MakeBoard() {
  auto model = std::make_shared<device_models::BalanceBoard>(12);
  const auto sample = [model](double t_s) {
    // Nobody for the first half second, then 60 kg that lean to the left and back.
    const double kg = t_s < 0.8 ? 0 : 60;
    const double lean = 0.3 * std::sin(2 * 3.14159265358979 * t_s);
    const double left_n = kg * 9.80665 / 4 * (1 + lean);
    const double right_n = kg * 9.80665 / 4 * (1 - lean);
    const auto report = model->Sample({left_n, right_n, left_n, right_n});
    return report ? std::vector<Report>{*report} : std::vector<Report>{};
  };
  return {IdentityOf(model->identity()),
          [model](std::span<const std::uint8_t> report) { return model->HandleOutput(report); },
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
  return {
      {"wiimote",
       "swung to and fro at 2 Hz, A and up pressed for 0.1 s each 0.5 s",
       "write_device_recordings, Wiimote of seed 11",
       false,
       1.6,
       {},
       MakeWiimote},
      {"balance_board", "empty, then 60 kg leaning left and right; at the end a real report",
       "write_device_recordings, board of seed 12; the last report is from wiiuse issue 42", false,
       2, std::vector<Report>(3, RealBoardReport()), MakeBoard},
  };
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
