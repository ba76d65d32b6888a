#include "daemon/sensor/kinds/kind.h"

#include "tests/fuzz/input.h"

/// A device that answers anything at any time: name, then time steps (of 5 ms) and reports.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace footing;
  using fuzz::Expect;
  fuzz::Input input(bytes, size);
  constexpr std::int64_t kStepNs = 5'000'000;
  const bool board = (input.Byte() & 1) != 0;
  const auto kind =
      kinds::MakeKind({}, {0, 0, board ? "Nintendo RVL-WBC-01" : "Nintendo RVL-CNT-01"}, {});
  std::int64_t now_ns = kStepNs;
  std::size_t sent = 0;
  std::size_t reports_taken = 0;
  while (!input.empty()) {
    now_ns += input.Byte() * kStepNs;
    kinds::Outputs outputs;
    (void)kind->Take(now_ns, input.String(), outputs);
    kind->Advance(now_ns, outputs);
    ++reports_taken;
    for (const auto& output : outputs) {
      Expect(output.size() >= 2 && output.size() <= reports::kMaxReportBytes);
    }
    sent += outputs.size();
    // A device chokes on a flood: bounded by what came in and by the time that passed.
    Expect(outputs.size() <= 8);
    Expect(sent <= 4 * reports_taken + static_cast<std::size_t>(now_ns / 10'000'000) + 8);
    Expect(kind->Note(now_ns).size() < 500);
    stream::DeviceStatus status;
    kind->AddTo(status);
  }
  return 0;
}
