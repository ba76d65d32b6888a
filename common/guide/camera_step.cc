#include "common/guide/camera_step.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/camera/camera_pose.h"
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

/// 30 frames of a camera with 15 a second.
constexpr double kRestS = 2;
/// A sphere that rests where nobody brought it is not on a mark.
constexpr double kBroughtM = 0.1;
/// A lens that is not calibrated sees lengths wrong by less than this share; a sphere that rests
/// elsewhere than on its mark is farther off.
constexpr double kLengthOff = 0.25;
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

std::string Centimetres(double metres) { return std::to_string(std::lround(100 * metres)) + " cm"; }

}  // namespace

void CameraStep::Begin(const Situation& now, const SetUpOptions& options) {
  begun_ = true;
  stream::BoardLayout layout = board::DefaultLayout();
  for (const auto& rig : *now.setup)
    if (rig.rig == options.rig) layout = board::LayoutOr(rig.layout);
  picture_ = LayoutPicture(layout.preset);
  marks_ = camera_pose::BoardMarks(layout, options.camera_radius_m);
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    places_.push_back(i);
    upright_.push_back(false);
    if (i % 4 != 0 || !HasController(now, options)) continue;
    places_.push_back(i);
    upright_.push_back(true);
  }
  asked_ns_ = now.now_ns;
}

CameraStep::Rest CameraStep::Look(const Situation& now, const SetUpOptions& options,
                                  bool upright) const {
  Rest rest;
  const std::int64_t from_ns = std::max(asked_ns_, now.now_ns - SecondsToNanoseconds(kRestS));
  std::vector<camera_pose::SeenPoint> frames;
  for (const auto& sample :
       now.recent->Hands(options.rig, options.camera_role, from_ns, now.now_ns))
    if (const auto seen = camera_pose::InTrackerFrame(sample)) frames.push_back(*seen);
  if (frames.empty()) {
    rest.feedback = "the camera does not see the sphere";
    return rest;
  }
  if (now.now_ns - asked_ns_ < SecondsToNanoseconds(kRestS)) {
    rest.feedback = "seen";
    rest.share = NanosecondsToSeconds(now.now_ns - asked_ns_) / kRestS;
    return rest;
  }
  const auto mean = camera_pose::MeanAtRest(frames);
  if (!mean) {
    rest.feedback = mean.error().message;
    return rest;
  }
  if (observations_.marks.empty() &&
      !WasBrought(now.recent->Hands(options.rig, options.camera_role, asked_ns_, now.now_ns),
                  mean->p_C_m)) {
    rest.feedback = "bring the sphere to the mark";
    return rest;
  }
  if (upright) {
    const auto tilt = TiltRad(now, options, from_ns);
    rest.feedback = tilt ? text::Fixed(RadiansToDegrees(*tilt), 1) + " degrees from upright"
                         : "the controller sends no data";
    if (!tilt || *tilt > kMostTiltRad) return rest;
    rest.tilt_rad = *tilt;
  }
  rest.seen = *mean;
  rest.share = 1;
  return rest;
}

std::string CameraStep::Doubt(const Rest& rest) const {
  const camera_pose::BoardMark& mark = marks_[places_[next_]];
  const Eigen::Vector3d& p_C_m = rest.seen->p_C_m;
  if (upright_[next_]) {
    const double height_m = (p_C_m - observations_.marks.back().seen.p_C_m).norm();
    if (height_m >= kShortestM && height_m <= kLongestM) return "";
    return Centimetres(height_m) + " from the mark";
  }
  for (const camera_pose::SeenMark& other : observations_.marks) {
    const double known_m = (mark.p_W_m - other.p_W_m).norm();
    const double seen_m = (p_C_m - other.seen.p_C_m).norm();
    if (std::abs(seen_m - known_m) <= kLengthOff * known_m) continue;
    return Centimetres(seen_m) + " from the mark at the " + other.name + ", should be " +
           Centimetres(known_m);
  }
  return "";
}

void CameraStep::Take(const Rest& rest) {
  if (upright_[next_]) {
    const double tilt_rad = std::hypot(rest.tilt_rad, std::sqrt(2.0) * kAccelerometerSdRad);
    observations_.plumbs.push_back({observations_.marks.back().seen, *rest.seen, tilt_rad});
  } else {
    const camera_pose::BoardMark& mark = marks_[places_[next_]];
    observations_.marks.push_back({mark.name, mark.p_W_m, *rest.seen});
  }
}

MarksState CameraStep::Marks(double rest_share) const {
  MarksState state;
  state.done = next_;
  state.all = places_.size();
  state.rest_share = rest_share;
  for (const camera_pose::BoardMark& mark : marks_)
    state.marks.push_back({mark.name, mark.p_W_m, MarkState::Stage::kToCome});
  for (std::size_t i = 0; i < next_; ++i) state.marks[places_[i]].stage = MarkState::Stage::kTaken;
  if (next_ < places_.size()) {
    state.marks[places_[next_]].stage = MarkState::Stage::kNext;
    state.upright = upright_[next_];
  }
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
  store.remark = std::to_string(observations_.marks.size()) + " marks, residual " +
                 text::Fixed(1e3 * pose_.residual_rms_m, 1) + " mm, direction to " +
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
  Rest rest = Look(now, options, upright_[next_]);
  if (!rest.seen) return Ask(rest);
  rest.feedback = Doubt(rest);
  if (!rest.feedback.empty()) return Ask(rest);
  Take(rest);
  asked_ns_ = now.now_ns;
  if (++next_ == places_.size()) return Solve();
  return Ask();
}

}  // namespace footing::guide
