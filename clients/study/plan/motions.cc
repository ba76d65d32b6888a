#include "clients/study/plan/ranges.h"

namespace footing::study::ranges {
namespace {

std::vector<Motion> OfStick() {
  return {{"Push the stick as far forwards as is comfortable, and hold it there.", 5},
          {"Push it as far to the left.", 4},
          {"Push it as far to the right.", 4},
          {"Let it go.", 4}};
}

std::vector<Motion> OfBoards() {
  return {{"Step in place, as slowly as is comfortable.", 5},
          {"Faster: jog as fast as is comfortable, one foot on the boards.", 4},
          {"Stand. Rise quickly on your toes and come down, three times, gently.", 5},
          {"Three times, as hard as is comfortable, toes on the boards.", 5},
          {"Step in place and lean to the left, as far as is comfortable.", 4},
          {"Step and lean to the right.", 4},
          {"Stand on both feet and lean to the left, as far as is comfortable.", 3},
          {"Stand and lean to the right.", 3}};
}

}  // namespace

double DurationOf(const Played& played) {
  double duration_s = 0;
  for (const Motion& motion : MotionsOf(played)) duration_s += motion.duration_s;
  return duration_s;
}

std::vector<Motion> MotionsOf(const Played& played) {
  if (played.interface == "joystick") return OfStick();
  if (played.interface == "boards") return OfBoards();
  if (played.interface == "arm") {
    return {{"Swing straight arms in turns, as slowly as is comfortable.", 4},
            {"Faster: as fast as is comfortable.", 3},
            {"Bend your arms and swing them in turns, as slowly as is comfortable.", 3.5},
            {"Faster: as fast as is comfortable.", 2.5},
            {"Swing both arms together, gently.", 2.5},
            {"Together, as hard as is comfortable.", 2.5},
            {"Bend your arms and incline both to the left, as far as is comfortable.", 2},
            {"Incline both to the right.", 2}};
  }
  const bool leg = played.interface == "leg";
  const std::string who = played.turn_by == "trunk" ? "your trunk" : "your head";
  std::vector<Motion> motions{
      {leg ? "Step in place, as slowly as is comfortable."
           : "Swing in turns, as slowly as is comfortable.",
       5},
      {"Faster: as fast as is comfortable.", 3},
      {leg ? "Hop with both legs together, low." : "Swing both hands together, gently.", 3.5},
      {leg ? "Hop as high as is comfortable." : "Together, as hard as is comfortable.", 3.5}};
  if (leg && played.turn_by == "feet") {
    motions.push_back({"Step, and lift the right foot higher than the left.", 3});
    motions.push_back({"Step, and lift the left foot higher than the right.", 3});
  } else {
    const std::string what = leg ? who : "both wrists";
    motions.push_back({"Incline " + what + " to the left, as far as is comfortable.", 2.5});
    motions.push_back({"Incline " + what + " to the right.", 2.5});
  }
  return motions;
}

}  // namespace footing::study::ranges
