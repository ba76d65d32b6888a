#include "daemon/offline/pose_run/pose_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/devices/scene.h"
#include "common/virtual/motion/edit.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/pose/arm_tracker.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::pose_run {
namespace {

namespace sensors = virtual_sensors;

/// The calibration is over before the T-pose is.
constexpr double kWeighedS = momentum::TPoseCalibration::kSeconds + 0.2;

/// The boards, where they are and where they are configured to be.
struct Boards {
  std::array<sensors::BoardPlace, sensors::kFeet> real = sensors::SideBySide();
  std::array<sensors::BoardPlace, sensors::kFeet> configured;
  std::vector<sensors::CellErrors> cells;

  Boards(const sensors::Scene& scene, const Settings& settings) {
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      // Each foot begins in its board's middle.
      real[f].middle_m = sensors::SoleMiddle(scene.course, f, 0).head<2>();
      configured[f] = real[f];
      configured[f].middle_m.y() += (f == 0 ? 0.5 : -0.5) * settings.gap_error_m;
      if (f == 1) configured[f].yaw_rad -= settings.yaw_error_rad;
      sensors::CellErrorConfig errors = settings.errors;
      errors.seed = 2 * settings.errors.seed + f;
      cells.emplace_back(errors);
    }
  }

  sensors::BoardLoad Load(std::size_t f, const sensors::FootForce& force,
                          const Settings& settings) const {
    sensors::BoardLoad load = sensors::LoadBoard(real[f], force, settings.limited);
    if (settings.floor && sensors::IsBeside(real[f], force)) load.corners_n = {};
    return load;
  }

  momentum::FootLoads Read(std::size_t f, const sensors::BoardLoad& load, double scale,
                           double step_s) {
    const auto read_n = cells[f].Advance(load.corners_n, step_s);
    const auto places = sensors::SensorPlaces(configured[f]);
    momentum::FootLoads foot;
    foot.valid = true;
    foot.count = places.size();
    for (std::size_t k = 0; k < places.size(); ++k) {
      foot.cells[k] = {{places[k].x(), places[k].y(), 0}, scale * read_n[k]};
    }
    return foot;
  }
};

}  // namespace

void MeasureHands(const body::Body& body, const body::Kinematics& at, double noise_m,
                  noise::Random& random,
                  std::array<reconstruction::HandInput, reconstruction::kHands>& hands) {
  for (int side = 0; side < 2; ++side) {
    reconstruction::HandInput& hand = hands[static_cast<std::size_t>(side)];
    hand.valid = true;
    hand.p_W_m = body::Place(body::Fist(body, side), at);
    for (double& value : hand.p_W_m) value += noise_m * random.Normal();
    hand.sd_m.setConstant(std::max(noise_m, 0.001));
  }
}

PoseRun WithoutExtras(PoseRun run) {
  for (Frame& frame : run.frames) {
    if (!reconstruction::IsSkeleton(frame.inputs.joints)) frame.inputs.joints = {};
    frame.inputs.turns = {};
  }
  return run;
}

FootForcesAt SimulatedForces(const sensors::Scene& scene) {
  return [&scene](double, Eigen::Index column) {
    return sensors::ShareBetweenFeet(scene.course, scene.reaction, column);
  };
}

namespace {

/// The true frame of a body whose joints are `at`, with nothing measured yet.
Frame TrueFrame(const sensors::Scene& scene, Eigen::Index column,
                const std::array<sensors::FootForce, sensors::kFeet>& forces,
                const body::Kinematics& at) {
  Frame frame;
  frame.q = scene.motion.q.col(column);
  frame.angular_momentum = scene.course.angular_momentum.col(column);
  frame.com_m = body::CentreOfMass(scene.body, at);
  for (std::size_t f = 0; f < sensors::kFeet; ++f) {
    frame.feet[f] = {forces[f].load_n, forces[f].cop_m,
                     body::Place(body::Ankle(scene.body, static_cast<int>(f)), at),
                     body::Place(body::Toe(scene.body, static_cast<int>(f)), at)};
  }
  return frame;
}

}  // namespace

