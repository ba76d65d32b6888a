#include "clients/log/export_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "clients/log/biped_person.h"
#include "clients/log/contents.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/angle_deviation.h"
#include "common/body/skeleton.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/files.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion/gltf.h"
#include "common/virtual/motion/joint_angles.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "common/wire/wire.h"

namespace footing::log_client {

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

/// The standard deviations of the columns of `angles` that are angles, at the same times: in each
/// frame those that the engine states, otherwise those that were measured.
motion::Table DeviationTable(const motion::Table& angles, const std::vector<bool>& valid,
                             const std::vector<std::vector<double>>& stated_deg) {
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
    const std::vector<double>& stated = stated_deg[static_cast<std::size_t>(row)];
    for (std::size_t i = 1; i < columns.size(); ++i) {
      double& sd_deg = table.values(row, static_cast<Eigen::Index>(i));
      const auto angle = body::StatedAngle(table.columns[i]);
      if (!valid[static_cast<std::size_t>(row)]) {
        sd_deg = kUnknownDeg;
      } else if (angle && *angle < stated.size()) {
        sd_deg = stated[*angle];
      } else {
        sd_deg = bent ? deviations[i].bent_deg : deviations[i].upright_deg;
      }
    }
  }
  return table;
}

Result<std::vector<NamedText>> MotTexts(const motion::Motion& motion,
                                        const std::vector<bool>& valid,
                                        const std::vector<motion::FootForces>& forces,
                                        const std::string& name, const MotionGatherer& gatherer) {
  Result<motion::Table> angles = joint_angles::JointAngles(motion);
  if (!angles) return angles.error();
  angles->name = name + ".mot";
  motion::Table table = motion::ForceTable(forces, motion.rate_hz);
  table.name = name + "_grf.mot";
  if (gatherer.is_biped()) {  // Nothing about it is estimated, and a person's model is not its.
    return std::vector<NamedText>{{angles->name, motion::WriteTable(*angles)},
                                  {table.name, motion::WriteTable(table)}};
  }
  const auto stated_deg = gatherer.AngleDeviations();
  if (!stated_deg) return stated_deg.error();
  motion::Table deviations = DeviationTable(*angles, valid, *stated_deg);
  deviations.name = name + "_sd.sto";
  const std::string source(body::AngleDeviationSource());
  std::vector<NamedText> texts{
      {angles->name,
       motion::WithNote(motion::WriteTable(*angles), "Angles are estimates: " + deviations.name +
                                                         " has their standard "
                                                         "deviations, frame by frame")},
      {table.name, motion::WriteTable(table)},
      {deviations.name,
       motion::WithNote(motion::WriteTable(deviations),
                        "pelvis, trunk and legs: as the engine states them in each frame, by the "
                        "sensors that are worn; others: " +
                            source),
       true},
      {name + "_loads.xml", motion::ExternalLoads(name), true}};
  const auto csv = motion::AnglesCsv(*angles, valid);
  if (!csv) return csv.error();
  texts.push_back({name + "_angles.csv", *csv, true});
  // Without a weight there is no model.
  if (const auto person = gatherer.Person()) {
    const auto model = joint_angles::OpenSimModel(motion, *person, name);
    if (!model) return model.error();
    texts.push_back({name + ".osim", *model, true});
  }
  return texts;
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
                                       BodyFormat format, const std::string& name,
                                       BvhSkeleton skeleton) {
  const auto& [motion, valid] = gathered;
  if (format == BodyFormat::kBvh) {
    if (skeleton == BvhSkeleton::kCmu) {
      return std::vector<NamedText>{{name + ".bvh", motion::WriteBvh(motion)}};
    }
    const auto humanoid = motion::Humanoid(motion);
    if (!humanoid) return humanoid.error();
    return std::vector<NamedText>{{name + ".bvh", motion::WriteBvh(*humanoid)}};
  }
  if (format == BodyFormat::kGltf) {
    const auto humanoid = motion::Humanoid(motion);
    if (!humanoid) return humanoid.error();
    const auto glb = motion::WriteGlb(*humanoid, name);
    if (!glb) return glb.error();
    return std::vector<NamedText>{{name + ".glb", *glb}};
  }
  if (format == BodyFormat::kTrc) {
    return std::vector<NamedText>{
        {name + ".trc", motion::WriteTrc(motion::JointPlaces(motion, valid), name + ".trc")}};
  }
  const auto forces = gatherer.Forces();
  if (!forces) return forces.error();
  if (format == BodyFormat::kMot) {
    return MotTexts(motion, valid, *forces, name, gatherer);
  }
  const auto c3d = motion::WriteC3d(motion::ToC3d(motion, valid, *forces));
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
    if (damaged_) return InvalidData(path + ": a message of footing-sim cannot be read");
    for (auto& [index, biped] : bipeds_) {
      const auto person = BipedPerson::Of(biped.skeleton, biped.longest_leg_m);
      if (!person) continue;  // It has no frame.
      gatherers_[index] = MotionGatherer(person->Skeleton(), /*is_biped=*/true);
      for (const auto& [frame, log_ns] : biped.frames) {
        gatherers_[index].Add(person->Frame(frame), log_ns);
      }
      biped.frames.clear();
    }
    std::erase_if(gatherers_, [](const MotionGatherer& gatherer) { return gatherer.empty(); });
    if (gatherers_.empty()) {
      return InvalidData(path +
                         " has no frame of the biped and no reconstructed body after its T-pose: "
                         "record footing-sim");
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
      if (BipedPerson::IsBiped(skeletons.skeletons(0))) {
        bipeds_[gatherers_.size() - 1].skeleton = skeletons.skeletons(0);
      }
    } else if (topic == "characters" && !gatherers_.empty()) {
      v1::CharacterFrame frame;
      if (!Parse(message, frame)) return;
      const auto biped = bipeds_.find(gatherers_.size() - 1);
      if (biped != bipeds_.end()) {
        if (frame.characters_size() == 0) return;
        const double leg_m = BipedPerson::LongestLegM(biped->second.skeleton, frame.characters(0));
        biped->second.longest_leg_m = std::max(biped->second.longest_leg_m, leg_m);
        biped->second.frames.emplace_back(std::move(frame), message.log_time_ns);
        return;
      }
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
  /// Frames of a biped, whose longest leg is known at their end.
  struct Biped {
    v1::Skeleton skeleton;
    double longest_leg_m = 0;
    std::vector<std::pair<v1::CharacterFrame, std::uint64_t>> frames;
  };

  std::vector<MotionGatherer> gatherers_;
  std::map<std::size_t, Biped> bipeds_;  ///< By place in `gatherers_`.
  std::string last_skeleton_, subject_;
  std::uint64_t first_ns_ = UINT64_MAX;
  bool has_subject_ = false;
  bool damaged_ = false;
};

}  // namespace

