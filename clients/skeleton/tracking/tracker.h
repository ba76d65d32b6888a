#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "clients/skeleton/tracking/decoder.h"
#include "clients/skeleton/tracking/person_gate.h"
#include "clients/skeleton/tracking/osc.h"
#include "clients/skeleton/tracking/observation.h"
#include "clients/skeleton/tracking/placement.h"
#include "clients/skeleton/tracking/sender_clock.h"

namespace footing::skeleton {

struct TrackerOptions {
  DialectOptions dialect = {};
  CameraPlace camera = {};
  bool stand = false;  ///< Find the camera's place from the person; nothing is published before.
  std::optional<std::int32_t> user = {};  ///< Only this person; none: who was seen first and stays.
  std::int64_t latency_ns = 67'000'000;   ///< Of a sender that gives no time: two frames at 30 Hz.
};

/// What came of one person's skeletons.
struct PersonCounts {
  Dialect dialect = Dialect::kFooting;
  std::uint64_t skeletons = 0, joints = 0, inferred = 0;
  std::array<std::uint64_t, 5> verdicts{};  ///< By Verdict.
  Fault fault = Fault::kNone;               ///< Of the last frame.
};

struct TrackerCounts {
  std::uint64_t packets = 0, bytes = 0, rejected_packets = 0, skeletons = 0;
  std::uint64_t overtaken = 0;  ///< Skeletons that came after a newer one of their person.
  std::map<std::int32_t, PersonCounts> people;  ///< By user; bounded as the decoder's.
};

/// UDP packets to observations in W: decoder, gate, clock and placement of each person, of whom one
/// is published. A plain value; time is an argument.
class Tracker {
 public:
  explicit Tracker(const TrackerOptions& options);

  /// One packet; appends the observations that are complete. `now_ns` monotonic, `wall_ns` since
  /// 1970.
  void Take(osc::Bytes packet, std::int64_t now_ns, std::int64_t wall_ns,
            std::vector<Observation>& out);
  /// What has waited too long for the rest of its frame.
  void Flush(std::int64_t now_ns, std::int64_t wall_ns, std::vector<Observation>& out);

  /// Lines for a person since the last call: packets that cannot be read, a fault that came or
  /// went, the placement, a person who is wanted and not seen.
  std::vector<std::string> Messages();

  /// What is wrong with a person's skeleton and what to do, also while the camera is not placed;
  /// empty when all is well.
  std::string AdviceOf(std::int32_t user) const;
  /// Why nobody is published at all, where what arrives shows it.
  std::string Advice() const;

  const TrackerCounts& counts() const { return counts_; }
  const DecoderCounts& decoder_counts() const { return decoder_.counts(); }
  /// None while the person's stand has not been seen.
  const std::optional<CameraPlace>& camera() const { return camera_; }

 private:
  struct Person {
    explicit Person(std::int64_t latency_ns) : clock(latency_ns) {}
    PersonGate gate;
    SenderClock clock;
    std::int64_t seen_ns = 0;
    /// Of its newest skeleton.
    std::int64_t exposed_ns = std::numeric_limits<std::int64_t>::min();
    Fault reported = Fault::kNone;
  };

  void Settle(std::int64_t now_ns, std::int64_t wall_ns, std::vector<Observation>& out);
  void Take(const Decoded& decoded, std::int64_t now_ns, std::int64_t wall_ns,
            std::vector<Observation>& out);
  Person& PersonOf(std::int32_t user, std::int64_t now_ns);
  bool IsPublished(std::int32_t user, std::int64_t now_ns);
  void Stand(const Decoded& decoded, const Skeleton& gated, std::int64_t exposed_ns);
  void NoteOther(std::int32_t user, std::int64_t now_ns);
  void Report(std::int32_t user, Person& person, Fault fault);

  TrackerOptions options_;
  Decoder decoder_;
  std::map<std::int32_t, Person> people_;
  std::optional<std::int32_t> published_;
  std::optional<CameraPlace> camera_;
  Eigen::Isometry3d X_WK_ = Eigen::Isometry3d::Identity();
  std::vector<Skeleton> standing_;
  std::int64_t standing_since_ns_ = 0;
  std::string not_placed_;
  std::set<std::int32_t> others_;  // Seen, and not the wanted one; a few.
  std::int64_t other_since_ns_ = 0;
  bool others_reported_ = false;
  TrackerCounts counts_;
  std::vector<std::string> messages_;
  osc::Packet packet_;
  std::vector<Decoded> complete_;
};

}  // namespace footing::skeleton
