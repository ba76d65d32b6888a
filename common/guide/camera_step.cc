#include "common/guide/camera_step.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/camera/camera_pose.h"
#include "common/guide/device_steps.h"
#include "common/guide/recent.h"

namespace footing::guide {

const char* Name(Item item) {
  switch (item) {
    case Item::kAdapter:
      return "adapter";
    case Item::kPairing:
      return "pairing";
    case Item::kRoles:
      return "roles";
    case Item::kLayout:
      return "layout";
    case Item::kTare:
      return "tare";
    case Item::kMounting:
      return "mounting";
    case Item::kWeigh:
      return "weigh";
    case Item::kCamera:
      return "camera";
    case Item::kChecks:
      return "checks";
  }
  return "";
}

const std::vector<Item>& AllItems() {
  static const std::vector<Item> items{Item::kAdapter, Item::kPairing, Item::kRoles,
                                       Item::kLayout,  Item::kTare,    Item::kMounting,
                                       Item::kWeigh,   Item::kCamera,  Item::kChecks};
  return items;
}

std::optional<Item> ItemNamed(const std::string& name) {
  for (const Item item : AllItems()) {
    if (name == Name(item)) return item;
  }
  return std::nullopt;
}

stream::SetupItem Outcome(Item item, const std::string& serial, bool passed, double residual,
                          const std::string& unit, const std::string& note) {
  stream::SetupItem outcome;
  outcome.name = Name(item);
  outcome.serial = serial;
  outcome.passed = passed;
  outcome.residual = residual;
  outcome.unit = unit;
  outcome.note = note;
  return outcome;
}

namespace {

/// 30 frames of a camera with 15 a second. A slower one is waited for: a pose held for this time
/// has not moved, however many frames that were.
constexpr double kRestS = 2;
constexpr double kLongestRestS = 10;
/// A sphere that rests where nobody brought it is not on a mark.
constexpr double kBroughtM = 0.1;
/// A lens that is not calibrated sees lengths wrong by less than this share; a sphere that rests
/// elsewhere than on its mark is farther off.
constexpr double kLengthOff = 0.25;
/// Nor is a hand in a pose that is farther off than this as well: hands are held loosely.
constexpr double kHandOffM = 0.12;
constexpr double kMostTiltRad = DegreesToRadians(3);
/// Standard deviation of a PS Move's calibrated accelerometer, at rest.
constexpr double kAccelerometerSdRad = DegreesToRadians(0.5);
constexpr double kShortestM = 0.1, kLongestM = 0.3;  // From the mark to a sphere above it.

/// Tilt of the controller's long axis, y of its sensor frame; nothing when it is not at rest.
std::optional<double> TiltRad(const Situation& now, const SetUpOptions& options,
                              std::int64_t from_ns) {
  const auto device = now.recent->Holding(options.rig, options.camera_role);
  if (!device) return {};
  const auto force = now.recent->MeanForce(device->device, from_ns, now.now_ns);
  if (!force) return {};
  return std::acos(std::clamp(force->normalized().y(), -1.0, 1.0));
}

bool HasController(const Situation& now, const SetUpOptions& options) {
  const auto device = now.recent->Holding(options.rig, options.camera_role);
  return device && device->kind == stream::DeviceKind::kPsMove;
}

/// Whether the sphere was elsewhere, or out of sight, since the place was asked for.
bool WasBrought(const std::vector<stream::HandSample>& samples, const Eigen::Vector3d& p_C_m) {
  return std::any_of(samples.begin(), samples.end(), [&](const stream::HandSample& sample) {
    const auto seen = camera_pose::InTrackerFrame(sample);
    return !seen || (seen->p_C_m - p_C_m).norm() > kBroughtM;
  });
}

/// Prompts, in the order of camera_pose::PoseMarks.
constexpr const char* kPosePrompts[] = {
    "Stand on the boards with both arms hanging and the spheres to the front, and keep still.",
    "Stretch both arms straight ahead, level, with the spheres up, and keep still.",
    "Stretch both arms out to the sides, level, with the spheres up, and keep still."};

std::string Centimetres(double metres) { return std::to_string(std::lround(100 * metres)) + " cm"; }

}  // namespace

void CameraStep::Begin(const Situation& now, const SetUpOptions& options) {
  begun_ = true;
  layout_ = board::DefaultLayout();
  for (const auto& rig : *now.setup)
    if (rig.rig == options.rig) layout_ = board::LayoutOr(rig.layout);
  asked_ns_ = now.now_ns;
  if (options.poses_height_m > 0) {
    observations_.in_poses = true;
    observations_.placement_sd_m = camera_pose::kPoseSdM;
    marks_ = camera_pose::PoseMarks(options.poses_height_m, options.fist_to_sphere_m);
    roles_ = {stream::DeviceRole::kLeftHand, stream::DeviceRole::kRightHand};
    for (std::size_t i = 0; i < marks_.size(); i += roles_.size()) places_.push_back(i);
    upright_.assign(places_.size(), false);
    return;
  }
  picture_ = LayoutPicture(layout_.preset);
  marks_ = camera_pose::BoardMarks(layout_, options.camera_radius_m);
  roles_ = {options.camera_role};
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    places_.push_back(i);
    upright_.push_back(false);
    if (i % 4 != 0 || !HasController(now, options)) continue;
    places_.push_back(i);
    upright_.push_back(true);
  }
}

