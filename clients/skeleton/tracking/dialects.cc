#include "clients/skeleton/tracking/dialects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include "clients/skeleton/tracking/joint_set.h"
#include "common/base/osc.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::skeleton {
namespace {

constexpr std::array<std::string_view, kDialects> kDialectNames = {
    "sensebloom", "quartz", "zillode",       "kinect-sdk2",     "footing",
    "vmc",        "nite2",  "kinect-v2-osc", "azure-kinect-osc"};
constexpr std::array<std::string_view, 5> kUnitNames = {"dialect", "normalised", "mm", "cm", "m"};

template <typename Enum, std::size_t N>
std::optional<Enum> Find(const std::array<std::string_view, N>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}

Units UnitsOf(Dialect dialect, const DialectOptions& options) {
  if (options.units != Units::kOfDialect) return options.units;
  switch (dialect) {
    case Dialect::kSensebloom:
    case Dialect::kQuartz:
      return Units::kNormalised;
    case Dialect::kZillode:
    case Dialect::kKinectSdk2:
    case Dialect::kNite2:
    case Dialect::kAzure:
      return Units::kMillimetres;
    case Dialect::kFooting:
    case Dialect::kVmc:
    case Dialect::kKinectV2:
      break;
  }
  return Units::kMetres;
}

/// Numbers times scale plus shift are metres in the dialect's own frame.
struct Linear {
  Eigen::Array3d scale, shift;
};

Linear ToMetres(Units units) {
  switch (units) {
    case Units::kNormalised:
      return {{-2.56, -1.92, 1.28}, {1.28, 0.96, 0}};
    case Units::kMillimetres:
      return {Eigen::Array3d::Constant(1e-3), Eigen::Array3d::Zero()};
    case Units::kCentimetres:
      return {Eigen::Array3d::Constant(1e-2), Eigen::Array3d::Zero()};
    case Units::kOfDialect:
    case Units::kMetres:
      break;
  }
  return {Eigen::Array3d::Ones(), Eigen::Array3d::Zero()};
}

/// The dialect's axes along K's: OpenNI and NiTE have x to the camera's right; Kinect v2's axes are
/// K's; KinectSDK2 has them with y negated; Azure Kinect has x to the camera's right and y down;
/// VMC has those of Unity (x to the person's right, y up, z where the person looks), and the camera
/// stands in front of the person.
Eigen::Array3d Signs(Dialect dialect, const DialectOptions& options) {
  Eigen::Array3d signs = Eigen::Array3d::Ones();
  switch (dialect) {
    case Dialect::kSensebloom:
    case Dialect::kQuartz:
    case Dialect::kZillode:
    case Dialect::kNite2:
      signs.x() = -1;
      break;
    case Dialect::kKinectSdk2:
      signs.y() = -1;
      break;
    case Dialect::kAzure:
      signs.x() = signs.y() = -1;
      break;
    case Dialect::kVmc:
      signs.z() = -1;
      break;
    case Dialect::kFooting:
    case Dialect::kKinectV2:
      break;
  }
  if (options.flip_y) signs.y() = -signs.y();
  return signs;
}

}  // namespace

std::string_view NameOf(Dialect dialect) {
  return kDialectNames[static_cast<std::size_t>(dialect)];
}
std::optional<Dialect> DialectOf(std::string_view name) {
  return Find<Dialect>(kDialectNames, name);
}
std::string_view NameOf(Units units) { return kUnitNames[static_cast<std::size_t>(units)]; }
std::optional<Units> UnitsOf(std::string_view name) { return Find<Units>(kUnitNames, name); }

Skeleton WithSides(const DialectOptions& options, const Skeleton& skeleton) {
  const Skeleton sides = options.swap_sides ? SwappedSides(skeleton) : skeleton;
  return options.mirrored ? MirrorImage(sides) : sides;
}

Eigen::Vector3d ToCamera(Dialect dialect, const DialectOptions& options,
                         const Eigen::Vector3d& numbers) {
  const Linear linear = ToMetres(UnitsOf(dialect, options));
  const Eigen::Array3d plain = (numbers - options.offset).array() / options.factor.array();
  return (Signs(dialect, options) * (plain * linear.scale + linear.shift)).matrix();
}