Result<std::vector<ExportedMotion>> ExportBodies(const std::string& recording,
                                                 const std::string& folder, BodyFormat format,
                                                 bool replace, BvhSkeleton skeleton) {
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
    const bool is_biped = gatherer.is_biped();
    const std::string name = (is_biped ? "gait_" : "pose_") + std::to_string(++people) + code;
    auto texts = Written(gatherer, *gathered, format, name, skeleton);
    if (!texts) return InvalidData(recording + ": " + texts.error().message);
    std::string errors;
    if (!is_biped) {
      texts->push_back({name + "_errors.csv", ErrorsCsv(), true});
      errors = folder + "/" + texts->back().name;
    }
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

namespace {

constexpr double kMostRateHz = 1000;
constexpr double kMostLagS = 10;
constexpr double kMostRowsPerFrame = 100;  // Limit on rows that fill gaps between frames.

bool HasChild(const v1::Skeleton& skeleton, int link) {
  return std::any_of(skeleton.links().begin(), skeleton.links().end(),
                     [link](const v1::Link& other) { return other.parent() == link; });
}

/// Whether the load of a foot is of this frame. Without both boards the engine repeats the last
/// loads of both feet, while each insole counts on its own.
bool IsFresh(const v1::BodyState& body, int side) {
  const auto measured = [&body](int foot) {
    return foot >= body.feet_told_size() || body.feet_told(foot);
  };
  return measured(side) && (body.contact_source() == "insoles" || measured(1 - side));
}

}  // namespace

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

void MotionGatherer::Add(const v1::CharacterFrame& frame, std::uint64_t log_time_ns) {
  if (frame.characters_size() == 0) return;
  const v1::Character& character = frame.characters(0);
  if (!character.has_body() || !character.body().calibrated()) return;
  if (character.links_size() != skeleton_.links_size()) return;
  subject_ = character.body().subject();
  // The frame that completes the T-pose has no estimate yet.
  if (frames_.size() == 1 && !frames_[0].characters(0).valid() && character.valid()) {
    frames_.clear();
  }
  if (frames_.empty()) begin_ns_ = log_time_ns;
  frames_.push_back(frame);
}

std::optional<body::PersonParameters> MotionGatherer::Person() const {
  if (frames_.empty()) return std::nullopt;
  const v1::BodyState& body = frames_.back().characters(0).body();
  if (!(body.mass_kg() > 0)) return std::nullopt;
  body::PersonParameters person;
  person.mass_kg = body.mass_kg();
  if (body.height_m() > 0) person.height_m = body.height_m();
  return person;
}

double MotionGatherer::lag_s() const {
  const double lag_s = frames_.empty() ? 0 : frames_.front().characters(0).body().lag_s();
  return lag_s > 0 && lag_s < kMostLagS ? lag_s : 0;
}

Result<MotionGatherer::Grid> MotionGatherer::MakeGrid() const {
  if (frames_.size() < 2) return InvalidData("fewer than two frames of a body after its T-pose");
  double step_s = frames_.back().time_s() - frames_.front().time_s();
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    const double next_s = frames_[i].time_s() - frames_[i - 1].time_s();
    if (!(next_s > 0)) return InvalidData("the time of the frames does not go on");
    step_s = std::min(step_s, next_s);
  }
  if (step_s < 1 / kMostRateHz) return InvalidData("the frames are less than 1 ms apart");
  Grid grid;
  grid.step_s = step_s;
  const double start_s = frames_.front().time_s();
  const double steps = (frames_.back().time_s() - start_s) / step_s;
  if (!(steps < kMostRowsPerFrame * static_cast<double>(frames_.size()))) {
    return InvalidData("nearly all of the " + std::to_string(std::llround(std::min(steps, 1e15))) +
                       " frames between the first and the last one are missing");
  }
  const auto columns = static_cast<std::size_t>(std::llround(steps) + 1);
  std::size_t at = 0;
  for (std::size_t i = 0; i < columns; ++i) {
    const double time_s = start_s + static_cast<double>(i) * step_s;
    while (at + 1 < frames_.size() && frames_[at + 1].time_s() < time_s + 0.5 * step_s) ++at;
    grid.frames.push_back(at);
  }
  return grid;
}

