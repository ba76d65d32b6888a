#include "clients/skeleton/tracking/decoder.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::skeleton {
namespace {

constexpr double kLargestNumber = 1e5;         // Beyond any unit of length here.
constexpr double kLatestMs = 4'102'444'800e3;  // 2100-01-01.

/// OSCeleton's other messages, which say nothing that is needed.
bool IsKnown(std::string_view address) {
  for (const std::string_view begin :
       {"/new_user", "/new_skel", "/lost_user", "/exit_user", "/re-enter_user", "/new_hand",
        "/lost_hand", "/begin_session", "/begin_frame", "/state", "/center", "/calib_start",
        "/calib_fail", "/user/", "/orient", "/hit", "/osceleton2/", "/VMC/"}) {
    if (address.starts_with(begin)) return true;
  }
  return false;
}

std::optional<std::int64_t> FromMs(double time_ms) {
  if (!(time_ms > 0 && time_ms <= kLatestMs)) return std::nullopt;  // 0: no time is given.
  return static_cast<std::int64_t>(std::llround(time_ms * 1e6));
}

/// A message below /bodies/: whose, and which joint or hand.
struct BodyAddress {
  std::int32_t user = 0;
  std::string_view kind;  ///< "joints" or "hands".
  std::string_view name;
};

/// Kinect v2's numbers of persons have 64 bits; the lower 31 are enough.
std::optional<BodyAddress> ParseBody(std::string_view address) {
  constexpr std::string_view kBegin = "/bodies/";
  if (!address.starts_with(kBegin)) return std::nullopt;
  std::uint64_t user = 0;
  const char* const end = address.data() + address.size();
  const auto parsed = std::from_chars(address.data() + kBegin.size(), end, user);
  if (parsed.ec != std::errc() || parsed.ptr == end || *parsed.ptr != '/') return std::nullopt;
  const std::string_view rest(parsed.ptr + 1, static_cast<std::size_t>(end - parsed.ptr - 1));
  const std::size_t slash = rest.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  return BodyAddress{static_cast<std::int32_t>(user & 0x7fffffff), rest.substr(0, slash),
                     rest.substr(slash + 1)};
}

/// Names of the Azure Kinect's joints, by their numbers (k4abt_joint_id_t of its documentation).
constexpr std::string_view kAzureJoints[] = {
    "pelvis",        "spine_navel",    "spine_chest",    "neck",        "clavicle_left",
    "shoulder_left", "elbow_left",     "wrist_left",     "hand_left",   "handtip_left",
    "thumb_left",    "clavicle_right", "shoulder_right", "elbow_right", "wrist_right",
    "hand_right",    "handtip_right",  "thumb_right",    "hip_left",    "knee_left",
    "ankle_left",    "foot_left",      "hip_right",      "knee_right",  "ankle_right",
    "foot_right",    "head",           "nose",           "eye_left",    "ear_left",
    "eye_right",     "ear_right"};

/// A name as kAzureJoints has it, of a number; none of anything else.
std::optional<std::string_view> AzureJoint(std::string_view number) {
  const auto index = text::ToCount(number);
  if (!index || *index >= std::size(kAzureJoints)) return std::nullopt;
  return kAzureJoints[*index];
}

/// Confidences of Kinect v2's states, as OSCeleton-KinectSDK2 has them.
double KinectV2Confidence(std::string_view state) {
  return state == "Tracked" ? 1 : state == "Inferred" ? 0.5 : 0.1;
}

Eigen::Vector3d Three(std::span<const osc::Argument> arguments, std::size_t first) {
  return {std::get<float>(arguments[first]), std::get<float>(arguments[first + 1]),
          std::get<float>(arguments[first + 2])};
}

}  // namespace

void Decoder::Take(const osc::Packet& packet, std::int64_t now_ns, std::vector<Decoded>& complete) {
  footing_user_ = 0;
  for (const osc::Message& message : packet.messages) {
    ++counts_.messages;
    TakeMessage(packet, message, now_ns, complete);
  }
  if (packet.messages.size() <= 1) return;
  // A bundle has whole persons.
  for (Frame& frame : frames_)
    if (frame.used_ns == now_ns && !frame.joints.empty()) Complete(frame, complete);
}