Eigen::Vector3d FromCamera(Dialect dialect, const DialectOptions& options,
                           const Eigen::Vector3d& p_K_m) {
  const Linear linear = ToMetres(UnitsOf(dialect, options));
  const Eigen::Array3d plain =
      (Signs(dialect, options) * p_K_m.array() - linear.shift) / linear.scale;
  return (plain * options.factor.array()).matrix() + options.offset;
}

namespace {

using osc::Argument;

constexpr std::int32_t kSensor = 0;

/// Below this a dialect does not send a joint at all.
double LeastConfidence(Dialect dialect) {
  if (dialect == Dialect::kSensebloom || dialect == Dialect::kQuartz) return 0.5;
  return dialect == Dialect::kZillode ? 0.1 : 0;
}

float Kinect2Confidence(double confidence) {
  if (confidence >= 0.75) return 1;
  return confidence >= 0.25 ? 0.5f : 0.1f;
}

std::string JointMessage(Dialect dialect, const Skeleton& skeleton, std::size_t joint,
                         const Eigen::Vector3f& p, float confidence) {
  const std::string_view name = kJointNames[joint];
  const double time_ms = NanosecondsToMilliseconds(skeleton.sent_ns.value_or(0));
  switch (dialect) {
    case Dialect::kSensebloom: {
      const Argument arguments[] = {name, skeleton.user, p.x(), p.y(), p.z()};
      return osc::WriteMessage("/joint", arguments);
    }
    case Dialect::kQuartz: {
      const Argument arguments[] = {p.x(), p.y(), p.z()};
      return osc::WriteMessage("/joint/" + std::string(name) + "/" + std::to_string(skeleton.user),
                               arguments);
    }
    case Dialect::kZillode: {
      const Argument arguments[] = {name,  kSensor, skeleton.user, p.x(),
                                    p.y(), p.z(),   confidence,    time_ms};
      return osc::WriteMessage("/joint", arguments);
    }
    case Dialect::kKinectSdk2: {
      // A foot in this dialect is the tip of the foot.
      const std::string_view ankle = name == "l_foot"   ? "l_ankle"
                                     : name == "r_foot" ? "r_ankle"
                                                        : name;
      const Argument arguments[] = {ankle, kSensor, skeleton.user, p.x(),
                                    p.y(), p.z(),   confidence,    time_ms};
      return osc::WriteMessage("/osceleton2/joint", arguments);
    }
    case Dialect::kFooting: {
      const Argument arguments[] = {name, p.x(), p.y(), p.z(), confidence};
      return osc::WriteMessage("/footing/joint", arguments);
    }
    case Dialect::kVmc:
    case Dialect::kNite2:
    case Dialect::kKinectV2:
    case Dialect::kAzure:
      break;
  }
  return "";
}

}  // namespace

std::vector<std::string> Encode(Dialect dialect, const DialectOptions& options,
                                const Skeleton& skeleton) {
  if (dialect >= Dialect::kVmc) return {};
  const Skeleton sent = WithSides(options, skeleton);
  std::vector<std::string> messages;
  if (dialect == Dialect::kFooting) {
    const Argument head[] = {skeleton.sequence.value_or(0), skeleton.user};
    messages.push_back(osc::WriteMessage("/footing/skeleton", head));
  }
  for (std::size_t i = 0; i < kJoints; ++i) {
    const JointReading& reading = sent.joints[i];
    if (!reading.present() || reading.confidence < LeastConfidence(dialect)) continue;
    const float confidence = dialect == Dialect::kKinectSdk2
                                 ? Kinect2Confidence(reading.confidence)
                                 : static_cast<float>(reading.confidence);
    messages.push_back(JointMessage(
        dialect, sent, i, FromCamera(dialect, options, reading.p_K_m).cast<float>(), confidence));
  }
  if (dialect == Dialect::kKinectSdk2) return messages;
  const osc::TimeTag time = dialect == Dialect::kFooting && skeleton.sent_ns
                                ? osc::ToTimeTag(*skeleton.sent_ns)
                                : osc::TimeTag{};
  return {osc::WriteBundle(time, messages)};
}

