#pragma once

#include <array>
#include <cstdint>

/// HID descriptor of a Wiimote and a Balance Board: 217 bytes, reports 10 to 1a out and 20 to 3f
/// in, all of opaque bytes on a vendor's page.
namespace footing::vm {

struct ReportLength {
  std::uint8_t id;
  std::uint8_t bytes;  ///< Without the id.
};
inline constexpr ReportLength kOutputReports[] = {{0x10, 1},  {0x11, 1}, {0x12, 2},  {0x13, 1},
                                                  {0x14, 1},  {0x15, 1}, {0x16, 21}, {0x17, 6},
                                                  {0x18, 21}, {0x19, 1}, {0x1a, 1}};
inline constexpr ReportLength kInputReports[] = {
    {0x20, 6},  {0x21, 21}, {0x22, 4},  {0x30, 2},  {0x31, 5},  {0x32, 10}, {0x33, 17},
    {0x34, 21}, {0x35, 21}, {0x36, 21}, {0x37, 21}, {0x3d, 21}, {0x3e, 21}, {0x3f, 21}};

inline constexpr std::size_t kDescriptorBytes = 217;

constexpr std::array<std::uint8_t, kDescriptorBytes> MakeReportDescriptor() {
  std::array<std::uint8_t, kDescriptorBytes> out{};
  std::size_t at = 0;
  const auto put = [&](std::initializer_list<int> bytes) {
    for (const int byte : bytes) out[at++] = static_cast<std::uint8_t>(byte);
  };
  put({0x05, 0x01, 0x09, 0x05, 0xa1, 0x01});  // Generic desktop, gamepad, application collection.
  bool first = true;
  for (const ReportLength& report : kOutputReports) {
    put({0x85, report.id});
    // 8 bits each, 0 to 255, on page ff00; it holds for all that follow.
    if (first) put({0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08});
    put({0x95, report.bytes});
    if (first) put({0x06, 0x00, 0xff});
    put({0x09, 0x01, 0x91, 0x00});
    first = false;
  }
  for (const ReportLength& report : kInputReports) {
    put({0x85, report.id, 0x95, report.bytes, 0x09, 0x01, 0x81, 0x00});
  }
  put({0xc0});
  return out;
}
inline constexpr auto kReportDescriptor = MakeReportDescriptor();
static_assert(kReportDescriptor.back() == 0xc0);

/// A PS Move's reports: 01 in, 02 and 06 out, features 04, 05 and 10. `input_bytes`: of report 01
/// without its id; the kernel drops what is shorter. hid-sony puts a descriptor of its own in the
/// place of whatever the first type says.
constexpr auto MakeMoveDescriptor(std::uint8_t input_bytes) {
  return std::to_array<std::uint8_t>({0x05, 0x01,        0x09, 0x04, 0xa1, 0x01,  //
                                      0x85, 0x01,        0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08,
                                      0x95, input_bytes, 0x06, 0x00,                          //
                                      0xff, 0x09,        0x01, 0x81, 0x02,                    //
                                      0x85, 0x02,        0x95, 0x30, 0x09, 0x01, 0x91, 0x02,  //
                                      0x85, 0x06,        0x95, 0x08, 0x09, 0x01, 0x91, 0x02,  //
                                      0x85, 0x04,        0x95, 0x0f, 0x09, 0x01, 0xb1, 0x02,  //
                                      0x85, 0x05,        0x95, 0x16, 0x09, 0x01, 0xb1, 0x02,  //
                                      0x85, 0x10,        0x95, 0x30, 0x09, 0x01, 0xb1, 0x02, 0xc0});
}
inline constexpr auto kZcm1Descriptor = MakeMoveDescriptor(48);
inline constexpr auto kZcm2Descriptor = MakeMoveDescriptor(43);

/// A controller of the Switch over Bluetooth: reports 21 and 30 (48 bytes) and 3f (11 bytes) in, 01
/// and 10 (48 bytes) out, all of opaque bytes on a vendor's page.
inline constexpr auto kJoyconDescriptor = std::to_array<std::uint8_t>(
    {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75,
     0x08, 0x06, 0x01, 0xff, 0x85, 0x21, 0x95, 0x30, 0x09, 0x21, 0x81, 0x02,  //
     0x85, 0x30, 0x95, 0x30, 0x09, 0x30, 0x81, 0x02,                          //
     0x85, 0x3f, 0x95, 0x0b, 0x09, 0x3f, 0x81, 0x02,                          //
     0x85, 0x01, 0x95, 0x30, 0x09, 0x01, 0x91, 0x02,                          //
     0x85, 0x10, 0x95, 0x30, 0x09, 0x10, 0x91, 0x02, 0xc0});

}  // namespace footing::vm
