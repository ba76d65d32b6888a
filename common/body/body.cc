#include "common/body/body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/rotation.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/body/skeleton.h"

namespace footing::body {
namespace {

struct Row {
  std::string_view name;
  double length_mm, mass_percent, centre_percent, sagittal_percent, transverse_percent,
      longitudinal_percent;
};

using Table = std::array<Row, kSegmentCount>;

// de Leva 1996, Table 4. Upper trunk: CERV-XIPH; head: VERT-CERV; shank: KJC-AJC; hand: WJC-MET3.
constexpr double kFemaleStatureMm = 1735, kFemaleTrunkMm = 497.9;  // MIDS-MIDH.
constexpr Table kFemale{{
    // name            length mass   centre sagittal transverse longitudinal
    // -               mm     %      %      %        %          %
    {"head", 243.7, 6.68, 48.41, 27.1, 29.5, 26.1},
    {"upper trunk", 228.0, 15.45, 50.50, 46.6, 31.4, 44.9},
    {"middle trunk", 205.3, 14.65, 45.12, 43.3, 35.4, 41.5},
    {"lower trunk", 181.5, 12.47, 49.20, 43.3, 40.2, 44.4},
    {"upper arm", 275.1, 2.55, 57.54, 27.8, 26.0, 14.8},
    {"forearm", 264.3, 1.38, 45.59, 26.1, 25.7, 9.4},
    {"hand", 78.0, 0.56, 74.74, 53.1, 45.4, 33.5},
    {"thigh", 368.5, 14.78, 36.12, 36.9, 36.4, 16.2},
    {"shank", 438.6, 4.81, 43.52, 26.7, 26.3, 9.2},
    {"foot", 228.3, 1.29, 40.14, 29.9, 27.9, 13.9},
}};
constexpr double kMaleStatureMm = 1741, kMaleTrunkMm = 515.5;
constexpr Table kMale{{
    {"head", 242.9, 6.94, 50.02, 30.3, 31.5, 26.1},
    {"upper trunk", 242.1, 15.96, 50.66, 50.5, 32.0, 46.5},
    {"middle trunk", 215.5, 16.33, 45.02, 48.2, 38.3, 46.8},
    {"lower trunk", 145.7, 11.17, 61.15, 61.5, 55.1, 58.7},
    {"upper arm", 281.7, 2.71, 57.72, 28.5, 26.9, 15.8},
    {"forearm", 268.9, 1.62, 45.74, 27.6, 26.5, 12.1},
    {"hand", 86.2, 0.61, 79.00, 62.8, 51.3, 40.1},
    {"thigh", 422.2, 14.16, 40.95, 32.9, 32.9, 14.9},
    {"shank", 440.3, 4.33, 43.95, 25.1, 24.6, 10.2},
    {"foot", 258.1, 1.37, 44.15, 25.7, 24.5, 12.4},
}};

constexpr const Row& At(const Table& table, Segment segment) {
  return table[static_cast<std::size_t>(segment)];
}

/// Masses of the table sum to 99.99 or 100.01: they are made to sum to one.
double MassSum(const Table& table) {
  double sum = 0;
  for (int i = 0; i < kSegmentCount; ++i) {
    const bool paired = static_cast<Segment>(i) >= Segment::kUpperArm;
    sum += (paired ? 2 : 1) * table[static_cast<std::size_t>(i)].mass_percent;
  }
  return sum;
}

SegmentParameters FromRow(const Table& table, double stature_mm, Segment segment) {
  const Row& row = At(table, segment);
  return {row.name,
          row.length_mm / stature_mm,
          row.mass_percent / MassSum(table),
          row.centre_percent / 100,
          row.sagittal_percent / 100,
          row.transverse_percent / 100,
          row.longitudinal_percent / 100};
}

double Mean(double a, double b) { return (a + b) / 2; }

/// Mid-hip to cervicale: the three parts of the trunk.
double CervicaleMm(const Table& table) {
  return At(table, Segment::kUpperTrunk).length_mm + At(table, Segment::kMiddleTrunk).length_mm +
         At(table, Segment::kLowerTrunk).length_mm;
}

double TrunkCentreMm(const Table& table, Segment part) {
  double top_mm = CervicaleMm(table);  // Upper end of the part, over mid-hip.
  for (Segment above : {Segment::kUpperTrunk, Segment::kMiddleTrunk}) {
    if (part == above) break;
    top_mm -= At(table, above).length_mm;
  }
  const Row& row = At(table, part);
  return top_mm - row.centre_percent / 100 * row.length_mm;
}

double LegMm(const Table& table) {
  return At(table, Segment::kThigh).length_mm + At(table, Segment::kShank).length_mm;
}

double OfSex(Sex sex, double female, double male) {
  if (sex == Sex::kFemale) return female;
  return sex == Sex::kMale ? male : Mean(female, male);
}

}  // namespace

SegmentParameters Parameters(Segment segment, Sex sex) {
  const SegmentParameters female = FromRow(kFemale, kFemaleStatureMm, segment);
  const SegmentParameters male = FromRow(kMale, kMaleStatureMm, segment);
  if (sex == Sex::kFemale) return female;
  if (sex == Sex::kMale) return male;
  return {male.name,
          Mean(female.length_of_stature, male.length_of_stature),
          Mean(female.mass_of_body, male.mass_of_body),
          Mean(female.centre_of_length, male.centre_of_length),
          Mean(female.sagittal_radius, male.sagittal_radius),
          Mean(female.transverse_radius, male.transverse_radius),
          Mean(female.longitudinal_radius, male.longitudinal_radius)};
}

double TrunkCentre(Segment trunk_part, Sex sex) {
  return OfSex(sex, TrunkCentreMm(kFemale, trunk_part) / kFemaleTrunkMm,
               TrunkCentreMm(kMale, trunk_part) / kMaleTrunkMm);
}

double CervicaleOnTrunk(Sex sex) {
  return OfSex(sex, CervicaleMm(kFemale) / kFemaleTrunkMm, CervicaleMm(kMale) / kMaleTrunkMm);
}

double StatureOfLengths(Sex sex) {
  return OfSex(sex, kFemaleStatureMm / (LegMm(kFemale) + kFemaleTrunkMm),
               kMaleStatureMm / (LegMm(kMale) + kMaleTrunkMm));
}

double TrunkOfStature(Sex sex) {
  return OfSex(sex, kFemaleTrunkMm / kFemaleStatureMm, kMaleTrunkMm / kMaleStatureMm);
}

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

namespace {

/// One rotation about an axis of the joint (as in the file frame, y up), with its limits.
struct Turn {
  Axis axis;
  double lower_deg, upper_deg;
};

/// One bone as the CMU skeletons have it: it turns at its near end, about axes that are themselves
/// turned by Rz Ry Rx (`axes_deg`) from those of the file.
struct Bone {
  std::string name, parent;
  Eigen::Vector3d along;  ///< From its near to its far end, over the standing height; y up.
  Eigen::Vector3d axes_deg;
  std::vector<Turn> turns;  ///< In the order of the file: x, y, z.
};

constexpr Axis kX = Axis::kX, kY = Axis::kY, kZ = Axis::kZ;

// Places of joints over the standing height where the table of segments has none: read off the
// proportions of the CMU skeletons, which agree with each other to some 0.005.
constexpr double kRootOverHips = 0.058, kRootBehindHips = 0.020, kHalfHips = 0.047;
constexpr double kBackBone = 0.0665, kNeckBone = 0.057;
constexpr double kHalfShoulders = 0.105;
constexpr double kAnkleHeight = 0.040, kBallHeight = 0.015, kAnkleToBall = 0.075, kToes = 0.038;
constexpr double kSplayDeg = 20;  ///< Splay of the legs at rest.

std::vector<Bone> Bones(Sex sex) {
  const auto length = [sex](Segment segment) { return Parameters(segment, sex).length_of_stature; };
  const double head = 1 - (kAnkleHeight + length(Segment::kShank) + length(Segment::kThigh) +
                           kRootOverHips + 3 * kBackBone + 2 * kNeckBone);
  const double clavicle_up = TrunkOfStature(sex) - kRootOverHips - 3 * kBackBone;
  const std::vector<Turn> back = {{kX, -20, 45}, {kY, -30, 30}, {kZ, -30, 30}};
  std::vector<Bone> bones;
  const auto mirrored = [](std::vector<Turn> turns, double side) {
    for (Turn& turn : turns) {  // A mirror at the sagittal plane keeps the angles about x.
      if (side < 0 && turn.axis != kX) turn = {turn.axis, -turn.upper_deg, -turn.lower_deg};
    }
    return turns;
  };
  for (const double side : {1.0, -1.0}) {
    const std::string l = side > 0 ? "l" : "r";
    const double splay = DegreesToRadians(kSplayDeg);
    const Eigen::Vector3d down(side * std::sin(splay), -std::cos(splay), 0);
    const Eigen::Vector3d leg(0, 0, side * kSplayDeg), foot(-90, 0, side * kSplayDeg);
    bones.push_back({l + "hipjoint",
                     "root",
                     {side * kHalfHips, -kRootOverHips, kRootBehindHips},
                     {0, 0, 0},
                     {}});
    bones.push_back({l + "femur", l + "hipjoint", length(Segment::kThigh) * down, leg,
                     mirrored({{kX, -160, 20}, {kY, -70, 70}, {kZ, -60, 70}}, side)});
    bones.push_back(
        {l + "tibia", l + "femur", length(Segment::kShank) * down, leg, {{kX, -10, 170}}});
    bones.push_back({l + "foot", l + "tibia",
                     Eigen::Vector3d(0, 0, kAnkleToBall) + (kAnkleHeight - kBallHeight) * down,
                     foot, mirrored({{kX, -45, 90}, {kZ, -70, 20}}, side)});
    bones.push_back({l + "toes", l + "foot", {0, 0, kToes}, foot, {{kX, -90, 20}}});
  }
  bones.push_back({"lowerback", "root", {0, kBackBone, 0}, {0, 0, 0}, back});
  bones.push_back({"upperback", "lowerback", {0, kBackBone, 0}, {0, 0, 0}, back});
  bones.push_back({"thorax", "upperback", {0, kBackBone, 0}, {0, 0, 0}, back});
  bones.push_back({"lowerneck", "thorax", {0, kNeckBone, 0}, {0, 0, 0}, back});
  bones.push_back({"upperneck", "lowerneck", {0, kNeckBone, 0}, {0, 0, 0}, back});
  bones.push_back({"head", "upperneck", {0, head, 0}, {0, 0, 0}, back});
  for (const double side : {1.0, -1.0}) {
    const std::string l = side > 0 ? "l" : "r";
    const Eigen::Vector3d out(side, 0, 0);
    const Eigen::Vector3d arm(180, -30 * side, -90 * side), hand(0, 90 * side, 90 * side);
    bones.push_back({l + "clavicle",
                     "thorax",
                     {side * kHalfShoulders, clavicle_up, 0},
                     {0, 0, 0},
                     mirrored({{kY, -20, 10}, {kZ, 0, 20}}, side)});
    // The mirror of these axes turns the sense of x.
    const Turn lift = side > 0 ? Turn{kX, -60, 90} : Turn{kX, -90, 60};
    bones.push_back({l + "humerus",
                     l + "clavicle",
                     length(Segment::kUpperArm) * out,
                     arm,
                     {lift, {kY, -90, 90}, {kZ, -90, 90}}});
    bones.push_back({l + "radius",
                     l + "humerus",
                     length(Segment::kForearm) * 2 / 3 * out,
                     arm,
                     {{kX, -10, 170}}});
    bones.push_back(
        {l + "wrist", l + "radius", length(Segment::kForearm) / 3 * out, hand, {{kY, -180, 0}}});
    bones.push_back({l + "hand",
                     l + "wrist",
                     length(Segment::kHand) * out,
                     hand,
                     {{kX, -90, 90}, {kZ, -45, 45}}});
  }
  return bones;
}

}  // namespace

Skeleton StandardPerson(double height_m, Sex sex) {
  const std::vector<Bone> bones = Bones(sex);
  std::vector<Joint> joints(1);
  joints[0].name = "root";
  // Heading first: locked only when the pelvis lies on its side.
  joints[0].rotations = {{Axis::kZ, -kUnlimited, kUnlimited},
                         {Axis::kX, -kUnlimited, kUnlimited},
                         {Axis::kY, -kUnlimited, kUnlimited}};
  const auto index = [&joints](const std::string& name) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i].name == name) return static_cast<int>(i);
    }
    return -1;
  };
  const auto far_end = [&](const std::string& name) -> Eigen::Vector3d {
    for (const Bone& bone : bones) {
      if (bone.name == name) return height_m * FromYUp(bone.along);
    }
    return Eigen::Vector3d::Zero();  // The root is a point.
  };
  for (const Bone& bone : bones) {
    Joint joint;
    joint.name = bone.name;
    joint.parent = index(bone.parent);
    joint.offset_m = far_end(bone.parent);
    if (!bone.axes_deg.isZero()) joint.axes = FromYUpXyz(bone.axes_deg * (kPi / 180));
    for (auto turn = bone.turns.rbegin(); turn != bone.turns.rend(); ++turn) {
      joint.rotations.push_back({FromYUp(turn->axis), DegreesToRadians(turn->lower_deg),
                                 DegreesToRadians(turn->upper_deg)});
    }
    joints.push_back(std::move(joint));
    const bool last = std::none_of(bones.begin(), bones.end(),
                                   [&](const Bone& other) { return other.parent == bone.name; });
    if (!last) continue;
    Joint end;
    end.name = bone.name + "_end";
    end.parent = static_cast<int>(joints.size()) - 1;
    end.offset_m = height_m * FromYUp(bone.along);
    joints.push_back(std::move(end));
  }
  return MakeSkeleton(std::move(joints));
}

