#include "clients/view/scene/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace footing::scene {
namespace {

bool HasTree(const stream::Skeleton& skeleton) {
  for (std::size_t i = 0; i < skeleton.links.size(); ++i) {
    const int parent = skeleton.links[i].parent;
    if (i == 0 ? parent != -1 : parent < 0 || parent >= static_cast<int>(i)) return false;
  }
  return !skeleton.links.empty();
}

}  // namespace

Anatomy FindAnatomy(const stream::Skeleton& skeleton) {
  Anatomy anatomy;
  anatomy.landmarks.joint.fill(-1);
  if (!HasTree(skeleton)) return anatomy;
  std::vector<body::Joint> joints;
  for (const stream::Link& link : skeleton.links) {
    body::Joint joint;
    joint.name = link.name;
    joint.parent = link.parent;
    joints.push_back(std::move(joint));
    anatomy.parents.push_back(link.parent);
    anatomy.radii_m.push_back(static_cast<float>(0.5 * link.size_m.maxCoeff()));
  }
  const auto landmarks = body::FindLandmarks(body::MakeSkeleton(std::move(joints)));
  if (!landmarks) return anatomy;
  anatomy.landmarks = *landmarks;
  anatomy.person = true;
  return anatomy;
}

bool Fits(const Anatomy& anatomy, const std::vector<int>& parents) {
  return anatomy.person && anatomy.parents == parents;
}

namespace {

using body::Landmark;
using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr double kThighAndShankOfHeight = 0.49;  // common/body/body.h
constexpr double kSureSdM = 0.06;                // As good as it gets: not coloured.
constexpr double kLostSdM = 0.35;                // As red as it gets.

/// Half the depth of a trunk over the standing height, by the share of the way from the hips to the
/// neck; its width is kTrunkOval times as much.
constexpr std::array<std::array<double, 2>, 8> kTrunkDepths{{{-0.10, 0.046},
                                                             {0.05, 0.061},
                                                             {0.28, 0.056},
                                                             {0.48, 0.059},
                                                             {0.66, 0.064},
                                                             {0.80, 0.064},
                                                             {0.92, 0.060},
                                                             {1.00, 0.052}}};
constexpr float kTrunkOval = 1.42f;
constexpr int kTrunkPieces = 10;

/// The depths joined by a curve without kinks: a cubic between each two, whose slope at each is
/// that between its neighbours (Catmull and Rom).
float TrunkDepth(double share) {
  std::size_t i = 1;
  while (i + 1 < kTrunkDepths.size() && share > kTrunkDepths[i][0]) ++i;
  const auto& a = kTrunkDepths[i - 1];
  const auto& b = kTrunkDepths[i];
  const auto slope = [](std::size_t at) {
    const auto& before = kTrunkDepths[at > 0 ? at - 1 : at];
    const auto& after = kTrunkDepths[std::min(at + 1, kTrunkDepths.size() - 1)];
    return (after[1] - before[1]) / (after[0] - before[0]);
  };
  const double width = b[0] - a[0], t = std::clamp((share - a[0]) / width, 0.0, 1.0);
  const double t2 = t * t, t3 = t2 * t;
  return static_cast<float>((2 * t3 - 3 * t2 + 1) * a[1] +
                            (t3 - 2 * t2 + t) * width * slope(i - 1) + (3 * t2 - 2 * t3) * b[1] +
                            (t3 - t2) * width * slope(i));
}

/// One figure being built. Sizes in the functions below are over the standing height, by eye.
class Mannequin {
 public:
  Mannequin(const Anatomy& anatomy, const PersonPose& pose, const PersonLook& look, PartList& parts)
      : anatomy_(anatomy), pose_(pose), look_(look), parts_(parts) {
    height_ = std::max(0.3f, ((At(Landmark::kLeftHip) - At(Landmark::kLeftKnee)).norm() +
                              (At(Landmark::kLeftKnee) - At(Landmark::kLeftAnkle)).norm()) /
                                 static_cast<float>(kThighAndShankOfHeight));
    hips_ = 0.5f * (At(Landmark::kLeftHip) + At(Landmark::kRightHip));
    neck_ = At(Landmark::kNeck);
    pelvis_ = Frame(At(Landmark::kLeftHip) - At(Landmark::kRightHip), neck_ - hips_);
    chest_ = Frame(At(Landmark::kLeftShoulder) - At(Landmark::kRightShoulder), neck_ - hips_);
  }