PoseRun RunScene(const sensors::Scene& scene, const Settings& settings,
                 const FootForcesAt& forces_at) {
  PoseRun run;
  run.body = scene.body;
  run.rate_hz = settings.rate_hz;
  Boards boards(scene, settings);
  noise::Random random(settings.seed);
  std::optional<HeldHands> held;
  const bool strapped = settings.hand_device == HandDevice::kStraps;
  if (settings.hands && (strapped || settings.hand_device == HandDevice::kWiimote)) {
    held.emplace(scene, strapped ? kStrapped : kFists, settings);
    run.reading_s = held->step_s();
  }
  virtual_sensors::KinectOptions options = settings.kinect;
  options.hides = options.hides && settings.joints;
  KinectBody kinect(scene.body, settings.seed, 1 / settings.rate_hz, options);
  body::Kinematics at(scene.body.skeleton);
  const double step_s = 1 / settings.rate_hz;
  ExtraSensors extra(scene, settings.head, settings.segments, settings.squat_before, settings.seed,
                     step_s);
  const auto aligned = static_cast<std::size_t>(kAlignedS * settings.rate_hz);
  const std::size_t count = FrameCount(scene, settings.rate_hz);
  std::size_t loaded = 0, outside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = static_cast<double>(i) * step_s;
    const Eigen::Index column = ColumnAt(scene, time_s);
    const auto forces = forces_at(time_s, column);
    body::ComputeKinematics(scene.body.skeleton, scene.motion.q.col(column), at);
    Frame frame = TrueFrame(scene, column, forces, at);
    frame.inputs.loads.time_s = time_s;
    const double scale = time_s < kWeighedS ? 1 + settings.mass_error : 1;
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      const auto load = boards.Load(f, forces[f], settings);
      frame.inputs.loads.feet[f] = boards.Read(f, load, scale, step_s);
      if (forces[f].load_n > kLoadedN) {
        ++loaded;
        outside += load.outside ? 1 : 0;
      }
    }
    if (held) {
      frame.readings = held->Until(column);
    } else if (settings.hands && settings.hand_device == HandDevice::kKinect) {
      kinect.Advance(at, settings.joints, frame.inputs);
      frame.kinect.assign(kinect.exposed().begin(), kinect.exposed().end());
      frame.kinect_crouches = kinect.crouches();
    } else if (settings.hands) {
      MeasureHands(scene.body, at, settings.hand_noise_m, random, frame.inputs.hands);
    }
    const double t_pose_m = (run.frames.empty() ? frame : run.frames.front()).com_m.z();
    const bool squats =
        arms::IsSquat(frame.com_m.z(), t_pose_m, forces[0].load_n, forces[1].load_n);
    extra.Advance(at, column, time_s < kStandS, i == aligned, squats, frame.inputs);
    run.frames.push_back(std::move(frame));
  }
  run.outside_share = loaded > 0 ? static_cast<double>(outside) / static_cast<double>(loaded) : 0;
  run.judged_from = static_cast<std::size_t>(std::lround(kStandS * settings.rate_hz));
  run.headings = extra.headings();
  return run;
}

Result<PoseRun> RunPose(const motion::Motion& clip, const Settings& settings,
                        const std::string& origin) {
  const auto scene = Stage(clip, settings, origin);
  if (!scene) return scene.error();
  PoseRun run = RunScene(*scene, settings, SimulatedForces(*scene));
  run.clock_offset_s =
      clip.start_s - (scene->motion.duration_s() - clip.duration_s());  // But for a loop.
  return run;
}

Result<virtual_sensors::Scene> Stage(const motion::Motion& clip, const Settings& settings,
                                     const std::string& origin) {
  auto kept = motion::WithLandmarksOnly(clip);
  if (!kept) return InvalidData(origin + ": " + kept.error().message);
  body::PersonParameters person;
  person.mass_kg = settings.mass_kg;
  person.height_m = settings.height_m;
  virtual_sensors::SceneOptions options;
  options.hold_s = kStandS;
  options.leave_s = kLeaveS;
  options.rest_share = momentum::FootShape{}.rest_share;
  options.loop_s = settings.loop_s;
  return virtual_sensors::MakeScene(std::move(kept).value(), person, options, origin);
}

std::size_t FrameCount(const virtual_sensors::Scene& scene, double rate_hz) {
  return static_cast<std::size_t>(scene.motion.duration_s() * rate_hz);
}

Eigen::Index ColumnAt(const virtual_sensors::Scene& scene, double time_s) {
  return std::min<Eigen::Index>(
      static_cast<Eigen::Index>(std::lround(time_s * scene.motion.rate_hz)),
      scene.motion.frames() - 1);
}

