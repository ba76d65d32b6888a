#include "clients/view/scene/model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "clients/view/scene/stage.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/geometry.h"

namespace footing::scene {
namespace {

using guide::MarkState;

constexpr float kPadRadiusM = 0.03f, kBallRadiusM = 0.0225f;
constexpr float kUprightM =
    0.16f;  // From the mark to the sphere of a controller that stands on it.
constexpr double kPulseHz = 1;
constexpr double kFrustumM = 0.25;

Colour ColourOfMark(MarkState::Stage stage) {
  switch (stage) {
    case MarkState::Stage::kToCome:
      return Rgb(0x8c939c);
    case MarkState::Stage::kNext:
      return Rgb(0xf2a33c);
    case MarkState::Stage::kTaken:
      return Rgb(0x3fbf6f);
  }
  return Rgb(0x8c939c);
}

/// The sphere as it should be held; it swells and shrinks, so that it is seen at once.
void AddNext(const MarkState& mark, bool upright, std::int64_t now_ns, Picture& picture) {
  const double phase = 2 * kPi * kPulseHz * NanosecondsToSeconds(now_ns);
  const float radius = kBallRadiusM * static_cast<float>(1.15 + 0.25 * std::sin(phase));
  const Colour colour = ColourOfMark(mark.stage);
  Eigen::Vector3f at = mark.p_W_m.cast<float>();
  if (upright) {
    const Eigen::Vector3f foot(at.x(), at.y(), 0);
    at.z() += kUprightM;
    picture.figures.AddRod(foot, at, 0.02f, 0.016f, Rgb(0x20242a), 0.3f);
  }
  picture.signs.AddBall(
      Ellipsoid(at, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Constant(radius)), colour, colour,
      0.3f);
  picture.labels.push_back(
      {at, upright ? "stand the controller here" : "hold the sphere here", colour});
}

void AddMark(const MarkState& mark, Picture& picture) {
  const Colour colour = ColourOfMark(mark.stage);
  const Eigen::Vector3f at = mark.p_W_m.cast<float>();
  picture.clear.AddDisc({at.x(), at.y(), 0.002f}, {kPadRadiusM, kPadRadiusM}, 0, colour);
  if (mark.stage != MarkState::Stage::kTaken) return;
  picture.figures.AddBall(
      Ellipsoid(at, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Constant(kBallRadiusM)), colour,
      colour, 0.2f);
  if (mark.residual_m)
    picture.labels.push_back({at, text::Fixed(1e3 * *mark.residual_m, 1) + " mm", colour});
}

/// A body and what it looks at.
void AddCamera(const Eigen::Isometry3d& X_WC, Picture& picture) {
  const Eigen::Vector3f eye = X_WC.translation().cast<float>();
  const Colour colour = Rgb(0x62bfee);
  picture.figures.AddBox(eye, X_WC.linear().cast<float>(), {0.09f, 0.05f, 0.05f}, Rgb(0x20242a));
  Eigen::Vector3f corners[4];
  for (int i = 0; i < 4; ++i) {
    const double right = (i == 0 || i == 3 ? -0.6 : 0.6) * kFrustumM;
    const double down = (i < 2 ? -0.45 : 0.45) * kFrustumM;
    corners[i] = (X_WC * Eigen::Vector3d(right, down, kFrustumM)).cast<float>();
  }
  for (int i = 0; i < 4; ++i) {
    picture.figures.AddRod(eye, corners[i], 0.004f, 0.004f, colour);
    picture.figures.AddRod(corners[i], corners[(i + 1) % 4], 0.004f, 0.004f, colour);
  }
  picture.labels.push_back({eye, "camera", colour});
}

}  // namespace

void AddCalibration(const Model& model, std::int64_t now_ns, Picture& picture) {
  const Calibration& calibration = *model.observed.calibration;
  picture.studio = true;
  picture.ground_m = picture.floor_m = static_cast<float>(-board::kPlateHeightM);
  picture.camera.eye_m = {-1.15, 0, 1.15};
  picture.camera.target_m = {0.1, 0, -0.1};
  picture.camera.vertical_field_rad = 0.64;
  AddPlates(BoardsOf(model, calibration.rig, now_ns), picture.figures);
  picture.spots.push_back({Eigen::Vector3f(0, 0, picture.floor_m), {0, 0}});
  if (!calibration.marks) return;
  for (const MarkState& mark : calibration.marks->marks) {
    AddMark(mark, picture);
    if (mark.stage == MarkState::Stage::kNext && !calibration.result)
      AddNext(mark, calibration.marks->upright, now_ns, picture);
  }
  if (!calibration.marks->X_WC) return;
  AddCamera(*calibration.marks->X_WC, picture);
  // From the side, so that the boards and the camera are in the picture, above the panel.
  const Eigen::Vector3d camera_m = calibration.marks->X_WC->translation();
  const Eigen::Vector3d middle_m = camera_m / 2 - Eigen::Vector3d(0, 0, 0.3);
  picture.camera.target_m = middle_m;
  picture.camera.eye_m =
      middle_m + (1.2 + 1.1 * camera_m.norm()) * Eigen::Vector3d(-0.45, -0.75, 0.5).normalized();
}

std::string CalibrationTitle(const Calibration& calibration) {
  if (calibration.result)
    return calibration.result->passed ? "The camera's pose is measured." : "Refused.";
  return calibration.prompt.empty() ? "Waiting for footingd." : calibration.prompt;
}

std::string CalibrationDetail(const Calibration& calibration) {
  if (calibration.result) return calibration.result->note;
  return calibration.feedback;
}

std::string CalibrationProgress(const Calibration& calibration) {
  std::string text = "Where the camera stands";
  if (calibration.result || !calibration.marks || calibration.marks->all == 0) return text;
  const std::size_t number = std::min(calibration.marks->done + 1, calibration.marks->all);
  return text + ", " + std::to_string(number) + " of " + std::to_string(calibration.marks->all);
}

namespace {

constexpr std::size_t kMaxFrames = 2048;

bool Fell(const WorldFrame& before, const WorldFrame& after) {
  for (const CharacterPose& now : after.characters) {
    for (const CharacterPose& then : before.characters) {
      if (now.character == then.character && now.gait.falls > then.gait.falls) return true;
    }
  }
  return false;
}

bool PutBack(const WorldFrame& before, const WorldFrame& after) {
  for (const CharacterPose& now : after.characters) {
    for (const CharacterPose& then : before.characters) {
      if (now.character == then.character && (now.com_m - then.com_m).norm() > kPutBackM) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

void FallReplay::CutClip(double fall_s) {
  // A second fall within the first one's clip belongs to it.
  if (filling_) return;
  clip_ = recent_;
  fall_s_ = fall_s;
  filling_ = true;
  started_ns_.reset();
}

void FallReplay::Push(const WorldFrame& frame) {
  if (!recent_.empty() && frame.time_s < recent_.back().time_s) *this = {};
  if (!recent_.empty() && frame.time_s == recent_.back().time_s) return;
  const bool fell = !recent_.empty() && Fell(recent_.back(), frame);
  const bool put_back = !recent_.empty() && PutBack(recent_.back(), frame);
  // Frames before a put-back belong to another walk.
  if (put_back) recent_.clear();
  if (fell) CutClip(frame.time_s);
  if (filling_ && (put_back || frame.time_s > fall_s_ + kAfterS)) {
    filling_ = false;
    ++clips_;
  }
  if (filling_) clip_.push_back(frame);
  recent_.push_back(frame);
  while (recent_.size() > kMaxFrames || recent_.front().time_s < frame.time_s - kBeforeS) {
    recent_.pop_front();
  }
}

void FallReplay::Start(std::int64_t now_ns) {
  if (ready()) started_ns_ = now_ns;
}

double FallReplay::ClipTimeS(std::int64_t now_ns) const {
  if (!started_ns_ || clip_.empty()) return 0;
  return clip_.front().time_s + kPace * NanosecondsToSeconds(now_ns - *started_ns_);
}

std::optional<WorldFrame> FallReplay::At(std::int64_t now_ns) const {
  if (!started_ns_ || !ready()) return std::nullopt;
  const double time_s = ClipTimeS(now_ns);
  const auto after = std::find_if(clip_.begin(), clip_.end(),
                                  [time_s](const WorldFrame& f) { return f.time_s > time_s; });
  if (after == clip_.end()) return std::nullopt;
  if (after == clip_.begin()) return clip_.front();
  const WorldFrame& before = *std::prev(after);
  return Between(before, *after, (time_s - before.time_s) / (after->time_s - before.time_s));
}

namespace {

constexpr std::int64_t kKeptNs = 3 * kNanosecondsPerSecond / 2;
constexpr std::size_t kMaxPlayoutFrames = 512;

Eigen::Vector3d Mix(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share) {
  return a + share * (b - a);
}

CharacterPose Between(const CharacterPose& a, const CharacterPose& b, double share) {
  CharacterPose between = a;
  between.com_m = Mix(a.com_m, b.com_m, share);
  between.com_velocity_mps = Mix(a.com_velocity_mps, b.com_velocity_mps, share);
  if (a.body && b.body) between.body = share < 0.5 ? a.body : b.body;
  for (std::size_t i = 0; i < between.links.size(); ++i) {
    between.links[i].position_m = Mix(a.links[i].position_m, b.links[i].position_m, share);
    between.links[i].orientation = a.links[i].orientation.slerp(share, b.links[i].orientation);
  }
  for (std::size_t i = 0; i < between.contacts.size(); ++i) {
    between.contacts[i].position_m = Mix(a.contacts[i].position_m, b.contacts[i].position_m, share);
  }
  return between;
}

bool Joinable(const CharacterPose& a, const CharacterPose& b) {
  return a.character == b.character && a.links.size() == b.links.size() &&
         a.contacts.size() == b.contacts.size() && (a.com_m - b.com_m).norm() < kPutBackM;
}

}  // namespace

WorldFrame Between(const WorldFrame& a, const WorldFrame& b, double share) {
  if (share >= 1) return b;
  if (share <= 0) return a;
  WorldFrame between = a;
  between.time_s = a.time_s + share * (b.time_s - a.time_s);
  for (std::size_t i = 0; i < std::min(a.characters.size(), b.characters.size()); ++i) {
    if (!Joinable(a.characters[i], b.characters[i])) continue;
    between.characters[i] = Between(a.characters[i], b.characters[i], share);
  }
  return between;
}

void Playout::Push(WorldFrame frame, std::int64_t received_ns) {
  if (!frames_.empty() && frame.time_s < frames_.back().frame.time_s) frames_.clear();
  if (!frames_.empty() && frame.time_s == frames_.back().frame.time_s) return;
  frames_.push_back({std::move(frame), received_ns});
  while (frames_.size() > kMaxPlayoutFrames ||
         frames_.front().received_ns < received_ns - kKeptNs) {
    frames_.pop_front();
  }
}

double Playout::ShownTime(std::int64_t now_ns) const {
  const std::int64_t base_ns = frames_.front().received_ns;
  double offset_s = 1e300;  // Viewer's clock minus simulation time, at the least delay.
  for (const Timed& timed : frames_) {
    offset_s =
        std::min(offset_s, NanosecondsToSeconds(timed.received_ns - base_ns) - timed.frame.time_s);
  }
  const std::size_t count = frames_.size();
  const double interval_s =
      count < 2 ? 0 : frames_[count - 1].frame.time_s - frames_[count - 2].frame.time_s;
  return NanosecondsToSeconds(now_ns - base_ns) - offset_s - interval_s;
}

WorldFrame Playout::At(std::int64_t now_ns) const {
  const double shown_s = ShownTime(now_ns);
  const auto after = std::find_if(frames_.begin(), frames_.end(), [shown_s](const Timed& timed) {
    return timed.frame.time_s > shown_s;
  });
  if (after == frames_.end()) return frames_.back().frame;
  if (after == frames_.begin()) return frames_.front().frame;
  const WorldFrame& a = std::prev(after)->frame;
  const WorldFrame& b = after->frame;
  return Between(a, b, (shown_s - a.time_s) / (b.time_s - a.time_s));
}

namespace {

constexpr std::size_t kMaxPoints = 2500;  // 10 s at 200 Hz, and some more.
constexpr std::size_t kMaxDevices = 16;
constexpr std::size_t kMaxRigs = 8;
constexpr std::int64_t kLineBreakNs = 500'000'000;

void AddIf(Strip& strip, bool valid, std::int64_t time_ns, double value) {
  if (valid) {
    strip.Add(time_ns, value);
  } else {
    strip.Break(time_ns);
  }
}

void AddSample(const stream::MotionSample& sample, std::int64_t time_ns, DeviceStrips& strips) {
  strips.simulated = sample.simulated;
  strips.magnitude_mps2.Add(time_ns, sample.specific_force_mps2.norm());
  strips.filtered_x_mps2.Add(time_ns, sample.filtered_mps2.x());
  strips.filtered_y_mps2.Add(time_ns, sample.filtered_mps2.y());
  strips.filtered_z_mps2.Add(time_ns, sample.filtered_mps2.z());
}

void AddFeatures(const stream::DeviceFeatures& features, std::int64_t time_ns,
                 DeviceStrips& strips) {
  strips.role = features.role;
  strips.moving.Add(time_ns, features.moving ? 1 : 0);
  AddIf(strips.frequency_hz, features.frequency_valid, time_ns, features.frequency_hz);
  AddIf(strips.amplitude_mps2, features.amplitude_valid, time_ns, features.amplitude_mps2);
  AddIf(strips.roll_rad, features.inclination_valid, time_ns, features.roll_rad);
  AddIf(strips.pitch_rad, features.inclination_valid, time_ns, features.pitch_rad);
}

}  // namespace

void Strip::Add(std::int64_t time_ns, double value) {
  if (!std::isfinite(value)) return Break(time_ns);
  const bool late = !points_.empty() && time_ns - points_.back().time_ns > kLineBreakNs;
  points_.push_back({time_ns, static_cast<float>(value), !broken_ && !late});
  broken_ = false;
  if (points_.size() > kMaxPoints) points_.pop_front();
  DropBefore(time_ns - kStripNs);
}

void Strip::Break(std::int64_t time_ns) {
  broken_ = true;
  DropBefore(time_ns - kStripNs);
}

void Strip::DropBefore(std::int64_t time_ns) {
  while (!points_.empty() && points_.front().time_ns < time_ns) points_.pop_front();
}

std::int64_t ShownTime(std::int64_t newest_ns, std::int64_t now_ns) {
  // A little more, so that the values there count as old.
  return std::min(now_ns, newest_ns + kCurrentNs + kCurrentNs / 5);
}

void StripSet::Add(const Update& update) {
  if (!update.motion.empty() || !update.features.empty()) newest_ns = update.received_ns;
  const auto strips_of = [this, &update](std::uint32_t device) -> DeviceStrips* {
    const std::pair key(update.source, device);
    if (devices.count(key) == 0 && devices.size() >= kMaxDevices) return nullptr;
    return &devices[key];
  };
  for (const stream::MotionSample& sample : update.motion) {
    DeviceStrips* strips = strips_of(sample.device);
    // The sample's place within its tick: how long before the tick's stamp the radio gave it.
    const std::int64_t time_ns = update.received_ns - (update.host_ns - sample.received_ns);
    if (strips != nullptr) AddSample(sample, std::min(time_ns, update.received_ns), *strips);
  }
  for (const stream::RigFeatures& rig : update.features) {
    for (const stream::DeviceFeatures& features : rig.devices) {
      DeviceStrips* strips = strips_of(features.device);
      if (strips != nullptr) AddFeatures(features, update.received_ns, *strips);
    }
    if (rig.pairs.empty()) continue;
    if (phases_rad.count(rig.rig) == 0 && phases_rad.size() >= kMaxRigs) continue;
    const stream::PairFeatures& pair = rig.pairs.front();
    AddIf(phases_rad[rig.rig], pair.phase_valid, update.received_ns, pair.phase_rad);
  }
}

namespace {

constexpr std::size_t kMaxBoards = 8;
constexpr std::size_t kMaxTracePoints = 1500;
constexpr std::size_t kMaxSpans = 512;
constexpr std::size_t kMaxPhases = 8;
constexpr std::int64_t kReferencesNs = 500'000'000;
constexpr double kStandingN = 50;  // Five kilograms: less is not a person.

void Replace(std::vector<Device>& devices, int source,
             const std::vector<stream::DeviceStatus>& statuses) {
  std::erase_if(devices, [source](const Device& device) { return device.source == source; });
  for (const stream::DeviceStatus& status : statuses) devices.push_back({source, status});
}

/// A device that its server does not list any more, such as after a restart, or that is lost while
/// another one has its place.
bool IsGone(std::uint32_t device, const std::vector<stream::DeviceStatus>& statuses) {
  const auto own =
      std::find_if(statuses.begin(), statuses.end(),
                   [device](const stream::DeviceStatus& one) { return one.device == device; });
  if (own == statuses.end()) return true;
  if (own->state != stream::DeviceState::kLost) return false;
  if (own->role == stream::DeviceRole::kUnspecified) return false;
  return std::any_of(statuses.begin(), statuses.end(), [own](const stream::DeviceStatus& other) {
    return other.state != stream::DeviceState::kLost && other.rig == own->rig &&
           other.role == own->role;
  });
}

/// Curves of what is gone would stand beside those of what came in its place.
void DropGone(Model& model, int source, const std::vector<stream::DeviceStatus>& statuses) {
  const auto gone = [&](const auto& one) {
    return one.first.first == source && IsGone(one.first.second, statuses);
  };
  std::erase_if(model.strips.devices, gone);
  std::erase_if(model.boards, gone);
}

void AddBoard(Model& model, int source, std::int64_t received_ns,
              const stream::BoardSample& sample) {
  const std::pair key(source, sample.device);
  if (model.boards.count(key) == 0 && model.boards.size() >= kMaxBoards) return;
  BoardTrace& board = model.boards[key];
  const bool joined = board.newest.cop_valid;
  board.newest = sample;
  board.newest_ns = received_ns;
  if (sample.cop_valid) {
    board.points.push_back({received_ns, static_cast<float>(sample.cop_x_m),
                            static_cast<float>(sample.cop_y_m), joined});
  }
  while (board.points.size() > kMaxTracePoints ||
         (!board.points.empty() && board.points.front().time_ns < received_ns - kStripNs)) {
    board.points.pop_front();
  }
}

void AddNote(Model& model, const Note& note, int source, std::int64_t received_ns) {
  if (note.kind == NoteKind::kResponse) {
    model.last.response = note;
    model.tally.Add(note.response);
    return;
  }
  if (note.text.empty()) return;
  model.last.note = note;
  model.last.note->received_ns = received_ns;
  if (note.kind == NoteKind::kServer) model.last.server[source] = *model.last.note;
}

void AddPhase(Model& model, const CharacterPose& pose, std::int64_t received_ns) {
  std::deque<PhaseSpan>& spans = model.phase_spans;
  const bool same_gait = !spans.empty() && spans.back().gait == pose.gait.gait;
  if (!same_gait) model.phases.clear();
  if (same_gait && spans.back().phase == pose.phase) return;
  spans.push_back({pose.phase, pose.gait.gait, received_ns});
  while (spans.size() > kMaxSpans ||
         (spans.size() > 1 && spans[1].start_ns < received_ns - kStripNs)) {
    spans.pop_front();
  }
  const bool known =
      std::find(model.phases.begin(), model.phases.end(), pose.phase) != model.phases.end();
  if (!known && model.phases.size() < kMaxPhases) model.phases.push_back(pose.phase);
}

void AddReference(Model& model, const ReferencePose& reference) {
  model.observed.references.push_back(reference);
  while (model.observed.references.size() > 1 &&
         model.observed.references.front().received_ns < reference.received_ns - kReferencesNs) {
    model.observed.references.pop_front();
  }
}

stream::DeviceRole RoleOf(const Model& model, const std::pair<int, std::uint32_t>& key) {
  for (const Device& device : model.devices) {
    if (device.source == key.first && device.status.device == key.second) {
      return device.status.role;
    }
  }
  return stream::DeviceRole::kUnspecified;
}

}  // namespace

void Apply(Model& model, const Update& update) {
  if (update.host_ns != 0) {
    std::int64_t& newest_ns = model.newest_host_ns[update.source];
    newest_ns = std::max(newest_ns, update.host_ns);
  }
  if (update.devices) {
    Replace(model.devices, update.source, *update.devices);
    DropGone(model, update.source, *update.devices);
  }
  if (update.skeletons) {
    model.skeletons = *update.skeletons;
    model.anatomy = model.skeletons.empty() ? Anatomy{} : FindAnatomy(model.skeletons.front());
  }
  if (update.track) {
    model.track = *update.track;
    ++model.track_version;
  }
  if (update.game) model.game = *update.game;
  if (update.study) {
    model.study = {*update.study, update.received_ns};
  }
  if (update.setup) model.setup = *update.setup;
  if (update.reference) AddReference(model, *update.reference);
  for (const stream::HandSample& sample : update.hands)
    TakeHand(sample, update.received_ns, model.observed.hands);
  model.strips.Add(update);
  for (const stream::BoardSample& sample : update.boards) {
    AddBoard(model, update.source, update.received_ns, sample);
  }
  for (const Note& note : update.notes) AddNote(model, note, update.source, update.received_ns);
  if (update.frame) {
    if (!update.frame->characters.empty() && !update.frame->characters.front().body) {
      AddPhase(model, update.frame->characters.front(), update.received_ns);
    }
    if (!update.frame->characters.empty()) {
      model.pose_tally.Add(update.frame->characters.front(), model.anatomy, update.host_ns,
                           model.observed.references);
    }
    model.tally.Add(*update.frame);
    model.replay.Push(*update.frame);
    model.playout.Push(*update.frame, update.received_ns);
  }
}

bool IsCurrent(const Model& model, const Device& device) {
  const auto source = static_cast<std::size_t>(device.source);
  // A recording has no connections.
  return source >= model.links.size() || model.links[source].state == LinkState::kLive;
}

bool IsSimulated(const Model& model) {
  const bool device = std::any_of(model.devices.begin(), model.devices.end(),
                                  [](const Device& d) { return d.status.simulated; });
  if (device || model.playout.empty()) return device;
  const auto& characters = model.playout.Newest().characters;
  return std::any_of(characters.begin(), characters.end(),
                     [](const CharacterPose& pose) { return pose.simulated_input; });
}

double AgeMs(const Model& model, std::int64_t now_ns) {
  std::int64_t oldest_ns = IsWaiting(model) ? 0 : now_ns;
  for (const auto& [source, newest_ns] : model.newest_host_ns) {
    oldest_ns = std::min(oldest_ns, newest_ns);
  }
  return std::max(0.0, static_cast<double>(now_ns - oldest_ns) * 1e-6);
}

bool HasPicture(const Model& model) { return !model.playout.empty(); }

bool IsWaiting(const Model& model) { return model.newest_host_ns.empty(); }

const ReferencePose* ReferenceAt(const Model& model, std::int64_t time_ns) {
  if (model.observed.references.empty()) return nullptr;
  const ReferencePose* found = &model.observed.references.front();
  for (const ReferencePose& reference : model.observed.references) {
    if (reference.received_ns <= time_ns) found = &reference;
  }
  return found;
}

Stance StanceOf(const Model& model) {
  Stance stance;
  double left_n = 0, right_n = 0;
  for (const auto& [key, board] : model.boards) {
    const stream::BoardSample& sample = board.newest;
    const double left_cells_n = sample.top_left_n + sample.bottom_left_n;
    const double right_cells_n = sample.top_right_n + sample.bottom_right_n;
    switch (RoleOf(model, key)) {
      case stream::DeviceRole::kLeftBoard:
        left_n += sample.total_n;
        break;
      case stream::DeviceRole::kRightBoard:
        right_n += sample.total_n;
        break;
      case stream::DeviceRole::kUnspecified:
      case stream::DeviceRole::kLeftHand:
      case stream::DeviceRole::kRightHand:
      case stream::DeviceRole::kLeftLeg:
      case stream::DeviceRole::kRightLeg:
      case stream::DeviceRole::kHead:
      case stream::DeviceRole::kTrunk:
      case stream::DeviceRole::kLeftUpperArm:
      case stream::DeviceRole::kRightUpperArm:
      case stream::DeviceRole::kLeftForearm:
      case stream::DeviceRole::kRightForearm:
      case stream::DeviceRole::kPelvis:
      case stream::DeviceRole::kLeftThigh:
      case stream::DeviceRole::kRightThigh:
      case stream::DeviceRole::kEditor:
        left_n += left_cells_n;
        right_n += right_cells_n;
    }
  }
  // A lone board carries both feet, whatever its role is called.
  if (model.boards.size() == 1) {
    const stream::BoardSample& only = model.boards.begin()->second.newest;
    left_n = only.top_left_n + only.bottom_left_n;
    right_n = only.top_right_n + only.bottom_right_n;
  }
  stance.total_n = left_n + right_n;
  stance.valid = stance.total_n > kStandingN;
  if (stance.valid) stance.left_share = std::clamp(left_n / stance.total_n, 0.0, 1.0);
  return stance;
}

namespace {

/// Whose key it is.
enum class Of { kAll, kBiped, kPerson };

struct LiveKey {
  const char* key;
  const char* what;
  Of of;
};

constexpr std::array<LiveKey, 21> kLiveKeys{{
    {"?, F1", "show or hide this list", Of::kAll},
    {"H", "hide or show the panels", Of::kAll},
    {"F11", "full screen, or a window again", Of::kAll},
    {"arrows", "turn the view; + and - zoom", Of::kAll},
    {"Z", "the view from behind again; also a double click", Of::kBiped},
    {"Z", "the view from the front again; also a double click", Of::kPerson},
    {"F", "force arrows at the feet", Of::kBiped},
    {"P", "states of the gait controller", Of::kBiped},
    {"R", "replay the last fall in slow motion", Of::kBiped},
    {"T", "take the T-pose again", Of::kPerson},
    {"N", "the next subject", Of::kPerson},
    {"M", "best mode, or the mode of the paper; stand upright", Of::kPerson},
    {"L", "with or without the angular momentum", Of::kPerson},
    {"U", "with or without the linear momentum", Of::kPerson},
    {"B", "with or without the basis of poses", Of::kPerson},
    {"K", "with or without the clean-up of the feet", Of::kPerson},
    {"O", "the true pose beside the body, or over it", Of::kPerson},
    {"V", "the preview of the camera", Of::kAll},
    {"E", "a marker in the recordings", Of::kAll},
    {"C", "calibrate where the camera stands; X ends it", Of::kAll},
    {"space", "freeze the picture", Of::kAll},
}};

bool Is(const LiveKey& key, char letter) { return key.key[0] == letter && key.key[1] == '\0'; }

bool IsOfOther(Of of, Engine engine) {
  return (of == Of::kBiped && engine == Engine::kPerson) ||
         (of == Of::kPerson && engine == Engine::kBiped);
}

/// T, N and those of the mode send a command.
bool Commands(char letter) { return letter == 'T' || letter == 'N' || ChangesMode(letter); }

}  // namespace

bool ChangesMode(char key) { return key == 'M' || !PartOfKey(key).empty(); }

std::string PartOfKey(char key) {
  switch (key) {
    case 'L':
      return "angular_momentum";
    case 'U':
      return "momentum";
    case 'B':
      return "basis";
    case 'K':
      return "cleanup";
    default:
      return "";
  }
}

Engine EngineOf(const Model& model) {
  if (model.playout.empty() || model.playout.Newest().characters.empty()) return Engine::kUnknown;
  return model.playout.Newest().characters.front().body ? Engine::kPerson : Engine::kBiped;
}

namespace {

/// The server is connected, on this machine.
bool IsLiveHere(const Model& model, const char* server_id) {
  return std::any_of(model.links.begin(), model.links.end(), [server_id](const LinkReport& link) {
    return link.server_id == server_id && link.state == LinkState::kLive &&
           link.address.rfind("unix:", 0) == 0;
  });
}

}  // namespace

KeyContext ContextOf(const Model& model, bool has_subjects, bool calibrates) {
  return {EngineOf(model), has_subjects, calibrates, IsLiveHere(model, "footing-sim")};
}

std::string MarkedServer(const Model& model) {
  for (const char* server_id : {"footingd", "footing-sim"}) {
    if (IsLiveHere(model, server_id)) return server_id;
  }
  return "";
}

std::vector<KeyLine> LiveKeyLines(const KeyContext& context) {
  std::vector<KeyLine> lines;
  for (const LiveKey& key : kLiveKeys) {
    const bool shown = key.of == Of::kAll
                           ? !Is(key, 'C') || context.calibrates
                           : context.engine != Engine::kUnknown &&
                                 !IsOfOther(key.of, context.engine) &&
                                 (!Commands(key.key[0]) || WhyNoKey(key.key[0], context).empty());
    if (shown) lines.push_back({key.key, key.what});
  }
  lines.push_back({"Esc, Q", "quit"});
  for (KeyLine& line : MouseLines()) lines.push_back(std::move(line));
  if (WhyNoPush(context).empty()) lines.push_back({"", "drag the character to push it"});
  return lines;
}

std::vector<KeyLine> MouseLines() {
  return {{"mouse", "drag to turn the view, wheel to zoom"},
          {"", "right or middle button to shift the view"},
          {"", "double click on a character to follow it"},
          {"", "strips: wheel to zoom in, drag to go back"},
          {"", "drop a recording here to play it"}};
}

std::string WhyNoPush(const KeyContext& context) {
  if (context.engine != Engine::kBiped) return "only the biped can be pushed";
  if (!context.may_command) return "works only on the machine where footing-sim runs";
  return "";
}

std::string WhyNoKey(char letter, const KeyContext& context) {
  const auto* const key =
      std::find_if(kLiveKeys.begin(), kLiveKeys.end(),
                   [letter](const LiveKey& one) { return one.of != Of::kAll && Is(one, letter); });
  if (key == kLiveKeys.end() || letter == 'Z') return "";
  const std::string does = std::string("Key ") + key->key + " (" + key->what + "): ";
  if (IsOfOther(key->of, context.engine)) {
    return does + (key->of == Of::kPerson
                       ? "only for a person on boards. Start footing-sim with --engine pose."
                       : "only for the biped. Start footing-sim with --engine gait.");
  }
  if (!Commands(letter)) return "";
  if (letter == 'N' && !context.has_subjects)
    return does + "no subject file was named. Start footing-view with --next-subject FILE.";
  if (!context.may_command)
    return does + "works only on the machine where footing-sim runs, while it is connected.";
  return "";
}

}  // namespace footing::scene