  void Add() {
    AddTrunk();
    AddHead();
    AddArm(Landmark::kLeftClavicle, Landmark::kLeftShoulder, Landmark::kLeftElbow,
           Landmark::kLeftWrist, Landmark::kLeftHandEnd);
    AddArm(Landmark::kRightClavicle, Landmark::kRightShoulder, Landmark::kRightElbow,
           Landmark::kRightWrist, Landmark::kRightHandEnd);
    AddLeg(Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle);
    AddLeg(Landmark::kRightHip, Landmark::kRightKnee, Landmark::kRightAnkle);
    AddFoot(Landmark::kLeftAnkle, Landmark::kLeftToe, Landmark::kLeftToeEnd, look_.left_shoe);
    AddFoot(Landmark::kRightAnkle, Landmark::kRightToe, Landmark::kRightToeEnd, look_.right_shoe);
  }

 private:
  bool Has(Landmark landmark) const { return anatomy_.landmarks[landmark] >= 0; }
  Vector3f At(Landmark landmark) const {
    return pose_.p_m[static_cast<std::size_t>(anatomy_.landmarks[landmark])].cast<float>();
  }
  Matrix3f OrientationOf(Landmark landmark, const Matrix3f& unknown) const {
    const int joint = anatomy_.landmarks[landmark];
    if (joint < 0 || joint >= static_cast<int>(pose_.orientations.size())) return unknown;
    return pose_.orientations[static_cast<std::size_t>(joint)].cast<float>().toRotationMatrix();
  }
  /// Columns: forward, left, up.
  static Matrix3f Frame(const Vector3f& left, const Vector3f& up) {
    Matrix3f axes;
    axes.col(2) = up.normalized();
    Vector3f ahead = left.cross(axes.col(2));
    if (ahead.norm() < 1e-6f) ahead = axes.col(2).unitOrthogonal();
    axes.col(0) = ahead.normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
  }
  Colour Sure(const Colour& colour, Landmark landmark) const {
    const auto joint = static_cast<std::size_t>(std::max(0, anatomy_.landmarks[landmark]));
    if (joint >= pose_.sd_m.size()) return colour;
    const double lost =
        std::clamp((pose_.sd_m[joint] - kSureSdM) / (kLostSdM - kSureSdM), 0.0, 1.0);
    return colour + static_cast<float>(0.75 * lost) * (Rgb(0xd83a2b) - colour);
  }
  void Ball(const Vector3f& centre, const Matrix3f& axes, const Vector3f& half_of_height,
            const Colour& colour, float gloss = 0.12f) {
    parts_.AddBall(Ellipsoid(centre, axes, height_ * half_of_height), colour, 0.75f * colour,
                   gloss);
  }
  void Limb(const Vector3f& a, const Vector3f& b, float radius_a, float radius_b,
            const Colour& colour) {
    parts_.AddLimb(a, b, height_ * radius_a, height_ * radius_b, colour, 0.12f);
  }

