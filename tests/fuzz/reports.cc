#include <variant>

#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/output_report.h"
#include "tests/fuzz/input.h"

/// Reports of one device after another: lengths and bytes. Every decoder sees every report.
namespace footing::fuzz {
namespace {

void CheckExtension(Bytes extension) {
  (void)reports::IdentifyExtension(extension);
  if (const auto board = reports::DecodeBoard(extension)) {
    const double battery = reports::BoardBatteryFraction(board->battery);
    Expect(battery >= 0 && battery <= 1);
  }
  for (const auto& nunchuk :
       {reports::DecodeNunchuk(extension), reports::DecodePassedNunchuk(extension)}) {
    if (!nunchuk) continue;
    for (const std::uint16_t counts : nunchuk->acceleration) Expect(counts < 1024);
  }
  for (const auto& classic :
       {reports::DecodeClassic(extension), reports::DecodePassedClassic(extension)}) {
    if (!classic) continue;
    Expect(classic->left_x < 64 && classic->left_y < 64);
    Expect(classic->right_x < 32 && classic->right_y < 32);
    Expect(classic->left_trigger < 32 && classic->right_trigger < 32);
  }
  const auto motion_plus = reports::DecodeMotionPlus(extension);
  Expect(motion_plus.has_value() ==
         (reports::PacketOf(extension) == reports::PassedPacket::kMotionPlus));
  if (motion_plus) {
    for (const std::uint16_t counts : motion_plus->counts) Expect(counts < 0x4000);
    Expect(reports::ChildConnected(extension) == motion_plus->extension_connected);
  }
}

void CheckData(const reports::Data& data) {
  for (const std::uint16_t counts : data.acceleration_counts) Expect(counts < 1024);
  const auto points = reports::DecodeCamera(data.camera());
  Expect(points.size() <= 4);
  for (const auto& point : points) Expect(point.x < 1024 && point.y < 768 && point.size < 16);
  CheckExtension(data.extension());
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace footing;
  using fuzz::Expect;
  fuzz::Input input(bytes, size);
  reports::Interleaver interleaver;
  reports::MemoryRead read(reports::Space::kRegisters, 0xa40020, 66);
  while (!input.empty()) {
    const fuzz::Bytes report = input.String();
    const reports::InputReport decoded = reports::Decode(report);
    Expect((decoded.buttons & 0x6060) == 0);
    if (const auto* data = std::get_if<reports::Data>(&decoded.body)) {
      fuzz::CheckData(*data);
      if (const auto joined = interleaver.Take(*data)) {
        Expect(joined->half == reports::Half::kNone);
        fuzz::CheckData(*joined);
      }
    }
    if (const auto* memory = std::get_if<reports::MemoryData>(&decoded.body)) {
      (void)read.Take(*memory);
      Expect(read.bytes().size() <= 66);
      Expect(read.Request().size() == 7);
    }
    // As they would come in by themselves, of any length.
    (void)reports::DecodeCamera(report);
    fuzz::CheckExtension(report);
  }
  return 0;
}
