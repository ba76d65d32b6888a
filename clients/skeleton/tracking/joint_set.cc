#include "clients/skeleton/tracking/joint_set.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace footing::skeleton {

Joint Mirrored(Joint joint) {
  if (joint == Joint::kHead || joint == Joint::kNeck || joint == Joint::kTorso) return joint;
  // From the shoulders to the hands left is even; from the hips down, behind the torso, odd.
  const std::size_t index = Index(joint);
  const bool left = (index < Index(Joint::kTorso)) == (index % 2 == 0);
  return static_cast<Joint>(left ? index + 1 : index - 1);
}

std::size_t Skeleton::present() const {
  return static_cast<std::size_t>(
      std::count_if(joints.begin(), joints.end(), [](const auto& one) { return one.present(); }));
}

Skeleton SwappedSides(const Skeleton& skeleton) {
  Skeleton swapped = skeleton;
  for (std::size_t i = 0; i < kJoints; ++i)
    swapped.joints[i] = skeleton[Mirrored(static_cast<Joint>(i))];
  return swapped;
}

Skeleton MirrorImage(const Skeleton& skeleton) {
  Skeleton image = SwappedSides(skeleton);
  for (JointReading& joint : image.joints) joint.p_K_m.x() *= -1;
  if (image.toes_K_m) image.toes_K_m->x() *= -1;
  return image;
}

namespace {

enum class Place : std::uint8_t { kJoint, kEar, kNose, kNothing };

/// A name without its side; a side is looked for apart. Rank 0 is the best name of a joint.
struct Name {
  std::string_view name;
  Joint left;
  int rank;
  Place place = Place::kJoint;
};

constexpr Name kNames[] = {
    {"head", Joint::kHead, 0},
    {"neck", Joint::kNeck, 1},
    {"spineshoulder", Joint::kNeck, 0},
    {"shouldercenter", Joint::kNeck, 0},
    {"torso", Joint::kTorso, 0},
    {"spinemid", Joint::kTorso, 0},
    {"spine", Joint::kTorso, 1},
    {"spinenavel", Joint::kTorso, 1},
    {"spinechest", Joint::kTorso, 2},
    {"shoulder", Joint::kLeftShoulder, 0},
    {"elbow", Joint::kLeftElbow, 0},
    {"hand", Joint::kLeftHand, 0},
    {"wrist", Joint::kLeftHand, 1},
    {"hip", Joint::kLeftHip, 0},
    {"knee", Joint::kLeftKnee, 0},
    {"ankle", Joint::kLeftFoot, 0},
    {"foot", Joint::kLeftFoot, 1},
    {"ear", Joint::kHead, 0, Place::kEar},
    {"nose", Joint::kHead, 0, Place::kNose},
    {"waist", Joint::kTorso, 0, Place::kNothing},
    {"spinebase", Joint::kTorso, 0, Place::kNothing},
    {"hipcenter", Joint::kTorso, 0, Place::kNothing},
    {"pelvis", Joint::kTorso, 0, Place::kNothing},
    {"collar", Joint::kLeftShoulder, 0, Place::kNothing},
    {"clavicle", Joint::kLeftShoulder, 0, Place::kNothing},
    {"fingertip", Joint::kLeftHand, 0, Place::kNothing},
    {"finger", Joint::kLeftHand, 0, Place::kNothing},
    {"handtip", Joint::kLeftHand, 0, Place::kNothing},
    {"thumb", Joint::kLeftHand, 0, Place::kNothing},
    {"pinky", Joint::kLeftHand, 0, Place::kNothing},
    {"index", Joint::kLeftHand, 0, Place::kNothing},
    {"heel", Joint::kLeftFoot, 0, Place::kNothing},
    {"footindex", Joint::kLeftFoot, 0, Place::kNothing},
    {"eye", Joint::kHead, 0, Place::kNothing},
    {"eyeinner", Joint::kHead, 0, Place::kNothing},
    {"eyeouter", Joint::kHead, 0, Place::kNothing},
    {"mouth", Joint::kHead, 0, Place::kNothing},
};
// A bit of JointSet for each.
static_assert(std::size(kNames) <= 64);

enum class Side : std::uint8_t { kNone, kLeft, kRight };

/// A name in lower case without '_', '-' and spaces; too long a one is none of a joint.
struct Plain {
  char text[24];
  std::size_t size = 0;