  /// One piece of trunk after the other, each as wide as the next one begins: no seam.
  void AddTrunk() {
    const Vector3f up = neck_ - hips_;
    const auto add = [&](double from, double to, float wider, const Colour& colour) {
      for (int piece = 0; piece < kTrunkPieces; ++piece) {
        const double low = from + (to - from) * piece / kTrunkPieces;
        const double high = from + (to - from) * (piece + 1) / kTrunkPieces;
        const auto middle = static_cast<float>(std::clamp((low + high) / 2, 0.0, 1.0));
        const Vector3f ahead = (1 - middle) * pelvis_.col(0) + middle * chest_.col(0);
        parts_.AddOvalLimb(hips_ + static_cast<float>(low) * up,
                           hips_ + static_cast<float>(high) * up, ahead,
                           height_ * wider * TrunkDepth(low), height_ * wider * TrunkDepth(high),
                           kTrunkOval, colour, 0.12f);
      }
    };
    add(-0.06, 0.13, 1.03f, look_.trousers);
    add(0.08, 0.97, 1, look_.shirt);
  }

  void AddHead() {
    const Vector3f base = Has(Landmark::kHead) ? At(Landmark::kHead) : neck_;
    const Vector3f fallback = base + 0.11f * height_ * chest_.col(2);
    const Vector3f vertex = Has(Landmark::kVertex) ? At(Landmark::kVertex) : fallback;
    Limb(neck_ - 0.015f * height_ * chest_.col(2), base + 0.2f * (vertex - base), 0.033f, 0.030f,
         look_.skin);
    // The skull ends at the vertex, whatever the rig calls the head's joint.
    const Matrix3f axes = Frame(OrientationOf(Landmark::kHead, chest_).col(1), vertex - neck_);
    const Vector3f middle = vertex - 0.064f * height_ * axes.col(2);
    const auto ball = [&](const Vector3f& at, const Vector3f& half, const Colour& colour,
                          float gloss) {
      Ball(middle + height_ * (axes * at), axes, half, colour, gloss);
    };
    ball({0, 0, 0}, {0.051f, 0.043f, 0.064f}, look_.skin, 0.2f);
    ball({0.018f, 0, -0.047f}, {0.024f, 0.025f, 0.021f}, look_.skin, 0.2f);
    ball({0.050f, 0, -0.012f}, {0.010f, 0.006f, 0.012f}, look_.skin, 0.2f);
    if (look_.plain) return;
    ball({-0.009f, 0, 0.013f}, {0.050f, 0.0465f, 0.057f}, look_.hair, 0.1f);
    ball({0.039f, 0, -0.037f}, {0.005f, 0.013f, 0.003f}, look_.lips, 0.1f);
    for (const float left : {-1.0f, 1.0f}) {
      ball({0.000f, 0.043f * left, -0.006f}, {0.009f, 0.005f, 0.014f}, look_.skin, 0.2f);
      ball({0.040f, 0.017f * left, 0.004f}, {0.0075f, 0.0085f, 0.007f}, look_.eyes, 0.5f);
      ball({0.0455f, 0.0165f * left, 0.004f}, {0.003f, 0.0045f, 0.005f}, look_.hair, 0.5f);
      ball({0.0415f, 0.018f * left, 0.018f}, {0.0045f, 0.010f, 0.0025f}, look_.hair, 0.1f);
    }
  }

  void AddArm(Landmark clavicle, Landmark shoulder, Landmark elbow, Landmark wrist,
              Landmark hand_end) {
    const Vector3f s = At(shoulder), e = At(elbow), w = At(wrist);
    const Vector3f root = Has(clavicle) ? At(clavicle) : neck_;
    Limb(root + 0.35f * (s - root), s, 0.040f, 0.038f, look_.shirt);
    Limb(neck_ + 0.014f * height_ * chest_.col(2), s, 0.029f, 0.037f, look_.shirt);
    AddShoulder(s, e);
    Limb(s, s + 0.55f * (e - s), 0.039f, 0.029f, look_.shirt);
    Limb(s + 0.55f * (e - s), e, 0.026f, 0.023f, Sure(look_.skin, elbow));
    Limb(e, e + 0.3f * (w - e), 0.023f, 0.024f, Sure(look_.skin, elbow));
    Limb(e + 0.3f * (w - e), w, 0.024f, 0.016f, Sure(look_.skin, wrist));
    AddHand(wrist, hand_end, (w - e).normalized());
  }