Eigen::VectorXd TPose(const Skeleton& skeleton, const Landmarks& landmarks) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(skeleton.dof);
  Kinematics at(skeleton);
  const auto place = [&](Landmark l) { return at.p_WJ[static_cast<std::size_t>(landmarks[l])]; };
  // Turns a joint so that the line to the next one points along `to_W`.
  const auto point = [&](Landmark from, Landmark next, const Eigen::Vector3d& to_W) {
    ComputeKinematics(skeleton, q, at);
    const int index = landmarks[from];
    const Joint& joint = skeleton.joint(index);
    const Eigen::Quaterniond turn = LeastTurn(place(next) - place(from), to_W);
    const Eigen::Matrix3d& R_WP = at.R_WJ[static_cast<std::size_t>(joint.parent)];
    SetJointRotation(
        joint,
        R_WP.transpose() * turn.toRotationMatrix() * at.R_WJ[static_cast<std::size_t>(index)], q);
  };
  const Eigen::Vector3d left = Eigen::Vector3d::UnitY(), down = -Eigen::Vector3d::UnitZ();
  point(Landmark::kLeftHip, Landmark::kLeftKnee, down);
  point(Landmark::kRightHip, Landmark::kRightKnee, down);
  point(Landmark::kLeftShoulder, Landmark::kLeftElbow, left);
  point(Landmark::kRightShoulder, Landmark::kRightElbow, -left);
  ComputeKinematics(skeleton, q, at);
  double lowest_m = 0;
  for (const Eigen::Vector3d& p_W : at.p_WJ) lowest_m = std::min(lowest_m, p_W.z());
  q(2) = -lowest_m;
  return q;
}

}  // namespace footing::body