namespace {

using body::Landmark;

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The least of both knees' and both hips' bends.
double LeastBend(const body::Body& body, const Eigen::VectorXd& q, body::Kinematics& at) {
  body::ComputeKinematics(body.skeleton, q, at);
  const auto place = [&](Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(body.landmarks[landmark])];
  };
  const Eigen::Vector3d hips = 0.5 * (place(Landmark::kLeftHip) + place(Landmark::kRightHip));
  const Eigen::Vector3d trunk = place(Landmark::kNeck) - hips;
  double least = kPi;
  for (const bool right : {false, true}) {
    const auto of = [&](Landmark left) { return place(right ? body::Mirrored(left) : left); };
    const Eigen::Vector3d hip = of(Landmark::kLeftHip), knee = of(Landmark::kLeftKnee);
    const Eigen::Vector3d ankle = of(Landmark::kLeftAnkle);
    least = std::min({least, Angle(trunk, hip - knee), Angle(knee - hip, ankle - knee)});
  }
  return least;
}

}  // namespace

Crouch DeepestCrouch(const PoseRun& run, std::size_t from) {
  body::Kinematics at(run.body.skeleton);
  Crouch deepest{from, 0};
  for (std::size_t i = from; i < run.frames.size(); ++i) {
    const Frame& frame = run.frames[i];
    if (!(frame.feet[0].load_n > kLoadedN && frame.feet[1].load_n > kLoadedN)) continue;
    const double bend_rad = LeastBend(run.body, frame.q, at);
    if (bend_rad > deepest.bend_rad) deepest = {i, bend_rad};
  }
  return deepest;
}

Result<InsoleRun> RunInsoles(const motion::Motion& clip, const Settings& settings,
                             const std::string& origin) {
  const auto scene = Stage(clip, settings, origin);
  if (!scene) return scene.error();

  InsoleRun run;
  run.body = scene->body;
  run.rate_hz = settings.rate_hz;
  std::array<std::array<Eigen::Vector2d, sensors::kInsoleCells>, sensors::kFeet> places;
  for (std::size_t f = 0; f < places.size(); ++f) {
    const double length_m = sensors::PlaceOfSole(scene->course, f, 0).length_m;
    places[f] = sensors::InsolePlaces(length_m);
  }
  noise::Random random(settings.seed);
  const double noise_n = KilogramsToNewtons(settings.errors.noise_kg);
  body::Kinematics at(scene->body.skeleton);
  const std::size_t count = FrameCount(*scene, settings.rate_hz);
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = static_cast<double>(i) / settings.rate_hz;
    const Eigen::Index column = ColumnAt(*scene, time_s);
    InsoleFrame frame;
    frame.inputs.time_s = time_s;
    frame.q = scene->motion.q.col(column);
    const auto forces = sensors::ShareBetweenFeet(scene->course, scene->reaction, column);
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      const auto loads =
          sensors::LoadInsole(places[f], sensors::PlaceOfSole(scene->course, f, column), forces[f]);
      frame.load_n[f] = forces[f].load_n;
      reconstruction::InsoleFoot& foot = frame.inputs.feet[f];
      foot.valid = true;
      foot.count = loads.size();
      for (std::size_t k = 0; k < loads.size(); ++k) {
        foot.p_S_m[k] = places[f][k];
        foot.load_n[k] = loads[k] + noise_n * random.Normal();
      }
    }
    if (settings.hands) {
      body::ComputeKinematics(scene->body.skeleton, frame.q, at);
      MeasureHands(scene->body, at, settings.hand_noise_m, random, frame.inputs.hands);
    }
    run.frames.push_back(std::move(frame));
  }
  return run;
}

namespace {

constexpr double kLeastStandingS = 1;
constexpr double kWeightBand = 0.06;  // Part of the mean load: breathing and sway are less.
constexpr double kSwayM = 0.04;
constexpr double kStandingMassOff = 0.1;
constexpr double kMostOffsetM = 0.08;

struct Felt {
  double load_n = 0;
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();
};

/// Load and COP of all plates together at one sample.
Felt All(const motion::GroundForces& forces, Eigen::Index sample) {
  Felt felt;
  for (const motion::PlateForces& plate : forces.plates) {
    const double load_n = plate.force_W(2, sample);
    if (!(load_n > kLoadedN)) continue;
    felt.load_n += load_n;
    felt.cop_m += load_n * plate.cop_W.col(sample).head<2>();
  }
  if (felt.load_n > 0) felt.cop_m /= felt.load_n;
  return felt;
}

}  // namespace

