#include "daemon/sensor/kinds/joycon.h"

#include <cmath>
#include <memory>

#include "common/stream/product_ids.h"
#include "tests/fuzz/input.h"

/// A controller of the Switch that answers anything at any time: model, calibration blocks, then
/// time steps (of 5 ms) and reports. A report that begins with FF is made the reply to what was
/// asked last, with the bytes behind it as its data, which no random input would hit.
namespace footing::fuzz {
namespace {

constexpr std::int64_t kStepNs = 5'000'000;
constexpr std::uint32_t kProducts[] = {stream::kProductJoyConLeft, stream::kProductJoyConRight,
                                       stream::kProductSwitchPro};

void CheckCalibration(Input& input) {
  calibration::JoyconBlocks blocks;
  for (auto* block :
       {&blocks.factory_motion, &blocks.user_motion, &blocks.factory_sticks, &blocks.user_sticks}) {
    const Bytes bytes = input.String();
    block->assign(bytes.begin(), bytes.end());
  }
  const auto calibration = calibration::ParseJoycon(blocks);
  Expect((calibration.origin == stream::CalibrationOrigin::kDefaults) !=
         calibration.problem.empty());
  for (const double gain : calibration.gyroscope_gain_radps) Expect(gain > 0 && gain < 0.01);
  for (const auto& axes : calibration.sticks) {
    for (const std::uint16_t counts : {0, 2048, 4095}) {
      const Eigen::Vector2d at = calibration::StickOf(axes, {counts, counts});
      Expect(at.cwiseAbs().maxCoeff() <= 1);
    }
  }
}

void CheckSamples(const decode::Decoded& decoded) {
  std::int64_t before_ns = 0;
  for (const stream::MotionSample& sample : decoded.motion) {
    Expect(sample.specific_force_mps2.allFinite());
    Expect(sample.angular_velocity_radps.allFinite());
    if (!decoded.own_times) continue;
    if (before_ns != 0) Expect(sample.sampled_ns >= before_ns);
    before_ns = sample.sampled_ns;
  }
}

/// The reply to `asked`, with these data behind the address.
std::vector<std::uint8_t> ReplyTo(const reports::OutputReport& asked, Bytes data) {
  std::vector<std::uint8_t> reply(reports::kJoyconReportBytes, 0);
  reply[0] = reports::kJoyconReplyId;
  reply[13] = 0x90;
  std::copy_n(asked.begin() + 10, 6, reply.begin() + 14);
  for (std::size_t i = 1; i < data.size() && 19 + i < reply.size(); ++i) reply[19 + i] = data[i];
  return reply;
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace footing;
  using fuzz::Expect;
  fuzz::Input input(bytes, size);
  const std::uint8_t head = input.Byte();
  fuzz::CheckCalibration(input);
  const auto kind =
      kinds::MakeKind({}, {stream::kVendorNintendo, fuzz::kProducts[head % 3], "Joy-Con"}, {});
  link::Outbox outbox(kind->writing());
  outbox.SetRumble((head & 0x80) != 0);
  reports::OutputReport asked = reports::JoyconRead(0x6020, 24);
  std::int64_t now_ns = fuzz::kStepNs;
  while (!input.empty()) {
    now_ns += (input.Byte() + 1) * fuzz::kStepNs;
    const fuzz::Bytes report = input.String();
    kinds::Outputs outputs;
    const bool replies = !report.empty() && report[0] == 0xff;
    const auto decoded = replies ? kind->Take(now_ns, fuzz::ReplyTo(asked, report), outputs)
                                 : kind->Take(now_ns, report, outputs);
    if (decoded) fuzz::CheckSamples(*decoded);
    kind->Advance(now_ns, outputs);
    Expect(outputs.size() <= 1);  // One subcommand at a time.
    for (const auto& output : outputs) {
      Expect(output.size() == reports::kJoyconReportBytes);
      asked = output;
      (void)outbox.Push(output);
    }
    (void)kind->NextOutput(now_ns, outbox);
    Expect(kind->Note(now_ns).size() < 500);
    stream::DeviceStatus status;
    kind->AddTo(status);
    Expect(status.battery_fraction <= 1);
  }
  return 0;
}
