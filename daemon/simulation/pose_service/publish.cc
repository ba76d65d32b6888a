#include "daemon/simulation/pose_service/publish.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/landmarks.h"
#include "common/wire/wire.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::pose_service {
namespace {

constexpr double kMassOverHeightSquared = 22.5;  // kg/m^2: the middle of the healthy range.
/// The ankle joint is so much of the foot ahead of the heel (docs/body.md).
constexpr double kAnkleFromHeel = 0.25;

/// Ankle to ball and ball to tip, so that heel to tip has the length.
void StretchFeet(const body::Landmarks& landmarks, double length_m, body::Skeleton& skeleton) {
  using body::Landmark;
  for (const auto& [ball, tip] : {std::pair(Landmark::kLeftToe, Landmark::kLeftToeEnd),
                                  std::pair(Landmark::kRightToe, Landmark::kRightToeEnd)}) {
    if (landmarks[ball] < 0 || landmarks[tip] < 0) continue;
    Eigen::Vector3d& to_ball = skeleton.joints[static_cast<std::size_t>(landmarks[ball])].offset_m;
    Eigen::Vector3d& to_tip = skeleton.joints[static_cast<std::size_t>(landmarks[tip])].offset_m;
    const double ahead_m = (to_ball + to_tip).head<2>().norm();
    if (ahead_m <= 0) continue;
    const double scale = (1 - kAnkleFromHeel) * length_m / ahead_m;
    to_ball.head<2>() *= scale;
    to_tip.head<2>() *= scale;
  }
}

}  // namespace

Result<body::Body> MakeSubjectBody(const Subject& subject) {
  body::Skeleton skeleton = body::StandardPerson(subject.height_m);
  if (subject.foot_length_m > 0) {
    const auto landmarks = body::FindLandmarks(skeleton);
    if (!landmarks) return landmarks.error();
    StretchFeet(*landmarks, subject.foot_length_m, skeleton);
  }
  body::PersonParameters person;
  person.height_m = subject.height_m;
  person.mass_kg = subject.mass_kg > 0
                       ? subject.mass_kg
                       : kMassOverHeightSquared * subject.height_m * subject.height_m;
  return body::MakeBody(skeleton, person);
}

