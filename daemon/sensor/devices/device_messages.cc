#include "daemon/sensor/devices/device_messages.h"

#include "footing/v1/device.pb.h"

namespace footing::devices {

std::string OutputMessage(std::uint32_t slot, const reports::OutputReport& report) {
  v1::DeviceEnvelope envelope;
  v1::DeviceOutput& output = *envelope.mutable_output();
  output.set_slot(slot);
  output.set_channel(v1::DeviceOutput::CHANNEL_INTERRUPT);
  output.set_report(report.data(), report.size());
  return envelope.SerializeAsString();
}

std::string FeatureRequestMessage(std::uint32_t slot, std::uint8_t id, std::size_t size) {
  v1::DeviceEnvelope envelope;
  v1::DeviceOutput& output = *envelope.mutable_output();
  output.set_slot(slot);
  output.set_channel(v1::DeviceOutput::CHANNEL_FEATURE_GET);
  output.set_report(&id, 1);
  output.set_size(static_cast<std::uint32_t>(size));
  return envelope.SerializeAsString();
}

std::string RefusedMessage(std::uint32_t slot, const std::string& why) {
  v1::DeviceEnvelope envelope;
  envelope.mutable_refused()->set_slot(slot);
  envelope.mutable_refused()->set_reason(why);
  return envelope.SerializeAsString();
}

}  // namespace footing::devices