std::optional<Eigen::Vector2d> CameraStep::Standing(const Situation& now,
                                                    const SetUpOptions& options,
                                                    std::int64_t from_ns) const {
  const auto boards = now.recent->Boards(options.rig);
  Eigen::Vector2d moment_nm(0, 0);
  double load_n = 0;
  // Left before right, and a lone board stands in the left one's place.
  for (std::size_t i = 0; i < std::min<std::size_t>(2, boards.size()); ++i) {
    const Load load = now.recent->BoardLoad(boards[i].device, from_ns, now.now_ns);
    if (!load.cop_valid) continue;
    const stream::BoardPose& pose = i == 0 ? layout_.left : layout_.right;
    moment_nm += load.mean_n * board::InWorld(pose, load.cop_x_m, load.cop_y_m);
    load_n += load.mean_n;
  }
  if (load_n < kStoodOnN) return {};
  return moment_nm / load_n;
}

std::int64_t CameraStep::RestFrom(const Situation& now, const SetUpOptions& options) const {
  const std::int64_t longest_ns =
      std::max(asked_ns_, now.now_ns - SecondsToNanoseconds(kLongestRestS));
  std::int64_t from_ns = std::max(asked_ns_, now.now_ns - SecondsToNanoseconds(kRestS));
  for (const stream::DeviceRole role : roles_) {
    const auto samples = now.recent->Hands(options.rig, role, longest_ns, now.now_ns);
    std::size_t count = 0;
    std::int64_t enough_ns = longest_ns;
    for (auto one = samples.rbegin(); one != samples.rend(); ++one) {
      if (!camera_pose::InTrackerFrame(*one) || ++count < camera_pose::kLeastFrames) continue;
      enough_ns = one->received_ns;
      break;
    }
    from_ns = std::min(from_ns, enough_ns);
  }
  return from_ns;
}

CameraStep::Rest CameraStep::Look(const Situation& now, const SetUpOptions& options) const {
  Rest rest;
  const std::int64_t from_ns = RestFrom(now, options);
  const std::size_t first = places_[next_];
  std::vector<camera_pose::SeenMark> seen;
  for (std::size_t k = 0; k < roles_.size(); ++k) {
    std::vector<camera_pose::SeenPoint> frames;
    for (const auto& sample : now.recent->Hands(options.rig, roles_[k], from_ns, now.now_ns))
      if (const auto one = camera_pose::InTrackerFrame(sample)) frames.push_back(*one);
    const std::string which =
        observations_.in_poses ? (k == 0 ? "left hand: " : "right hand: ") : "";
    if (frames.empty()) {
      rest.feedback = which + "the camera does not see the sphere";
      return rest;
    }
    if (now.now_ns - asked_ns_ < SecondsToNanoseconds(kRestS)) {
      rest.feedback = "seen";
      rest.share = NanosecondsToSeconds(now.now_ns - asked_ns_) / kRestS;
      continue;
    }
    const auto mean = observations_.in_poses
                          ? camera_pose::MeanAtRest(frames, camera_pose::kPoseTrembleM)
                          : camera_pose::MeanAtRest(frames);
    if (!mean) {
      rest.feedback = which + mean.error().message;
      return rest;
    }
    seen.push_back({marks_[first + k], *mean});
  }
  if (seen.empty()) return rest;
  if (observations_.in_poses) {
    const auto cop_W_m = Standing(now, options, from_ns);
    rest.feedback = "nobody stands on the boards";
    if (!cop_W_m) return rest;
    for (camera_pose::SeenMark& mark : seen) mark.p_W_m.head<2>() += *cop_W_m;
  } else if (observations_.marks.empty() &&
             !WasBrought(now.recent->Hands(options.rig, roles_[0], asked_ns_, now.now_ns),
                         seen[0].seen.p_C_m)) {
    rest.feedback = "bring the sphere to the mark";
    return rest;
  }
  if (upright_[next_]) {
    const auto tilt = TiltRad(now, options, from_ns);
    rest.feedback = tilt ? text::Fixed(RadiansToDegrees(*tilt), 1) + " degrees from upright"
                         : "the controller sends no data";
    if (!tilt || *tilt > kMostTiltRad) return rest;
    rest.tilt_rad = *tilt;
  }
  rest.seen = std::move(seen);
  rest.share = 1;
  return rest;
}

