#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clients/skeleton/tracking/dialects.h"
#include "clients/skeleton/tracking/joint_set.h"
#include "common/base/osc.h"

namespace footing::skeleton {

/// A skeleton that is complete, as its sender gave it: nothing is checked but that it is finite.
struct Decoded {
  Skeleton skeleton;
  Dialect dialect = Dialect::kFooting;
  std::int64_t arrived_ns = 0;  ///< Arrival of its first joint, monotonic.
};

/// Counts of decoded input since the start.
struct DecoderCounts {
  std::uint64_t messages = 0;
  std::uint64_t joints = 0;
  std::uint64_t unknown = 0;  ///< Messages of no dialect, and unknown joints and bones.
  std::uint64_t rejected =
      0;                   ///< Joints and bones with numbers that make no sense, too many persons.
  std::uint64_t late = 0;  ///< Joints of a frame that was complete already.
};

/// Packets to skeletons. The dialects differ by address and types, so several may arrive at once.
/// A skeleton is complete when its bundle ends; of a sender that puts each joint into a packet of
/// its own, when all 15 joints or the sender's last message of a person have come, when the next
/// frame begins, or after kPatienceNs. Memory
/// is bounded: kMostPeople at once. A plain value; time is an argument.
class Decoder {
 public:
  static constexpr std::size_t kMostPeople = 8;
  static constexpr std::int64_t kPatienceNs = 20'000'000;

  explicit Decoder(const DialectOptions& options) : options_(options), vmc_(options) {}

  /// Appends what is complete now.
  void Take(const osc::Packet& packet, std::int64_t now_ns, std::vector<Decoded>& complete);
  /// Appends what has waited for kPatienceNs.
  void Flush(std::int64_t now_ns, std::vector<Decoded>& complete);

  const DecoderCounts& counts() const { return counts_; }
  /// The first problem of each kind since the last call.
  std::vector<std::string> TakeProblems();
  /// Why the bones of a VMC sender make no skeleton now; empty while they do.
  std::string NoSkeleton() const { return vmc_.NoSkeleton(); }

 private:
  enum class Problem : std::uint8_t { kMessage, kJoint, kBone, kBoneNumbers, kNoSkeleton };

  /// A person's frame while it comes in.
  struct Frame {
    Dialect dialect = Dialect::kFooting;
    std::int32_t user = 0;
    JointSet joints = {};
    std::optional<std::int64_t> sequence = {}, sent_ns = {}, last_sent_ns = {};
    std::int64_t arrived_ns = 0, used_ns = 0;
  };
  struct Numbers {
    std::string_view name;
    std::int32_t user = 0;
    Eigen::Vector3d numbers = Eigen::Vector3d::Zero();
    double confidence = 1;
    std::optional<std::int64_t> sent_ns;
  };

  void TakeMessage(const osc::Packet& packet, const osc::Message& message, std::int64_t now_ns,
                   std::vector<Decoded>& complete);
  void TakeBody(const osc::Packet& packet, const osc::Message& message, std::int64_t now_ns,
                std::vector<Decoded>& complete);
  bool TakeJointOf(Dialect dialect, const osc::Packet& packet, const osc::Message& message,
                   std::int64_t now_ns, std::vector<Decoded>& complete);
  void TakeHead(const osc::Packet& packet, const osc::Message& message, std::int64_t now_ns,
                std::vector<Decoded>& complete);
  void TakeJoint(Dialect dialect, const Numbers& joint, std::int64_t now_ns,
                 std::vector<Decoded>& complete);
  Frame* FrameOf(Dialect dialect, std::int32_t user, std::int64_t now_ns);
  void TakeVmc(const osc::Packet& packet, const osc::Message& message, std::int64_t now_ns,
               std::vector<Decoded>& complete);
  void Complete(Frame& frame, std::vector<Decoded>& complete);
  void EndBody(Dialect dialect, std::int32_t user, std::vector<Decoded>& complete);
  void Unknown(const osc::Message& message, const std::string& why);
  void Report(Problem problem, std::string text);

  DialectOptions options_;
  VmcPose vmc_;
  std::vector<Frame> frames_;
  std::int32_t footing_user_ = 0;  // User in the packet's last head message.
  DecoderCounts counts_;
  std::array<bool, 5> reported_{};  // Indexed by Problem.
  std::vector<std::string> problems_;
};

}  // namespace footing::skeleton
