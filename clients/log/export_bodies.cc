#include "clients/log/export_bodies.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "clients/log/c3d_body.h"
#include "clients/log/contents.h"
#include "clients/log/motion_gatherer.h"
#include "clients/log/opensim.h"
#include "clients/log/output_folder.h"
#include "common/body/angle_deviation.h"
#include "common/body/kinematics.h"
#include "common/runtime/data_file.h"
#include "common/recording/walk.h"
#include "common/recording/mapped_file.h"
#include "common/recording/output_file.h"
#include "common/base/number.h"
#include "common/virtual/motion/joint_angles.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/c3d.h"
#include "common/virtual/motion/trc.h"

namespace footing::log_client {

motion::MarkerTracks JointPlaces(const motion::Motion& motion, const std::vector<bool>& valid) {
  motion::MarkerTracks tracks;
  tracks.rate_hz = motion.rate_hz;
  body::Kinematics at(motion.skeleton);
  for (int i = 0; i < motion.skeleton.size(); ++i) {
    tracks.names.push_back(motion.skeleton.joint(i).name);
    tracks.p.emplace_back(3, motion.frames());
  }
  const Eigen::Vector3d unseen =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    if (!valid[static_cast<std::size_t>(frame)]) {
      for (Eigen::Matrix3Xd& track : tracks.p) track.col(frame) = unseen;
      continue;
    }
    body::ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
    for (std::size_t i = 0; i < tracks.p.size(); ++i) {
      const Eigen::Vector3d& p_W = at.p_WJ[i];
      tracks.p[i].col(frame) << p_W.x(), p_W.z(), -p_W.y();
    }
  }
  return tracks;
}

namespace {

struct NamedText {
  std::string name;
  std::string text;
  bool is_note = false;  ///< Says something about the other files, and has no motion of its own.
};

/// The stated errors of each coordinate.
std::string ErrorsCsv() {
  std::string text = "coordinate,sd_upright_deg,sd_bent_deg\n";
  for (const body::AngleDeviation& one : body::CoordinateDeviations()) {
    text += std::string(one.name) + ",";
    text::AppendShortest(text, one.upright_deg);
    text += ",";
    text::AppendShortest(text, one.bent_deg);
    text += "\n";
  }
  return text;
}

/// A frame that is not valid says nothing about an angle: that of any direction, 360 / sqrt(12).
constexpr double kUnknownDeg = 103.923;

/// The stated standard deviations of the columns of `angles` that are angles, at the same times.
motion::Table DeviationTable(const motion::Table& angles, const std::vector<bool>& valid) {
  motion::Table table;
  table.in_degrees = true;
  std::vector<Eigen::Index> columns;
  std::vector<body::AngleDeviation> deviations;
  for (std::size_t i = 0; i < angles.columns.size(); ++i) {
    const auto deviation = body::CoordinateDeviation(angles.columns[i]);
    if (!deviation && angles.columns[i] != "time") continue;
    table.columns.push_back(angles.columns[i]);
    columns.push_back(static_cast<Eigen::Index>(i));
    deviations.push_back(deviation.value_or(body::AngleDeviation()));
  }
  const int left = motion::FindColumn(angles, "knee_angle_l");
  const int right = motion::FindColumn(angles, "knee_angle_r");
  table.values.setZero(angles.values.rows(), static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index row = 0; row < angles.values.rows(); ++row) {
    const bool bent =
        (angles.values(row, left) + angles.values(row, right)) / 2 >= body::kBentKneeDeg;
    table.values(row, 0) = angles.values(row, 0);
    for (std::size_t i = 1; i < columns.size(); ++i) {
      table.values(row, static_cast<Eigen::Index>(i)) = !valid[static_cast<std::size_t>(row)]
                                                            ? kUnknownDeg
                                                        : bent ? deviations[i].bent_deg
                                                               : deviations[i].upright_deg;
    }
  }
  return table;
}

/// A table of OpenSim with a line for people in its header, which readers pass over.
std::string WithNote(std::string table, const std::string& note) {
  const std::size_t end = table.find("endheader\n");
  FOOTING_CHECK(end != std::string::npos);
  return table.insert(end, note + "\n");
}

Result<std::vector<NamedText>> MotTexts(const motion::Motion& motion,
                                        const std::vector<bool>& valid,
                                        const std::vector<FootForces>& forces,
                                        const std::string& name) {
  Result<motion::Table> angles = joint_angles::JointAngles(motion);
  if (!angles) return angles.error();
  angles->name = name + ".mot";
  motion::Table deviations = DeviationTable(*angles, valid);
  deviations.name = name + "_sd.sto";
  const std::string source(body::AngleDeviationSource());
  motion::Table table = ForceTable(forces, motion.rate_hz);
  table.name = name + "_grf.mot";
  return std::vector<NamedText>{
      {angles->name, WithNote(motion::WriteTable(*angles),
                              "Angles are estimates: " + deviations.name + " has their " + source)},
      {table.name, motion::WriteTable(table)},
      {deviations.name, WithNote(motion::WriteTable(deviations), source), true}};
}

/// A motion, and which of its frames are valid.
struct Gathered {
  motion::Motion motion;
  std::vector<bool> valid;

