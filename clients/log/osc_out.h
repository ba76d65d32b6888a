#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clients/log/biped_person.h"
#include "common/base/result.h"
#include "common/body/skeleton.h"
#include "common/net/address.h"
#include "footing/v1/character.pb.h"

namespace footing::log_client {

/// Form in which characters are sent, over UDP in Open Sound Control 1.0.
enum class OscFormat {
  /// Virtual Motion Capture protocol (protocol.vmc.info), performer to marionette: the bones of a
  /// humanoid relative to its T-pose, each in its parent's frame, in Unity's axes (x right, y up, z
  /// ahead, left-handed). Of several characters the first. The biped is sent as BipedPerson.
  kVmc,
  /// Places and rotations of all links in W, gait, loads: docs/recordings.md has the messages.
  kPlain,
};

/// Largest datagram: what most networks carry in one piece.
inline constexpr std::size_t kMostOscBytes = 1400;

/// Frames of footing-sim as packets of OSC. A plain value.
class OscEncoder {
 public:
  explicit OscEncoder(OscFormat format) : format_(format) {}

  /// The links of the characters of the frames that follow.
  void Take(const v1::Skeletons& skeletons);
  /// The packets of a frame, in the order in which they are sent. Before a person's T-pose VMC
  /// only says that it is awaited.
  std::vector<std::string> Encode(const v1::CharacterFrame& frame);

 private:
  std::vector<std::string> EncodeVmc(const v1::CharacterFrame& frame);
  std::vector<std::string> EncodePlain(const v1::CharacterFrame& frame) const;

  OscFormat format_;
  std::map<std::uint32_t, v1::Skeleton> skeletons_;  ///< By character.
  std::optional<BipedPerson> biped_;
  // VMC's character: its links, and once a frame showed its lengths, its joints and their bones.
  v1::Skeleton links_;
  std::optional<body::Skeleton> body_;
  std::vector<std::string> bones_;
};

/// Options of a sender.
struct OscOptions {
  transport::Address from;
  std::vector<std::string> to;  ///< HOST:PORT.
  OscFormat format = OscFormat::kVmc;
  double rate_hz = 60;
  double seconds = 0;  ///< 0: until SIGINT or SIGTERM.
};

/// Counts of a sender.
struct OscReport {
  std::uint64_t frames = 0;
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;
  std::uint64_t refused =
      0;                     ///< Packets that no program at their address took, as far as is known.
  double longest_gap_s = 0;  ///< Between frames.
};

/// Sends what a footing-sim publishes to every receiver. A receiver that is not there is sent to
/// all the same: it may come. An address that is none is a usage error; NoDevice where no frame
/// came.
Result<OscReport> SendOsc(const OscOptions& options);

}  // namespace footing::log_client
