#include <deque>
#include <memory>

#include "common/virtual/devices/wiimote.h"
#include "daemon/sensor/kinds/kind.h"
#include "tests/fuzz/input.h"

/// A simulated Wiimote whose answers are lost, changed or late as the input says, while things are
/// plugged into it and pulled out again: the handshake takes every way that a device allows. Seeds
/// come as bytes of steps, see Step.
namespace footing::fuzz {
namespace {

using virtual_devices::Accessory;

class Conversation {
 public:
  explicit Conversation(std::uint8_t how)
      : wiimote_(how, {.tr = (how & 1) != 0, .motion_plus_inside = (how & 2) != 0}),
        kind_(kinds::MakeKind(
            {.handshake = {.motion_plus = (how & 4) == 0, .camera = (how & 8) != 0}},
            {wiimote_.identity().vendor, wiimote_.identity().product, wiimote_.identity().name},
            {})) {}

  void Step(Input& input) {
    const std::uint8_t what = input.Byte();
    switch (what % 12) {
      case 0:
        return Queue(wiimote_.Plug(static_cast<Accessory>(input.Byte() % 5), now_ns_));
      case 1:
        return Queue(wiimote_.Pull(now_ns_));
      case 2:
        return Queue(wiimote_.PullMotionPlus(now_ns_));
      case 3:
        return wiimote_.RefuseNext(input.Byte() % 8);
      case 4:  // An answer is lost.
        return Advance(input.Byte() % 4, 1);
      case 5: {  // One is changed.
        const Bytes changed = input.String();
        if (!reports_.empty()) reports_.front().assign(changed.begin(), changed.end());
        return;
      }
      case 6:
        (void)kind_->SetCamera((what & 16) != 0);
        (void)kind_->SetSphere(input.Byte());
        return;
      case 7:
        (void)kind_->RequestStatus(now_ns_);
        return;
      case 8:
        return kind_->Restart();
      case 9:  // Nothing comes for a while.
        now_ns_ += input.Byte() * std::int64_t{50'000'000};
        return;
      default:
        return Advance(input.Byte(), 0);
    }
  }

  /// 15 s of samples.
  bool IsLong() const { return samples_ > 1500; }

 private:
  void Queue(std::vector<virtual_devices::Report> reports) {
    for (auto& report : reports) reports_.push_back(std::move(report));
  }

  /// So many samples; of the answers `lost` are left out.
  void Advance(int samples, std::size_t lost) {
    constexpr std::int64_t kPeriodNs = 10'000'000;
    for (int i = 0; i < samples; ++i) {
      now_ns_ += kPeriodNs;
      ++samples_;
      Queue(wiimote_.Sample(now_ns_, {}));
      for (; lost > 0 && !reports_.empty(); --lost) reports_.pop_front();
      kinds::Outputs outputs;
      for (; !reports_.empty(); reports_.pop_front()) {
        (void)kind_->Take(now_ns_, reports_.front(), outputs);
      }
      kind_->Advance(now_ns_, outputs);
      Expect(outputs.size() <= 16);
      for (const auto& output : outputs) Queue(wiimote_.HandleOutput(now_ns_, output));
      Expect(kind_->Note(now_ns_).size() < 500);
      stream::DeviceStatus status;
      kind_->AddTo(status);
    }
  }

  virtual_devices::Wiimote wiimote_;
  std::unique_ptr<kinds::Kind> kind_;
  std::deque<virtual_devices::Report> reports_;
  std::int64_t now_ns_ = 1'000'000'000;
  int samples_ = 0;
};

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::Input input(data, size);
  fuzz::Conversation conversation(input.Byte());
  while (!input.empty() && !conversation.IsLong()) conversation.Step(input);
  return 0;
}
