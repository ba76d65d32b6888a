#pragma once

#include <cstdint>

namespace footing::hands {

/// When a frame of a tracker or an insole was received and sent, and how old its content was then.
struct FrameTimes {
  std::int64_t received_ns = 0;
  std::int64_t sent_ns = 0;  ///< On the clock of `received_ns`; 0: not stated.
  std::int64_t age_ns = 0;   ///< When it was sent.
};

/// When the frames of one source were exposed. A plain value.
///
/// footingd reads what arrives in bursts while it is busy: several frames then share one
/// `received_ns`, although they were sent one after the other. Where the sender states when it sent
/// a frame, the exposure is exact. Where it does not, a frame is taken as sent when it was read,
/// and the earlier frames of the same read are as much older as the source's frames are apart.
class ExposureClock {
 public:
  struct Exposure {
    std::int64_t sampled_ns = 0;  ///< Later than that of every frame before.
    /// The earlier frames that were read together with this one, and that are not published yet,
    /// were exposed by this much earlier than was said of them.
    std::int64_t others_earlier_ns = 0;
  };

  Exposure Take(const FrameTimes& times);
  /// What was taken so far is published, and no longer changes.
  void Publish();

  std::int64_t received_ns() const { return received_ns_; }

 private:
  bool started_ = false;
  std::int64_t received_ns_ = 0;   ///< Of the newest frame.
  std::int64_t sampled_ns_ = 0;    ///< Of the newest frame.
  std::int64_t oldest_ns_ = 0;     ///< Of the unpublished frames of the newest read.
  std::int64_t published_ns_ = 0;  ///< Of the newest frame that no longer changes.
  int waiting_ = 0;                ///< Unpublished frames of the newest read.
  double period_ns_ = 0;           ///< Between frames; 0: not known.
};

}  // namespace footing::hands
