#include <array>
#include <string>
#include <string_view>

#include "common/wire/model_file.h"
#include "common/wire/wire.h"
#include "footing/v1/model.pb.h"
#include "tests/fuzz/message.h"

/// Every message that has a struct of its own: what is read of any bytes, or of any fields, is
/// written with finite numbers only, and read and written again it is the same.
namespace footing::fuzz {
namespace {

template <typename Message>
void Check(Input input, bool as_bytes) {
  Message message;
  if (as_bytes) {
    const Bytes bytes = input.Rest();
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
  } else {
    Fill(input, message);
  }
  const Message once = wire::ToProto(wire::FromProto(message));
  Expect(IsFinite(once));
  const Message twice = wire::ToProto(wire::FromProto(once));
  Expect(once.SerializeAsString() == twice.SerializeAsString());
}

/// The file's bytes with the checksum that belongs to them, which no input would hit.
std::string WithDigest(std::string bytes) {
  const model::Digest digest = model::Sha256(bytes);
  bytes.append("\x7a\x20").append(digest.begin(), digest.end());
  return bytes;
}

void CheckModel(Input input) {
  v1::Model message;
  Fill(input, message);
  message.set_version(model::kVersion);
  const auto model = wire::FromModelFile(WithDigest(message.SerializeAsString()), "f");
  if (!model) return;
  const auto written = wire::ToModelFile(*model);
  Expect(written.ok() && wire::FromModelFile(*written, "f").ok());
}

void CheckModelBytes(Input input) {
  const Bytes bytes = input.Rest();
  const std::string file(bytes.begin(), bytes.end());
  (void)wire::FromModelFile(file, "f").ok();
  (void)wire::FromModelFile(WithDigest(file), "f").ok();
}

constexpr std::array kChecks{
    &Check<v1::DeviceStatus>,   &Check<v1::RawReport>,      &Check<v1::MotionSample>,
    &Check<v1::RigFeatures>,    &Check<v1::BoardSample>,    &Check<v1::NunchukSample>,
    &Check<v1::GamepadSample>,  &Check<v1::CameraSample>,   &Check<v1::BoardPose>,
    &Check<v1::BoardGeometry>,  &Check<v1::BoardLayout>,    &Check<v1::SetupItem>,
    &Check<v1::RigSetup>,       &Check<v1::Skeleton>,       &Check<v1::Track>,
    &Check<v1::GameState>,      &Check<v1::StudyState>,     &Check<v1::ServerStats>,
    &Check<v1::TrackSegment>,   &Check<v1::FailureCounts>,  &Check<v1::TrialState>,
    &Check<v1::LinkPose>,       &Check<v1::Contact>,        &Check<v1::GaitState>,
    &Check<v1::InterfaceState>, &Check<v1::ResponseStages>, &Check<v1::HandFrame>,
    &Check<v1::ReferenceFrame>, &Check<v1::HandSample>,     &Check<v1::ReferencePose>,
    &Check<v1::ContactFrame>,   &Check<v1::ContactSample>,  &Check<v1::Vector3>,
    &Check<v1::Quaternion>,     &Check<v1::CameraPoint>,    &Check<v1::GamePlayer>,
    &Check<v1::GameRound>};

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::Input input(data, size);
  const std::uint8_t type = input.Byte(), how = input.Byte();
  const std::size_t which = type % (fuzz::kChecks.size() + 2);
  if (which < fuzz::kChecks.size()) {
    fuzz::kChecks[which](input, (how & 1) != 0);
  } else if (which == fuzz::kChecks.size()) {
    fuzz::CheckModel(input);
  } else {
    fuzz::CheckModelBytes(input);
  }
  return 0;
}
