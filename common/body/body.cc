#include "common/body/body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "common/body/kinematics.h"

namespace footing::body {
namespace {

constexpr double kLeastMassKg = 10, kMostMassKg = 400;
constexpr double kLeastHeightM = 0.5, kMostHeightM = 2.6;

// Ankle to the tip of the toes is about three quarters of heel to tip (the ankle stands a quarter
// before the heel), the ball at 0.73 of it. So the foot's centre (heel to tip, Segment::kFoot) is
// this far from the ankle to the tip, or to the ball where the skeleton ends there.
constexpr double kAnkleOfFoot = 0.25, kBallOfFoot = 0.73;

/// Everything below is worked out in one pose, in W, and put into the joints' frames at the end.
struct Builder {
  const Skeleton& skeleton;
  const Landmarks& landmarks;
  Sex sex;
  double mass_kg, height_m;
  Kinematics at;
  std::vector<JointMass> masses;

  Eigen::Vector3d Place(Landmark landmark) const {
    return at.p_WJ[static_cast<std::size_t>(landmarks[landmark])];
  }
  Eigen::Vector3d MidHip() const {
    return (Place(Landmark::kLeftHip) + Place(Landmark::kRightHip)) / 2;
  }

  Eigen::Vector3d MidShoulder() const {
    return (Place(Landmark::kLeftShoulder) + Place(Landmark::kRightShoulder)) / 2;
  }

  /// A segment with its centre at `centre_W`, long axis `long_W` and `lateral_W` across.
  void Add(int joint, Segment segment, double length_m, const Eigen::Vector3d& centre_W,
           const Eigen::Vector3d& long_W, const Eigen::Vector3d& lateral_W) {
    const SegmentParameters row = Parameters(segment, sex);
    const double mass = row.mass_of_body * mass_kg;
    Eigen::Matrix3d axes;  // Fore-aft, left-right, long.
    axes.col(2) = long_W.normalized();
    Eigen::Vector3d ahead = lateral_W.cross(axes.col(2));
    if (ahead.norm() < 1e-6) ahead = axes.col(2).unitOrthogonal();
    axes.col(0) = ahead.normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    const Eigen::Vector3d radii_m =
        length_m *
        Eigen::Vector3d(row.sagittal_radius, row.transverse_radius, row.longitudinal_radius);
    const Eigen::Vector3d moments = mass * radii_m.cwiseAbs2();
    Merge(joint, {mass, centre_W, axes * moments.asDiagonal() * axes.transpose()});
  }

  /// Adds a mass given in W (its centre a place in W) to what the joint carries already.
  void Merge(int joint, JointMass in_W) {
    const auto index = static_cast<std::size_t>(joint);
    const Eigen::Matrix3d R_JW = at.R_WJ[index].transpose();
    const JointMass added{in_W.mass_kg, R_JW * (in_W.com_J - at.p_WJ[index]),
                          R_JW * in_W.inertia_J * R_JW.transpose()};
    JointMass& here = masses[index];
    const double sum = here.mass_kg + added.mass_kg;
    const Eigen::Vector3d centre = (here.mass_kg * here.com_J + added.mass_kg * added.com_J) / sum;
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (const JointMass& part : {here, added}) {
      const Eigen::Vector3d d = part.com_J - centre;
      inertia += part.inertia_J +
                 part.mass_kg * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
    }
    here = {sum, centre, inertia};
  }

  /// The joint among the ancestors of `top`, down to `bottom`, that last comes before `along` (m)
  /// on the line from `from_W` in the direction `up_W`.
  int Carrier(int top, int bottom, const Eigen::Vector3d& from_W, const Eigen::Vector3d& up_W,
              double along_m) const {
    int joint = top;
    while (joint > 0 && joint != bottom) {
      const auto& p_W = at.p_WJ[static_cast<std::size_t>(joint)];
      if ((p_W - from_W).dot(up_W) <= along_m) return joint;
      joint = skeleton.joint(joint).parent;
    }
    return bottom;
  }

  void AddTrunk() {
    const Eigen::Vector3d bottom = MidHip(), line = MidShoulder() - bottom;
    const double length_m = line.norm();
    const Eigen::Vector3d up = line / length_m;
    const std::array<Segment, 3> parts = {Segment::kLowerTrunk, Segment::kMiddleTrunk,
                                          Segment::kUpperTrunk};
    // The neck's own joint carries no trunk: its parent is the last that can.
    const int top = skeleton.joint(landmarks[Landmark::kNeck]).parent;
    const Eigen::Vector3d hips = Place(Landmark::kLeftHip) - Place(Landmark::kRightHip);
    const Eigen::Vector3d shoulders =
        Place(Landmark::kLeftShoulder) - Place(Landmark::kRightShoulder);
    for (Segment part : parts) {
      const double along_m = TrunkCentre(part, sex) * length_m;
      const double part_m =
          length_m * Parameters(part, sex).length_of_stature / TrunkOfStature(sex);
      const int joint = part == Segment::kLowerTrunk
                            ? landmarks[Landmark::kHips]
                            : Carrier(top, landmarks[Landmark::kHips], bottom, up, along_m);
      Add(joint, part, part_m, bottom + along_m * up, up,
          part == Segment::kUpperTrunk ? shoulders : hips);
    }
  }

