#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/contacts.h"
#include "common/stream/hands.h"

/// Points of a body that trackers see, loads that insoles feel, and the true poses of simulated
/// bodies: what of them is taken.
namespace footing::hands {

inline constexpr std::size_t kMostJoints = 64;
inline constexpr std::size_t kMostCells = 16;
inline constexpr double kFarthestCellM = 1;  ///< From the origin of what its source sits on.
inline constexpr double kMostLoadN = 10'000;

/// Error of a frame with the accepted range, in one line; empty when it can be taken: a
/// place within 10 m, a standard deviation in (0, 1] m along each axis (any with confidence 0),
/// covariances that belong to them, a confidence in [0, 1], the role of a hand or a joint, each
/// once, 1 to 16 points, an age in [0, 1] s, names of at most 64 printable characters.
std::string Problem(const stream::HandFrame& frame);

/// The same of a pose: 1 to 64 joints within 10 m, a centre of mass alike, parents before their
/// children.
std::string Problem(const stream::ReferenceFrame& frame);

/// The same of an insole: a foot, 1 to 16 cells within 1 m of its frame's origin, loads within
/// 10 000 N of zero.
std::string Problem(const stream::ContactFrame& frame);

/// A frame without a problem as samples, one a point. Without a rig they are of `default_rig`.
std::vector<stream::HandSample> ToSamples(const stream::HandFrame& frame, std::int64_t received_ns,
                                          const std::string& default_rig);

/// The published form of an insole's frame, with the rig filled in.
stream::ContactSample ToSample(const stream::ContactFrame& frame, std::int64_t received_ns,
                               const std::string& default_rig);

/// The published form of a reference frame, with the rig filled in.
stream::ReferencePose ToPose(const stream::ReferenceFrame& frame, std::int64_t received_ns,
                             const std::string& default_rig);

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
  /// Ends the present read: frames taken so far are published and no longer change.
  void Publish();

  std::int64_t received_ns() const { return received_ns_; }

 private:
  bool started_ = false;
  std::int64_t received_ns_ = 0;   ///< Arrival of the newest frame.
  std::int64_t sampled_ns_ = 0;    ///< Exposure time of the newest frame.
  std::int64_t oldest_ns_ = 0;     ///< Oldest of the newest read's unpublished frames.
  std::int64_t published_ns_ = 0;  ///< Newest frame that no longer changes.
  int waiting_ = 0;                ///< Unpublished frames of the newest read.
  double period_ns_ = 0;           ///< Between frames; 0: not known.
};

/// Counts what is refused, each kind of message by itself, and says when a line for a person is
/// due: at once, then at most one a kind in ten seconds, which says how many there were. A plain
/// value; time is an argument.
class Refusals {
 public:
  static constexpr std::int64_t kQuietNs = 10'000'000'000;

  /// `what` is "a hand frame", `why` what is wrong with it.
  std::optional<std::string> Add(std::int64_t now_ns, const std::string& what,
                                 const std::string& why);
  /// The lines that are due for what was refused in quiet since.
  std::vector<std::string> Due(std::int64_t now_ns);

  std::uint64_t total() const { return total_; }

 private:
  struct Kind {
    std::uint64_t unsaid = 0;
    std::string why;  ///< Reason of the newest.
    std::optional<std::int64_t> said_ns;
  };

  static std::optional<std::string> Say(std::int64_t now_ns, const std::string& what, Kind& kind);

  std::uint64_t total_ = 0;
  std::map<std::string, Kind> kinds_;
};

}  // namespace footing::hands
