#include "clients/view/scene/stage.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/figure.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/part.h"
#include "clients/view/scene/ribbon.h"
#include "clients/view/scene/signs.h"
#include "clients/view/scene/tally.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/board/layout.h"

namespace footing::scene {
namespace {

constexpr double kEmptyHipHeightM = 1.0;
constexpr double kStepsPerS = 2.5;  // A walk takes about 2, a run 3 steps a second.
constexpr double kSlopeHalfM = 0.3;
constexpr double kSteepest = 0.6;
/// The picture follows a head within this time, without its tremor.
constexpr double kRollS = 0.15;

/// The higher a thing, the wider and paler its spot.
Blob BlobUnder(const Eigen::Vector3d& p_m, double floor_m, double radius_m, double darkness) {
  const double height_m = std::max(0.0, p_m.z() - floor_m);
  const double wider = 1 + 0.35 * height_m;
  return {Eigen::Vector3d(p_m.x(), p_m.y(), floor_m).cast<float>(),
          static_cast<float>(radius_m * wider), static_cast<float>(darkness / (wider * wider))};
}

/// The rise is measured over 0.6 m; where that meets a step or an edge the ground counts as level.
Spot SpotUnder(const stream::Track& track, const Eigen::Vector2d& p_m, double floor_m) {
  const auto rise = [&](const Eigen::Vector2d& half_m) {
    const double difference_m =
        HeightAt(track, p_m + half_m, floor_m) - HeightAt(track, p_m - half_m, floor_m);
    const double slope = difference_m / (2 * half_m.norm());
    return std::abs(slope) < kSteepest ? static_cast<float>(slope) : 0.0f;
  };
  return {Eigen::Vector3d(p_m.x(), p_m.y(), floor_m).cast<float>(),
          {rise({kSlopeHalfM, 0}), rise({0, kSlopeHalfM})}};
}

BirdSkeleton SkeletonOf(const Model& model, std::uint32_t character) {
  for (const stream::Skeleton& skeleton : model.skeletons) {
    if (skeleton.character == character) return FindParts(skeleton);
  }
  return {};
}

/// The mean height of the contacts that touch.
std::optional<double> SupportOf(const std::vector<stream::Contact>& contacts) {
  double sum_m = 0;
  int touching = 0;
  for (const stream::Contact& contact : contacts) {
    if (!contact.touching) continue;
    sum_m += contact.position_m.z();
    ++touching;
  }
  return touching > 0 ? std::optional(sum_m / touching) : std::nullopt;
}

Subject SubjectOf(const Model& model, const CharacterPose& pose) {
  const BirdSkeleton skeleton = SkeletonOf(model, pose.character);
  Subject subject;
  subject.position_m = pose.com_m;
  if (skeleton.body < static_cast<int>(pose.links.size())) {
    subject.position_m = pose.links[static_cast<std::size_t>(skeleton.body)].position_m;
  }
  subject.heading_rad = pose.gait.heading_rad;
  subject.speed_mps = pose.gait.speed_mps;
  subject.turn_radps = kStepsPerS * pose.gait.commanded_turn_rad;
  subject.support_m = SupportOf(pose.contacts);
  return subject;
}

}  // namespace

void Stage::AddCharacter(const Model& model, const CharacterPose& pose, double dt_s,
                         const StageOptions& options, Picture& picture) {
  const auto ground_m = static_cast<double>(picture.ground_m);
  const BirdSkeleton skeleton = SkeletonOf(model, pose.character);
  BirdMotion& motion = motions_[pose.character];
  motion = scene::Advance(motion, skeleton, pose, dt_s);

  if (options.forces) AddForceArrows(pose, picture.forces);

  const double floor_m = HeightAt(model.track, pose.com_m.head<2>(), ground_m);
  AddBird(skeleton, pose, motion, floor_m, picture.figures);
  picture.spots.push_back(SpotUnder(model.track, pose.com_m.head<2>(), floor_m));
  picture.blobs.push_back(BlobUnder(pose.com_m, floor_m, 0.42, 0.75));
  for (const stream::Contact& foot : pose.contacts) {
    picture.blobs.push_back(BlobUnder(foot.position_m, floor_m, 0.15, 0.5));
  }
  const Eigen::Vector2d& next_m = pose.gait.next_foothold_m;
  if (!next_m.isZero()) {
    const double height_m = HeightAt(model.track, next_m, ground_m);
    picture.footholds.push_back(Eigen::Vector3d(next_m.x(), next_m.y(), height_m).cast<float>());
  }
}

void Stage::AddReconstructed(const Model& model, const CharacterPose& pose, double time_s,
                             std::int64_t now_ns, const StageOptions& options, Picture& picture) {
  ComTrail& trail = trails_[pose.character];
  if (pose.body->momentum_valid) trail.Add(time_s, pose.com_m);
  AddBody(model, pose, trail, now_ns, options, picture);
  const double floor_m = -board::kPlateHeightM;
  picture.spots.push_back(
      {Eigen::Vector3d(pose.com_m.x(), pose.com_m.y(), floor_m).cast<float>(), {0, 0}});
}

Picture Stage::AdvancePeople(const Model& model, const WorldFrame& frame, std::int64_t now_ns,
                             double dt_s, const StageOptions& options) {
  Picture picture;
  picture.studio = true;
  picture.ground_m = picture.floor_m = static_cast<float>(-board::kPlateHeightM);
  Eigen::Vector2d body_m(0, 0);
  for (const CharacterPose& pose : frame.characters) {
    if (!pose.body) continue;
    AddReconstructed(model, pose, frame.time_s, now_ns, options, picture);
    if (pose.body->calibrated) body_m = pose.com_m.head<2>();
  }
  front_.Advance(body_m, HasReference(model, now_ns) && !options.overlay_reference, dt_s);
  picture.camera = front_.Look();
  return picture;
}

Picture Stage::Advance(const Model& model, const WorldFrame& frame, std::int64_t now_ns,
                       double dt_s, const StageOptions& options) {
  if (model.observed.calibration) {
    Picture picture;
    AddCalibration(model, now_ns, picture);
    return picture;
  }
  if (!frame.characters.empty() && frame.characters.front().body) {
    return AdvancePeople(model, frame, now_ns, dt_s, options);
  }
  Picture picture;
  picture.ground_m = static_cast<float>(GroundHeight(model.track));
  Subject subject;
  subject.position_m.z() = kEmptyHipHeightM;
  double roll_rad = 0;
  bool none = true;
  for (const CharacterPose& pose : frame.characters) {
    if (!pose.valid) continue;
    AddCharacter(model, pose, dt_s, options, picture);
    if (!none && pose.character != options.followed) continue;
    subject = SubjectOf(model, pose);
    roll_rad = pose.interface.view_roll_rad;
    none = false;
  }
  AddGhostSegment(model.game, picture.ghosts);
  camera_.Advance(subject, dt_s);
  picture.camera = camera_.Look();
  roll_rad_ += (roll_rad - roll_rad_) * (1 - std::exp(-std::clamp(dt_s, 0.0, 1.0) / kRollS));
  picture.camera.roll_rad = roll_rad_;

  picture.floor_m = static_cast<float>(
      HeightAt(model.track, subject.position_m.head<2>(), static_cast<double>(picture.ground_m)));
  return picture;
}

namespace {

constexpr std::int64_t kReferenceStaleNs = 1'000'000'000;

Anatomy AnatomyOf(const Model& model, std::uint32_t character) {
  for (const stream::Skeleton& skeleton : model.skeletons) {
    if (skeleton.character == character) return FindAnatomy(skeleton);
  }
  return {};
}

PersonPose PersonOf(const CharacterPose& pose) {
  PersonPose person;
  for (const stream::LinkPose& link : pose.links) {
    person.p_m.push_back(link.position_m);
    person.orientations.push_back(link.orientation);
  }
  return person;
}

void AddReference(const Model& model, const Anatomy& anatomy, double lag_s, std::int64_t now_ns,
                  bool beside, Picture& picture) {
  const ReferencePose* reference = ReferenceAt(model, now_ns - SecondsToNanoseconds(lag_s));
  if (reference == nullptr) return;
  PersonPose person;
  person.p_m = reference->positions_m;
  if (beside) {
    for (Eigen::Vector3d& p : person.p_m) p += kBesideM;
  }
  const PersonLook look = PlainLook(Rgb(0xffc861));
  if (Fits(anatomy, reference->parents)) {
    AddPerson(anatomy, person, look, picture.ghosts);
  } else {
    AddLimbs(reference->parents, {}, person.p_m, look.shirt, picture.ghosts);
  }
}

/// Soft darkness under the shoes, on the boards.
void AddSoleShadows(const Anatomy& anatomy, const std::vector<Eigen::Vector3d>& p_m,
                    Picture& picture) {
  if (!anatomy.person) return;
  using body::Landmark;
  for (const auto& [ankle, toe] : {std::pair(Landmark::kLeftAnkle, Landmark::kLeftToe),
                                   std::pair(Landmark::kRightAnkle, Landmark::kRightToe)}) {
    const int a = anatomy.landmarks[ankle], b = anatomy.landmarks[toe];
    if (a < 0 || b < 0 || std::max(a, b) >= static_cast<int>(p_m.size())) continue;
    const Eigen::Vector3d& from_m = p_m[static_cast<std::size_t>(a)];
    const Eigen::Vector3d& to_m = p_m[static_cast<std::size_t>(b)];
    if (to_m.z() > 0.15) continue;
    const Eigen::Vector3d middle_m = 0.35 * from_m + 0.65 * to_m;
    const double yaw_rad = std::atan2(to_m.y() - from_m.y(), to_m.x() - from_m.x());
    picture.clear.AddDisc(
        {static_cast<float>(middle_m.x()), static_cast<float>(middle_m.y()), 0.0015f},
        {0.145f, 0.056f}, static_cast<float>(yaw_rad), Rgb(0x101418));
  }
}

}  // namespace

bool HasReference(const Model& model, std::int64_t now_ns) {
  return !model.observed.references.empty() &&
         now_ns - model.observed.references.back().received_ns < kReferenceStaleNs;
}

void AddBody(const Model& model, const CharacterPose& pose, const ComTrail& trail,
             std::int64_t now_ns, const StageOptions& options, Picture& picture) {
  const Anatomy anatomy = AnatomyOf(model, pose.character);
  PersonPose person = PersonOf(pose);
  const BodyState& body = *pose.body;
  AddBoards(BoardsOf(model, pose.rig, now_ns), picture.figures);
  if (body.calibrated) {
    person.sd_m = body.link_sd_m;
    AddPerson(anatomy, person, MannequinLook(), picture.figures);
    AddSoleShadows(anatomy, person.p_m, picture);
  } else {
    AddPerson(anatomy, person, PlainLook(Rgb(0x8fd6ff)), picture.ghosts);
  }
  if (HasReference(model, now_ns)) {
    const bool beside = !options.overlay_reference;
    AddReference(model, anatomy, body.lag_s, now_ns, beside, picture);
  }
  BodySigns signs;
  AddBodySigns(pose, trail, signs);
  AddHandSigns(model.observed.hands, pose.rig, now_ns, signs);
  picture.signs = std::move(signs.solid);
  const PartList& clear = signs.clear;
  picture.clear.balls.insert(picture.clear.balls.end(), clear.balls.begin(), clear.balls.end());
  picture.labels = std::move(signs.labels);
}

void Show::Take(const Update& update, std::int64_t now_ns) {
  if (update.live) model_.tally.publish_to_view.Add(now_ns - update.host_ns);
  Apply(model_, update);
}

WorldFrame Show::FrameAt(std::int64_t now_ns) {
  if (replays_falls_ && model_.replay.clips() > replayed_) model_.replay.Start(now_ns);
  replayed_ = model_.replay.clips();
  if (!model_.replay.At(now_ns)) model_.replay.Stop();
  return ShownAt(now_ns);
}

WorldFrame Show::ShownAt(std::int64_t now_ns) const {
  if (auto again = model_.replay.At(now_ns)) return *again;
  return model_.playout.empty() ? frame_ : model_.playout.At(now_ns);
}

double Show::PassedS(std::int64_t now_ns) const {
  return last_ns_ == 0 ? 0 : NanosecondsToSeconds(now_ns - last_ns_);
}

void Show::ToggleReplay(std::int64_t now_ns) {
  if (model_.replay.At(now_ns)) {
    model_.replay.Stop();
  } else {
    model_.replay.Start(now_ns);
  }
}

Show::Shot Show::At(std::int64_t now_ns, bool frozen, const StageOptions& options) {
  const double passed_s = PassedS(now_ns);
  last_ns_ = now_ns;
  if (frozen && !frozen_) frozen_ = std::make_unique<const Frozen>(Frozen{model_, now_ns});
  if (!frozen) {
    frozen_.reset();
    frame_ = FrameAt(now_ns);
  }
  ++model_.tally.frames_drawn;
  return {frame_, stage_.Advance(model_, frame_, now_ns, frozen ? 0 : passed_s, options),
          frozen_ ? frozen_->model : model_, frozen_ ? frozen_->at_ns : now_ns};
}

void Show::Step(std::int64_t now_ns, const StageOptions& options) {
  frame_ = FrameAt(now_ns);
  stage_.Advance(model_, frame_, now_ns, PassedS(now_ns), options);
  last_ns_ = now_ns;
}

Show::Shot Show::Peek(std::int64_t now_ns, const StageOptions& options) {
  ++model_.tally.frames_drawn;
  const WorldFrame frame = ShownAt(now_ns);
  Stage ahead = stage_;
  return {frame, ahead.Advance(model_, frame, now_ns, PassedS(now_ns), options), model_, now_ns};
}

namespace {

using Eigen::Vector3f;

constexpr std::int64_t kStaleNs = 500'000'000;
constexpr float kColumnPerN = 0.25f / 400;  // A quarter of a metre for a person on one cell.
constexpr float kLowestColumnM = 0.004f;
constexpr float kColumnRadiusM = 0.016f;

Vector3f At(const Eigen::Vector2d& p_m, double z_m) {
  return Eigen::Vector3d(p_m.x(), p_m.y(), z_m).cast<float>();
}

void AddPlate(const PlacedBoard& board, const Colour& accent, PartList& parts) {
  const auto turn = static_cast<float>(board.pose.yaw_rad);
  Eigen::Matrix3f axes;  // Columns: right, front, up.
  axes << std::sin(turn), std::cos(turn), 0, -std::cos(turn), std::sin(turn), 0, 0, 0, 1;
  const auto box = [&](double right_m, double front_m, double z_m, const Vector3f& sides_m,
                       const Colour& colour, float gloss) {
    parts.AddBox(At(board.InWorld(right_m, front_m), z_m), axes, sides_m, colour, gloss);
  };
  const auto wide = static_cast<float>(board.geometry.plate_x_m),
             deep = static_cast<float>(board.geometry.plate_y_m),
             high = static_cast<float>(board::kPlateHeightM);
  const Colour body = board.live ? Rgb(0xe8ebee) : Rgb(0x8d949b);
  const Colour pad = board.live ? Rgb(0xd3d8dd) : Rgb(0x7d848b);
  box(0, 0, -0.60 * high, {wide, deep - 0.03f, 0.8f * high}, body, 0.3f);
  box(0, 0, -0.60 * high, {wide - 0.03f, deep, 0.8f * high}, body, 0.3f);
  box(0, 0, -0.11 * high, {wide - 0.02f, deep - 0.02f, 0.2f * high}, body, 0.3f);
  for (const double right : {-1.0, 1.0}) {
    for (const double front : {-1.0, 1.0}) {
      box(right * 0.121, front * 0.073, -0.0019, {0.228f, 0.130f, 0.004f}, pad, 0.05f);
    }
  }
  // The edge with the power button says which board it is.
  box(0, -0.5 * deep + 0.004, -0.5 * high, {0.16f, 0.012f, 0.016f}, accent, 0.4f);
}

void AddColumns(const PlacedBoard& board, const Colour& accent, PartList& parts) {
  const auto sensors = board.Sensors();
  const auto loads = board.Loads();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const float height = std::max(kLowestColumnM, kColumnPerN * static_cast<float>(loads[i]));
    const Vector3f foot = At(sensors[i], 0);
    parts.AddRod(foot, foot + Vector3f(0, 0, height), kColumnRadiusM, kColumnRadiusM, accent, 0.3f);
    parts.AddDisc(foot + Vector3f(0, 0, height), {kColumnRadiusM, kColumnRadiusM}, 0, accent);
  }
}

}  // namespace