  void AddHead() {
    const SegmentParameters row = Parameters(Segment::kHead, sex);
    const double length_m = row.length_of_stature * height_m;
    const Eigen::Vector3d neck = Place(Landmark::kNeck);
    Eigen::Vector3d up = MidShoulder() - MidHip();
    const Eigen::Vector3d cervicale = MidHip() + CervicaleOnTrunk(sex) * up;
    int top = landmarks[Landmark::kNeck];
    for (Landmark above : {Landmark::kVertex, Landmark::kHead}) {
      if (landmarks[above] < 0 || (Place(above) - neck).norm() < 0.02) continue;
      up = Place(above) - neck;
      top = landmarks[above];
      break;
    }
    up.normalize();
    const double along_m = (1 - row.centre_of_length) * length_m;
    if (IsEnd(skeleton, top)) top = skeleton.joint(top).parent;
    const int joint = Carrier(top, landmarks[Landmark::kNeck], cervicale, up, along_m);
    Add(joint, Segment::kHead, length_m, cervicale + along_m * up, up,
        Place(Landmark::kLeftShoulder) - Place(Landmark::kRightShoulder));
  }

  void AddLimb(Segment segment, Landmark from, Landmark to) {
    const Eigen::Vector3d along = Place(to) - Place(from);
    Add(landmarks[from], segment, along.norm(),
        Place(from) + Parameters(segment, sex).centre_of_length * along, along,
        Eigen::Vector3d::UnitX());
  }

  void AddHand(Landmark elbow, Landmark wrist, Landmark end) {
    Eigen::Vector3d along = Place(wrist) - Place(elbow);
    if (landmarks[end] >= 0 && (Place(end) - Place(wrist)).norm() > 0.01) {
      along = Place(end) - Place(wrist);
    }
    along.normalize();
    const SegmentParameters row = Parameters(Segment::kHand, sex);
    const double length_m = row.length_of_stature * height_m;
    Add(landmarks[wrist], Segment::kHand, length_m,
        Place(wrist) + row.centre_of_length * length_m * along, along, Eigen::Vector3d::UnitX());
  }

  void AddFoot(Landmark knee, Landmark ankle, Landmark ball, Landmark tip) {
    const SegmentParameters row = Parameters(Segment::kFoot, sex);
    const double length_m = row.length_of_stature * height_m;
    const double centre = row.centre_of_length - kAnkleOfFoot;
    const auto there = [&](Landmark l) {
      return landmarks[l] >= 0 && (Place(l) - Place(ankle)).norm() > 0.02;
    };
    const Eigen::Vector3d lateral = Place(Landmark::kLeftHip) - Place(Landmark::kRightHip);
    Eigen::Vector3d along, place;
    if (there(tip)) {
      along = Place(tip) - Place(ankle);
      place = centre / (1 - kAnkleOfFoot) * along;
    } else if (there(ball)) {
      along = Place(ball) - Place(ankle);
      place = centre / (kBallOfFoot - kAnkleOfFoot) * along;
    } else {  // Square to shank and hips.
      along = lateral.cross(Place(knee) - Place(ankle));
      place = centre * length_m * along.normalized();
    }
    Add(landmarks[ankle], Segment::kFoot, length_m, Place(ankle) + place, along, lateral);
  }