Result<Eigen::Vector2d> StandingOffset(const motion::Motion& still,
                                       const motion::GroundForces& forces, const Settings& settings,
                                       const std::string& origin,
                                       const std::string& forces_origin) {
  const auto kept = motion::WithLandmarksOnly(still);
  if (!kept) return InvalidData(origin + ": " + kept.error().message);
  body::PersonParameters person;
  person.mass_kg = settings.mass_kg;
  person.height_m = settings.height_m;
  const auto body = body::MakeBody(kept->skeleton, person);
  if (!body) return InvalidData(origin + ": " + body.error().message);
  body::Kinematics at(body->skeleton);
  const Eigen::Index samples = forces.plates.front().force_W.cols();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), least, most;
  least.setConstant(std::numeric_limits<double>::infinity());
  most = -least;
  double load_n = 0, least_n = std::numeric_limits<double>::infinity(), most_n = 0, count = 0;
  for (Eigen::Index i = 0; i < kept->frames(); ++i) {
    const double time_s = kept->start_s + static_cast<double>(i) / kept->rate_hz;
    const auto sample =
        static_cast<Eigen::Index>(std::lround((time_s - forces.start_s) * forces.rate_hz));
    if (sample < 0 || sample >= samples) continue;
    const Felt felt = All(forces, sample);
    body::ComputeKinematics(body->skeleton, kept->q.col(i), at);
    const Eigen::Vector2d com = body::CentreOfMass(*body, at).head<2>();
    least = least.cwiseMin(com);
    most = most.cwiseMax(com);
    least_n = std::min(least_n, felt.load_n);
    most_n = std::max(most_n, felt.load_n);
    load_n += felt.load_n;
    sum += com - felt.cop_m;
    ++count;
  }
  if (count < kLeastStandingS * kept->rate_hz) {
    return InvalidData(forces_origin + ": has less than a second in common with " + origin);
  }
  load_n /= count;
  const double weight_n = settings.mass_kg * kStandardGravityMps2;
  if (most_n - least_n > 2 * kWeightBand * load_n || (most - least).norm() > 2 * kSwayM) {
    return InvalidData(origin + ": this person moves: give a trial of standing still");
  }
  if (std::abs(load_n - weight_n) > kStandingMassOff * weight_n) {
    return InvalidData(forces_origin + ": the plates carry " +
                       std::to_string(std::lround(NewtonsToKilograms(load_n))) +
                       " kg of a person of " + std::to_string(std::lround(settings.mass_kg)) +
                       ": both feet must be on them, and --mass-kg the person's");
  }
  const Eigen::Vector2d offset = sum / count;
  if (!(offset.norm() < kMostOffsetM)) {
    return InvalidData(forces_origin + ": its centre of pressure is " +
                       std::to_string(std::lround(100 * offset.norm())) +
                       " cm from under the body of " + origin +
                       ": forces and motion must be of one trial, in one frame");
  }
  return offset;
}

namespace {

/// Errors of a Wiimote in a fist, or strapped.
sensors::HeldErrorConfig ErrorsOf(arms::Place place, const Settings& settings) {
  sensors::HeldErrorConfig config;
  if (settings.perfect_devices) config = sensors::HeldErrors::None();
  config.rolled = !settings.perfect_devices && place != arms::Place::kFist;
  return config;
}

sensors::HeldCourse CourseOf(const sensors::Scene& scene, std::size_t arm, arms::Place place) {
  const int side = static_cast<int>(arm);
  if (place == arms::Place::kFist) return sensors::FollowFist(scene.body, scene.motion, side);
  return sensors::FollowSegment(scene.body, scene.motion, side,
                                place == arms::Place::kUpperArm ? sensors::ArmSegment::kUpperArm
                                                                : sensors::ArmSegment::kForearm);
}

}  // namespace

