#include "tests/vm/tally.h"

#include <algorithm>

#include "common/stream/device.h"

namespace footing::vm {
namespace {

/// Longer than any outage of the mode, shorter than any device is away.
constexpr std::int64_t kSilenceNs = 400'000'000;

}  // namespace

void Tally::CountBetween(std::int64_t begin_ns, std::int64_t end_ns) {
  begin_ns_ = begin_ns;
  end_ns_ = end_ns;
}

int Tally::Live() const {
  return static_cast<int>(std::count_if(devices_.begin(), devices_.end(), [](const auto& one) {
    return one.second.status.state() == v1::DEVICE_STATE_LIVE;
  }));
}

void Tally::TakeTick(const v1::Tick& tick, std::int64_t now_ns) {
  ++ticks_;
  for (const v1::DeviceStatus& status : tick.status().devices()) {
    One& one = devices_[status.device()];
    one.status = status;
    if (one.places.empty() || one.places.back() != status.place()) {
      one.places.push_back(status.place());
    }
  }
  for (const v1::MotionSample& sample : tick.motion().samples()) {
    One& one = devices_[sample.device()];
    const bool move = one.status.kind() == v1::DEVICE_KIND_PS_MOVE;
    TakeSample(one, move ? kMoveRampMps2 : kForceRampMps2, sample.specific_force_mps2().x(),
               sample.report_count(), sample.received_ns(), now_ns);
    if (sample.has_angular_velocity_radps() && sample.received_ns() >= begin_ns_ &&
        sample.received_ns() < end_ns_) {
      ++one.turning_samples;
    }
  }
  for (const v1::BoardSample& sample : tick.boards().samples()) {
    TakeSample(devices_[sample.device()], kCornerRampN, sample.top_left_n(), sample.report_count(),
               sample.received_ns(), now_ns);
  }
  for (const v1::NunchukSample& sample : tick.nunchuk().samples()) {
    if (sample.received_ns() >= begin_ns_ && sample.received_ns() < end_ns_) {
      ++devices_[sample.device()].nunchuk_samples;
    }
  }
}

void Tally::TakeSample(One& one, const Ramp& ramp, double value, std::uint64_t report_count,
                       std::int64_t received_ns, std::int64_t now_ns) {
  const int step = ramp.StepOf(value);
  const std::int64_t silence_ns = received_ns - one.last_received_ns;
  if (one.last_received_ns == 0 || silence_ns > kSilenceNs) one.resumed_ns.push_back(now_ns);
  if (report_count < one.last_report_count)
    one.last_step = -1;  // The ramp went on while it was away.
  one.last_report_count = report_count;
  const bool counts = received_ns >= begin_ns_ && received_ns < end_ns_;
  if (counts && step >= 0 && step < ramp.steps) {
    ++one.samples;
    if (one.last_received_ns >= begin_ns_) {
      one.longest_silence_ns = std::max(one.longest_silence_ns, silence_ns);
    }
    if (one.last_step >= 0) {
      const int ahead = (step - one.last_step + ramp.steps) % ramp.steps;
      if (ahead == 0) ++one.twice;
      if (ahead > 1) one.missing += static_cast<std::uint64_t>(ahead - 1);
    }
  } else if (counts) {
    ++one.foreign;
  }
  one.last_step = step;
  one.last_received_ns = received_ns;
}

nlohmann::json Tally::Summary() const {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [number, one] : devices_) {
    const v1::DeviceStatus& status = one.status;
    list.push_back({{"device", number},
                    {"serial", status.serial()},
                    {"kind", stream::Name(static_cast<stream::DeviceKind>(status.kind()))},
                    {"state", stream::Name(static_cast<stream::DeviceState>(status.state()))},
                    {"extension", stream::Name(static_cast<stream::Extension>(status.extension()))},
                    {"calibration",
                     stream::Name(static_cast<stream::CalibrationOrigin>(status.calibration()))},
                    {"driver", status.driver()},
                    {"places", one.places},
                    {"note", status.note()},
                    {"reports", status.reports()},
                    {"samples", one.samples},
                    {"missing", one.missing},
                    {"twice", one.twice},
                    {"foreign", one.foreign},
                    {"nunchuk_samples", one.nunchuk_samples},
                    {"turning_samples", one.turning_samples},
                    {"longest_silence_ms", static_cast<double>(one.longest_silence_ns) * 1e-6},
                    {"resumed_ns", one.resumed_ns},
                    {"gaps", status.gaps()},
                    {"mode_reasserts", status.mode_reasserts()},
                    {"undecodable", status.undecodable()},
                    {"queue_drops", status.queue_drops()},
                    {"writes_failed", status.writes_failed()}});
  }
  return {{"devices", list},
          {"ticks", ticks_},
          {"gaps", gaps_},
          {"seconds", static_cast<double>(end_ns_ - begin_ns_) * 1e-9}};
}

}  // namespace footing::vm