void Decoder::Flush(std::int64_t now_ns, std::vector<Decoded>& complete) {
  for (Frame& frame : frames_)
    if (!frame.joints.empty() && now_ns - frame.arrived_ns >= kPatienceNs)
      Complete(frame, complete);
}

void Decoder::TakeMessage(const osc::Packet& packet, const osc::Message& message,
                          std::int64_t now_ns, std::vector<Decoded>& complete) {
  if (message.address == "/footing/skeleton" && (message.types == "hi" || message.types == "ii"))
    return TakeHead(packet, message, now_ns, complete);
  if (message.address == "/footing/joint" && message.types == "sffff") {
    TakeJointOf(Dialect::kFooting, packet, message, now_ns, complete);
  } else if (message.address == "/joint" && message.types == "sifff") {
    TakeJointOf(Dialect::kSensebloom, packet, message, now_ns, complete);
  } else if (message.address == "/joint" && message.types == "siiffffd") {
    TakeJointOf(Dialect::kZillode, packet, message, now_ns, complete);
  } else if (message.address == "/joint" && message.types == "isfffffffff") {
    TakeJointOf(Dialect::kNite2, packet, message, now_ns, complete);
  } else if (message.address.starts_with("/bodies/")) {
    TakeBody(packet, message, now_ns, complete);
  } else if (message.address == "/osceleton2/joint" && message.types == "siiffffd") {
    TakeJointOf(Dialect::kKinectSdk2, packet, message, now_ns, complete);
  } else if (message.address.starts_with("/joint/") && message.types == "fff") {
    if (!TakeJointOf(Dialect::kQuartz, packet, message, now_ns, complete))
      Unknown(message, "the address is not /joint/NAME/USER");
  } else if (message.address == "/joint" && message.types == "sff") {
    Unknown(message, "kitchen mode has two dimensions only; start OSCeleton without -k");
  } else if (message.address.starts_with("/VMC/Ext/")) {
    TakeVmc(packet, message, now_ns, complete);
  } else if (message.address.starts_with("/footing/")) {
    Unknown(message, "Footing's own are /footing/skeleton ,hi or ,ii and /footing/joint ,sffff");
  } else if (!IsKnown(message.address)) {
    Unknown(message, "neither a joint of OSCeleton, KinectV2-OSC, VMC nor Footing");
  }
}

void Decoder::TakeBody(const osc::Packet& packet, const osc::Message& message, std::int64_t now_ns,
                       std::vector<Decoded>& complete) {
  const auto body = ParseBody(message.address);
  if (body && body->kind == "hands") {
    // KinectV2-OSC sends the state of both hands behind the joints, the right one last.
    if (body->name == "Right") EndBody(Dialect::kKinectV2, body->user, complete);
    return;
  }
  const auto arguments = packet.Of(message);
  const auto numbered = body ? AzureJoint(body->name) : std::nullopt;
  const bool three = message.types == "fff", seven = message.types == "fffffff";
  const bool with_state = message.types == "fffs";
  if (!body || body->kind != "joints" || !(numbered ? three || seven : three || with_state)) {
    return Unknown(message, "a joint is /bodies/USER/joints/NAME ,fffs or its number ,fff");
  }
  const Dialect dialect = numbered ? Dialect::kAzure : Dialect::kKinectV2;
  Numbers joint;
  joint.name = numbered.value_or(body->name);
  joint.user = body->user;
  joint.numbers = Three(arguments, 0);
  if (with_state) joint.confidence = KinectV2Confidence(std::get<std::string_view>(arguments[3]));
  TakeJoint(dialect, joint, now_ns, complete);
  if (numbered == std::end(kAzureJoints)[-1]) EndBody(dialect, body->user, complete);
}

void Decoder::EndBody(Dialect dialect, std::int32_t user, std::vector<Decoded>& complete) {
  for (Frame& frame : frames_) {
    const bool its = frame.dialect == dialect && frame.user == user;
    if (its && !frame.joints.empty()) Complete(frame, complete);
  }
}

