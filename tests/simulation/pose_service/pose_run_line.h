#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "daemon/simulation/pose_service/pose_line.h"
#include "daemon/simulation/pose_service/pose_run.h"
#include "tests/simulation/reconstruction/made_person.h"

namespace footing::pose_service {

namespace made = reconstruction;

/// A person who stands in a T-pose for 6 s and then moves, in the steps of the simulation thread.
struct Line {
  explicit Line(double seconds = 8)
      : person(made::MadePerson()),
        motion(made::MadeMotion(person, seconds)),
        measured(made::Measured(person, motion)),
        models(made::MakeModels({made::BasisOf(person, motion)}).value()),
        run(Subject(1), made::kMadeRateHz, subjects) {
    told.subject_number = 1;
  }

  std::unique_ptr<SubjectRun> Subject(std::uint64_t number) const {
    return InMode(number, made::Mode::kBest);
  }
  std::unique_ptr<SubjectRun> InMode(std::uint64_t number, made::Mode mode) const {
    made::Options options;
    options.mode = mode;
    options.rate_hz = made::kMadeRateHz;
    if (mode == made::Mode::kPaper) {
      return std::make_unique<SubjectRun>(
          number, made::Reconstruction::Create(person, models, options).value());
    }
    return std::make_unique<SubjectRun>(
        SubjectRun{number, made::Reconstruction::Create(person, models, options).value(),
                   made::InsoleWalk::Create(person, models, options).value()});
  }
  /// The person wears insoles, too: all of a foot's load in one cell under its middle.
  void Wear(std::size_t i) {
    const made::Inputs& seen = measured[i % measured.size()];
    for (std::size_t f = 0; f < momentum::kFeet; ++f) {
      told.insoles[f].valid = true;
      told.insoles[f].count = 1;
      told.insoles[f].p_S_m[0] = {0.11, 0};
      told.insoles[f].load_n[0] = momentum::PressureOf(seen.loads.feet[f], 1).total_n;
    }
  }
  /// Adds the impulses on the boards until the i-th frame, which comes at once.
  void Press(std::size_t i) {
    for (std::size_t f = 0; f < momentum::kFeet; ++f) {
      const momentum::FootLoads& foot = measured[i].loads.feet[f];
      std::array<double, board::kCorners> load_n{};
      for (std::size_t k = 0; k < board::kCorners; ++k) load_n[k] = foot.cells[k].load_n;
      meters[f].Add(1 + static_cast<double>(i) / made::kMadeRateHz, load_n);
      told.impulses[f] = meters[f].impulse();
    }
  }
  /// The left hand is not seen, but a Wiimote tells of its arm.
  void HoldAnArm() {
    told.sensors.hands[0].valid = false;
    told.sensors.arms[0].valid = true;
    told.sensors.arms[0].directions.upper = Eigen::Vector3d(0.3, 0.8, -0.4).normalized();
  }
  /// A camera sees two joints, one of them with errors that depend on each other.
  void SeeJoints(std::size_t i) {
    made::JointInputs& joints = told.sensors.joints;
    joints = {};
    joints[0] = {true, {0.01, 0, 1.6 + 1e-4 * static_cast<double>(i % 10)}, {0.04, 0.05, 0.1}};
    joints[7] = {true, {0, 0.1, 0.9}, {0.04, 0.05, 0.1}, {0.001, -0.0005, 0.002}};
    told.sensors.hands[0].of_skeleton = i % 2 == 0;
  }
  /// Worn sensors tell of a belt that turns and of a thigh.
  void Turn(std::size_t i) {
    arms::HandState turn;
    turn.valid = true;
    turn.heading_sd_rad = 0.12;
    turn.inclination_sd_rad = 0.02;
    const double angle_rad = 1e-3 * static_cast<double>(i);
    turn.turn_W = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(0.6, 0.8, 0)).matrix();
    told.sensors.turns[static_cast<std::size_t>(made::BodySite::kPelvis)] = turn;
    told.sensors.turns[static_cast<std::size_t>(made::BodySite::kRightThigh)] = turn;
  }
  /// One step with the i-th frame that was measured.
  void Step(std::size_t i) {
    told.sensors = measured[i % measured.size()];
    inputs.Write(told);
    Quiet();
  }
  /// One step without a word of the sensors.
  void Quiet() {
    run.StepOnSimThread(inputs, frame);
    run.FillOnSimThread(frame);
    run.TakenOnSimThread(frame);
  }

  body::Body person;
  motion::Motion motion;
  std::vector<made::Inputs> measured;
  made::Models models;
  SubjectExchange subjects;
  PoseRun run;
  exchange::Latest<PoseInputs> inputs;
  PoseInputs told;
  std::array<board::ImpulseMeter, momentum::kFeet> meters;
  PoseFrame frame;
};

inline void ExpectFinite(const v1::CharacterFrame& message) {
  for (const v1::LinkPose& link : message.characters(0).links()) {
    for (const double number : {link.position_m().x(), link.position_m().y(), link.position_m().z(),
                                link.orientation().w(), link.orientation().x(),
                                link.orientation().y(), link.orientation().z()}) {
      ASSERT_TRUE(std::isfinite(number));
    }
  }
  for (const double sd_m : message.characters(0).body().link_sd_m()) {
    ASSERT_TRUE(std::isfinite(sd_m) && sd_m >= 0);
  }
}

}  // namespace footing::pose_service