  std::string_view view() const { return {text, size}; }
};

std::optional<Plain> ToPlain(std::string_view name) {
  Plain plain;
  for (const char c : name) {
    if (c == '_' || c == '-' || c == ' ') continue;
    if (plain.size == std::size(plain.text)) return std::nullopt;
    plain.text[plain.size++] = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return plain;
}

/// Takes "l_", "left" or "Left" from either end.
Side TakeSide(std::string_view raw, std::string_view& plain) {
  const auto cut = [&plain](std::string_view side) {
    if (plain.starts_with(side)) {
      plain.remove_prefix(side.size());
      return true;
    }
    if (plain.ends_with(side)) {
      plain.remove_suffix(side.size());
      return true;
    }
    return false;
  };
  if (raw.size() > 2 && raw[1] == '_' && (raw[0] == 'l' || raw[0] == 'r')) {
    plain.remove_prefix(1);
    return raw[0] == 'l' ? Side::kLeft : Side::kRight;
  }
  if (cut("left")) return Side::kLeft;
  return cut("right") ? Side::kRight : Side::kNone;
}

JointReading Between(std::initializer_list<JointReading> readings) {
  JointReading mean{.confidence = 1};
  for (const JointReading& one : readings) {
    if (!one.present()) return {};
    mean.p_K_m += one.p_K_m / static_cast<double>(readings.size());
    mean.confidence = std::min(mean.confidence, one.confidence);
  }
  return mean;
}

void Fill(Skeleton& skeleton, Joint joint, const JointReading& reading) {
  if (!skeleton[joint].present()) skeleton[joint] = reading;
}

}  // namespace

void FillTrunk(Skeleton& skeleton) {
  const JointReading &left = skeleton[Joint::kLeftShoulder],
                     &right = skeleton[Joint::kRightShoulder];
  Fill(skeleton, Joint::kNeck, Between({left, right}));
  Fill(skeleton, Joint::kTorso,
       Between({left, right, skeleton[Joint::kLeftHip], skeleton[Joint::kRightHip]}));
}

JointSet::Taken JointSet::Add(std::string_view name, const JointReading& reading) {
  const auto plain = ToPlain(name);
  if (!plain) return Taken::kUnknown;
  std::string_view rest = plain->view();
  const Side side = TakeSide(name, rest);
  const auto* found = std::find_if(std::begin(kNames), std::end(kNames),
                                   [rest](const Name& one) { return one.name == rest; });
  if (found == std::end(kNames)) return Taken::kUnknown;
  const bool paired = Mirrored(found->left) != found->left || found->place != Place::kJoint;
  if (!paired && side != Side::kNone) return Taken::kUnknown;
  if (Mirrored(found->left) != found->left && side == Side::kNone) return Taken::kUnknown;
  const auto row = static_cast<std::size_t>(found - std::begin(kNames));
  if (found->place == Place::kNothing) return Taken::kBeside;
  auto& seen = seen_[side == Side::kRight ? 1 : 0];
  if (seen >> row & 1) return Taken::kRepeated;
  seen |= std::uint64_t{1} << row;
  ++added_;
  if (found->place == Place::kNose) {
    face_[2] = reading;
    return Taken::kAdded;
  }
  if (found->place == Place::kEar) {
    face_[side == Side::kRight ? 1 : 0] = reading;
    return Taken::kAdded;
  }
  Given& given = joints_[Index(side == Side::kRight ? Mirrored(found->left) : found->left)];
  if (found->rank >= given.rank) return Taken::kBeside;
  given = {reading, found->rank};
  return Taken::kAdded;
}

Skeleton JointSet::Finish() const {
  Skeleton skeleton;
  for (std::size_t i = 0; i < kJoints; ++i) skeleton.joints[i] = joints_[i].reading;
  FillTrunk(skeleton);
  Fill(skeleton, Joint::kHead, Between({face_[0], face_[1]}));
  Fill(skeleton, Joint::kHead, face_[2]);
  return skeleton;
}

std::size_t JointSet::best() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kJoints; ++i)
    // Most senders call the point between the shoulders a neck.
    count += joints_[i].rank == 0 || (i == Index(Joint::kNeck) && joints_[i].rank == 1) ? 1 : 0;
  return count;
}

}  // namespace footing::skeleton