HeldHands::HeldHands(const sensors::Scene& scene, const Places& places, const Settings& settings)
    : step_s_(1 / scene.motion.rate_hz) {
  for (std::size_t place = 0; place < arms::kPlaces; ++place) {
    for (std::size_t arm = 0; places[place] && arm < arms::kArms; ++arm) {
      const auto where = static_cast<arms::Place>(place);
      sensors::HeldErrorConfig config = ErrorsOf(where, settings);
      config.seed = 2 * settings.seed + arm + 7919 * place;
      devices_.push_back({arm, place, CourseOf(scene, arm, where), sensors::HeldErrors(config)});
    }
  }
}

ArmReadings HeldHands::Until(Eigen::Index column) {
  ArmReadings readings;
  for (; next_ <= column; ++next_) {
    for (Device& device : devices_) {
      const auto reading =
          device.errors.Advance(device.course.specific_force_S_mps2.col(next_),
                                device.course.angular_velocity_S_radps.col(next_), step_s_);
      readings[device.arm][device.place].push_back(
          {reading.specific_force_S_mps2, reading.angular_velocity_S_radps, reading.clipped});
    }
  }
  return readings;
}

void Feed(const ArmReadings& readings, double reading_s, arms::ArmTracker& tracker) {
  for (std::size_t arm = 0; arm < arms::kArms; ++arm) {
    for (std::size_t place = 0; place < arms::kPlaces; ++place) {
      for (const arms::HandReading& reading : readings[arm][place]) {
        tracker.Add(arm, reading, reading_s, static_cast<arms::Place>(place));
      }
    }
  }
}

void EstimateArms(arms::ArmTracker tracker, PoseRun& run) {
  const auto aligned = static_cast<std::size_t>(kAlignedS * run.rate_hz);
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    Frame& frame = run.frames[i];
    Feed(frame.readings, run.reading_s, tracker);
    if (i == aligned) tracker.Align();
    frame.inputs.arms = tracker.Advance(1 / run.rate_hz);
  }
}

Result<ArmRun> RunArms(const motion::Motion& clip, const Settings& settings,
                       const std::string& origin, const Places& places) {
  const auto scene = Stage(clip, settings, origin);
  if (!scene) return scene.error();
  ArmRun run;
  run.body = scene->body;
  run.rate_hz = settings.rate_hz;
  run.aligned = static_cast<std::size_t>(kAlignedS * settings.rate_hz);
  HeldHands hands(*scene, places, settings);
  run.reading_s = hands.step_s();
  const std::size_t count = FrameCount(*scene, settings.rate_hz);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index column = ColumnAt(*scene, static_cast<double>(i) / settings.rate_hz);
    run.frames.push_back({hands.Until(column), scene->motion.q.col(column)});
  }
  return run;
}

namespace {

constexpr double kBentRad = 35 * kPi / 180;
constexpr double kCrouchedShare = 0.9;  // In parts of the T-pose's height of the COM.
constexpr double kArmMps = 0.5;
constexpr double kWalkingMps = 0.1;
constexpr double kSpanS = 0.1;
constexpr std::size_t kMostName = 60;
constexpr std::string_view kHead = "begin_s,end_s,activity";

enum Rule { kAirborne, kOneFoot, kBent, kCrouched, kArms, kMoving, kStill };
const std::vector<std::string> kRules{"airborne", "one_foot", "bent", "crouched",
                                      "arms",     "moving",   "still"};

/// Measures of a pose that the rules look at.
struct Shape {
  Eigen::Vector3d trunk, com_m;
  std::array<Eigen::Vector3d, 2> wrists;  ///< From the chest.
};

Shape ShapeOf(const body::Body& body, const Frame& frame, body::Kinematics& at) {
  body::ComputeKinematics(body.skeleton, frame.q, at);
  const auto place = [&](Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(body.landmarks[landmark])];
  };
  const Eigen::Vector3d neck = place(Landmark::kNeck);
  const Eigen::Vector3d chest =
      body.landmarks[Landmark::kChest] >= 0 ? place(Landmark::kChest) : neck;
  const Eigen::Vector3d hips = 0.5 * (place(Landmark::kLeftHip) + place(Landmark::kRightHip));
  return {neck - hips,
          frame.com_m,
          {place(Landmark::kLeftWrist) - chest, place(Landmark::kRightWrist) - chest}};
}

