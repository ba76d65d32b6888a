#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::NunchukSample&) {
  FOOTING_FIELD(device);
  FOOTING_FIELD(report_count);
  FOOTING_FIELD(received_ns);
  FOOTING_FIELD(sampled_ns);
  FOOTING_FIELD(stick_x);
  FOOTING_FIELD(stick_y);
  FOOTING_FIELD(c);
  FOOTING_FIELD(z);
  FOOTING_MESSAGE(specific_force_mps2);
  FOOTING_FIELD(clipped_axes);
  FOOTING_FIELD(repeated);
  FOOTING_FIELD(uncalibrated);
  FOOTING_FIELD(simulated);
}
FOOTING_BOTH_WAYS(NunchukSample)

template <typename Way>
void Fields(Way way, const stream::GamepadSample&) {
  FOOTING_FIELD(device);
  FOOTING_FIELD(report_count);
  FOOTING_FIELD(received_ns);
  FOOTING_FIELD(sampled_ns);
  FOOTING_FIELD(left_x);
  FOOTING_FIELD(left_y);
  FOOTING_FIELD(right_x);
  FOOTING_FIELD(right_y);
  FOOTING_FIELD(left_trigger);
  FOOTING_FIELD(right_trigger);
  FOOTING_FIELD(buttons);
  FOOTING_FIELD(repeated);
  FOOTING_FIELD(uncalibrated);
  FOOTING_FIELD(simulated);
}
FOOTING_BOTH_WAYS(GamepadSample)

template <typename Way>
void Fields(Way way, const stream::CameraPoint&) {
  FOOTING_FIELD(x);
  FOOTING_FIELD(y);
  FOOTING_FIELD(size);
}
FOOTING_BOTH_WAYS(CameraPoint)

template <typename Way>
void Fields(Way way, const stream::CameraSample&) {
  FOOTING_FIELD(device);
  FOOTING_FIELD(received_ns);
  FOOTING_FIELD(sampled_ns);
  FOOTING_REPEATED(points);
  FOOTING_FIELD(simulated);
}
FOOTING_BOTH_WAYS(CameraSample)

}  // namespace footing::wire