namespace {

using body::Landmark;
using wire::ToProto;

/// Thickness of a body at its joints over its height, by eye from anatomical proportions.
struct Thickness {
  Landmark landmark;
  double of_height;
};
constexpr std::array<Thickness, 13> kThickness{{
    {Landmark::kHips, 0.125},
    {Landmark::kChest, 0.13},
    {Landmark::kNeck, 0.065},
    {Landmark::kHead, 0.065},
    {Landmark::kLeftClavicle, 0.07},
    {Landmark::kLeftShoulder, 0.062},
    {Landmark::kLeftElbow, 0.046},
    {Landmark::kLeftWrist, 0.034},
    {Landmark::kLeftHip, 0.095},
    {Landmark::kLeftKnee, 0.062},
    {Landmark::kLeftAnkle, 0.042},
    {Landmark::kLeftToe, 0.040},
    {Landmark::kLeftToeEnd, 0.028},
}};
constexpr double kElseOfHeight = 0.03;

void SetFoot(const momentum::FootEstimate& foot, v1::BodyFoot& message) {
  message.set_contact(foot.contact);
  message.set_valid(foot.valid);
  *message.mutable_position_m() = ToProto(foot.p_WF_m);
  *message.mutable_variance_m2() = ToProto(foot.variance_m2);
  message.set_load_n(foot.load_n);
  message.set_cop_valid(foot.cop_valid);
  *message.mutable_cop_m() = ToProto(foot.p_WP_m);
  message.set_airborne_s(foot.airborne_s);
}

std::string HandsSource(const PoseFrame& frame, const std::string& tracker) {
  if (frame.input.hands_valid[0] || frame.input.hands_valid[1])
    return tracker.empty() ? "tracker" : tracker;
  return frame.input.arms_valid[0] || frame.input.arms_valid[1] ? "wiimote" : "";
}

void SetBody(const PoseFrame& frame, const Subject& subject, const reconstruction::Options& options,
             const std::string& tracker, v1::BodyState& body) {
  body.set_subject(subject.code);
  body.set_mode(reconstruction::NameOf(options.mode));
  for (const std::string& part : reconstruction::LeftOut(options)) body.add_left_out(part);
  body.set_calibrated(frame.t_pose.complete);
  body.set_calibration_progress(frame.t_pose.progress);
  body.set_calibration_restarts(frame.t_pose.restarts);
  body.set_mass_kg(frame.t_pose.mass_kg);
  body.set_height_m(subject.height_m);
  body.set_lag_s(frame.lag_s);
  body.set_momentum_valid(frame.momentum.valid);
  *body.mutable_com_variance_m2() = ToProto(frame.momentum.position_variance_m2);
  *body.mutable_com_acceleration_mps2() = ToProto(frame.momentum.a_WC_mps2);
  *body.mutable_angular_momentum_kgm2ps() = ToProto(frame.momentum.angular_momentum_kgm2ps);
  *body.mutable_angular_momentum_variance() = ToProto(frame.momentum.angular_momentum_variance);
  for (const auto& foot : frame.momentum.feet) SetFoot(foot, *body.add_feet());
  body.set_resets(frame.resets);
  for (std::size_t i = 0; i < frame.links.count; ++i) body.add_link_sd_m(frame.links.sd_m[i]);
  if (options.mode == reconstruction::Mode::kBest) {
    for (const double sd_rad : frame.links.angle_sd_rad) body.add_angle_sd_rad(sd_rad);
  }
  body.set_note(PoseNote(frame, subject));
  body.set_solve_us(frame.solve_us);
  for (std::size_t side = 0; side < reconstruction::kHands; ++side) {
    body.add_hands_seen(frame.input.hands_valid[side] || frame.input.arms_valid[side]);
  }
  body.set_hands_source(HandsSource(frame, tracker));
  body.set_contact_source(frame.input.source == PoseSource::kInsoles ? "insoles" : "boards");
  for (const bool measured : frame.input.feet_measured) body.add_feet_told(measured);
}

}  // namespace

v1::CharacterFrame ToCharacterFrame(const PoseFrame& frame, const Subject& subject,
                                    const reconstruction::Options& options,
                                    const std::string& world, const std::string& rig,
                                    const std::string& tracker) {
  v1::CharacterFrame message = serving::MakeFrame({.step = frame.step,
                                                   .time_s = frame.time_s,
                                                   .overruns = frame.overruns,
                                                   .state_hash = frame.state_hash,
                                                   .valid = frame.valid,
                                                   .p_WC_m = frame.momentum.p_WC_m,
                                                   .v_WC_mps = frame.momentum.v_WC_mps,
                                                   .simulated_input = frame.input.simulated},
                                                  world, rig);
  v1::Character& character = *message.mutable_characters(0);
  for (std::size_t i = 0; i < frame.links.count; ++i) {
    *character.add_links() = ToProto(frame.links.pose[i]);
  }
  for (const auto& foot : frame.momentum.feet) {
    *character.add_contacts() = ToProto(
        stream::Contact{foot.contact, foot.cop_valid ? foot.p_WP_m : foot.p_WF_m, foot.load_n});
  }
  SetBody(frame, subject, options, tracker, *character.mutable_body());
  return message;
}

stream::Skeleton ToSkeleton(const body::Body& body) {
  stream::Skeleton skeleton;
  skeleton.name = "person";
  skeleton.contact_points = {"left_foot", "right_foot"};
  for (const body::Joint& joint : body.skeleton.joints) {
    const double size_m = kElseOfHeight * body.height_m;
    skeleton.links.push_back({joint.name, joint.parent, Eigen::Vector3d::Constant(size_m)});
  }
  for (const Thickness& thickness : kThickness) {
    for (const Landmark landmark : {thickness.landmark, body::Mirrored(thickness.landmark)}) {
      const int joint = body.landmarks[landmark];
      if (joint < 0) continue;
      skeleton.links[static_cast<std::size_t>(joint)].size_m.setConstant(thickness.of_height *
                                                                         body.height_m);
    }
  }
  return skeleton;
}

