#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/virtual/devices/controller.h"
#include "daemon/sensor/kinds/kind.h"

namespace footing::handshake {

/// One device as what it is, with a device model at the other end, 5 ms a step; faults are put in
/// between.
template <typename Device>
class Conversation {
 public:
  Conversation(Device device, const std::string& name)
      : device_(std::move(device)), kind_(kinds::MakeKind({}, {0, 0, name}, {})) {}

  /// Reports of the host and of the device as they arrive may be changed or dropped (false).
  std::function<bool(reports::OutputReport&)> on_output;
  std::function<bool(virtual_devices::Report&)> on_input;
  /// The device's data report of a step, if any.
  std::function<std::optional<virtual_devices::Report>(Device&)> sample;

  void Advance(double seconds) {
    for (int step = 0; step < static_cast<int>(seconds / kStepS); ++step) {
      now_ns_ += static_cast<std::int64_t>(kStepS * 1e9);
      kinds::Outputs outputs;
      kind_->Advance(now_ns_, outputs);
      for (auto& output : outputs) Send(output);
      if (!sample) continue;
      if (auto report = sample(device_)) Receive(*report);
    }
  }

  void Receive(virtual_devices::Report report) {
    if (on_input && !on_input(report)) return;
    kinds::Outputs outputs;
    (void)kind_->Take(now_ns_, report, outputs);
    for (auto& output : outputs) Send(output);
  }

  /// Time passes unseen, as in a suspension.
  void Jump(double seconds) { now_ns_ += static_cast<std::int64_t>(seconds * 1e9); }

  const HandshakeSequencer& handshake() const { return *kind_->sequencer(); }
  kinds::Kind& kind() { return *kind_; }
  stream::DeviceStatus status() const {
    stream::DeviceStatus status;
    kind_->AddTo(status);
    return status;
  }
  std::string Note() const { return kind_->Note(now_ns_); }
  Device& device() { return device_; }
  std::int64_t now_ns() const { return now_ns_; }
  /// Everything sent to the device, by id.
  int Sent(std::uint8_t id) const {
    int count = 0;
    for (const auto& output : sent_) count += output[0] == id ? 1 : 0;
    return count;
  }

 private:
  static constexpr double kStepS = 0.005;

  void Send(reports::OutputReport output) {
    sent_.push_back(output);
    if (on_output && !on_output(output)) return;
    for (auto& answer : device_.HandleOutput(output)) Receive(std::move(answer));
  }

  Device device_;
  std::unique_ptr<kinds::Kind> kind_;
  std::vector<reports::OutputReport> sent_;
  std::int64_t now_ns_ = 0;
};

}  // namespace footing::handshake
