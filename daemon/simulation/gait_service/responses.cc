#include "daemon/simulation/gait_service/responses.h"

namespace footing::gait_service {

bool Responses::Complete(const Frame& frame, std::int64_t now_ns, v1::ResponseStages& stages) {
  const engine::EngineOutput& output = frame.output;
  if (output.response.taken_over == 0 || output.response.taken_over == shown_step_) return false;
  shown_step_ = output.response.taken_over;
  const stream::Gait from = from_;
  from_ = output.gait.gait;
  const FeatureStamps& stamps = Slot(output.response.features_number);
  const bool from_features =
      output.response.features_number > 0 && stamps.number == output.response.features_number;
  if (!from_features || output.response.taken_over < output.response.commanded) return false;
  stages.set_from(static_cast<v1::Gait>(from));
  stages.set_to(static_cast<v1::Gait>(output.gait.gait));
  stages.set_report_received_ns(stamps.report_received_ns);
  stages.set_decoded_ns(stamps.decoded_ns);
  stages.set_features_computed_ns(stamps.computed_ns);
  stages.set_features_received_ns(stamps.received_ns);
  stages.set_command_ns(frame.command_ns);
  stages.set_contact_ns(frame.contact_ns);
  stages.set_first_frame_ns(now_ns);
  return true;
}

}  // namespace footing::gait_service
