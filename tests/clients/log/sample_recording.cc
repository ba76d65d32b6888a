#include "tests/clients/log/sample_recording.h"

#include "common/base/result.h"
#include "common/recording/stream_recorder.h"
#include "tests/common/made_recording.h"

namespace footing::log_client {
namespace {

v1::Tick SampleTick(int k, bool simulated) {
  v1::Tick tick;
  tick.set_sequence(static_cast<std::uint64_t>(k));
  tick.set_host_ns(std::int64_t{10'000'000} * k);
  v1::MotionSample& sample = *tick.mutable_motion()->add_samples();
  sample.set_device(1);
  sample.set_report_count(static_cast<std::uint64_t>(k));
  sample.set_simulated(simulated);
  sample.mutable_specific_force_mps2()->set_z(-9.80665);
  if (k % 50 == 0) {
    v1::DeviceStatus& status = *tick.mutable_status()->add_devices();
    status.set_device(1);
    status.set_note("battery, \"low\"");
    status.set_simulated(simulated);
  }
  return tick;
}

}  // namespace

void WriteSampleRecording(const std::string& path, bool simulated, bool compress) {
  recording::WriterSettings settings{"footing-log test", true, {}};
  settings.chunks.compress = compress;
  auto writer = recording::RecordingWriter::Create(path, settings);
  FOOTING_CHECK(writer.ok());
  recording::StreamRecorder recorder(*writer, "unix:/made",
                                     [](const std::string& id) { return id; });
  v1::Welcome welcome;
  welcome.set_server_id("footingd");
  welcome.set_version("0.1.0");
  FOOTING_CHECK(recorder.OnWelcome(welcome, 0).ok());
  FOOTING_CHECK(writer->Attach("config.json", "application/json", "{}", 0).ok());
  for (int k = 0; k < kSampleTicks; ++k) {
    FOOTING_CHECK(recorder.OnTick(SampleTick(k, simulated), std::int64_t{10'000'000} * k).ok());
    if (k != 100) continue;
    v1::Gap gap;
    gap.set_from_sequence(101);
    gap.set_to_sequence(105);
    FOOTING_CHECK(recorder.OnGap(gap, std::int64_t{10'000'000} * k).ok());
  }
  FOOTING_CHECK(recorder.OnEnd({}, 0).ok());
  FOOTING_CHECK(writer->Finish().ok());
}

namespace {

constexpr int kSceneTicks = 100;

void AddLink(const std::string& name, int parent, v1::Skeleton& skeleton) {
  v1::Link& link = *skeleton.add_links();
  link.set_name(name);
  link.set_parent(parent);
  link.mutable_size_m()->set_x(0.1);
  link.mutable_size_m()->set_y(0.1);
  link.mutable_size_m()->set_z(0.1);
}

void AddSegment(double start_m, bool pit, v1::Track& track) {
  v1::TrackSegment& segment = *track.add_segments();
  segment.mutable_start_m()->set_x(start_m);
  segment.set_length_m(2);
  segment.set_width_m(4);
  segment.set_pit(pit);
}

v1::Tick SceneOfBoards(int k) {
  v1::Tick tick;
  tick.set_sequence(static_cast<std::uint64_t>(k + 1));
  tick.set_host_ns(1'000'000'000 + std::int64_t{10'000'000} * k);
  if (k == 0) {
    tick.mutable_setup()->add_rigs()->set_rig("main");
    for (const int device : {1, 2}) {
      v1::DeviceStatus& status = *tick.mutable_status()->add_devices();
      status.set_device(static_cast<std::uint32_t>(device));
      status.set_rig("main");
      status.set_role(device == 1 ? v1::DEVICE_ROLE_LEFT_BOARD : v1::DEVICE_ROLE_RIGHT_BOARD);
    }
  }
  for (const std::uint32_t device : {1u, 2u}) {
    v1::BoardSample& sample = *tick.mutable_boards()->add_samples();
    sample.set_device(device);
    sample.set_sampled_ns(tick.host_ns());
    sample.set_total_n(device == 1 ? 500 : 0);
    sample.set_cop_valid(device == 1);
  }
  if (k != 50) return tick;
  for (const char* text : {"stimulus on", "again"}) {
    v1::Event& event = *tick.mutable_events()->add_events();
    event.set_kind(v1::Event::KIND_MARKER);
    event.set_text(text);
    event.set_host_ns(tick.host_ns() - 1000);
    if (event.text() == "stimulus on") event.mutable_marker()->set_value(3);
  }
  return tick;
}

v1::Tick SnapshotOfPerson() {
  v1::Tick tick;
  tick.set_snapshot(true);
  tick.set_sequence(50);
  tick.set_host_ns(1'500'000'000);
  v1::Skeleton& skeleton = *tick.mutable_skeletons()->add_skeletons();
  skeleton.set_name("person");
  AddLink("hips", -1, skeleton);
  AddLink("end", 0, skeleton);
  AddLink("end", 1, skeleton);
  AddSegment(0, false, *tick.mutable_track());
  AddSegment(2, true, *tick.mutable_track());
  AddSegment(4, false, *tick.mutable_track());
  return tick;
}

v1::Tick SceneOfPerson(int k) {
  v1::Tick tick;
  tick.set_sequence(static_cast<std::uint64_t>(k + 1));
  tick.set_host_ns(1'000'000'000 + std::int64_t{10'000'000} * k);
  v1::Character& character = *tick.mutable_characters()->add_characters();
  for (const double height_m : {1.0, 0.5, 0.0}) {
    v1::LinkPose& link = *character.add_links();
    link.mutable_position_m()->set_x(0.01 * k);
    link.mutable_position_m()->set_z(height_m);
    link.mutable_orientation()->set_w(1);
  }
  character.mutable_com_m()->set_z(0.9);
  v1::Contact& contact = *character.add_contacts();
  contact.set_touching(true);
  contact.set_normal_force_n(500);
  contact.mutable_position_m()->set_y(0.1);
  if (k != 70) return tick;
  v1::Event& event = *tick.mutable_events()->add_events();
  event.set_kind(v1::Event::KIND_FALL);
  event.set_text("fell");
  return tick;
}

}  // namespace

void WriteSceneRecording(const std::string& path) {
  test::MadeRecording recording(path);
  recording.Begin("footingd");
  for (int k = 0; k < kSceneTicks; ++k) recording.Add(SceneOfBoards(k));
  recording.Begin("footing-sim");
  recording.Add(SnapshotOfPerson());
  for (int k = 0; k < kSceneTicks; ++k) recording.Add(SceneOfPerson(k));
}

}  // namespace footing::log_client
