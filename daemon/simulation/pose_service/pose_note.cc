#include "daemon/simulation/pose_service/pose_note.h"

#include <array>
#include <cmath>

#include "common/base/number.h"
#include "common/base/units.h"
#include "daemon/simulation/momentum/calibration.h"

namespace footing::pose_service {
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
      return "the " + side + " Wiimote is not followed: there is no arm.fmodel (docs/models.md)";
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
  AddMass(frame, subject, note);
  return note;
}

}  // namespace footing::pose_service