std::string CameraStep::Doubt(const Rest& rest) const {
  if (upright_[next_]) {
    const Eigen::Vector3d& low_C_m = observations_.marks.back().seen.p_C_m;
    const double height_m = (rest.seen[0].seen.p_C_m - low_C_m).norm();
    if (height_m >= kShortestM && height_m <= kLongestM) return "";
    return Centimetres(height_m) + " from the mark";
  }
  std::vector<camera_pose::SeenMark> others = observations_.marks;
  for (const camera_pose::SeenMark& mark : rest.seen) {
    for (const camera_pose::SeenMark& other : others) {
      const double known_m = (mark.p_W_m - other.p_W_m).norm();
      const double seen_m = (mark.seen.p_C_m - other.seen.p_C_m).norm();
      const double off_m = std::abs(seen_m - known_m);
      if (off_m <= kLengthOff * known_m) continue;
      if (!observations_.in_poses)
        return Centimetres(seen_m) + " from the mark at the " + other.name + ", should be " +
               Centimetres(known_m);
      if (off_m <= kHandOffM) continue;
      return mark.name + ": " + Centimetres(seen_m) + " from the " + other.name +
             ", should be about " + Centimetres(known_m);
    }
    others.push_back(mark);
  }
  return "";
}

void CameraStep::Take(const Rest& rest) {
  if (upright_[next_]) {
    const double tilt_rad = std::hypot(rest.tilt_rad, std::sqrt(2.0) * kAccelerometerSdRad);
    observations_.plumbs.push_back({observations_.marks.back().seen, rest.seen[0].seen, tilt_rad});
  } else {
    observations_.marks.insert(observations_.marks.end(), rest.seen.begin(), rest.seen.end());
  }
}

MarksState CameraStep::Marks(double rest_share) const {
  MarksState state;
  state.done = next_;
  state.all = places_.size();
  state.rest_share = rest_share;
  for (const camera_pose::Mark& mark : marks_)
    state.marks.push_back({mark.name, mark.p_W_m, MarkState::Stage::kToCome});
  for (std::size_t i = 0; i < std::min(next_ + 1, places_.size()); ++i)
    for (std::size_t k = 0; k < roles_.size(); ++k)
      state.marks[places_[i] + k].stage =
          i < next_ ? MarkState::Stage::kTaken : MarkState::Stage::kNext;
  state.upright = next_ < places_.size() && upright_[next_];
  if (!stored_) return state;
  state.X_WC = pose_.X_WC;
  // Without the upright places, the marks were taken in their own order.
  for (std::size_t i = 0; i < std::min(marks_.size(), pose_.residuals_m.size()); ++i)
    state.marks[i].residual_m = pose_.residuals_m[i];
  return state;
}

Progress CameraStep::Ask(const Rest& rest) const {
  Progress progress = Ask();
  progress.feedback = rest.feedback;
  progress.marks = Marks(rest.share);
  return progress;
}

Progress CameraStep::Ask() const {
  Progress progress;
  progress.marks = Marks(0);
  if (observations_.in_poses) {
    progress.prompt = kPosePrompts[next_];
    return progress;
  }
  const std::string place = "the mark at the " + marks_[places_[next_]].name;
  progress.prompt = upright_[next_] ? "Stand the controller on " + place +
                                          ", sphere up, and hold it upright and still."
                                    : "Hold the sphere on " + place + ", and keep still.";
  if (next_ == 0) progress.picture = picture_;
  return progress;
}

Progress CameraStep::Solve() {
  Progress progress;
  const auto pose = camera_pose::Calibrate(observations_);
  if (!pose) {
    progress.results = {Outcome(Item::kCamera, "", false, 0, "mm", pose.error().message)};
    progress.marks = Marks(0);
    progress.finished = true;
    return progress;
  }
  pose_ = *pose;
  stored_ = true;
  progress.marks = Marks(1);
  Action store;
  store.kind = Action::Kind::kStoreCamera;
  store.key = "camera";
  store.X_WC = pose_.X_WC;
  store.remark = (observations_.in_poses ? "three poses"
                                         : std::to_string(observations_.marks.size()) + " marks") +
                 ", residual " + text::Fixed(1e3 * pose_.residual_rms_m, 1) + " mm, direction to " +
                 text::Fixed(RadiansToDegrees(pose_.TurnSdRad()), 2) + " degrees" +
                 (observations_.plumbs.empty() ? "" : ", with gravity");
  progress.actions = {store};
  return progress;
}

Progress CameraStep::Stored(const Situation& now) {
  Progress progress;
  progress.marks = Marks(1);
  for (const Answer& answer : now.answers) {
    if (answer.key != "camera") continue;
    progress.results = {
        Outcome(Item::kCamera, "", answer.ok, 1e3 * pose_.residual_rms_m, "mm", answer.message)};
    progress.finished = true;
  }
  return progress;
}

Progress CameraStep::Advance(const Situation& now, const SetUpOptions& options) {
  Progress progress;
  if (options.camera_file.empty()) {
    progress.finished = true;
    return progress;
  }
  if (!begun_) Begin(now, options);
  if (stored_) return Stored(now);
  Rest rest = Look(now, options);
  if (rest.seen.empty()) return Ask(rest);
  rest.feedback = Doubt(rest);
  if (!rest.feedback.empty()) return Ask(rest);
  Take(rest);
  asked_ns_ = now.now_ns;
  if (++next_ == places_.size()) return Solve();
  return Ask();
}

}  // namespace footing::guide
