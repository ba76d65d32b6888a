#include "tests/clients/view/made_person.h"

#include <cmath>

#include "clients/view/scene/stage.h"
#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "tests/clients/view/made_stream.h"

namespace footing::scene::made {
namespace {

constexpr double kHeightM = 1.75;
constexpr double kMassKg = 71;
constexpr std::uint32_t kLeftDevice = 1, kRightDevice = 2;

const body::Body& Person() {
  static const body::Body kPerson = [] {
    body::PersonParameters parameters;
    parameters.mass_kg = kMassKg;
    parameters.height_m = kHeightM;
    return body::MakeBody(body::StandardPerson(kHeightM), parameters).value();
  }();
  return kPerson;
}

/// Turns a joint in W, after all before it.
void Turn(body::Landmark landmark, body::Axis axis, double angle_rad, Eigen::VectorXd& q) {
  const body::Skeleton& skeleton = Person().skeleton;
  body::Kinematics at(skeleton);
  body::ComputeKinematics(skeleton, q, at);
  const int index = Person().landmarks[landmark];
  const body::Joint& joint = skeleton.joint(index);
  body::SetJointRotation(joint,
                         at.R_WJ[static_cast<std::size_t>(joint.parent)].transpose() *
                             body::AxisRotation(axis, angle_rad) *
                             at.R_WJ[static_cast<std::size_t>(index)],
                         q);
}

Eigen::VectorXd PoseAt(double time_s, const PersonWish& wish) {
  using body::Landmark;
  Eigen::VectorXd q = body::TPose(Person().skeleton, Person().landmarks);
  Turn(Landmark::kLeftHip, body::Axis::kX, 0.09, q);  // Feet apart, one on each board.
  Turn(Landmark::kRightHip, body::Axis::kX, -0.09, q);
  Turn(Landmark::kLeftAnkle, body::Axis::kX, -0.09, q);
  Turn(Landmark::kRightAnkle, body::Axis::kX, 0.09, q);
  if (!wish.calibrated) return q;
  const double bend = 0.30 * (1 - std::cos(2 * time_s));
  for (const Landmark hip : {Landmark::kLeftHip, Landmark::kRightHip}) {
    Turn(hip, body::Axis::kY, -bend, q);
  }
  for (const Landmark knee : {Landmark::kLeftKnee, Landmark::kRightKnee}) {
    Turn(knee, body::Axis::kY, 2 * bend, q);
  }
  for (const Landmark ankle : {Landmark::kLeftAnkle, Landmark::kRightAnkle}) {
    Turn(ankle, body::Axis::kY, -bend, q);
  }
  const double swing = 0.5 * std::sin(2 * time_s);
  Turn(Landmark::kLeftShoulder, body::Axis::kX, -1.1 + swing, q);
  Turn(Landmark::kRightShoulder, body::Axis::kX, 0.8 + swing, q);
  Turn(Landmark::kLeftElbow, body::Axis::kZ, -0.7, q);
  Turn(Landmark::kRightElbow, body::Axis::kZ, 0.9, q);
  if (wish.left_foot_off) {
    Turn(Landmark::kLeftHip, body::Axis::kY, -0.7, q);
    Turn(Landmark::kLeftKnee, body::Axis::kY, 0.9, q);
  }
  return q;
}

/// With the right ankle where it was in the T-pose.
body::Kinematics KinematicsAt(double time_s, const PersonWish& wish) {
  body::Kinematics at(Person().skeleton);
  Eigen::VectorXd q = PoseAt(time_s, wish);
  body::ComputeKinematics(Person().skeleton, q, at);
  const auto ankle = static_cast<std::size_t>(Person().landmarks[body::Landmark::kRightAnkle]);
  const double height_m = 0.040 * kHeightM;
  q.head<3>() += Eigen::Vector3d(-0.02, -0.165, height_m) - at.p_WJ[ankle];
  body::ComputeKinematics(Person().skeleton, q, at);
  return at;
}

BodyFoot FootAt(std::size_t side, double time_s, const PersonWish& wish,
                const body::Kinematics& at) {
  const auto ankle = static_cast<std::size_t>(
      Person().landmarks[side == 0 ? body::Landmark::kLeftAnkle : body::Landmark::kRightAnkle]);
  const double share = 0.5 + (side == 0 ? 0.15 : -0.15) * std::sin(2 * time_s);
  BodyFoot foot;
  foot.valid = true;
  foot.contact = !(side == 0 && wish.left_foot_off);
  foot.position_m = {at.p_WJ[ankle].x() + 0.05, at.p_WJ[ankle].y(), 0};
  const double sd_m = foot.contact ? 0.012 : 0.16;
  foot.variance_m2.setConstant(sd_m * sd_m);
  foot.airborne_s = foot.contact ? 0 : 1.4;
  foot.load_n = !foot.contact ? 0 : wish.left_foot_off ? 696 : 696 * share;
  foot.cop_valid = foot.contact;
  foot.cop_m = foot.position_m + Eigen::Vector3d(0.03 * std::sin(3 * time_s), 0, 0);
  return foot;
}

BodyState StateAt(double time_s, const PersonWish& wish, const body::Kinematics& at) {
  BodyState body;
  body.subject = "p07";
  body.mode = "best";
  body.calibrated = wish.calibrated;
  body.calibration_progress = wish.calibrated ? 1 : wish.calibration_progress;
  body.mass_kg = kMassKg;
  body.height_m = kHeightM;
  body.lag_s = wish.lag_s;
  body.momentum_valid = wish.calibrated;
  body.com_variance_m2.setConstant(0.01 * 0.01);
  body.angular_momentum_kgm2ps = {1.5 * std::cos(2 * time_s), 4 * std::sin(2 * time_s), 1};
  for (std::size_t side = 0; side < 2; ++side) body.feet[side] = FootAt(side, time_s, wish, at);
  body.link_sd_m.assign(at.p_WJ.size(), 0.03);
  body.solve_us = 640;
  body.hands_seen = {true, true};
  if (!wish.calibrated) body.note = "T-pose: hold still, 2.0 s more";
  if (wish.left_foot_off) {
    body.note = "the left foot is off its board for 1.4 s: its place is a guess";
  }
  return body;
}

CharacterPose CharacterAt(double time_s, const PersonWish& wish) {
  const body::Kinematics at = KinematicsAt(time_s, wish);
  CharacterPose pose;
  pose.character = 1;
  pose.rig = "one";
  pose.valid = wish.calibrated && wish.valid;
  pose.simulated_input = true;
  for (std::size_t i = 0; i < at.p_WJ.size(); ++i) {
    pose.links.push_back({at.p_WJ[i], Eigen::Quaterniond(at.R_WJ[i])});
  }
  pose.com_m = body::CentreOfMass(Person(), at);
  pose.com_velocity_mps = {0.02, 0.05 * std::cos(2 * time_s), 0.35 * std::sin(2 * time_s)};
  pose.body = StateAt(time_s, wish, at);
  for (const BodyFoot& foot : pose.body->feet) {
    pose.contacts.push_back({foot.contact, foot.cop_m, foot.load_n});
  }
  return pose;
}

void AddSnapshot(Update& update) {
  update.skeletons = {PersonSkeleton()};
  update.devices.emplace(2);
  for (std::size_t i = 0; i < 2; ++i) {
    stream::DeviceStatus& device = (*update.devices)[i];
    device.device = i == 0 ? kLeftDevice : kRightDevice;
    device.serial = i == 0 ? "stand-in-left" : "stand-in-right";
    device.kind = stream::DeviceKind::kBalanceBoard;
    device.state = stream::DeviceState::kLive;
    device.rig = "one";
    device.role = i == 0 ? stream::DeviceRole::kLeftBoard : stream::DeviceRole::kRightBoard;
    device.simulated = true;
    device.report_rate_hz = 100;
    device.battery_fraction = 0.8;
  }
}

/// The cells that make the foot's load and COP on its board.
stream::BoardSample SampleOf(const BodyFoot& foot, const stream::BoardPose& pose,
                             std::uint32_t device) {
  const PlacedBoard board{pose, true, {}};
  const Eigen::Vector2d middle = board.InWorld(0, 0);
  const Eigen::Vector2d right = board.InWorld(1, 0) - middle, front = board.InWorld(0, 1) - middle;
  const Eigen::Vector2d cop = foot.cop_m.head<2>() - middle;
  stream::BoardSample sample;
  sample.device = device;
  sample.simulated = true;
  sample.total_n = foot.load_n;
  sample.cop_valid = foot.cop_valid;
  sample.cop_x_m = cop.dot(right);
  sample.cop_y_m = cop.dot(front);
  const double x = sample.cop_x_m / (board.geometry.sensor_distance_x_m / 2),
               y = sample.cop_y_m / (board.geometry.sensor_distance_y_m / 2);
  sample.top_left_n = foot.load_n / 4 * (1 - x) * (1 + y);
  sample.top_right_n = foot.load_n / 4 * (1 + x) * (1 + y);
  sample.bottom_left_n = foot.load_n / 4 * (1 - x) * (1 - y);
  sample.bottom_right_n = foot.load_n / 4 * (1 + x) * (1 - y);
  return sample;
}

}  // namespace

stream::Skeleton PersonSkeleton() {
  stream::Skeleton skeleton;
  skeleton.character = 1;
  skeleton.name = "person";
  for (const body::Joint& joint : Person().skeleton.joints) {
    skeleton.links.push_back({joint.name, joint.parent, Eigen::Vector3d::Constant(0.05)});
  }
  skeleton.contact_points = {"left_foot", "right_foot"};
  return skeleton;
}

PersonPose Bent(const std::vector<Bend>& bends) {
  Eigen::VectorXd q = body::TPose(Person().skeleton, Person().landmarks);
  for (const Bend& bend : bends) Turn(bend.landmark, bend.axis, bend.angle_rad, q);
  body::Kinematics at(Person().skeleton);
  body::ComputeKinematics(Person().skeleton, q, at);
  PersonPose pose;
  pose.p_m = at.p_WJ;
  for (const Eigen::Matrix3d& R : at.R_WJ) pose.orientations.emplace_back(R);
  return pose;
}

Update PersonTickAt(double time_s, const PersonWish& wish) {
  Update update;
  update.received_ns = ClockAt(time_s);
  update.host_ns = update.received_ns - 1'000'000;
  if (time_s == 0) AddSnapshot(update);
  WorldFrame frame;
  frame.time_s = time_s;
  frame.step = static_cast<std::uint64_t>(120 * time_s);
  frame.characters.push_back(CharacterAt(time_s, wish));
  const BodyState& body = *frame.characters[0].body;
  const stream::BoardLayout layout = board::DefaultLayout();
  update.boards.push_back(SampleOf(body.feet[0], layout.left, kLeftDevice));
  update.boards.push_back(SampleOf(body.feet[1], layout.right, kRightDevice));
  if (wish.reference) {
    ReferencePose reference;
    reference.received_ns = update.received_ns;
    reference.sampled_ns = update.host_ns;
    for (const body::Joint& joint : Person().skeleton.joints) {
      reference.parents.push_back(joint.parent);
    }
    reference.positions_m = KinematicsAt(time_s, wish).p_WJ;
    update.reference = reference;
  }
  update.frame = std::move(frame);
  return update;
}

Model PersonModelAfter(double seconds, const PersonWish& wish) {
  Model model;
  model.links = {
      {"unix:/run/user/1000/footing/simulation.sock", "footing-sim", LinkState::kLive, ""},
      {"unix:/run/user/1000/footing/sensor.sock", "footingd", LinkState::kLive, ""}};
  const auto ticks = static_cast<int>(100 * seconds);
  for (int tick = 0; tick <= ticks; ++tick) Apply(model, PersonTickAt(0.01 * tick, wish));
  return model;
}

}  // namespace footing::scene::made