  std::uint64_t invalid_frames() const {
    return static_cast<std::uint64_t>(std::count(valid.begin(), valid.end(), false));
  }
};

Result<Gathered> Gather(const MotionGatherer& gatherer) {
  Result<motion::Motion> motion = gatherer.Finish();
  if (!motion) return motion.error();
  Result<std::vector<bool>> valid = gatherer.Valid();
  if (!valid) return valid.error();
  return Gathered{std::move(motion).value(), std::move(valid).value()};
}

/// The files of one person, whose names begin with `name`.
Result<std::vector<NamedText>> Written(const MotionGatherer& gatherer, const Gathered& gathered,
                                       BodyFormat format, const std::string& name) {
  const auto& [motion, valid] = gathered;
  if (format == BodyFormat::kBvh) {
    return std::vector<NamedText>{{name + ".bvh", motion::WriteBvh(motion)}};
  }
  if (format == BodyFormat::kTrc) {
    return std::vector<NamedText>{
        {name + ".trc", motion::WriteTrc(JointPlaces(motion, valid), name + ".trc")}};
  }
  const auto forces = gatherer.Forces();
  if (!forces) return forces.error();
  if (format == BodyFormat::kMot) return MotTexts(motion, valid, *forces, name);
  const auto c3d = motion::WriteC3d(ToC3d(motion, valid, *forces));
  if (!c3d) return c3d.error();
  return std::vector<NamedText>{{name + ".c3d", *c3d}};
}

/// One gatherer a skeleton, in the order of the recording.
class Walker {
 public:
  Result<std::vector<MotionGatherer>> Run(std::string_view bytes, const std::string& path) {
    mcap::Visitor visitor;
    visitor.channel = [this](const mcap::Channel& channel) {
      topics_[channel.id] = channel.topic.substr(channel.topic.rfind('/') + 1);
    };
    visitor.message = [this](const mcap::Message& message) {
      first_ns_ = std::min(first_ns_, message.log_time_ns);
      Take(message);
    };
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
  /// Log time of the recording's first message.
  std::uint64_t first_ns() const { return first_ns_; }

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
      gatherers_.back().Add(frame, message.log_time_ns);
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
  std::uint64_t first_ns_ = UINT64_MAX;
  bool has_subject_ = false;
  bool damaged_ = false;
};

}  // namespace

Result<std::vector<ExportedMotion>> ExportBodies(const std::string& recording,
                                                 const std::string& folder, BodyFormat format,
                                                 bool replace) {
  Result<recording::MappedFile> file = recording::MappedFile::Open(recording);
  if (!file) return file.error();
  Walker walker;
  const auto gatherers = walker.Run(file->bytes(), recording);
  if (!gatherers) return gatherers.error();
  if (const Result<void> made = MakeFolder(folder); !made) return made.error();
  std::vector<ExportedMotion> exported;
  int people = 0;
  for (const MotionGatherer& gatherer : *gatherers) {
    const auto gathered = Gather(gatherer);
    if (!gathered) return InvalidData(recording + ": " + gathered.error().message);
    const std::string code = gatherer.subject().empty() ? "" : "_" + gatherer.subject();
    const std::string name = "pose_" + std::to_string(++people) + code;
    auto texts = Written(gatherer, *gathered, format, name);
    if (!texts) return InvalidData(recording + ": " + texts.error().message);
    texts->push_back({name + "_errors.csv", ErrorsCsv(), true});
    const std::string errors = folder + "/" + texts->back().name;
    for (const NamedText& one : *texts) {
      const std::string path = folder + "/" + one.name;
      if (one.is_note) {  // The export of another format may have written it.
        const auto old = config::ReadTextFile(path);
        if (old && *old == one.text) continue;
      }
      Result<recording::OutputFile> out = recording::OutputFile::Create(path, replace);
      if (!out) return out.error();
      if (const auto written = out->Write(one.text); !written) return written.error();
      if (one.is_note) continue;
      exported.push_back(
          {path, gatherer.subject(), gathered->valid.size(), gathered->invalid_frames(),
           gathered->motion.rate_hz,
           1e-9 * static_cast<double>(gatherer.begin_ns() - walker.first_ns()) - gatherer.lag_s(),
           errors});
    }
  }
  return exported;
}

}  // namespace footing::log_client
