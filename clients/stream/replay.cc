#include "clients/stream/replay.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "clients/stream/recorded_device.h"
#include "common/runtime/log.h"
#include "common/recording/recorded_identity.h"
#include "common/recording/recorded_session.h"
#include "common/base/units.h"

namespace footing::stream_client {
namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();
/// After the last report, so that its tick is made before the devices detach.
constexpr double kAfterLast_s = 0.1;

/// One stay of a device: from when it attached until it was lost.
struct Stay {
  v1::DeviceStatus status;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  bool lost = false;
  std::vector<RecordedReport> reports;
};

/// Collects the stays of all devices out of footingd's ticks.
class StayCollector {
 public:
  void Take(const v1::Tick& tick) {
    for (const v1::RawReport& raw : tick.raw().reports()) Take(raw);
    for (const v1::DeviceStatus& status : tick.status().devices()) {
      Stay* const stay = Current(status.device());
      if (status.state() == v1::DEVICE_STATE_LOST) {
        if (stay != nullptr) stay->lost = true;
      } else {
        statuses_[status.device()] = status;
        // What a device is becomes known as it answers.
        if (stay != nullptr) stay->status = status;
      }
    }
  }

  std::vector<Stay>& stays() { return stays_; }

 private:
  Stay* Current(std::uint32_t device) {
    const auto found = current_.find(device);
    if (found == current_.end() || stays_[found->second].lost) return nullptr;
    return &stays_[found->second];
  }

  void Take(const v1::RawReport& raw) {
    Stay* stay = Current(raw.device());
    if (stay == nullptr) {
      current_[raw.device()] = stays_.size();
      stay = &stays_.emplace_back();
      stay->first_ns = raw.received_ns();
      stay->status = statuses_[raw.device()];
    }
    stay->last_ns = std::max(stay->last_ns, raw.received_ns());
    RecordedReport report;
    report.time_s = NanosecondsToSeconds(raw.received_ns());  // From the start: see Plan.
    report.bytes.assign(raw.report().begin(), raw.report().end());
    report.to_device = raw.to_device();
    report.feature = raw.feature();
    stay->reports.push_back(std::move(report));
  }

  std::vector<Stay> stays_;
  std::map<std::uint32_t, std::size_t> current_;  ///< Of a device: its newest stay.
  std::map<std::uint32_t, v1::DeviceStatus> statuses_;
};

SimulatedDevice MakeDevice(Stay& stay, std::int64_t start_ns) {
  const double start_s = NanosecondsToSeconds(start_ns);
  for (RecordedReport& report : stay.reports) {
    v1::RawReport raw;
    raw.set_report(report.bytes.data(), report.bytes.size());
    raw.set_to_device(report.to_device);
    raw.set_feature(report.feature);
    report.feature = recording::IsFeature(raw, stay.status);
    report.time_s -= start_s;
  }
  const recording::RecordedIdentity recorded = recording::IdentityOf(stay.status);
  const std::string& stored = stay.status.stored_calibration();
  RecordedDevice device(
      {recorded.bus, recorded.vendor, recorded.product, recorded.name, recorded.serial},
      NanosecondsToSeconds(stay.first_ns - start_ns),
      stay.lost ? NanosecondsToSeconds(stay.last_ns - start_ns) : kNever_s, stay.reports,
      {stored.begin(), stored.end()});
  if (!device.has_handshake()) {
    log::Warning("the recording begins after " + recorded.serial +
                 " was set up: its calibration is not in it");
  }
  return SimulatedDevice(std::move(device), static_cast<stream::DeviceRole>(stay.status.role()));
}

}  // namespace

Result<Plan> PlanReplay(const std::string& path, const Common& common) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) return session.error();
  const recording::RecordedServer* server = session->Find("footingd");
  if (server == nullptr) return InvalidData(path + " has no messages of footingd");
  StayCollector collector;
  for (const recording::RecordedTick& recorded : server->ticks) {
    const auto tick =
        recording::ReadTick(recorded, {v1::Tick::kStatusFieldNumber, v1::Tick::kRawFieldNumber});
    if (!tick) return InvalidData(path + ": " + tick.error().message);
    collector.Take(*tick);
  }
  std::vector<Stay>& stays = collector.stays();
  std::erase_if(stays, [](const Stay& stay) { return stay.status.serial().empty(); });
  if (stays.empty()) return InvalidData(path + " holds no raw report of a device");
  const auto by_start = [](const Stay& a, const Stay& b) { return a.first_ns < b.first_ns; };
  const std::int64_t start_ns = std::min_element(stays.begin(), stays.end(), by_start)->first_ns;
  Plan plan;
  for (Stay& stay : stays) {
    plan.devices.push_back(MakeDevice(stay, start_ns));
    plan.duration_s =
        std::max(plan.duration_s, NanosecondsToSeconds(stay.last_ns - start_ns) + kAfterLast_s);
  }
  plan.duration_s /= common.rate_scale;
  if (common.seconds > 0) plan.duration_s = std::min(plan.duration_s, common.seconds);
  return plan;
}

}  // namespace footing::stream_client