Result<motion::Motion> MotionGatherer::Finish() const {
  const auto grid = MakeGrid();
  if (!grid) return grid.error();
  auto skeleton = SkeletonOf(skeleton_, frames_.front().characters(0));
  if (!skeleton) return skeleton.error();
  motion::Motion motion;
  motion.skeleton = std::move(skeleton).value();
  motion.rate_hz = std::round(1e6 / grid->step_s) * 1e-6;  // Times are rounded, too.
  motion.start_s = frames_.front().time_s();
  const auto columns = static_cast<Eigen::Index>(grid->frames.size());
  motion.q.setZero(motion.skeleton.dof, columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    if (i > 0) motion.q.col(i) = motion.q.col(i - 1);  // Angles stay on the same turn.
    const v1::CharacterFrame& frame = frames_[grid->frames[static_cast<std::size_t>(i)]];
    SetPose(motion.skeleton, frame.characters(0), motion.q.col(i));
  }
  return motion;
}

Result<std::vector<motion::FootForces>> MotionGatherer::Forces() const {
  const auto grid = MakeGrid();
  if (!grid) return grid.error();
  std::vector<motion::FootForces> forces(grid->frames.size());
  const auto lag = static_cast<std::size_t>(std::llround(lag_s() / grid->step_s));
  for (std::size_t i = 0; i < forces.size(); ++i) {
    // A frame has the newest loads, and the pose of a lag before them.
    const std::size_t then = i < lag ? 0 : i - lag;
    const v1::BodyState& body = frames_[grid->frames[then]].characters(0).body();
    for (int side = 0; side < std::min(2, body.feet_size()); ++side) {
      const v1::BodyFoot& foot = body.feet(side);
      if (!foot.cop_valid() || !(foot.load_n() > 0) || !IsFresh(body, side)) continue;
      forces[i][static_cast<std::size_t>(side)] = {foot.load_n(), wire::FromProto(foot.cop_m())};
    }
  }
  return forces;
}

Result<std::vector<bool>> MotionGatherer::Valid() const {
  const auto grid = MakeGrid();
  if (!grid) return grid.error();
  std::vector<bool> valid;
  for (const std::size_t frame : grid->frames) {
    valid.push_back(frames_[frame].characters(0).valid());
  }
  return valid;
}

Result<std::vector<std::vector<double>>> MotionGatherer::AngleDeviations() const {
  const auto grid = MakeGrid();
  if (!grid) return grid.error();
  std::vector<std::vector<double>> rows;
  for (const std::size_t frame : grid->frames) {
    const auto& stated_rad = frames_[frame].characters(0).body().angle_sd_rad();
    rows.emplace_back();
    for (const double sd_rad : stated_rad) rows.back().push_back(RadiansToDegrees(sd_rad));
  }
  return rows;
}

}  // namespace footing::log_client