namespace {

constexpr std::size_t kCertain = 10;  // Frames; the first one may have begun before this program.
constexpr std::size_t kMostBonesOfAFrame = 128;  // A humanoid has 55; more: no T, no Hips.
constexpr std::size_t kNamed = 6;                // Bones named in the message.

/// Parents before their children; -1: the root. Without a `link` nothing that hangs on it is known;
/// bones of the trunk may be left out.
struct VmcBone {
  std::string_view name;
  int parent;
  std::optional<Joint> joint;
  bool link = false;
};

constexpr VmcBone kChain[] = {
    {"Hips", -1, std::nullopt, true},
    {"Spine", 0, std::nullopt},
    {"Chest", 1, Joint::kTorso},
    {"UpperChest", 2, std::nullopt},
    {"Neck", 3, Joint::kNeck},
    {"Head", 4, Joint::kHead},
    {"LeftShoulder", 3, std::nullopt},
    {"LeftUpperArm", 6, Joint::kLeftShoulder, true},
    {"LeftLowerArm", 7, Joint::kLeftElbow, true},
    {"LeftHand", 8, Joint::kLeftHand, true},
    {"RightShoulder", 3, std::nullopt},
    {"RightUpperArm", 10, Joint::kRightShoulder, true},
    {"RightLowerArm", 11, Joint::kRightElbow, true},
    {"RightHand", 12, Joint::kRightHand, true},
    {"LeftUpperLeg", 0, Joint::kLeftHip, true},
    {"LeftLowerLeg", 14, Joint::kLeftKnee, true},
    {"LeftFoot", 15, Joint::kLeftFoot, true},
    {"RightUpperLeg", 0, Joint::kRightHip, true},
    {"RightLowerLeg", 17, Joint::kRightKnee, true},
    {"RightFoot", 18, Joint::kRightFoot, true},
    {"LeftToes", 16, std::nullopt, true},
    {"RightToes", 19, std::nullopt, true},
};

/// A skeleton needs all of them.
constexpr std::size_t kNeeded[] = {0, 7, 11, 14, 17};
constexpr std::size_t kToes[] = {20, 21};

/// The humanoid's bones that are not needed: eyes, jaw, fingers.
bool IsBeside(std::string_view bone) {
  if (bone == "Jaw" || bone == "LastBone") return true;
  for (const std::string_view side : {"Left", "Right"})
    if (bone.starts_with(side)) bone.remove_prefix(side.size());
  if (bone == "Eye") return true;
  for (const std::string_view finger : {"Thumb", "Index", "Middle", "Ring", "Little"})
    if (bone.starts_with(finger)) return true;
  return false;
}

/// Seven numbers behind a name: place and quaternion.
std::optional<Eigen::Isometry3d> ToPose(std::span<const osc::Argument> arguments) {
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    v[i] = std::get<float>(arguments[i + 1]);
    if (!(std::abs(v[i]) < 1e4)) return std::nullopt;
  }
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (std::abs(q.norm() - 1) > 0.1) return std::nullopt;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() << v[0], v[1], v[2];
  return pose;
}

}  // namespace

VmcStep VmcPose::Take(std::string_view address, std::span<const osc::Argument> arguments,
                      std::string_view types) {
  if (address == "/VMC/Ext/Bone/Pos") return TakeBone(arguments, types);
  if (address == "/VMC/Ext/Root/Pos" && types.starts_with("sfffffff")) {
    if (const auto pose = ToPose(arguments)) root_ = *pose;
  }
  if (address != "/VMC/Ext/T") return {};
  return {.skeleton = End()};
}

