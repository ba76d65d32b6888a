#include "clients/log/export_bodies.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "clients/log/contents.h"
#include "common/body/kinematics.h"
#include "common/mcap/walk.h"
#include "common/recording/mapped_file.h"
#include "common/recording/output_file.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/trc.h"
#include "common/wire/wire.h"

namespace footing::log_client {
namespace {

constexpr double kMostRateHz = 1000;

Eigen::Vector3d PlaceOf(const v1::Character& character, int link) {
  return wire::FromProto(character.links(link).position_m());
}

Eigen::Matrix3d TurnOf(const v1::Character& character, int link) {
  return wire::FromProto(character.links(link).orientation()).normalized().toRotationMatrix();
}

bool HasChild(const v1::Skeleton& skeleton, int link) {
  return std::any_of(skeleton.links().begin(), skeleton.links().end(),
                     [link](const v1::Link& other) { return other.parent() == link; });
}

/// All joints turn about z, x, y of W's axes at rest, as BVH files mostly do; ends do not turn.
Result<body::Skeleton> SkeletonOf(const v1::Skeleton& skeleton, const v1::Character& first) {
  std::vector<body::Joint> joints;
  for (int i = 0; i < skeleton.links_size(); ++i) {
    const v1::Link& link = skeleton.links(i);
    const bool fits = i == 0 ? link.parent() == -1 : link.parent() >= 0 && link.parent() < i;
    if (!fits) return InvalidData("the recorded skeleton is not a tree");
    body::Joint joint;
    joint.name = link.name();
    joint.parent = link.parent();
    if (i > 0) {
      joint.offset_m = TurnOf(first, link.parent()).transpose() *
                       (PlaceOf(first, i) - PlaceOf(first, link.parent()));
    }
    if (i == 0 || HasChild(skeleton, i)) {
      joint.rotations = {{body::Axis::kZ}, {body::Axis::kX}, {body::Axis::kY}};
    }
    joints.push_back(std::move(joint));
  }
  return body::MakeSkeleton(std::move(joints));
}

void SetPose(const body::Skeleton& skeleton, const v1::Character& character,
             Eigen::Ref<Eigen::VectorXd> q) {
  q.head<3>() = PlaceOf(character, 0);
  for (int i = 0; i < skeleton.size(); ++i) {
    const body::Joint& joint = skeleton.joint(i);
    if (joint.rotations.empty()) continue;
    const Eigen::Matrix3d R_WJ = TurnOf(character, i);
    const Eigen::Matrix3d R_PJ =
        joint.parent < 0 ? R_WJ
                         : Eigen::Matrix3d(TurnOf(character, joint.parent).transpose() * R_WJ);
    body::SetJointRotation(joint, R_PJ, q);
  }
}

}  // namespace

void MotionGatherer::Add(const v1::CharacterFrame& frame) {
  if (frame.characters_size() == 0) return;
  const v1::Character& character = frame.characters(0);
  if (!character.has_body() || !character.body().calibrated()) return;
  if (character.links_size() != skeleton_.links_size()) return;
  subject_ = character.body().subject();
  frames_.push_back(frame);
}

Result<motion::Motion> MotionGatherer::Finish() const {
  if (frames_.size() < 2) return InvalidData("fewer than two frames of a body after its T-pose");
  double step_s = frames_.back().time_s() - frames_.front().time_s();
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    const double next_s = frames_[i].time_s() - frames_[i - 1].time_s();
    if (!(next_s > 0)) return InvalidData("the time of the frames does not go on");
    step_s = std::min(step_s, next_s);
  }
  if (step_s < 1 / kMostRateHz) return InvalidData("the frames are less than 1 ms apart");
  auto skeleton = SkeletonOf(skeleton_, frames_.front().characters(0));
  if (!skeleton) return skeleton.error();
  motion::Motion motion;
  motion.skeleton = std::move(skeleton).value();
  motion.rate_hz = std::round(1e6 / step_s) * 1e-6;  // Times are rounded, too.
  motion.start_s = frames_.front().time_s();
  const auto columns = static_cast<Eigen::Index>(
      std::llround((frames_.back().time_s() - motion.start_s) / step_s) + 1);
  motion.q.setZero(motion.skeleton.dof, columns);
  std::size_t at = 0;
  for (Eigen::Index i = 0; i < columns; ++i) {
    const double time_s = motion.start_s + static_cast<double>(i) * step_s;
    while (at + 1 < frames_.size() && frames_[at + 1].time_s() < time_s + 0.5 * step_s) ++at;
    if (i > 0) motion.q.col(i) = motion.q.col(i - 1);  // Angles stay on the same turn.
    SetPose(motion.skeleton, frames_[at].characters(0), motion.q.col(i));
  }
  return motion;
}