namespace {

void Add(v1::Events& events, v1::Event::Kind kind, std::int64_t now_ns, const std::string& text) {
  *events.add_events() = serving::MakeEvent(kind, now_ns, text);
}

std::string Kilograms(double mass_kg) {
  const auto tenths = std::llround(10 * mass_kg);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " kg";
}

}  // namespace

/// Events for Wiimotes only: trackers lose hands and find them all the time.
void PoseEvents::AddHands(const PoseFrame& frame, std::int64_t now_ns, v1::Events& events) {
  for (std::size_t side = 0; side < hand_trouble_.size(); ++side) {
    const HandTrouble now = frame.input.hand_trouble[side];
    const HandTrouble before = std::exchange(hand_trouble_[side], now);
    if (!frame.t_pose.complete || now == before) continue;
    const std::string name = side == 0 ? "left" : "right";
    if (now == HandTrouble::kNone) {
      Add(events, v1::Event::KIND_STREAM_BACK, now_ns,
          "the " + name + " Wiimote reports its arm again");
    } else {
      Add(events, v1::Event::KIND_STREAM_LOST, now_ns, HandText(now, name));
    }
  }
}

v1::Events PoseEvents::Between(const PoseFrame& frame, const Subject& subject,
                               std::int64_t now_ns) {
  v1::Events events;
  const bool measured = frame.input.feet_measured[0] && frame.input.feet_measured[1];
  const bool on_insoles = frame.input.source == PoseSource::kInsoles;
  const bool next_subject = has_last_ && frame.subject_number != subject_number_;
  const std::string source = on_insoles ? "insole" : "board";
  if (has_last_ && frame.input.source != source_) {
    Add(events, v1::Event::KIND_COMMAND, now_ns, "the pose follows the " + source + "s");
  }
  if (measured != measured_) {
    Add(events, measured ? v1::Event::KIND_STREAM_BACK : v1::Event::KIND_STREAM_LOST, now_ns,
        measured ? "both " + source + "s are there"
                 : (on_insoles ? "an " : "a ") + source + " is lost: the pose coasts");
  }
  if (next_subject) {
    Add(events, v1::Event::KIND_COMMAND, now_ns,
        "next subject: " + subject.code + "; their T-pose is awaited");
  } else if (calibrated_ && !frame.t_pose.complete) {
    Add(events, v1::Event::KIND_COMMAND, now_ns, "the T-pose is to be taken again");
  }
  if (!calibrated_ && frame.t_pose.complete) {
    Add(events, v1::Event::KIND_COMMAND, now_ns,
        "T-pose taken: " + Kilograms(frame.t_pose.mass_kg));
  }
  if (has_last_ && !next_subject && frame.resets > resets_) {
    Add(events, v1::Event::KIND_COMMAND, now_ns, "the filters were reset");
  }
  AddHands(frame, now_ns, events);
  has_last_ = true;
  measured_ = measured;
  source_ = frame.input.source;
  calibrated_ = frame.t_pose.complete;
  subject_number_ = frame.subject_number;
  resets_ = frame.resets;
  return events;
}

