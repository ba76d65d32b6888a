#pragma once

#include <cstdint>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "clients/stream/plan.h"
#include "common/base/units.h"
#include "common/recording/recorded_session.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/hub.h"

namespace footing::stream_client {

inline constexpr std::int64_t kStartNs = 1'000'000'000'000;
inline constexpr std::int64_t kTickNs = 10'000'000;
inline constexpr std::int64_t kAnswerNs = 4'000'000;  // From a request to its answer.

/// footingd's hub and the devices that talk to it, in time that only they advance.
class VirtualLine {
 public:
  explicit VirtualLine(std::vector<SimulatedDevice> devices, const sensor::Config& config = {})
      : devices_(std::move(devices)),
        hub_(config,
             {[this](devices::DeviceHandle device, const reports::OutputReport& report) {
                const double time_s = NanosecondsToSeconds(now_ns_ - kStartNs);
                for (auto& answer : devices_[device - 1].HandleOutput(time_s, report)) {
                  answers_.push({now_ns_ + kAnswerNs, ++order_, device, std::move(answer), false});
                }
              },
              [](const sensor::LogLine&) {}, [this] { return now_ns_; },
              [this](devices::DeviceHandle device, std::uint8_t id, std::size_t size) {
                answers_.push({now_ns_ + kAnswerNs, ++order_, device,
                               devices_[device - 1].Feature(id, size), true});
              }}) {}

  std::vector<v1::Tick> Run(double seconds) {
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      now_ns_ = kStartNs;
      const virtual_devices::Identity& identity = devices_[i].identity();
      devices::DeviceIdentity who;
      who.bus = static_cast<devices::Bus>(identity.bus);
      who.vendor = identity.vendor;
      who.product = identity.product;
      who.name = identity.name;
      who.serial = identity.serial;
      who.simulated = true;
      who.wished_role = devices_[i].role();
      hub_.OnAttach(i + 1, who);
      next_.push_back(devices_[i].Next());
    }
    std::vector<v1::Tick> ticks;
    for (std::int64_t tick_ns = kStartNs + kTickNs;
         tick_ns <= kStartNs + SecondsToNanoseconds(seconds); tick_ns += kTickNs) {
      while (DeliverBefore(tick_ns)) {
      }
      now_ns_ = tick_ns;
      ticks.push_back(ToTick(hub_.Tick(tick_ns), tick_ns, ticks.size() + 1));
    }
    return ticks;
  }

 private:
  struct Answer {
    std::int64_t time_ns = 0;
    std::uint64_t order = 0;
    devices::DeviceHandle device = 0;
    virtual_devices::Report bytes;
    bool feature = false;
    bool operator<(const Answer& other) const {  // The earliest is on top.
      return std::tie(time_ns, order) > std::tie(other.time_ns, other.order);
    }
  };

  /// The next report of all that are due; false when none is.
  bool DeliverBefore(std::int64_t until_ns) {
    std::size_t first = devices_.size();
    std::int64_t first_ns = until_ns;
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      if (std::isinf(next_[i].arrives_s)) continue;
      const std::int64_t due_ns = kStartNs + SecondsToNanoseconds(next_[i].arrives_s);
      if (due_ns < first_ns) {
        first_ns = due_ns;
        first = i;
      }
    }
    if (!answers_.empty() && answers_.top().time_ns < first_ns) {
      const Answer answer = answers_.top();
      answers_.pop();
      now_ns_ = answer.time_ns;
      hub_.OnReport(answer.device, {answer.time_ns, answer.bytes, 0, answer.feature});
      return true;
    }
    if (first == devices_.size()) return false;
    now_ns_ = first_ns;
    for (const auto& report : devices_[first].Deliver(next_[first].sampled_s)) {
      hub_.OnReport(first + 1, {first_ns, report, 0});
    }
    next_[first] = devices_[first].Next();
    return true;
  }

  static v1::Tick ToTick(const sensor::TickContent& content, std::int64_t host_ns,
                         std::uint64_t sequence) {
    const auto channels = sensor::ToChannels(content);
    recording::RecordedTick recorded;
    recorded.host_ns = host_ns;
    recorded.sequence = static_cast<std::uint32_t>(sequence);
    for (const auto& channel : channels) {
      recorded.channels.push_back({channel.field, channel.bytes});
    }
    return recording::ReadTick(recorded).value();
  }

  std::vector<SimulatedDevice> devices_;
  std::vector<SimulatedDevice::Arrival> next_;
  std::priority_queue<Answer> answers_;
  std::uint64_t order_ = 0;
  std::int64_t now_ns_ = kStartNs;
  sensor::Hub hub_;
};

}  // namespace footing::stream_client
