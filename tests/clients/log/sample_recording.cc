#include "tests/clients/log/sample_recording.h"

#include "common/base/result.h"
#include "common/recording/stream_recorder.h"

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

}  // namespace footing::log_client