motion::MarkerTracks JointPlaces(const motion::Motion& motion) {
  motion::MarkerTracks tracks;
  tracks.rate_hz = motion.rate_hz;
  body::Kinematics at(motion.skeleton);
  for (int i = 0; i < motion.skeleton.size(); ++i) {
    tracks.names.push_back(motion.skeleton.joint(i).name);
    tracks.p.emplace_back(3, motion.frames());
  }
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    body::ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
    for (std::size_t i = 0; i < tracks.p.size(); ++i) {
      const Eigen::Vector3d& p_W = at.p_WJ[i];
      tracks.p[i].col(frame) << p_W.x(), p_W.z(), -p_W.y();
    }
  }
  return tracks;
}

namespace {

std::string Written(const motion::Motion& motion, BodyFormat format, const std::string& name) {
  switch (format) {
    case BodyFormat::kBvh:
      return motion::WriteBvh(motion);
    case BodyFormat::kTrc:
      return motion::WriteTrc(JointPlaces(motion), name);
  }
  return "";
}

/// One gatherer a skeleton, in the order of the recording.
class Walker {
 public:
  Result<std::vector<MotionGatherer>> Run(std::string_view bytes, const std::string& path) {
    mcap::Visitor visitor;
    visitor.channel = [this](const mcap::Channel& channel) {
      topics_[channel.id] = channel.topic.substr(channel.topic.rfind('/') + 1);
    };
    visitor.message = [this](const mcap::Message& message) { Take(message); };
    const mcap::WalkEnd end = mcap::Walk(bytes, visitor, mcap::WalkMode::kStrict);
    if (const std::optional<Error> incomplete = Incomplete(path, end)) return *incomplete;
    if (damaged_) return InvalidData(path + ": a message of the pose engine cannot be read");
    std::erase_if(gatherers_, [](const MotionGatherer& gatherer) { return gatherer.empty(); });
    if (gatherers_.empty()) {
      return InvalidData(path +
                         " has no reconstructed body after its T-pose: record footing-sim "
                         "--engine pose");
    }
    return std::move(gatherers_);
  }

 private:
  void Take(const mcap::Message& message) {
    const std::string& topic = topics_[message.channel_id];
    if (topic == "skeletons") {
      v1::Skeletons skeletons;
      if (!Parse(message, skeletons) || skeletons.skeletons_size() == 0) return;
      const std::string text = skeletons.skeletons(0).SerializeAsString();
      if (text == last_skeleton_) return;  // A snapshot after a broken link.
      last_skeleton_ = text;
      gatherers_.emplace_back(skeletons.skeletons(0));
    } else if (topic == "characters" && !gatherers_.empty()) {
      v1::CharacterFrame frame;
      if (!Parse(message, frame)) return;
      NextSubject(frame);
      gatherers_.back().Add(frame);
    }
  }

  /// Two people of one size have one skeleton, and yet are two.
  void NextSubject(const v1::CharacterFrame& frame) {
    if (frame.characters_size() == 0 || !frame.characters(0).has_body()) return;
    const std::string& subject = frame.characters(0).body().subject();
    if (has_subject_ && subject != subject_ && !gatherers_.back().empty()) {
      v1::Skeletons skeletons;
      v1::Skeleton skeleton;
      if (skeleton.ParseFromString(last_skeleton_)) gatherers_.emplace_back(skeleton);
    }
    has_subject_ = true;
    subject_ = subject;
  }

  bool Parse(const mcap::Message& message, google::protobuf::MessageLite& into) {
    const bool parsed =
        into.ParseFromArray(message.data.data(), static_cast<int>(message.data.size()));
    damaged_ |= !parsed;
    return parsed;
  }

  std::map<std::uint16_t, std::string> topics_;
  std::vector<MotionGatherer> gatherers_;
  std::string last_skeleton_, subject_;
  bool has_subject_ = false;
  bool damaged_ = false;
};

}  // namespace

Result<std::vector<ExportedMotion>> ExportBodies(const std::string& recording,
                                                 const std::string& folder, BodyFormat format,
                                                 bool replace) {
  Result<recording::MappedFile> file = recording::MappedFile::Open(recording);
  if (!file) return file.error();
  const auto gatherers = Walker().Run(file->bytes(), recording);
  if (!gatherers) return gatherers.error();
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Failure("cannot make the folder " + folder + ": " + error.message());
  std::vector<ExportedMotion> exported;
  for (const MotionGatherer& gatherer : *gatherers) {
    const auto motion = gatherer.Finish();
    if (!motion) return InvalidData(recording + ": " + motion.error().message);
    const std::string code = gatherer.subject().empty() ? "" : "_" + gatherer.subject();
    const std::string name = "pose_" + std::to_string(exported.size() + 1) + code +
                             (format == BodyFormat::kBvh ? ".bvh" : ".trc");
    const std::string path = folder + "/" + name;
    Result<recording::OutputFile> out = recording::OutputFile::Create(path, replace);
    if (!out) return out.error();
    if (const auto written = out->Write(Written(*motion, format, name)); !written) {
      return written.error();
    }
    exported.push_back(
        {path, gatherer.subject(), static_cast<std::uint64_t>(motion->frames()), motion->rate_hz});
  }
  return exported;
}

}  // namespace footing::log_client