VmcStep VmcPose::TakeBone(std::span<const osc::Argument> arguments, std::string_view types) {
  VmcStep step;
  if (++since_end_ > kMostBonesOfAFrame) End();
  if (types != "sfffffff") {
    wrong_types_ = types.substr(0, 16);
    step.taken = VmcStep::Taken::kTypes;
    return step;
  }
  step.bone = std::get<std::string_view>(arguments[0]);
  Arrived(step.bone);
  const auto found = std::find_if(std::begin(kChain), std::end(kChain),
                                  [&step](const VmcBone& one) { return one.name == step.bone; });
  if (found == std::end(kChain)) {
    if (!IsBeside(step.bone)) step.taken = VmcStep::Taken::kName;
    return step;
  }
  const bool hips = found == std::begin(kChain);
  if (hips && hips_came_) step.skeleton = End();
  hips_came_ = hips_came_ || hips;
  BoneState& bone = bones_[static_cast<std::size_t>(found - std::begin(kChain))];
  bone.pose = ToPose(arguments);
  bone.wrong = !bone.pose;
  if (bone.wrong) step.taken = VmcStep::Taken::kNumbers;
  return step;
}

std::optional<Skeleton> VmcPose::End() {
  const bool complete = hips_came_ && std::all_of(std::begin(kNeeded), std::end(kNeeded),
                                                  [this](std::size_t bone) { return Known(bone); });
  hips_came_ = false;
  since_end_ = 0;
  incomplete_ = complete ? 0 : incomplete_ + 1;
  if (!complete) return std::nullopt;
  return Joints();
}

void VmcPose::Arrived(std::string_view bone) {
  if (arrived_.size() >= kNamed) return;
  std::string name = text::Quoted(bone);
  if (std::find(arrived_.begin(), arrived_.end(), name) == arrived_.end())
    arrived_.push_back(std::move(name));
}

bool VmcPose::Known(std::size_t bone) const {
  if (!bones_[bone].pose) return false;
  for (int parent = kChain[bone].parent; parent >= 0;) {
    const auto at = static_cast<std::size_t>(parent);
    if (bones_[at].wrong || (kChain[at].link && !bones_[at].pose)) return false;
    parent = kChain[at].parent;
  }
  return true;
}

std::string VmcPose::NoSkeleton() const {
  if (incomplete_ < kCertain) return "";
  if (arrived_.empty() && !wrong_types_.empty())
    return "VMC: no skeleton: bones come as ," + wrong_types_ + " in place of ,sfffffff";
  std::string why = "bone Hips has stopped";
  for (const std::size_t needed : kNeeded) {
    if (Known(needed)) continue;
    why = "bone " + std::string(kChain[needed].name) + " was never received";
    for (std::size_t at = needed;; at = static_cast<std::size_t>(kChain[at].parent)) {
      if (bones_[at].wrong)
        why = "the numbers of bone " + std::string(kChain[at].name) + " make no sense";
      if (kChain[at].parent < 0) break;
    }
    break;
  }
  return "VMC: no skeleton: " + why +
         "; the first bones that arrived: " + (arrived_.empty() ? "none" : text::Joined(arrived_));
}

Skeleton VmcPose::Joints() const {
  Skeleton skeleton;
  std::array<Pose, kBones> poses;
  static_assert(std::size(kChain) == kBones);
  for (std::size_t i = 0; i < kBones; ++i) {
    const Pose& parent =
        kChain[i].parent < 0 ? root_ : poses[static_cast<std::size_t>(kChain[i].parent)];
    poses[i] = bones_[i].pose ? parent * *bones_[i].pose : parent;
    if (!kChain[i].joint || !Known(i)) continue;
    skeleton[*kChain[i].joint] = {ToCamera(Dialect::kVmc, options_, poses[i].translation()), 1};
  }
  for (const std::size_t toe : kToes) {
    if (!Known(toe)) continue;
    const auto in_camera = [&](std::size_t bone) {
      return ToCamera(Dialect::kVmc, options_, poses[bone].translation());
    };
    const Eigen::Vector3d toes =
        in_camera(toe) - in_camera(static_cast<std::size_t>(kChain[toe].parent));
    skeleton.toes_K_m = skeleton.toes_K_m.value_or(Eigen::Vector3d::Zero()) + toes;
  }
  FillTrunk(skeleton);
  return skeleton;
}

}  // namespace footing::skeleton