Rule RuleOf(const PoseRun& run, const std::vector<Shape>& shapes, std::size_t i, std::size_t half) {
  const auto& feet = run.frames[i].feet;
  const int carrying = (feet[0].load_n > kLoadedN ? 1 : 0) + (feet[1].load_n > kLoadedN ? 1 : 0);
  if (carrying == 0) return kAirborne;
  if (carrying == 1) return kOneFoot;
  const Shape& now = shapes[i];
  if (std::atan2(now.trunk.head<2>().norm(), now.trunk.z()) > kBentRad) return kBent;
  if (now.com_m.z() < kCrouchedShare * shapes.front().com_m.z()) return kCrouched;
  const std::size_t low = i >= half ? i - half : 0, high = std::min(i + half, shapes.size() - 1);
  const double span_s = static_cast<double>(high - low) / run.rate_hz;
  const auto speed = [&](const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
    return span_s > 0 ? (after - before).norm() / span_s : 0;
  };
  for (std::size_t side = 0; side < 2; ++side) {
    if (speed(shapes[low].wrists[side], shapes[high].wrists[side]) > kArmMps) return kArms;
  }
  return speed(shapes[low].com_m, shapes[high].com_m) > kWalkingMps ? kMoving : kStill;
}

Result<ActivitySpan> ParseSpan(text::Lines& lines, std::string_view line) {
  const auto fields = text::Fields(line, ',');
  if (fields.size() != 3) return lines.Fault("expected three fields: " + std::string(kHead));
  const auto begin = text::ToNumber(fields[0]), end = text::ToNumber(fields[1]);
  if (!begin || !end || !(*begin < *end)) {
    return lines.Fault("expected two times in s, the first one earlier, found " +
                       text::Quoted(fields[0]) + " and " + text::Quoted(fields[1]));
  }
  if (fields[2].empty() || fields[2].size() > kMostName) {
    return lines.Fault("expected the name of an activity, of 1 to 60 bytes");
  }
  return ActivitySpan{*begin, *end, std::string(fields[2])};
}

}  // namespace

Result<std::vector<ActivitySpan>> ParseActivities(std::string_view text, const std::string& file) {
  text::Lines lines(text, file);
  if (text::Trim(lines.NextFull().value_or("")) != kHead) {
    return lines.Fault("expected the line '" + std::string(kHead) + "'");
  }
  std::vector<ActivitySpan> spans;
  for (auto line = lines.NextFull(); line; line = lines.NextFull()) {
    auto span = ParseSpan(lines, *line);
    if (!span) return span.error();
    const auto overlaps = [&span](const ActivitySpan& other) {
      return span->begin_s < other.end_s && other.begin_s < span->end_s;
    };
    if (std::any_of(spans.begin(), spans.end(), overlaps)) {
      return lines.Fault("its times overlap those of a line before");
    }
    spans.push_back(*std::move(span));
  }
  if (spans.empty()) return lines.Fault("no activity in the file");
  return spans;
}

Activities LabelledActivities(const PoseRun& run, const std::vector<ActivitySpan>& spans) {
  Activities activities;
  for (const ActivitySpan& span : spans) {
    auto& names = activities.names;
    if (std::find(names.begin(), names.end(), span.activity) == names.end()) {
      names.push_back(span.activity);
    }
  }
  for (const Frame& frame : run.frames) {
    const double time_s = frame.inputs.loads.time_s + run.clock_offset_s;
    const auto span = std::find_if(spans.begin(), spans.end(), [time_s](const ActivitySpan& one) {
      return time_s >= one.begin_s && time_s < one.end_s;
    });
    const auto name = span == spans.end() ? activities.names.end()
                                          : std::find(activities.names.begin(),
                                                      activities.names.end(), span->activity);
    activities.of_frame.push_back(
        name == activities.names.end() ? -1 : static_cast<int>(name - activities.names.begin()));
  }
  return activities;
}

Activities RuledActivities(const PoseRun& run) {
  body::Kinematics at(run.body.skeleton);
  std::vector<Shape> shapes;
  for (const Frame& frame : run.frames) {
    shapes.push_back(ShapeOf(run.body, frame, at));
  }
  const auto half = static_cast<std::size_t>(std::max(1L, std::lround(0.5 * kSpanS * run.rate_hz)));
  Activities activities{kRules, {}};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    activities.of_frame.push_back(RuleOf(run, shapes, i, half));
  }
  return activities;
}

}  // namespace footing::pose_run