  /// Breast and back muscles from the ribs to the joint and to the arm's root: without them the arm
  /// hangs on its collar bone, and the skin splits at the armpit.
  void AddShoulder(const Vector3f& shoulder, const Vector3f& elbow) {
    const float left = chest_.col(1).dot(shoulder - neck_) > 0 ? 1 : -1;
    const Vector3f ribs = hips_ + 0.72f * (neck_ - hips_) + 0.045f * left * height_ * chest_.col(1);
    const Vector3f arm = shoulder + 0.25f * (elbow - shoulder);
    Limb(ribs, shoulder, 0.054f, 0.038f, look_.shirt);
    Limb(ribs, arm, 0.046f, 0.034f, look_.shirt);
  }

  /// A hand around a rod, as it holds a controller. In the T-pose the rod points ahead, where the
  /// thumbs are, and the palms face the ground.
  void AddHand(Landmark wrist, Landmark hand_end, const Vector3f& forearm) {
    const Vector3f w = At(wrist);
    Vector3f along = forearm;
    if (Has(hand_end) && (At(hand_end) - w).norm() > 1e-4f) along = (At(hand_end) - w).normalized();
    const float left = wrist == Landmark::kLeftWrist ? 1 : -1;
    const Vector3f as_t_pose = left * chest_.col(1);
    const Matrix3f unknown =
        Eigen::Quaternionf::FromTwoVectors(as_t_pose, along).toRotationMatrix() * chest_;
    // Columns: towards the thumb, to the finger tips, out of the back of the hand.
    Matrix3f axes;
    axes.col(1) = along;
    axes.col(2) = left * OrientationOf(wrist, unknown).col(0).cross(along).normalized();
    axes.col(0) = left * along.cross(axes.col(2));
    const Colour colour = Sure(look_.skin, wrist);
    const auto limb = [&](const Vector3f& a, const Vector3f& b, float radius_a, float radius_b) {
      Limb(w + height_ * (axes * a), w + height_ * (axes * b), radius_a, radius_b, colour);
    };
    parts_.AddOvalLimb(w, w + 0.048f * height_ * along, axes.col(2), 0.012f * height_,
                       0.0095f * height_, 1.9f, colour, 0.12f);
    if (look_.plain) return limb({0, 0.048f, 0}, {0, 0.058f, -0.024f}, 0.017f, 0.014f);
    for (const float x : {0.0175f, 0.006f, -0.006f, -0.0165f}) {
      const float reach = 1 - 8 * std::abs(x - 0.006f);  // The middle finger is the longest.
      const Vector3f knuckle(x, 0.054f * reach, 0.003f), middle(x, 0.064f * reach, -0.019f),
          tip(x, 0.040f, -0.027f);
      limb(knuckle, middle, 0.0078f, 0.0062f);
      limb(middle, tip, 0.0062f, 0.0055f);
    }
    limb({0.010f, 0.012f, -0.004f}, {0.026f, 0.034f, -0.014f}, 0.012f, 0.0078f);
    limb({0.026f, 0.034f, -0.014f}, {0.014f, 0.050f, -0.031f}, 0.0078f, 0.0062f);
  }

  void AddLeg(Landmark hip, Landmark knee, Landmark ankle) {
    const Vector3f h = At(hip), k = At(knee), a = At(ankle);
    const Colour trousers = Sure(look_.trousers, knee);
    Limb(h, h + 0.45f * (k - h), 0.052f, 0.045f, trousers);
    Limb(h + 0.45f * (k - h), k, 0.045f, 0.034f, trousers);
    const Vector3f calf = k + 0.30f * (a - k);
    Limb(k, calf, 0.034f, 0.034f, trousers);
    Limb(calf, k + 0.72f * (a - k), 0.034f, 0.026f, trousers);
    Limb(k + 0.72f * (a - k), a, 0.020f, 0.019f, Sure(look_.skin, ankle));
  }