Eigen::Vector2d PlacedBoard::InWorld(double right_m, double front_m) const {
  return board::InWorld(pose, right_m, front_m);
}

std::array<Eigen::Vector2d, board::kCorners> PlacedBoard::Sensors() const {
  return board::SensorPlaces(pose, geometry);
}

std::array<double, 4> PlacedBoard::Loads() const {
  if (!live) return {};
  return {sample.top_left_n, sample.top_right_n, sample.bottom_left_n, sample.bottom_right_n};
}

Colour SideColour(std::size_t side) { return side == 0 ? Rgb(0x3f8fe0) : Rgb(0xf2a33c); }

stream::BoardGeometry GeometryOf(const Model& model, const std::pair<int, std::uint32_t>& board) {
  for (const Device& device : model.devices) {
    if (std::pair(device.source, device.status.device) != board) continue;
    const bool left = device.status.role == stream::DeviceRole::kLeftBoard;
    for (const stream::RigSetup& setup : model.setup) {
      if (setup.rig != device.status.rig) continue;
      return board::GeometryOr(left ? setup.layout.left_geometry : setup.layout.right_geometry);
    }
  }
  return board::kBalanceBoard;
}

std::array<PlacedBoard, 2> BoardsOf(const Model& model, const std::string& rig,
                                    std::int64_t now_ns) {
  stream::BoardLayout layout = board::DefaultLayout();
  for (const stream::RigSetup& setup : model.setup) {
    if (setup.rig == rig) layout = board::LayoutOr(setup.layout);
  }
  std::array<PlacedBoard, 2> boards;
  boards[0].pose = layout.left;
  boards[0].geometry = board::GeometryOr(layout.left_geometry);
  boards[1].pose = layout.right;
  boards[1].geometry = board::GeometryOr(layout.right_geometry);
  for (const Device& device : model.devices) {
    if (device.status.rig != rig) continue;
    const bool left = device.status.role == stream::DeviceRole::kLeftBoard;
    if (!left && device.status.role != stream::DeviceRole::kRightBoard) continue;
    const auto trace = model.boards.find({device.source, device.status.device});
    if (trace == model.boards.end()) continue;
    PlacedBoard& board = boards[left ? 0 : 1];
    board.sample = trace->second.newest;
    board.live = now_ns - trace->second.newest_ns < kStaleNs;
  }
  return boards;
}

void AddPlates(const std::array<PlacedBoard, 2>& boards, PartList& parts) {
  for (std::size_t side = 0; side < boards.size(); ++side)
    AddPlate(boards[side], SideColour(side), parts);
}

void AddBoards(const std::array<PlacedBoard, 2>& boards, PartList& parts) {
  AddPlates(boards, parts);
  for (std::size_t side = 0; side < boards.size(); ++side) {
    AddColumns(boards[side], SideColour(side), parts);
  }
}

}  // namespace footing::scene
