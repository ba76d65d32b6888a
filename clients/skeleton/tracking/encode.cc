#include <string>

#include "clients/skeleton/tracking/dialects.h"
#include "clients/skeleton/tracking/osc.h"
#include "common/base/time.h"

namespace footing::skeleton {
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
      // What this dialect calls a foot is its tip.
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
      break;
  }
  return "";
}

}  // namespace

std::vector<std::string> Encode(Dialect dialect, const DialectOptions& options,
                                const Skeleton& skeleton) {
  if (dialect == Dialect::kVmc) return {};
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

}  // namespace footing::skeleton
