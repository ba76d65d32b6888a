#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/virtual/devices/noise.h"

namespace footing::virtual_devices {

enum class LinkQuality { kIdeal, kGood, kPoor };

/// "ideal", "good", "poor"; none for another name.
std::optional<LinkQuality> LinkNamed(const std::string& name);

/// Rates and quality of a simulated radio link.
struct LinkConfig {
  LinkQuality quality = LinkQuality::kGood;
  double sensor_rate_hz = 100;   ///< How often the device's sensor takes a new sample.
  double nominal_rate_hz = 100;  ///< Rate of reports on a good link.
  std::uint64_t seed = 1;
  bool queues = false;  ///< Every sample is a report of its own and waits for the radio.
  /// Time between two turns of the radio, drawn evenly, on another link than Bluetooth; 0: as
  /// recorded.
  double least_turn_s = 0;
  double most_turn_s = 0;
};

/// 100 new samples and 100 reports a second.
LinkConfig WiimoteLink(LinkQuality quality, std::uint64_t seed);
/// 60 new samples and 83.6 reports a second, as recorded.
LinkConfig BoardLink(LinkQuality quality, std::uint64_t seed);
/// A report every 15 ms, each sent once; the radio's turn comes 83.6 times a second.
LinkConfig JoyconLink(LinkQuality quality, std::uint64_t seed);

/// When reports arrive over Bluetooth, and how old the sample in each is.
///
/// The sensor runs at its own rate and holds each sample; a report carries the one held when it
/// leaves, so some are repeats and some samples are never sent. Intervals between arrivals are
/// drawn from the quantiles of two real recordings of a Balance Board (39 s on a good link, 18 min
/// on a poor one), scaled to the nominal rate. Order is kept: Bluetooth never changes it. A poor
/// link has outages besides: about one in two minutes, exponential in length with mean 1 s, 0.1 s
/// to 20 s; their samples are lost. An ideal link delivers every sample at once. A
/// device that queues has each sample sent once, in order, at the radio's next turn.
class LinkModel {
 public:
  LinkModel(const LinkConfig& config, std::int64_t start_ns);

  struct Arrival {
    std::int64_t arrives_ns = 0;
    std::int64_t sampled_ns = 0;  ///< Not after it arrives.
  };
  /// The next report.
  Arrival Next();

 private:
  Arrival NextQueued();
  double DrawInterval();
  double DrawOutage(double interval_s);

  LinkConfig config_;
  noise::Random random_;
  std::int64_t start_ns_;
  std::int64_t last_ns_;
  std::uint64_t count_ = 0;  ///< Samples so far, on a link that sends each.
  std::int64_t lost_until_ns_ = 0;
};

}  // namespace footing::virtual_devices
