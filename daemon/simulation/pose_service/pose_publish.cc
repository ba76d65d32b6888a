#include "daemon/simulation/pose_service/pose_publish.h"

#include <algorithm>
#include <array>

#include "common/body/landmarks.h"
#include "common/wire/wire.h"
#include "daemon/simulation/pose_service/pose_note.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::pose_service {
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

void SetBody(const PoseFrame& frame, const Subject& subject, const std::string& mode,
             const std::string& tracker, v1::BodyState& body) {
  body.set_subject(subject.code);
  body.set_mode(mode);
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
                                    const std::string& mode, const std::string& world,
                                    const std::string& rig, const std::string& tracker) {
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
  SetBody(frame, subject, mode, tracker, *character.mutable_body());
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

}  // namespace footing::pose_service
