#include <fstream>
#include <string>

#include "common/base/result.h"
#include "common/board/layout.h"
#include "common/recording/recording_writer.h"
#include "common/virtual/motion/bvh.h"
#include "common/wire/wire.h"
#include "tests/offline/learning/made_take.h"

namespace footing {
namespace {

constexpr std::int64_t kStartNs = 5'000'000'000;

/// Fault of the recording: "" none.
struct Writer {
  recording::RecordingWriter& out;
  const std::string& fault;

  void Put(const std::string& channel, const google::protobuf::Message& message, double time_s) {
    const auto ns = kStartNs + static_cast<std::int64_t>(1e9 * time_s);
    FOOTING_CHECK(out.Write("/footingd/" + channel, message, {ns, ns, 0}).ok());
  }

  void PutSetUp() {
    v1::DeviceStatusList list;
    v1::SetupState setup;
    for (const std::string rig : {"main", "other"}) {
      if (rig == "other" && fault != "two_people") continue;
      for (const std::uint32_t side : {0u, 1u}) {
        v1::DeviceStatus& status = *list.add_devices();
        status.set_device((rig == "main" ? 1 : 3) + side);
        status.set_rig(rig);
        status.set_role(side == 0 ? v1::DEVICE_ROLE_LEFT_BOARD : v1::DEVICE_ROLE_RIGHT_BOARD);
      }
      v1::RigSetup& message = *setup.add_rigs();
      message.set_rig(rig);
      *message.mutable_layout() = wire::ToProto(board::DefaultLayout());
    }
    Put("status", list, 0);
    Put("setup", setup, 0);
  }

  void PutBoard(const learning::BoardReading& reading, std::uint32_t device) {
    v1::BoardSamples samples;
    v1::BoardSample& sample = *samples.add_samples();
    sample.set_device(device);
    sample.set_sampled_ns(kStartNs + static_cast<std::int64_t>(1e9 * reading.time_s));
    sample.set_top_left_n(reading.corners_n[0]);
    sample.set_top_right_n(reading.corners_n[1]);
    sample.set_bottom_left_n(reading.corners_n[2]);
    sample.set_bottom_right_n(reading.corners_n[3]);
    sample.set_uncalibrated(fault == "uncalibrated");
    Put("boards", samples, reading.time_s);
  }

  void PutHand(const learning::HandReading& reading, std::size_t side) {
    v1::HandSamples samples;
    v1::HandSample& sample = *samples.add_samples();
    sample.set_rig("main");
    sample.set_role(side == 0 ? v1::DEVICE_ROLE_LEFT_HAND : v1::DEVICE_ROLE_RIGHT_HAND);
    sample.set_sampled_ns(kStartNs + static_cast<std::int64_t>(1e9 * reading.time_s));
    *sample.mutable_position_m() = wire::ToProto(reading.p_W_m);
    *sample.mutable_sd_m() = wire::ToProto(reading.sd_m);
    sample.set_confidence(1);
    Put("hands", samples, reading.time_s);
  }
};

void Write(const learning::MadeTake& take, const std::string& folder, const std::string& fault) {
  const std::string name = fault.empty() ? "me" : fault;
  auto made = recording::RecordingWriter::Create(folder + "/" + name + ".mcap", {"made", true, {}});
  FOOTING_CHECK(made.ok());
  Writer writer{*made, fault};
  writer.PutSetUp();
  for (std::size_t side = 0; side < 2; ++side) {
    for (const auto& reading : take.session.boards[side]) {
      if (fault == "no_boards" || (fault == "three_hours" && reading.time_s > 1)) continue;
      writer.PutBoard(reading, 1 + static_cast<std::uint32_t>(side));
      if (fault == "two_people") writer.PutBoard(reading, 3 + static_cast<std::uint32_t>(side));
    }
    if (fault == "three_hours")
      writer.PutBoard({3.0 * 3600, {}}, 1 + static_cast<std::uint32_t>(side));
    for (const auto& reading : take.session.hands[side]) writer.PutHand(reading, side);
  }
  FOOTING_CHECK(made->Finish().ok());
}

void WriteAll(const std::string& folder) {
  learning::MadeTakeSettings settings{.offset_s = 1.5, .drift = 60e-6};
  const learning::MadeTake take = learning::MakeTake(settings);
  std::ofstream(folder + "/me_01.bvh") << motion::WriteBvh(take.motion);
  for (const char* fault : {"", "no_boards", "three_hours", "two_people", "uncalibrated"}) {
    Write(take, folder, fault);
  }
  settings.stomps = false;
  Write(learning::MakeTake(settings), folder, "no_stomps");
}

}  // namespace
}  // namespace footing

/// write_own_recording FOLDER: me.mcap and the motion beside it, me_01.bvh; and with one thing
/// wrong each no_boards.mcap, no_stomps.mcap, three_hours.mcap, two_people.mcap and
/// uncalibrated.mcap.
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  footing::WriteAll(argv[1]);
  return 0;
}