void Decoder::TakeVmc(const osc::Packet& packet, const osc::Message& message, std::int64_t now_ns,
                      std::vector<Decoded>& complete) {
  const VmcStep step = vmc_.Take(message.address, packet.Of(message), message.types);
  switch (step.taken) {
    case VmcStep::Taken::kTaken:
      break;
    case VmcStep::Taken::kTypes:
      Unknown(message, "a bone has the types ,sfffffff: its name, position and quaternion");
      break;
    case VmcStep::Taken::kName:
      ++counts_.unknown;
      Report(Problem::kBone, "VMC: " + text::Quoted(step.bone) +
                                 " is not a bone of Unity's humanoid; names are case-sensitive");
      break;
    case VmcStep::Taken::kNumbers:
      ++counts_.rejected;
      Report(
          Problem::kBoneNumbers,
          "VMC: the numbers of " + text::Quoted(step.bone) +
              " make no sense: not finite, 10 km and more, or a quaternion whose length is not 1");
      break;
  }
  if (!reported_[static_cast<std::size_t>(Problem::kNoSkeleton)]) {
    if (std::string reason = vmc_.NoSkeleton(); !reason.empty())
      Report(Problem::kNoSkeleton, std::move(reason));
  }
  if (!step.skeleton) return;
  complete.push_back({WithSides(options_, *step.skeleton), Dialect::kVmc, now_ns});
  counts_.joints += step.skeleton->present();
}

/// False when the address of kQuartz cannot be understood.
bool Decoder::TakeJointOf(Dialect dialect, const osc::Packet& packet, const osc::Message& message,
                          std::int64_t now_ns, std::vector<Decoded>& complete) {
  const auto arguments = packet.Of(message);
  Numbers joint;
  const std::size_t name = dialect == Dialect::kNite2 ? 1 : 0;
  if (dialect != Dialect::kQuartz) joint.name = std::get<std::string_view>(arguments[name]);
  switch (dialect) {
    case Dialect::kNite2:
      joint.user = std::get<std::int32_t>(arguments[0]);
      joint.numbers = Three(arguments, 2);
      joint.confidence = std::get<float>(arguments[5]);
      break;
    case Dialect::kSensebloom:
      joint.user = std::get<std::int32_t>(arguments[1]);
      joint.numbers = Three(arguments, 2);
      break;
    case Dialect::kQuartz: {
      const std::string_view rest = message.address.substr(7);
      const std::size_t slash = rest.find('/');
      if (slash == std::string_view::npos) return false;
      const char* const end = rest.data() + rest.size();
      const auto parsed = std::from_chars(rest.data() + slash + 1, end, joint.user);
      if (parsed.ec != std::errc() || parsed.ptr != end) return false;
      joint.name = rest.substr(0, slash);
      joint.numbers = Three(arguments, 0);
      break;
    }
    case Dialect::kZillode:
    case Dialect::kKinectSdk2:
      joint.user = std::get<std::int32_t>(arguments[2]);
      joint.numbers = Three(arguments, 3);
      joint.confidence = std::get<float>(arguments[6]);
      joint.sent_ns = FromMs(std::get<double>(arguments[7]));
      break;
    case Dialect::kFooting:
      joint.user = footing_user_;
      joint.numbers = Three(arguments, 1);
      joint.confidence = std::get<float>(arguments[4]);
      if (!message.time.immediate()) joint.sent_ns = osc::ToUnixNs(message.time);
      break;
    case Dialect::kVmc:
    case Dialect::kKinectV2:
    case Dialect::kAzure:
      return false;
  }
  TakeJoint(dialect, joint, now_ns, complete);
  return true;
}

void Decoder::TakeHead(const osc::Packet& packet, const osc::Message& message, std::int64_t now_ns,
                       std::vector<Decoded>& complete) {
  const auto arguments = packet.Of(message);
  footing_user_ = std::get<std::int32_t>(arguments[1]);
  Frame* const frame = FrameOf(Dialect::kFooting, footing_user_, now_ns);
  if (!frame) return;
  if (!frame->joints.empty()) Complete(*frame, complete);
  // Many senders have no integers of 64 bits.
  const auto* const narrow = std::get_if<std::int32_t>(&arguments[0]);
  frame->sequence = narrow ? *narrow : std::get<std::int64_t>(arguments[0]);
}

