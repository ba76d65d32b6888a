#include "daemon/offline/eval/replay.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "common/recording/recorded_session.h"
#include "common/wire/wire.h"
#include "daemon/sensor/service/hub.h"

namespace footing::eval {

v1::EffectiveConfig ConfigOf(const std::vector<v1::Tick>& ticks) {
  const auto configured = std::find_if(ticks.begin(), ticks.end(),
                                       [](const v1::Tick& tick) { return tick.has_config(); });
  return configured == ticks.end() ? v1::EffectiveConfig() : configured->config();
}

namespace {

/// Config of the recorded footingd, as far as its features depend on it.
sensor::Config SensorConfigOf(const std::vector<v1::Tick>& ticks) {
  sensor::Config config;
  config.features = sensor::FeaturesIn(ConfigOf(ticks).json());
  return config;
}

/// A Hub whose clock follows the recording: what was read or written next says what time it was.
class HubReplay {
 public:
  explicit HubReplay(const std::vector<v1::Tick>& ticks)
      : hub_(SensorConfigOf(ticks), {[](devices::DeviceHandle, const reports::OutputReport&) {},
                                     [](const sensor::LogLine&) {},
                                     [this] { return NowNs(); },
                                     [](devices::DeviceHandle, std::uint8_t, std::size_t) {},
                                     [this](const std::string& serial) { return StoredOf(serial); },
                                     {},
                                     {}}) {
    for (const v1::Tick& tick : ticks) {
      for (const v1::DeviceStatus& status : tick.status().devices()) {
        statuses_.emplace(status.device(), status);
      }
    }
  }

  sensor::TickContent Run(const v1::Tick& tick) {
    raw_ = &tick.raw();
    next_ = 0;
    // A tick's status names what was attached or lost since the tick before. The first report goes
    // out at the attachment: a status without reports is a snapshot of later devices, or of no
    // news.
    for (const v1::DeviceStatus& status : tick.status().devices()) {
      const bool attached = status.state() != v1::DEVICE_STATE_LOST && next_ < raw_->reports_size();
      if (attached) AttachIfNew(status.device());
    }
    while (next_ < raw_->reports_size()) {
      const v1::RawReport& report = raw_->reports(next_++);
      if (report.to_device()) continue;
      now_ns_ = report.received_ns();
      AttachIfNew(report.device());
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(report.report().data());
      hub_.OnReport(report.device(), {report.received_ns(),
                                      {bytes, report.report().size()},
                                      0,
                                      recording::IsFeature(report, statuses_[report.device()])});
    }
    now_ns_ = tick.host_ns();
    for (const v1::DeviceStatus& status : tick.status().devices()) {
      if (status.state() != v1::DEVICE_STATE_LOST || attached_.erase(status.device()) == 0)
        continue;
      hub_.OnDetach(status.device(), "lost in the recording");
    }
    // Changes since the tick before hold from the end of this one on, as in the daemon.
    if (tick.has_setup()) TakeSetup(tick.setup());
    return hub_.Tick(now_ns_);
  }

 private:
  std::int64_t NowNs() const {
    const bool writes_next =
        raw_ != nullptr && next_ < raw_->reports_size() && raw_->reports(next_).to_device();
    return writes_next ? raw_->reports(next_).received_ns() : now_ns_;
  }

  /// The calibration that footingd had kept of a device.
  std::optional<std::vector<std::uint8_t>> StoredOf(const std::string& serial) const {
    for (const auto& [device, status] : statuses_) {
      const std::string& stored = status.stored_calibration();
      if (status.serial() == serial && !stored.empty())
        return std::vector<std::uint8_t>(stored.begin(), stored.end());
    }
    return std::nullopt;
  }

  void TakeSetup(const v1::SetupState& setup) {
    std::map<std::string, stream::DeviceMounting> mountings;
    for (const v1::RigSetup& rig : setup.rigs()) {
      for (auto& one : wire::FromProto(rig).mountings) mountings[one.serial] = one;
    }
    for (const auto& [device, status] : statuses_) {
      const auto found = mountings.find(status.serial());
      if (found == mountings.end()) {
        (void)hub_.setup().ClearMounting(status.serial());
        continue;
      }
      hub_.setup().StoreMounting({status.rig(), static_cast<stream::DeviceRole>(status.role())},
                                 found->second);
    }
  }

  void AttachIfNew(std::uint32_t device) {
    if (!attached_.insert(device).second) return;
    const v1::DeviceStatus& status = statuses_[device];
    devices::DeviceIdentity identity;
    const recording::RecordedIdentity recorded = recording::IdentityOf(status);
    identity.bus = static_cast<devices::Bus>(recorded.bus);
    identity.vendor = recorded.vendor;
    identity.product = recorded.product;
    identity.name = recorded.name;
    identity.serial = recorded.serial;
    identity.simulated = status.simulated();
    identity.wished_rig = status.rig();
    identity.wished_role = static_cast<stream::DeviceRole>(status.role());
    hub_.OnAttach(device, identity);
  }

  sensor::Hub hub_;
  std::map<std::uint32_t, v1::DeviceStatus> statuses_;
  std::set<std::uint32_t> attached_;
  const v1::RawReports* raw_ = nullptr;
  int next_ = 0;
  std::int64_t now_ns_ = 0;
};

/// The features alone: stamps of when they were worked out differ from run to run.
std::string Comparable(v1::RigFeatures features) {
  features.clear_decoded_ns();
  features.clear_computed_ns();
  return features.SerializeAsString();
}

}  // namespace

FeaturesReplay ReplayFeatures(const std::vector<v1::Tick>& ticks) {
  FeaturesReplay result;
  HubReplay hub(ticks);
  for (const v1::Tick& tick : ticks) {
    ++result.ticks;
    const sensor::TickContent content = hub.Run(tick);
    std::map<std::string, std::string> again;
    for (const auto& rig : content.features) again[rig.rig] = Comparable(wire::ToProto(rig));
    for (const v1::RigFeatures& rig : tick.features().rigs()) {
      ++result.compared;
      const auto found = again.find(rig.rig());
      if (found != again.end() && found->second == Comparable(rig)) {
        ++result.equal;
      } else if (result.first_difference_sequence == 0) {
        result.first_difference_sequence = tick.sequence();
      }
    }
  }
  return result;
}

Result<void> CheckFirstStep(std::uint64_t first_step) {
  constexpr std::uint64_t kLatestFirstStep = 100;  // No input can have come before.
  if (first_step <= kLatestFirstStep) return {};
  return InvalidData(
      "the recording begins at step " + std::to_string(first_step) +
      " of the simulation; only one from its first step can be run again (record "
      "with footing-log record --from-ring within 30 s of the start of footing-sim)");
}

}  // namespace footing::eval