  /// A shoe: the heel is behind and under the ankle, level with the ball.
  void AddFoot(Landmark ankle, Landmark ball, Landmark tip, const Colour& colour) {
    const Vector3f a = At(ankle);
    if (!Has(ball)) return;
    const Vector3f b = At(ball);
    Vector3f ahead = Has(tip) ? Vector3f(At(tip) - b) : Vector3f(b - a);
    if (ahead.norm() < 1e-5f) ahead = pelvis_.col(0);
    ahead.normalize();
    Vector3f down = (b - a) - (b - a).dot(ahead) * ahead;
    down = down.norm() < 1e-5f ? Vector3f(-Vector3f::UnitZ()) : Vector3f(down.normalized());
    const Vector3f left = -down.cross(ahead);
    Matrix3f axes;
    axes << ahead, left, -down;
    const Vector3f heel = a + (b - a).dot(down) * down - 0.036f * height_ * ahead;
    const Vector3f end = Has(tip) ? At(tip) : Vector3f(b + 0.03f * height_ * ahead);
    const float length = (end - heel).norm() / height_;
    const Colour shoe = Sure(colour, ankle);
    const Vector3f lift = -0.008f * height_ * down;
    Ball(0.5f * (heel + end) + lift, axes, {0.53f * length, 0.027f, 0.019f}, shoe);
    Ball(heel + 0.022f * height_ * ahead + 1.6f * lift, axes, {0.034f, 0.025f, 0.028f}, shoe);
    Limb(a, heel + 0.036f * height_ * ahead + 2 * lift, 0.021f, 0.022f, shoe);
  }

  const Anatomy& anatomy_;
  const PersonPose& pose_;
  const PersonLook& look_;
  PartList& parts_;
  float height_ = 1.7f;
  Vector3f hips_, neck_;
  Matrix3f pelvis_, chest_;
};

}  // namespace

PersonLook MannequinLook() {
  return {.skin = Rgb(0xecc9a4),
          .hair = Rgb(0x33261f),
          .eyes = Rgb(0xf4f4f0),
          .lips = Rgb(0xb9705f),
          .shirt = Rgb(0x2e8a94),
          .trousers = Rgb(0x36475a),
          .left_shoe = Rgb(0x3f8fe0),
          .right_shoe = Rgb(0xf2a33c)};
}

PersonLook PlainLook(const Colour& colour) {
  return {.skin = colour,
          .hair = colour,
          .eyes = colour,
          .lips = colour,
          .shirt = colour,
          .trousers = colour,
          .left_shoe = colour,
          .right_shoe = colour,
          .plain = true};
}

void AddPerson(const Anatomy& anatomy, const PersonPose& pose, const PersonLook& look,
               PartList& parts) {
  if (!anatomy.person || pose.p_m.size() != anatomy.parents.size()) {
    return AddLimbs(anatomy.parents, anatomy.radii_m, pose.p_m, look.shirt, parts);
  }
  Mannequin(anatomy, pose, look, parts).Add();
}

void AddLimbs(const std::vector<int>& parents, const std::vector<float>& radii_m,
              const std::vector<Eigen::Vector3d>& p_m, const Colour& colour, PartList& parts) {
  constexpr float kRadiusM = 0.03f;
  const auto radius_at = [&](std::size_t joint) {
    return joint < radii_m.size() && radii_m[joint] > 0 ? radii_m[joint] : kRadiusM;
  };
  for (std::size_t i = 1; i < std::min(parents.size(), p_m.size()); ++i) {
    const int parent = parents[i];
    if (parent < 0 || parent >= static_cast<int>(i)) continue;
    const auto from = static_cast<std::size_t>(parent);
    parts.AddLimb(p_m[from].cast<float>(), p_m[i].cast<float>(), radius_at(from), radius_at(i),
                  colour, 0.1f);
  }
}

}  // namespace footing::scene