namespace {

using momentum::TPoseCalibration;
using text::Fixed;

/// A foot that stepped off is noted after this time: steps and kicks are not.
constexpr double kAwayS = 0.5;
constexpr double kAtEdgeS = 0.3;  // The same of one whose load comes to the edge of its board.
constexpr std::array<const char*, 2> kSides{"left", "right"};

void Add(std::string& note, const std::string& words) {
  if (!note.empty()) note += "; ";
  note += words;
}

bool FollowsInsoles(const PoseFrame& frame) { return frame.input.source == PoseSource::kInsoles; }

std::string LostSource(const PoseFrame& frame) {
  if (!frame.input.feet_measured[0] && !frame.input.feet_measured[1]) {
    return FollowsInsoles(frame)
               ? "nothing comes from the insoles: are both on? the feet are guessed, less by the "
                 "second"
               : "nothing comes from the boards: are both on, and assigned as left and right?";
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (!frame.input.feet_measured[side]) {
      return std::string("nothing comes from the ") + kSides[side] +
             (FollowsInsoles(frame) ? " insole" : " board");
    }
  }
  return "";
}

std::string Awaited(const PoseFrame& frame) {
  const double total_n = frame.input.load_n[0] + frame.input.load_n[1];
  if (total_n < KilogramsToNewtons(TPoseCalibration::kLeastMassKg)) {
    return FollowsInsoles(frame) ? "stand on both feet" : "step on, one foot on each board";
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (frame.input.load_n[side] < TPoseCalibration::kLeastFootShare * total_n) {
      return std::string("put weight on the ") + kSides[side] + " foot";
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (!frame.input.at_edge[side]) continue;
    return std::string("the ") + kSides[side] +
           " foot presses on the edge of its board: put it in the middle of the board";
  }
  const auto& off = frame.input.hands_off_t_pose;
  if (off[0] || off[1]) {
    const std::string arms = off[0] && off[1] ? "both arms"
                             : off[0]         ? "the left arm"
                                              : "the right arm";
    return "the tracked hands are not in the T-pose: raise " + arms +
           " straight out to the sides, at shoulder height";
  }
  const double left_s = (1 - frame.t_pose.progress) * TPoseCalibration::kSeconds;
  if (frame.t_pose.progress > 0.04) {
    return "T-pose: hold still, " + Fixed(left_s, 1) + " s more";
  }
  return frame.t_pose.restarts > 0 ? "you moved: stand still, arms out to the sides"
                                   : "stand still, arms out to the sides";
}

void AddFeet(const PoseFrame& frame, std::string& note) {
  const auto& feet = frame.momentum.feet;
  const auto away = [](const momentum::FootEstimate& foot) {
    return !foot.contact && foot.airborne_s > kAwayS;
  };
  if (away(feet[0]) && away(feet[1])) {
    return Add(note,
               FollowsInsoles(frame) ? "both feet are in the air" : "nobody stands on the boards");
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (!away(feet[side])) continue;
    Add(note, std::string("the ") + kSides[side] + " foot is off " +
                  (FollowsInsoles(frame) ? "the ground for " : "its board for ") +
                  Fixed(feet[side].airborne_s, 1) + " s: its place is a guess");
  }
}

/// Feet, or a part of the weight, that are not where the boards measure them.
void AddBesides(const PoseFrame& frame, std::string& note) {
  for (std::size_t side = 0; side < 2; ++side) {
    const momentum::FootEstimate& foot = frame.momentum.feet[side];
    if (!foot.contact || foot.at_edge_s < kAtEdgeS) continue;
    Add(note, std::string("the ") + kSides[side] +
                  " foot presses on the edge of its board: what is beyond is not measured");
  }
  if (frame.momentum.valid && frame.momentum.stepped) {
    Add(note,
        "a foot has stepped ahead or back: where the body is, is not certain until it has stood "
        "for some seconds");
  }
  if (!frame.momentum.valid || frame.momentum.whole_weight) return;
  const bool less = frame.momentum.load_share < 1;
  Add(note,
      std::string(FollowsInsoles(frame) ? "the insoles" : "the boards") + " carry " +
          Fixed(100 * frame.momentum.load_share, 0) + " % of the weight of the T-pose: " +
          (less ? "stand on them with both feet, and on nothing else" : "put down what you carry") +
          ", or take the T-pose again");
}

/// Which hands have no measurement, and why.
void AddHands(const PoseFrame& frame, std::string& note) {
  const auto measured = [&](std::size_t side) {
    return frame.input.hands_valid[side] || frame.input.arms_valid[side];
  };
  const auto& trouble = frame.input.hand_trouble;
  const bool wiimotes = trouble[0] != HandTrouble::kNone || trouble[1] != HandTrouble::kNone;
  if (!measured(0) && !measured(1) && !wiimotes) return Add(note, "no hand is seen");
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    if (!measured(side)) Add(note, HandText(trouble[side], kSides[side]));
  }
}

/// Segments whose sensors wait for the squat that shows which way they face.
void AddSegmentSensors(const PoseFrame& frame, std::string& note) {
  std::string waiting;
  for (std::size_t site = 0; site < reconstruction::kBodySites; ++site) {
    // A head hardly bends in a squat: it counts once it has nodded, and nobody is asked to.
    const auto where = static_cast<reconstruction::BodySite>(site);
    const bool needs_none = where == reconstruction::BodySite::kHead || IsHand(where);
    if (!frame.input.turn_awaits[site] || needs_none) continue;
    std::string name = reconstruction::kBodySiteNames[site];
    std::replace(name.begin(), name.end(), '_', ' ');
    waiting += (waiting.empty() ? "" : ", ") + name;
  }
  if (!waiting.empty())
    Add(note, "squat once: which way the sensor faces is not known (" + waiting + ")");
}

void AddMass(const PoseFrame& frame, const Subject& subject, std::string& note) {
  if (subject.mass_kg <= 0 || frame.t_pose.mass_kg <= 0) return;
  const double difference = frame.t_pose.mass_kg / subject.mass_kg - 1;
  if (std::abs(difference) <= kMassTolerance) return;
  Add(note, std::string("the ") + (FollowsInsoles(frame) ? "insoles" : "boards") + " say " +
                Fixed(frame.t_pose.mass_kg, 1) + " kg, the subject's file " +
                Fixed(subject.mass_kg, 1) + " kg: is it " + subject.code +
                (FollowsInsoles(frame) ? "?" : ", and are both boards tared?"));
}

}  // namespace

