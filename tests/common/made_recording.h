#pragma once

#include <string>

#include "common/base/result.h"
#include "common/recording/recording_writer.h"
#include "common/recording/stream_recorder.h"
#include "footing/v1/session.pb.h"

namespace footing::test {

/// A recording of the ticks that a test gives it, complete when this goes.
class MadeRecording {
 public:
  explicit MadeRecording(const std::string& path)
      : writer_(recording::RecordingWriter::Create(path, {"test", true, {}})),
        recorder_(Checked(), "unix:/x", [](const std::string& id) { return id; }) {}
  ~MadeRecording() { FOOTING_CHECK(writer_->Finish().ok()); }
  MadeRecording(const MadeRecording&) = delete;
  MadeRecording& operator=(const MadeRecording&) = delete;

  /// From here on all is of this server, whose wall time is known where `host_ns` is not 0.
  void Begin(const std::string& server_id, std::int64_t host_ns = 0,
             std::int64_t wall_time_ns = 0) {
    v1::Welcome welcome;
    welcome.set_server_id(server_id);
    welcome.set_host_ns(host_ns);
    welcome.set_wall_time_ns(wall_time_ns);
    FOOTING_CHECK(recorder_.OnWelcome(welcome, 0).ok());
  }
  void Add(const v1::Tick& tick) { FOOTING_CHECK(recorder_.OnTick(tick, tick.host_ns()).ok()); }

 private:
  recording::RecordingWriter& Checked() {
    FOOTING_CHECK(writer_.ok());
    return *writer_;
  }

  Result<recording::RecordingWriter> writer_;
  recording::StreamRecorder recorder_;
};

}  // namespace footing::test
