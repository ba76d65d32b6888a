#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "common/stream/contacts.h"
#include "common/stream/hands.h"
#include "daemon/sensor/mounting/hands.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/device.h"
#include "daemon/sensor/service/service.h"

namespace footing::sensor {

/// Hands that trackers see, loads under feet that insoles feel, and the true poses of simulated
/// bodies. What makes no sense is refused, counted and said now and then.
class TrackerInput {
 public:
  TrackerInput(const Config& config, std::function<void(const LogLine&)> log,
               std::function<std::int64_t()> now_ns)
      : config_(config), log_(std::move(log)), now_ns_(std::move(now_ns)) {}

  void OnHands(std::int64_t received_ns, const stream::HandFrame& frame);
  void OnReference(std::int64_t received_ns, const stream::ReferenceFrame& frame);
  void OnContacts(std::int64_t received_ns, const stream::ContactFrame& frame);
  /// Hand, reference and contact frames refused so far.
  std::uint64_t refused_frames() const { return refusals_.total(); }

  /// Moves what came since the last tick into the tick, and logs what is due.
  void Publish(std::int64_t now_ns, TickContent& content);

 private:
  /// Key of one exposure clock: kind of frame, rig, name of the sender, and which part of a body.
  using Exposed = std::tuple<char, std::string, std::string, int>;
  hands::ExposureClock::Exposure Expose(const Exposed& what, const hands::FrameTimes& times);
  void Refuse(const std::string& what, const std::string& why);

  const Config& config_;
  std::function<void(const LogLine&)> log_;
  std::function<std::int64_t()> now_ns_;
  TickContent content_;
  hands::Refusals refusals_;
  std::map<Exposed, hands::ExposureClock> exposures_;
};

}  // namespace footing::sensor
