#include "daemon/offline/eval/recorded.h"

#include "common/recording/recorded_session.h"

namespace footing::eval {
namespace {

using v1::Tick;

const std::vector<std::uint32_t>& ReplayedFields() {
  static const std::vector<std::uint32_t> fields = {
      Tick::kStatusFieldNumber,     Tick::kRawFieldNumber,   Tick::kFeaturesFieldNumber,
      Tick::kCharactersFieldNumber, Tick::kSetupFieldNumber, Tick::kInputsFieldNumber,
      Tick::kTrackFieldNumber,      Tick::kConfigFieldNumber};
  return fields;
}

}  // namespace

Result<Recorded> ReadRecorded(const std::string& path) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) return session.error();
  Recorded recorded;
  for (const auto& [name, ticks] :
       {std::pair{"footingd", &recorded.sensor}, std::pair{"footing-sim", &recorded.simulation}}) {
    const recording::RecordedServer* server = session->Find(name);
    if (server == nullptr) continue;
    auto read = recording::ReadTicks(*server, ReplayedFields());
    if (!read) return InvalidData(path + ": " + read.error().message);
    *ticks = std::move(*read);
  }
  return recorded;
}

}  // namespace footing::eval
