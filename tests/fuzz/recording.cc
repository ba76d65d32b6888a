#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "common/net/tick.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/recorded_session.h"
#include "common/recording/recording_server.h"
#include "common/recording/seekable_recording.h"
#include "tests/fuzz/input.h"

/// Any bytes as a recording: read by every reader, from end to end, by its index, and by one that
/// is made for it. What borrows from the file lies within it.
namespace footing::fuzz {
namespace {

struct Counts {
  std::size_t messages = 0, others = 0;
};

mcap::WalkEnd WalkAll(std::string_view file, mcap::WalkMode mode, Counts& counts) {
  const auto within = [file](std::string_view part) {
    Expect(part.empty() ||
           (part.data() >= file.data() && part.data() + part.size() <= file.data() + file.size()));
  };
  mcap::Visitor visitor;
  visitor.header = [&](const mcap::Header&) { ++counts.others; };
  visitor.schema = [&](const mcap::Schema& schema) { Expect(schema.id != 0); };
  visitor.channel = [&](const mcap::Channel&) { ++counts.others; };
  visitor.message = [&](const mcap::Message& message) {
    ++counts.messages;
    within(message.data);
  };
  visitor.attachment = [&](const mcap::Attachment& attachment) { within(attachment.data); };
  visitor.metadata = [&](const mcap::Metadata&) { ++counts.others; };
  return mcap::Walk(file, visitor, mode);
}

void CheckWalks(std::string_view file) {
  Counts strict, salvaged;
  const mcap::WalkEnd end = WalkAll(file, mcap::WalkMode::kStrict, strict);
  const mcap::WalkEnd rest = WalkAll(file, mcap::WalkMode::kSalvage, salvaged);
  Expect(end.complete == end.problem.empty() && end.end_offset <= file.size());
  Expect(salvaged.messages >= strict.messages && rest.end_offset <= file.size());
  if (end.complete) Expect(rest.complete && salvaged.messages == strict.messages);
}

void CheckChunks(std::string_view file, const mcap::Summary& summary) {
  std::size_t seen = 0;
  const auto count = [&seen](const mcap::Message& message) { seen += 1 + message.data.size(); };
  for (const mcap::ChunkIndex& chunk : summary.chunks) {
    if (!mcap::CheckChunk(file, chunk)) continue;
    Expect(mcap::VisitChunk(file, chunk, count).ok());
    for (const auto& [channel, offset] : chunk.message_index_offsets) {
      Expect(mcap::VisitChannel(file, chunk, channel, count).ok());
    }
  }
}

void CheckIndexes(std::string_view file) {
  if (const auto summary = mcap::ReadSummary(file)) CheckChunks(file, *summary);
  (void)mcap::ReadSummary(file, 100).ok();
  (void)mcap::RebuildIndex(file, 2, 200).ok();
  if (const auto rebuilt = mcap::RebuildIndex(file, 1000)) {
    Expect(rebuilt->end_offset <= file.size());
    CheckChunks(file, rebuilt->summary);
  }
}

void CheckPlayback(const std::string& path) {
  const std::vector<std::string> names{"footingd", "footing-sim"};
  auto recording = playback::SeekableRecording::Open(path, names, {"status", "motion", "track"});
  if (!recording) return;
  const std::int64_t first_ns = recording->first_ns(), last_ns = recording->last_ns();
  Expect(first_ns <= last_ns);
  for (const auto& tick : recording->Ticks(first_ns, last_ns + 1)) {
    Expect(tick.time_ns >= first_ns && tick.time_ns <= last_ns && tick.delay_ns >= 0);
  }
  for (std::size_t server = 0; server < names.size(); ++server) {
    if (!recording->Has(server)) continue;
    (void)recording->LastOf(server, "motion", last_ns);
    (void)recording->LastOf(server, "status", first_ns - 1, true);
    recording->Visit(server, "motion", [](const playback::PlacedTick&) {});
  }
  (void)recording->Limits();
}

void CheckSession(const std::string& path) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) return;
  for (const recording::RecordedServer& server : session->servers()) {
    Expect(transport::IsTickRate(server.tick_rate_hz));
    if (auto ticks = recording::ReadTicks(server)) {
      for (v1::Tick& tick : *ticks) playback::ShiftStamps(tick, tick.host_ns());
    }
    (void)recording::ReadTicks(server, {17}).ok();
    (void)session->Find(server.name);
  }
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  const std::string_view file(reinterpret_cast<const char*>(data), size);
  fuzz::CheckWalks(file);
  fuzz::CheckIndexes(file);
  static const int descriptor = memfd_create("recording", MFD_CLOEXEC);
  fuzz::Expect(ftruncate(descriptor, 0) == 0 &&
               pwrite(descriptor, data, size, 0) == static_cast<ssize_t>(size));
  const std::string path = "/proc/self/fd/" + std::to_string(descriptor);
  fuzz::CheckPlayback(path);
  fuzz::CheckSession(path);
  return 0;
}
