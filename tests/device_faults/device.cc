#include <chrono>
#include <utility>

#include "common/runtime/clock.h"
#include "tests/device_faults/bench.h"

namespace footing::device_faults {

Device::Device(boost::asio::io_context& io, Testbed& testbed, const std::string& folder, int number,
               std::shared_ptr<Model> model)
    : testbed_(testbed),
      number_(number),
      model_(std::move(model)),
      node_(io, folder, number, model_->identity().name,
            {[this](std::span<const std::uint8_t> report) { Answer(report); },
             [this](std::uint8_t id, std::size_t size) { return model_->Feature(id, size); }}),
      timer_(io) {
  timer_.expires_after(std::chrono::milliseconds(1));
  Tick();
}

Device::~Device() = default;

std::size_t Device::Outputs(std::uint8_t id) const {
  std::size_t count = 0;
  for (const Output& output : outputs_) {
    if (!output.report.empty() && output.report[0] == id) ++count;
  }
  return count;
}

void Device::Send(const Report& report) {
  if (!outgoing) {
    node_.Send(report);
    return;
  }
  for (const Report& instead : outgoing(report)) node_.Send(instead);
}

void Device::SampleNow() {
  for (const Report& report : model_->Sample(clock::MonotonicNs())) Send(report);
}

void Device::Answer(std::span<const std::uint8_t> report) {
  const std::int64_t now_ns = clock::MonotonicNs();
  outputs_.push_back({now_ns, {report.begin(), report.end()}});
  const std::weak_ptr<int> alive = alive_;
  if (incoming && incoming(report)) return;
  if (alive.expired()) return;
  for (const Report& answer : model_->HandleOutput(now_ns, report)) {
    Send(answer);
    if (alive.expired()) return;
  }
}

void Device::Tick() {
  timer_.expires_at(timer_.expiry() +
                    std::chrono::nanoseconds(static_cast<std::int64_t>(model_->period_s * 1e9)));
  timer_.async_wait([this, alive = std::weak_ptr<int>(alive_)](boost::system::error_code error) {
    if (error || alive.expired()) return;
    if (sampling) SampleNow();
    if (!alive.expired()) Tick();
  });
}

}  // namespace footing::device_faults
