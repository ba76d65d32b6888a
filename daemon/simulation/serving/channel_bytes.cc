#include "daemon/simulation/serving/channel_bytes.h"

namespace footing::serving {

void AddFrame(const v1::CharacterFrame& frame, const v1::Events& events,
              const v1::AppliedInputs& inputs, std::vector<transport::ChannelBytes>& channels) {
  channels.push_back(Bytes(kCharacters, frame));
  if (events.events_size() > 0) channels.push_back(Bytes(kEvents, events));
  if (inputs.inputs_size() > 0) channels.push_back(Bytes(kInputs, inputs));
}

}  // namespace footing::serving