void Decoder::TakeJoint(Dialect dialect, const Numbers& joint, std::int64_t now_ns,
                        std::vector<Decoded>& complete) {
  const bool sane = joint.numbers.allFinite() &&
                    joint.numbers.lpNorm<Eigen::Infinity>() <= kLargestNumber &&
                    joint.confidence >= 0 && joint.confidence <= 1;
  Frame* const frame = sane ? FrameOf(dialect, joint.user, now_ns) : nullptr;
  if (!frame) {
    ++counts_.rejected;
    return;
  }
  if (!frame->joints.empty() && frame->sent_ns != joint.sent_ns) Complete(*frame, complete);
  if (joint.sent_ns && frame->joints.empty() && frame->last_sent_ns == joint.sent_ns) {
    ++counts_.late;
    return;
  }
  const JointReading reading{ToCamera(dialect, options_, joint.numbers), joint.confidence};
  auto taken = frame->joints.Add(joint.name, reading);
  if (taken == JointSet::Taken::kRepeated) {
    Complete(*frame, complete);
    taken = frame->joints.Add(joint.name, reading);
  }
  if (taken == JointSet::Taken::kUnknown) {
    ++counts_.unknown;
    Report(Problem::kJoint, "unknown joint " + std::string(joint.name.substr(0, 32)));
    return;
  }
  ++counts_.joints;
  if (taken == JointSet::Taken::kBeside) return;
  if (frame->joints.size() == 1) frame->arrived_ns = now_ns;
  frame->used_ns = now_ns;
  frame->sent_ns = joint.sent_ns;
  // KinectV2-OSC has better names for some joints behind the fifteenth.
  if (frame->joints.best() == kJoints && dialect != Dialect::kKinectV2) Complete(*frame, complete);
}

Decoder::Frame* Decoder::FrameOf(Dialect dialect, std::int32_t user, std::int64_t now_ns) {
  for (Frame& frame : frames_)
    if (frame.dialect == dialect && frame.user == user) return &frame;
  if (frames_.size() < kMostPeople) {
    frames_.push_back({.dialect = dialect, .user = user, .used_ns = now_ns});
    return &frames_.back();
  }
  // A person who has been away for long makes place.
  constexpr std::int64_t kAwayNs = 1'000'000'000;
  const auto oldest =
      std::min_element(frames_.begin(), frames_.end(),
                       [](const Frame& a, const Frame& b) { return a.used_ns < b.used_ns; });
  if (now_ns - oldest->used_ns < kAwayNs) return nullptr;
  *oldest = {.dialect = dialect, .user = user, .used_ns = now_ns};
  return &*oldest;
}

void Decoder::Complete(Frame& frame, std::vector<Decoded>& complete) {
  Decoded& one = complete.emplace_back();
  one.skeleton = WithSides(options_, frame.joints.Finish());
  one.skeleton.user = frame.user;
  one.skeleton.sequence = frame.sequence;
  one.skeleton.sent_ns = frame.sent_ns;
  one.skeleton.unix_time =
      frame.dialect == Dialect::kFooting || frame.dialect == Dialect::kKinectSdk2;
  one.dialect = frame.dialect;
  one.arrived_ns = frame.arrived_ns;
  frame.last_sent_ns = frame.sent_ns;
  frame.joints = {};
  frame.sequence.reset();
  frame.sent_ns.reset();
}

void Decoder::Unknown(const osc::Message& message, const std::string& why) {
  ++counts_.unknown;
  Report(Problem::kMessage, "message " + std::string(message.address) + " ," +
                                std::string(message.types) + " is not understood: " + why);
}

void Decoder::Report(Problem problem, std::string text) {
  bool& reported = reported_[static_cast<std::size_t>(problem)];
  if (!reported) problems_.push_back(std::move(text));
  reported = true;
}

std::vector<std::string> Decoder::TakeProblems() { return std::exchange(problems_, {}); }

}  // namespace footing::skeleton
