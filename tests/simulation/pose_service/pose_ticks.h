#pragma once

#include <array>
#include <cstdint>

#include "footing/v1/session.pb.h"

/// Ticks of a sensor daemon with two boards and two hands, for the tests of the pose engine's line.
namespace footing::pose_service {

inline constexpr std::uint32_t kLeftDevice = 7, kRightDevice = 9;

inline void AddDevice(v1::Tick& tick, std::uint32_t device, v1::DeviceRole role,
                      const char* rig = "one") {
  v1::DeviceStatus& status = *tick.mutable_status()->add_devices();
  status.set_device(device);
  status.set_rig(rig);
  status.set_role(role);
}

inline v1::Tick StatusTick() {
  v1::Tick tick;
  tick.set_snapshot(true);
  AddDevice(tick, kLeftDevice, v1::DEVICE_ROLE_LEFT_BOARD);
  AddDevice(tick, kRightDevice, v1::DEVICE_ROLE_RIGHT_BOARD);
  return tick;
}

/// Loads in the order top left, top right, bottom left, bottom right.
inline void AddBoard(v1::Tick& tick, std::uint32_t device, const std::array<double, 4>& loads_n) {
  v1::BoardSample& sample = *tick.mutable_boards()->add_samples();
  sample.set_device(device);
  sample.set_top_left_n(loads_n[0]);
  sample.set_top_right_n(loads_n[1]);
  sample.set_bottom_left_n(loads_n[2]);
  sample.set_bottom_right_n(loads_n[3]);
}

inline void AddHand(v1::Tick& tick, v1::DeviceRole role, double x_m, double y_m, double z_m) {
  v1::HandSample& sample = *tick.mutable_hands()->add_samples();
  sample.set_rig("one");
  sample.set_role(role);
  sample.mutable_position_m()->set_x(x_m);
  sample.mutable_position_m()->set_y(y_m);
  sample.mutable_position_m()->set_z(z_m);
  sample.mutable_sd_m()->set_x(0.01);
  sample.mutable_sd_m()->set_y(0.01);
  sample.mutable_sd_m()->set_z(0.01);
  sample.set_confidence(1);
}

/// A joint of the tracker "kinect"; with confidence 0 it is absent.
inline v1::HandSample& AddJoint(v1::Tick& tick, v1::BodyJoint joint, double x_m, double y_m,
                                double z_m, double confidence = 1) {
  AddHand(tick, v1::DEVICE_ROLE_UNSPECIFIED, x_m, y_m, z_m);
  v1::HandSample& sample = *tick.mutable_hands()->mutable_samples()->rbegin();
  sample.set_joint(joint);
  sample.set_tracker("kinect");
  sample.set_confidence(confidence);
  return sample;
}

/// Four cells about the middle of a sole of 24 cm, each with this load.
inline void AddInsole(v1::Tick& tick, v1::ContactBody body, double load_n,
                      const char* rig = "one") {
  v1::ContactSample& sample = *tick.mutable_contacts()->add_samples();
  sample.set_rig(rig);
  sample.set_body(body);
  sample.set_simulated(true);
  for (const double x_m : {0.02, 0.22}) {
    for (const double y_m : {-0.03, 0.03}) {
      v1::ContactCell& cell = *sample.add_cells();
      cell.set_x_m(x_m);
      cell.set_y_m(y_m);
      cell.set_load_n(load_n);
    }
  }
}

}  // namespace footing::pose_service
