#include "common/stream/response.h"

#include <array>
#include <utility>

#include "common/base/units.h"

namespace footing::stream {

std::vector<ResponseStage> ResponseTimes(const ResponseStages& r) {
  const std::array<std::pair<const char*, std::int64_t>, 7> stamps{
      {{"", r.report_received_ns},
       {"decode", r.decoded_ns},
       {"features", r.features_computed_ns},
       {"transport", r.features_received_ns},
       {"command", r.command_ns},
       {kContactStage, r.contact_ns},
       {"frame", r.first_frame_ns}}};
  std::vector<ResponseStage> stages;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const std::int64_t from_ns = stamps[i - 1].second, to_ns = stamps[i].second;
    if (from_ns == 0 || to_ns < from_ns) return {};
    stages.push_back({stamps[i].first, NanosecondsToMilliseconds(to_ns - from_ns)});
  }
  return stages;
}

}  // namespace footing::stream
