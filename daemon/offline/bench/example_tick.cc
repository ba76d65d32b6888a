#include "daemon/offline/bench/example_tick.h"

#include "common/wire/wire.h"
#include "footing/v1/session.pb.h"

namespace footing::bench {
namespace {

constexpr std::int64_t kSomeNs = 123'456'789'012'345;
constexpr std::uint64_t kSomeCount = 360'000;  // An hour at 100 Hz.

v1::MotionSamples Motion() {
  v1::MotionSamples message;
  for (std::uint32_t device = 1; device <= 3; ++device) {
    stream::MotionSample sample;
    sample.device = device;
    sample.report_count = kSomeCount;
    sample.received_ns = sample.sampled_ns = kSomeNs;
    sample.specific_force_mps2 = {0.1, -1.2, -9.7};
    sample.filtered_mps2 = {0.11, -1.19, -9.71};
    *message.add_samples() = wire::ToProto(sample);
  }
  return message;
}

v1::BoardSamples Boards() {
  stream::BoardSample sample;
  sample.report_count = kSomeCount;
  sample.received_ns = sample.sampled_ns = kSomeNs;
  sample.top_left_n = sample.top_right_n = sample.bottom_left_n = sample.bottom_right_n = 171.5;
  sample.total_n = 686;
  sample.cop_x_m = 0.01;
  sample.cop_y_m = -0.02;
  sample.cop_valid = sample.contact = true;
  v1::BoardSamples message;
  for (std::uint32_t device = 4; device <= 5; ++device) {
    sample.device = device;
    *message.add_samples() = wire::ToProto(sample);
  }
  return message;
}

v1::FeatureFrame Features() {
  stream::RigFeatures rig;
  rig.rig = "rig1";
  for (std::uint32_t device = 1; device <= 3; ++device) {
    stream::DeviceFeatures features;
    features.device = device;
    features.role = stream::DeviceRole::kLeftHand;
    features.moving = features.frequency_valid = features.amplitude_valid = true;
    features.inclination_valid = true;
    features.frequency_hz = 1.9;
    features.amplitude_mps2 = 12.5;
    features.roll_rad = 0.2;
    features.pitch_rad = -0.1;
    rig.devices.push_back(features);
  }
  rig.pairs.push_back({1, 2, true, 3.1});
  rig.newest_received_ns = rig.decoded_ns = rig.computed_ns = kSomeNs;
  v1::FeatureFrame message;
  *message.add_rigs() = wire::ToProto(rig);
  return message;
}

v1::RawReports Raw() {
  v1::RawReports message;
  for (std::uint32_t device = 1; device <= 5; ++device) {
    stream::RawReport report;
    report.device = device;
    report.received_ns = kSomeNs;
    report.report.assign(device >= 4 ? 22 : 6, 0x80);  // Reports 0x34 and 0x31 with their id.
    *message.add_reports() = wire::ToProto(report);
  }
  return message;
}

}  // namespace

std::vector<transport::Channel> SensorChannels() {
  return {{"status", 16, true},
          {"motion", 17, false},
          {"features", 18, false},
          {"boards", 19, false},
          {"raw", 20, false}};
}

std::vector<transport::ChannelBytes> ExampleTick() {
  return {{17, Motion().SerializeAsString()},
          {18, Features().SerializeAsString()},
          {19, Boards().SerializeAsString()},
          {20, Raw().SerializeAsString()}};
}

transport::ServerOptions ServerOptionsFor(double tick_rate_hz, double ring_s) {
  transport::ServerOptions options;
  options.server_id = "footing-bench";
  options.channels = SensorChannels();
  options.tick_rate_hz = tick_rate_hz;
  options.ring_s = ring_s;
  options.dead_after_s = 600;
  // All viewers of a benchmark come from this host.
  options.sessions.max_sessions_per_host = options.sessions.max_sessions;
  return options;
}

}  // namespace footing::bench