  /// The limbs of one side: 0 left, 1 right.
  void AddSide(int side) {
    const auto of_side = [side](Landmark left) { return OfSide(left, side); };
    const Landmark shoulder = of_side(Landmark::kLeftShoulder);
    const Landmark elbow = of_side(Landmark::kLeftElbow), wrist = of_side(Landmark::kLeftWrist);
    const Landmark hip = of_side(Landmark::kLeftHip), knee = of_side(Landmark::kLeftKnee);
    const Landmark ankle = of_side(Landmark::kLeftAnkle);
    AddLimb(Segment::kUpperArm, shoulder, elbow);
    AddLimb(Segment::kForearm, elbow, wrist);
    AddHand(elbow, wrist, of_side(Landmark::kLeftHandEnd));
    AddLimb(Segment::kThigh, hip, knee);
    AddLimb(Segment::kShank, knee, ankle);
    AddFoot(knee, ankle, of_side(Landmark::kLeftToe), of_side(Landmark::kLeftToeEnd));
  }
};

Kinematics At(const Skeleton& skeleton, const PersonParameters& person) {
  Kinematics at(skeleton);
  ComputeKinematics(skeleton, person.upright_pose.value_or(Eigen::VectorXd::Zero(skeleton.dof)),
                    at);
  return at;
}

Result<void> CheckPerson(const Skeleton& skeleton, const PersonParameters& person) {
  if (!(person.mass_kg >= kLeastMassKg && person.mass_kg <= kMostMassKg)) {
    return InvalidData("a mass of " + std::to_string(person.mass_kg) +
                       " kg is out of range: give one from 10 to 400 kg");
  }
  if (person.upright_pose && person.upright_pose->size() != skeleton.dof) {
    return InvalidData("the upright pose has " + std::to_string(person.upright_pose->size()) +
                       " coordinates, the skeleton " + std::to_string(skeleton.dof));
  }
  return {};
}

/// Refuses a skeleton in which both ends of a bone, or of the trunk, are in one place.
Result<void> CheckBones(const Builder& builder) {
  const auto nowhere = [&](Landmark a, Landmark b) {
    return !((builder.Place(a) - builder.Place(b)).norm() > 0.01);
  };
  const std::array<std::pair<Landmark, Landmark>, 10> lines = {{
      {Landmark::kLeftHip, Landmark::kLeftKnee},
      {Landmark::kLeftKnee, Landmark::kLeftAnkle},
      {Landmark::kRightHip, Landmark::kRightKnee},
      {Landmark::kRightKnee, Landmark::kRightAnkle},
      {Landmark::kLeftShoulder, Landmark::kLeftElbow},
      {Landmark::kLeftElbow, Landmark::kLeftWrist},
      {Landmark::kRightShoulder, Landmark::kRightElbow},
      {Landmark::kRightElbow, Landmark::kRightWrist},
      {Landmark::kLeftHip, Landmark::kLeftShoulder},
      {Landmark::kLeftShoulder, Landmark::kRightShoulder},
  }};
  for (const auto& [from, to] : lines) {
    if (nowhere(from, to)) {
      return InvalidData("the skeleton's " + std::string(LandmarkName(from)) + " and " +
                         std::string(LandmarkName(to)) + " are in one place");
    }
  }
  return {};
}

}  // namespace

double EstimateHeight(const Skeleton& skeleton, const Landmarks& landmarks,
                      const PersonParameters& person) {
  const Builder builder{skeleton, landmarks, person.sex, 0, 0, At(skeleton, person), {}};
  const auto between = [&](Landmark a, Landmark b) {
    return (builder.Place(a) - builder.Place(b)).norm();
  };
  const double legs_m = between(Landmark::kLeftHip, Landmark::kLeftKnee) +
                        between(Landmark::kLeftKnee, Landmark::kLeftAnkle) +
                        between(Landmark::kRightHip, Landmark::kRightKnee) +
                        between(Landmark::kRightKnee, Landmark::kRightAnkle);
  const double trunk_m = (builder.MidShoulder() - builder.MidHip()).norm();
  return StatureOfLengths(person.sex) * (legs_m / 2 + trunk_m);
}

Result<Body> MakeBody(const Skeleton& skeleton, const PersonParameters& person) {
  const auto landmarks = FindLandmarks(skeleton);
  if (!landmarks) return landmarks.error();
  if (auto usable = CheckPerson(skeleton, person); !usable) return usable.error();
  const double height_m = person.height_m.value_or(EstimateHeight(skeleton, *landmarks, person));
  if (!(height_m >= kLeastHeightM && height_m <= kMostHeightM)) {
    return InvalidData("a height of " + std::to_string(height_m) +
                       " m is out of range (0.5 to 2.6 m): is the skeleton in other units?");
  }
  Builder builder{skeleton,
                  *landmarks,
                  person.sex,
                  person.mass_kg,
                  height_m,
                  At(skeleton, person),
                  std::vector<JointMass>(skeleton.joints.size())};
  if (auto apart = CheckBones(builder); !apart) return apart.error();
  builder.AddTrunk();
  builder.AddHead();
  for (int side = 0; side < 2; ++side) builder.AddSide(side);
  return Body{skeleton, *landmarks, std::move(builder.masses), person.mass_kg, height_m};
}

Body WithMass(Body body, double mass_kg) {
  FOOTING_CHECK(mass_kg > 0);
  const double scale = mass_kg / body.mass_kg;
  for (JointMass& mass : body.masses) {
    mass.mass_kg *= scale;
    mass.inertia_J *= scale;
  }
  body.mass_kg = mass_kg;
  return body;
}

}  // namespace footing::body