std::string HandText(HandTrouble trouble, const std::string& side) {
  switch (trouble) {
    case HandTrouble::kNone:
      return "the " + side + " hand is not seen";
    case HandTrouble::kNoModel:
      return "the " + side +
             " Wiimote is not followed: arm.fmodel, or in paper mode arm_paper.fmodel, is missing "
             "(docs/models.md)";
    case HandTrouble::kNoGyroscope:
      return "the " + side + " Wiimote reports no rotation: is a MotionPlus in it?";
    case HandTrouble::kSilent:
      return "nothing comes from the " + side + " Wiimote: its arm is guessed";
    case HandTrouble::kAwaitsTPose:
      return "the " + side + " Wiimote was lost and has no heading: take the T-pose again";
    case HandTrouble::kOneStrap:
      return "the " + side +
             " arm has one strapped Wiimote: it needs one on the upper arm and one " +
             "on the forearm (roles " + side + "_upper_arm, " + side + "_forearm)";
  }
  return "";
}

std::string PoseNote(const PoseFrame& frame, const Subject& subject) {
  std::string note = LostSource(frame);
  const bool measured = note.empty();
  if (frame.input.insoles_idle)
    Add(note, "insoles need the best mode without lag: they are not followed");
  if (frame.input.insoles_await)
    Add(note, "insoles need a T-pose of their own: until then the boards are followed");
  if (!frame.t_pose.complete) {
    if (measured) Add(note, Awaited(frame));
    return note;
  }
  if (measured) AddFeet(frame, note);
  if (measured) AddBesides(frame, note);
  if (measured && frame.momentum.valid && frame.momentum.whole_weight && !frame.momentum.trusted)
    Add(note, "the height by the loads is not certain: it does not count for the pose");
  else if (measured && frame.momentum.valid && frame.momentum.trusted && !frame.momentum.stepped &&
           !frame.valid)
    Add(note, "what is measured fits no pose that the model knows: this one is a guess");
  AddHands(frame, note);
  AddSegmentSensors(frame, note);
  AddMass(frame, subject, note);
  return note;
}

}  // namespace footing::pose_service
